//! A cable, or a beam free of torsion, as a body.
//!
//! There are six unknowns for each node: position and derivative along the unstrained length. The internal numbers are the
//! predicted forces of each element.

use super::element::{Carries, Element, Forces, STRESSES, Stresses, UNKNOWNS};
use crate::centreline::{Centreline, Continuity};
use crate::chain::body::{ChainError, ReferenceLength, check_radius, positive};
use crate::curve_body::{self, CurveBody};
use crate::fields::{add_point_data, through};
use crate::hermite::THREE;
use crate::mass;
use crate::path::Sampled;
use crate::place::{self, Line};
use crate::quaternion;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::Curve;
use signorini_mechanics::body::{
    Body, BodyError, BodyFields, BodyState, BoxOfMaterial, Constitution, Constraint, ContactSides, Contribution,
    Elimination, Hold, Inertial, Kinematics, Load, Mass, Master, Order, PlaceError, Sampling, Site, Slack, SlavePoint,
};

/// A cable that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CableError {
    #[error("a cable requires a smooth path: sample it with continuity C1")]
    NotSmooth,
    #[error(transparent)]
    Number(#[from] ChainError),
}

/// A smooth curve that resists stretch and bending.
#[derive(Clone, Debug)]
pub struct Cable {
    name: String,
    line: Centreline,
    elements: Vec<Element>,
    radius: f64,
    contact_points: usize,
    start: Vec<f64>,
    /// The stiffness that is stated.
    stiffness: f64,
    mass_per_length: Option<f64>,
}

impl Cable {
    /// A curve along a path, bent from straight: `axial` is `EA`, `bending` is `EI` and may be 0 in a cable.
    ///
    /// # Errors
    /// A path with kinks; stiffness, length, tension or radius out of range.
    pub fn new(
        name: &str,
        path: &Sampled,
        axial: f64,
        bending: f64,
        carries: Carries,
        rest: ReferenceLength,
        radius: f64,
    ) -> Result<Self, CableError> {
        if path.continuity != Continuity::C1 {
            return Err(CableError::NotSmooth);
        }
        positive("stiffness", axial)?;
        check_radius(radius)?;
        match carries {
            Carries::TensionAndCompression => positive("bending stiffness", bending)?,
            Carries::TensionOnly if bending != 0.0 => positive("bending stiffness", bending)?,
            Carries::TensionOnly => {}
        }
        let ratio = rest.ratio(path.lengths.iter().sum(), axial)?;
        let lengths: Vec<f64> = path.lengths.iter().map(|h| h * ratio).collect();
        let line = Centreline::new(lengths, path.closure, Continuity::C1, [6, 6]);
        let start: Vec<f64> = (path.positions.iter().zip(&path.tangents))
            .flat_map(|(r, t)| {
                let t = t / ratio;
                [r[0], r[1], r[2], t[0], t[1], t[2]]
            })
            .collect();
        let elements = (0..line.elements())
            .map(|e| Element::new(line.lengths[e], axial, bending, carries, &line.nodal(&start, e)))
            .collect();
        Ok(Cable {
            name: name.to_string(),
            line,
            elements,
            radius,
            contact_points: 4,
            start,
            stiffness: axial,
            mass_per_length: None,
        })
    }

    /// Tests contact at so many points of Gauss of each element instead of four.
    pub fn with_contact_points(mut self, count: usize) -> Self {
        self.contact_points = count.max(1);
        self
    }

    /// The cable with a mass per unstrained length.
    pub fn with_mass(mut self, mass_per_length: f64) -> Self {
        self.mass_per_length = Some(mass_per_length);
        self
    }

    /// The same shape with the forces of this cable: to go on from the shape of one of another stiffness.
    pub fn restart(&self, state: &BodyState) -> BodyState {
        let nodal = |e: usize| self.line.nodal(&state.configuration, e);
        let internal = self.internal_numbers(|e| self.elements[e].stresses(&nodal(e)));
        BodyState { configuration: state.configuration.clone(), internal }
    }

    /// Number of elements.
    pub fn elements(&self) -> usize {
        self.elements.len()
    }

    /// Position of a node.
    pub fn position(&self, state: &BodyState, node: usize) -> Vector<3> {
        self.line.position(&state.configuration, node)
    }

    /// The axial force of each element, the mean of two points.
    pub fn tensions(&self, state: &BodyState) -> Vec<f64> {
        let of = |e: usize| self.elements[e].stresses(&self.line.nodal(&state.configuration, e)).axial;
        (0..self.elements.len()).map(|e| 0.5 * (of(e)[0] + of(e)[1])).collect()
    }

    /// Elements without tension.
    pub fn slack(&self, state: &BodyState) -> Vec<usize> {
        self.tensions(state).iter().enumerate().filter(|(_, t)| **t <= 0.0).map(|(e, _)| e).collect()
    }

    fn unknowns_of(&self, element: usize) -> [u32; UNKNOWNS] {
        let [a, b] = self.line.ends(element).map(|n| 6 * n);
        std::array::from_fn(|k| if k < 6 { a + k } else { b + k - 6 } as u32)
    }

    fn predicted(internal: &[f64], element: usize) -> Stresses {
        let own = &internal[STRESSES * element..STRESSES * (element + 1)];
        Stresses {
            axial: std::array::from_fn(|k| own[k]),
            moments: std::array::from_fn(|k| Vector::<3>::from_column_slice(&own[5 + 3 * k..8 + 3 * k])),
        }
    }

    fn internal_numbers(&self, stresses: impl Fn(usize) -> Stresses) -> Vec<f64> {
        (0..self.elements.len())
            .flat_map(|e| {
                let s = stresses(e);
                s.axial.into_iter().chain(s.moments.into_iter().flat_map(|m| [m[0], m[1], m[2]]))
            })
            .collect()
    }

    fn line_of<'a>(&'a self, state: &'a BodyState) -> Line<'a> {
        Line { body: &self.name, line: &self.line, start: &self.start, now: &state.configuration, shares: None }
    }
}

impl CurveBody for Cable {
    fn centreline(&self) -> &Centreline {
        &self.line
    }

    fn radius(&self) -> f64 {
        self.radius
    }

    fn contact_points(&self) -> usize {
        self.contact_points
    }
}

impl Body for Cable {
    fn name(&self) -> &str {
        &self.name
    }

    fn unknowns(&self) -> usize {
        self.start.len()
    }

    fn start(&self) -> BodyState {
        let internal = self.internal_numbers(|e| self.elements[e].stresses(&self.line.nodal(&self.start, e)));
        BodyState { configuration: self.start.clone(), internal }
    }

    fn advance(&self, state: &BodyState, step: &[f64], share: f64) -> BodyState {
        let configuration = state.configuration.iter().zip(step).map(|(x, s)| x + share * s).collect();
        let internal = self.internal_numbers(|e| {
            let unknowns = self.unknowns_of(e);
            let own = Forces::from_fn(|k, _| share * step[unknowns[k] as usize]);
            self.elements[e].predicted(&self.line.nodal(&state.configuration, e), &own)
        });
        BodyState { configuration, internal }
    }

    fn internal(&self, state: &BodyState, order: Order, out: &mut Contribution) -> Result<f64, BodyError> {
        let mut energy = 0.0;
        for (e, element) in self.elements.iter().enumerate() {
            let nodes = self.line.nodal(&state.configuration, e);
            let unknowns = self.unknowns_of(e);
            let (stored, forces) = element.forces(&nodes);
            if !stored.is_finite() || !forces.iter().all(|f| f.is_finite()) {
                return Err(BodyError::Inverted { body: self.name.clone(), cell: e });
            }
            energy += stored;
            (0..UNKNOWNS).for_each(|k| out.forces[unknowns[k] as usize] += forces[k]);
            if order == Order::Second {
                let tangent = element.tangent(&nodes, &Self::predicted(&state.internal, e));
                // Symmetric: columns are rows.
                out.add_block(&unknowns, tangent.as_slice());
            }
        }
        Ok(energy)
    }

    fn hold(&self, on: Option<&str>, hold: &Hold<'_>, state: &BodyState) -> Result<Vec<Constraint>, PlaceError> {
        hold.check_components(&self.name)?;
        let part = place::part(&self.name, &self.line, on)?;
        let mut out = self.line_of(state).hold(&part, hold);
        let [x, y, z] = match hold.rotation {
            [None, None, None] => return Ok(out),
            [Some(x), Some(y), Some(z)] => [x, y, z],
            _ => {
                let message = "without torsion the direction of an end is held as a whole: give all of its rotation";
                return Err(PlaceError::Unsuitable { body: self.name.clone(), message: message.to_string() });
            }
        };
        for node in place::nodes(&self.line, &part) {
            let reference = self.line.position(&self.start, node);
            let phi = Vector::<3>::new(x(&reference), y(&reference), z(&reference));
            let turn = quaternion::rotation(&quaternion::exponential(&phi));
            let along = (turn * self.line.derivative(&self.start, node)).normalize();
            let now = self.line.derivative(&state.configuration, node);
            // The derivative has no parts across the wanted direction; its length is free.
            let first = along.cross(&quaternion::axis(along.iamin())).normalize();
            for across in [first, along.cross(&first)] {
                let moment = along.cross(&across);
                let terms = (0..3).map(|i| ((6 * node + 3 + i) as u32, across[i])).collect();
                out.push(Constraint::of_component(terms, across.dot(&now), 3 + moment.iamax()));
            }
        }
        Ok(out)
    }

    fn load(
        &self,
        on: Option<&str>,
        load: &Load<'_>,
        state: &BodyState,
        order: Order,
        out: &mut Contribution,
    ) -> Result<(), PlaceError> {
        self.line_of(state).load(&place::part(&self.name, &self.line, on)?, load, order, out)
    }

    fn sites(&self, on: Option<&str>, sampling: Sampling) -> Result<Vec<Site>, PlaceError> {
        curve_body::sites(self, on, sampling)
    }

    fn placed(&self, state: &BodyState, site: &Site) -> SlavePoint {
        curve_body::placed(self, state, site)
    }

    fn master<'a>(&'a self, on: Option<&str>, state: &'a BodyState) -> Result<Box<dyn Master + 'a>, PlaceError> {
        curve_body::master(self, on, state)
    }

    fn site_stiffness(&self, site: &Site) -> f64 {
        let element = &self.elements[site.patch as usize];
        match element.carries {
            Carries::TensionOnly => element.axial / element.length,
            Carries::TensionAndCompression => 192.0 * element.bending / element.length.powi(3),
        }
    }

    fn rigid_modes(&self, state: &BodyState) -> [Vec<f64>; 6] {
        self.line_of(state).rigid_modes(self.unknowns())
    }

    fn size(&self) -> f64 {
        self.line.length()
    }

    fn fields(&self, state: &BodyState) -> BodyFields {
        let mut fields = crate::fields::of_curve(&self.line, &self.start, &state.configuration);
        crate::fields::add_element_data(&mut fields, "tension", 1, self.tensions(state));
        let moments: Vec<[Vector<3>; 3]> = (0..self.elements.len())
            .map(|e| self.elements[e].stresses(&self.line.nodal(&state.configuration, e)).moments)
            .collect();
        let component = |e: usize, xi: f64, i: usize| through(THREE.map(|p| p.0), moments[e].map(|m| m[i]), xi);
        add_point_data(&mut fields, (&self.line, "bending_moment", 1), |e, xi| {
            vec![Vector::<3>::from_fn(|i, _| component(e, xi, i)).norm()]
        });
        fields
    }
}

impl Kinematics for Cable {
    fn point(&self, on: Option<&str>) -> Option<Point<3>> {
        place::point(&self.line, &self.start, &place::part(&self.name, &self.line, on).ok()?)
    }
}

impl signorini_mechanics::Thermal for Cable {}

impl Inertial for Cable {
    fn mass(&self, _: &[Option<&str>]) -> Result<Option<Mass>, PlaceError> {
        Ok(self.mass_per_length.map(|mass| mass::consistent(&self.line, mass, 6)))
    }
}

impl Elimination for Cable {}

impl ContactSides for Cable {
    fn curve<'a>(&'a self, on: Option<&str>) -> Option<Box<dyn Curve + 'a>> {
        curve_body::curve(self, on)
    }
}

impl Slack for Cable {
    fn is_slack(&self, state: &BodyState, longer: f64) -> bool {
        let is_slack = |(e, own): (usize, &Element)| own.is_slack(&self.line.nodal(&state.configuration, e), longer);
        self.elements.iter().enumerate().all(is_slack)
    }

    fn add_sag_spring(&mut self, force: f64) {
        let is_cable = |e: &&mut Element| e.carries == Carries::TensionOnly;
        self.elements.iter_mut().filter(is_cable).for_each(|e| e.tightened = force);
    }

    fn soften(&mut self, share: f64) -> f64 {
        let axial = share * self.stiffness;
        let is_cable = |e: &&mut Element| e.carries == Carries::TensionOnly;
        let softened = self.elements.iter_mut().filter(is_cable).map(|e| e.axial = axial).count();
        if softened > 0 { self.stiffness } else { 0.0 }
    }
}

impl BoxOfMaterial for Cable {}

impl Constitution for Cable {}
