//! A beam: elements in a row, with sections that turn.
//!
//! A configuration has ten numbers for each node, `r t q`, and four for the middle of each element, `q`; there are nine
//! unknowns for each node, `r t θ`, and three for each middle, `θ`. The internal numbers are the predicted stresses of each
//! element. The start is without stress whatever its shape.

use super::element::{Element, Forces, Nodes, SPINS, STRESSES, Stresses, UNKNOWNS};
use crate::centreline::Centreline;
use crate::curve_body::{self, CurveBody, SectionMotion};
use crate::fields::{add_element_data, add_point_data, through};
use crate::hermite::{self, THREE, TWO};
use crate::mass::SectionMass;
use crate::place::{self, Line, Part};
use crate::quaternion::{self, Quaternion, spin_map};
use signorini_geometry::{Matrix, Point, Vector};
use signorini_mechanics::Curve;
use signorini_mechanics::body::{
    Body, BodyError, BodyFields, BodyState, BoxOfMaterial, Constitution, Constraint, ContactSides, Contribution,
    Elimination, Function, Hold, Kinematics, Load, Master, Order, PlaceError, Sampling, Site, Slack, SlavePoint,
};

/// Numbers of a node in a configuration, and unknowns.
pub(super) const NUMBERS: usize = 10;
pub(super) const NODE: usize = 9;

/// A geometrically exact beam.
#[derive(Clone, Debug)]
pub struct Beam {
    pub(super) name: String,
    pub(super) line: Centreline,
    pub(super) elements: Vec<Element>,
    /// Signs of the quaternions of each element that put them into one hemisphere: those of its last node and middle.
    pub(super) signs: Vec<[f64; 2]>,
    pub(super) radius: f64,
    pub(super) contact_points: usize,
    pub(super) start: Vec<f64>,
    pub(super) mass: Option<SectionMass>,
}

impl Beam {
    /// The beam with a mass of its sections.
    pub fn with_mass(mut self, mass: SectionMass) -> Self {
        self.mass = Some(mass);
        self
    }

    /// Tests contact at so many points of Gauss of each element instead of four.
    pub fn with_contact_points(mut self, count: usize) -> Self {
        self.contact_points = count.max(1);
        self
    }

    /// Where the quaternion of the middle of an element is in a configuration.
    pub(super) fn middle(&self, element: usize) -> usize {
        NUMBERS * self.line.nodes() + 4 * element
    }

    pub(super) fn nodes_of(&self, configuration: &[f64], element: usize) -> Nodes {
        let [a, b] = self.line.ends(element);
        let quaternion = |at: usize, sign: f64| Quaternion::from_column_slice(&configuration[at..at + 4]) * sign;
        let [last, middle] = self.signs[element];
        Nodes {
            centreline: self.line.nodal(configuration, element),
            rotations: [
                quaternion(NUMBERS * a + 6, 1.0),
                quaternion(NUMBERS * b + 6, last),
                quaternion(self.middle(element), middle),
            ],
        }
    }

    /// Unknowns of an element in the order of its forces.
    fn unknowns_of(&self, element: usize) -> [u32; UNKNOWNS] {
        let [a, b] = self.line.ends(element).map(|n| NODE * n);
        let middle = NODE * self.line.nodes() + 3 * element;
        std::array::from_fn(|k| match k {
            0..9 => a + k,
            9..18 => b + k - 9,
            _ => middle + k - 18,
        } as u32)
    }

    /// Spins of an element: first unknowns of those of its nodes and of its middle.
    pub(super) fn spins_of(&self, element: usize) -> [u32; 3] {
        let unknowns = self.unknowns_of(element);
        SPINS.map(|k| unknowns[k])
    }

    /// The axes of the section whose spins begin with an unknown.
    pub(super) fn frame(&self, state: &BodyState, first: u32) -> Matrix<3> {
        let (first, of_nodes) = (first as usize, NODE * self.line.nodes());
        let at = if first < of_nodes { first / NODE * NUMBERS + 6 } else { self.middle((first - of_nodes) / 3) };
        quaternion::rotation(&Quaternion::from_column_slice(&state.configuration[at..at + 4]))
    }

    fn predicted(internal: &[f64], element: usize) -> Stresses {
        let own = &internal[STRESSES * element..STRESSES * (element + 1)];
        std::array::from_fn(|k| Vector::<3>::from_column_slice(&own[3 * k..3 * k + 3]))
    }

    /// Number of elements.
    pub fn elements(&self) -> usize {
        self.elements.len()
    }

    /// Position of a node.
    pub fn position(&self, state: &BodyState, node: usize) -> Vector<3> {
        self.line.position(&state.configuration, node)
    }

    /// The quaternion of a node: the rotation of its section.
    pub fn rotation_of(&self, state: &BodyState, node: usize) -> Quaternion {
        Quaternion::from_column_slice(&state.configuration[NUMBERS * node + 6..NUMBERS * (node + 1)])
    }

    /// The state after a given motion of all of it: of positions, and of vectors and rotations by a quaternion.
    pub fn moved(
        &self,
        state: &BodyState,
        motion: impl Fn(&Vector<3>) -> (Vector<3>, Quaternion, Vector<3>),
    ) -> BodyState {
        let mut next = state.clone();
        let c = &mut next.configuration;
        for node in 0..self.line.nodes() {
            let at = NUMBERS * node;
            let x = self.line.position(&state.configuration, node);
            let (position, turn, shear) = motion(&x);
            let t = quaternion::rotation(&turn) * self.line.derivative(&state.configuration, node) + shear;
            let q = quaternion::product(&turn, &self.rotation_of(state, node));
            c[at..at + 3].copy_from_slice(position.as_slice());
            c[at + 3..at + 6].copy_from_slice(t.as_slice());
            c[at + 6..at + 10].copy_from_slice(q.as_slice());
        }
        for e in 0..self.line.elements() {
            let at = self.middle(e);
            let x = self.line.jet(&state.configuration, e, 0.5).x;
            let q =
                quaternion::product(&motion(&x).1, &Quaternion::from_column_slice(&state.configuration[at..at + 4]));
            c[at..at + 4].copy_from_slice(q.as_slice());
        }
        next.internal = self.true_stresses(&next.configuration);
        next
    }

    fn true_stresses(&self, configuration: &[f64]) -> Vec<f64> {
        (0..self.elements.len())
            .flat_map(|e| {
                let stresses = self.elements[e].stresses(&self.nodes_of(configuration, e));
                stresses.into_iter().flat_map(|s| [s[0], s[1], s[2]])
            })
            .collect()
    }

    fn line_of<'a>(&'a self, state: &'a BodyState) -> Line<'a> {
        Line { body: &self.name, line: &self.line, start: &self.start, now: &state.configuration, shares: None }
    }
}

impl CurveBody for Beam {
    fn centreline(&self) -> &Centreline {
        &self.line
    }

    fn radius(&self) -> f64 {
        self.radius
    }

    fn contact_points(&self) -> usize {
        self.contact_points
    }

    fn section(&self, configuration: &[f64], element: usize, xi: f64) -> SectionMotion {
        let nodes = self.nodes_of(configuration, element);
        let (l, l1) = (hermite::quadratic(xi), hermite::quadratic_first(xi));
        let sum = |l: &[f64; 3]| (0..3).fold(Quaternion::zeros(), |sum, a| sum + nodes.rotations[a] * l[a]);
        let (q, q1) = (sum(&l), sum(&l1));
        let square = q.norm_squared();
        let [inverse, slope] = [q, q1].map(|q| quaternion::conjugate(&q) * (2.0 / square));
        let spins = self.spins_of(element);
        let spin = (0..3)
            .flat_map(|a| {
                let map = spin_map(&nodes.rotations[a]);
                (0..3).map(move |i| {
                    let of = |q: &Quaternion| quaternion::vector(&quaternion::product(&map.column(i).into_owned(), q));
                    let unit = of(&inverse);
                    let along = unit * (l1[a] - l[a] * 2.0 * q.dot(&q1) / square) + of(&slope) * l[a];
                    let slopes = [along, Vector::<3>::zeros()];
                    Function { unknown: spins[a] + i as u32, value: unit * l[a], slopes, ..Function::default() }
                })
            })
            .collect();
        SectionMotion { spin, frame: quaternion::rotation(&q) }
    }

    /// With `w_ai = L_a vec(e_i q_a Q*)/S` the spin per unit of each unknown and `δq_b = ½ e_j q_b`, the derivative of `w_ai`,
    /// plus half of `w` along `e_j × e_i` where both are of one node: what turns with the node counts half.
    fn spin_bends(&self, configuration: &[f64], element: usize, xi: f64) -> Vec<Vector<3>> {
        let nodes = self.nodes_of(configuration, element);
        let l = hermite::quadratic(xi);
        let q = (0..3).fold(Quaternion::zeros(), |sum, a| sum + nodes.rotations[a] * l[a]);
        let square = q.norm_squared();
        let conjugate = quaternion::conjugate(&q);
        let turned = |v: &Vector<3>, q: &Quaternion| quaternion::product(&quaternion::pure(v), q);
        let spin = |a: usize, v: &Vector<3>| {
            quaternion::vector(&quaternion::product(&turned(v, &nodes.rotations[a]), &conjugate)) * (l[a] / square)
        };
        let bend = |(a, e_i): (usize, Vector<3>), (b, e_j): (usize, Vector<3>)| {
            let own = turned(&e_i, &nodes.rotations[a]) * l[a];
            let d_q = turned(&e_j, &nodes.rotations[b]) * (0.5 * l[b]);
            let changed = quaternion::vector(&quaternion::product(&own, &quaternion::conjugate(&d_q))) / square
                - spin(a, &e_i) * (2.0 * q.dot(&d_q) / square);
            if a != b {
                return changed;
            }
            let twice = turned(&e_i, &turned(&e_j, &nodes.rotations[a])) * (0.5 * l[a] / square);
            changed + quaternion::vector(&quaternion::product(&twice, &conjugate)) + spin(a, &e_j.cross(&e_i)) * 0.5
        };
        let all = |k: usize| (k / 3, quaternion::axis(k % 3));
        (0..81).map(|k| bend(all(k / 9), all(k % 9))).collect()
    }
}

impl Body for Beam {
    fn name(&self) -> &str {
        &self.name
    }

    fn unknowns(&self) -> usize {
        NODE * self.line.nodes() + 3 * self.line.elements()
    }

    fn start(&self) -> BodyState {
        BodyState { configuration: self.start.clone(), internal: vec![0.0; STRESSES * self.elements.len()] }
    }

    fn advance(&self, state: &BodyState, step: &[f64], share: f64) -> BodyState {
        let mut next = state.clone();
        let c = &mut next.configuration;
        let spin = |at: usize| Vector::<3>::from_column_slice(&step[at..at + 3]) * share;
        let turn = |c: &mut [f64], theta: Vector<3>| {
            let q = quaternion::product(&quaternion::exponential(&theta), &Quaternion::from_column_slice(c));
            c.copy_from_slice((q / q.norm()).as_slice());
        };
        for node in 0..self.line.nodes() {
            let (at, first) = (NUMBERS * node, NODE * node);
            (0..6).for_each(|k| c[at + k] += share * step[first + k]);
            turn(&mut c[at + 6..at + 10], spin(first + 6));
        }
        for e in 0..self.elements.len() {
            let at = self.middle(e);
            turn(&mut c[at..at + 4], spin(NODE * self.line.nodes() + 3 * e));
        }
        next.internal = (0..self.elements.len())
            .flat_map(|e| {
                let unknowns = self.unknowns_of(e);
                let own = Forces::from_fn(|k, _| share * step[unknowns[k] as usize]);
                let stresses = self.elements[e].predicted(&self.nodes_of(&state.configuration, e), &own);
                stresses.into_iter().flat_map(|s| [s[0], s[1], s[2]])
            })
            .collect();
        next
    }

    fn internal(&self, state: &BodyState, order: Order, out: &mut Contribution) -> Result<f64, BodyError> {
        let mut energy = 0.0;
        for (e, element) in self.elements.iter().enumerate() {
            let nodes = self.nodes_of(&state.configuration, e);
            let unknowns = self.unknowns_of(e);
            let (stored, forces) = element.forces(&nodes);
            if !stored.is_finite() {
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
        if hold.rotation.iter().all(Option::is_none) {
            return Ok(out);
        }
        for node in place::nodes(&self.line, &part) {
            let reference = self.line.position(&self.start, node);
            let from = Quaternion::from_column_slice(&self.start[NUMBERS * node + 6..NUMBERS * (node + 1)]);
            let now = self.rotation_of(state, node);
            let first = (NODE * node + 6) as u32;
            let wanted = hold.rotation.map(|f| f.map(|f| f(&reference)));
            if let [Some(x), Some(y), Some(z)] = wanted {
                // The spin that is lacking, whatever the angle.
                let target = quaternion::product(&quaternion::exponential(&Vector::<3>::new(x, y, z)), &from);
                let violation = quaternion::logarithm(&quaternion::product(&now, &quaternion::conjugate(&target)));
                for i in 0..3 {
                    out.push(Constraint::of_component(vec![(first + i as u32, 1.0)], violation[i], 3 + i));
                }
                continue;
            }
            let phi = quaternion::logarithm(&quaternion::product(&now, &quaternion::conjugate(&from)));
            let map = quaternion::inverse_tangent_map(&phi);
            for (i, value) in wanted.iter().enumerate() {
                if let Some(value) = value {
                    let terms = (0..3).map(|j| (first + j as u32, map[(i, j)])).collect();
                    out.push(Constraint::of_component(terms, phi[i] - value, 3 + i));
                }
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
        let part = place::part(&self.name, &self.line, on)?;
        let (given, follows) = match (load, &part) {
            (Load::Moment(m), Part::Nodes(_)) => (*m, 0.0),
            (Load::FollowerMoment(m), Part::Nodes(_)) => (*m, 1.0),
            (Load::Moment(_) | Load::FollowerMoment(_), Part::Whole) => {
                let message = "a moment acts on an end: `start` or `end`".to_string();
                return Err(PlaceError::Unsuitable { body: self.name.clone(), message });
            }
            _ => return self.line_of(state).load(&part, load, order, out),
        };
        let nodes = place::nodes(&self.line, &part);
        for &node in &nodes {
            let first = NODE * node + 6;
            let share = given / nodes.len() as f64;
            // Turns with the section since the start.
            let from = Quaternion::from_column_slice(&self.start[NUMBERS * node + 6..NUMBERS * (node + 1)]);
            let turned = quaternion::product(&self.rotation_of(state, node), &quaternion::conjugate(&from));
            let m = if follows > 0.0 { quaternion::rotation(&turned) * share } else { share };
            (0..3).for_each(|i| out.forces[first + i] -= m[i]);
            if order == Order::Second {
                // Derivatives of forces plus half the cross matrix of the residual: as those of the elements.
                let block = m.cross_matrix() * (follows - 0.5);
                let rows: Vec<f64> = (0..9).map(|k| block[(k / 3, k % 3)]).collect();
                out.add_block(&[first as u32, first as u32 + 1, first as u32 + 2], &rows);
            }
        }
        Ok(())
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
        // A beam clamped at the ends of the element, loaded in its middle.
        let element = &self.elements[site.patch as usize];
        let bending = element.stiffness.bending[0].min(element.stiffness.bending[1]);
        192.0 * bending / element.length.powi(3)
    }

    fn rigid_modes(&self, state: &BodyState) -> [Vec<f64>; 6] {
        let mut modes = self.line_of(state).rigid_modes(self.unknowns());
        for (mode, out) in modes.iter_mut().enumerate().skip(3) {
            self.spins().iter().for_each(|s| out[s[mode - 3] as usize] = 1.0);
        }
        modes
    }

    fn size(&self) -> f64 {
        self.line.length()
    }

    fn fields(&self, state: &BodyState) -> BodyFields {
        let mut fields = crate::fields::of_curve(&self.line, &self.start, &state.configuration);
        let stresses: Vec<Stresses> = (self.elements.iter().enumerate())
            .map(|(e, element)| element.stresses(&self.nodes_of(&state.configuration, e)))
            .collect();
        // Forces are linear through two points, moments quadratic through three.
        let force = |a: usize, e: usize, xi: f64| through(TWO.map(|p| p.0), [0, 1].map(|k| stresses[e][k][a]), xi);
        let moment =
            |a: usize, e: usize, xi: f64| through(THREE.map(|p| p.0), [5, 6, 7].map(|k| stresses[e][k][a]), xi);
        let axial = (0..stresses.len()).map(|e| force(0, e, 0.5)).collect();
        add_element_data(&mut fields, "axial_force", 1, axial);
        add_point_data(&mut fields, (&self.line, "shear_force", 2), |e, xi| vec![force(1, e, xi), force(2, e, xi)]);
        add_point_data(&mut fields, (&self.line, "torque", 1), |e, xi| vec![moment(0, e, xi)]);
        add_point_data(&mut fields, (&self.line, "bending_moment", 2), |e, xi| {
            vec![moment(1, e, xi), moment(2, e, xi)]
        });
        fields
    }
}

impl Kinematics for Beam {
    fn spins(&self) -> Vec<[u32; 3]> {
        let three = |first: usize| [first as u32, first as u32 + 1, first as u32 + 2];
        let nodes = self.line.nodes();
        let of_nodes = (0..nodes).map(|n| three(NODE * n + 6));
        of_nodes.chain((0..self.elements.len()).map(|e| three(NODE * nodes + 3 * e))).collect()
    }

    fn point(&self, on: Option<&str>) -> Option<Point<3>> {
        place::point(&self.line, &self.start, &place::part(&self.name, &self.line, on).ok()?)
    }
}

impl Elimination for Beam {}

impl ContactSides for Beam {
    fn curve<'a>(&'a self, on: Option<&str>) -> Option<Box<dyn Curve + 'a>> {
        curve_body::curve(self, on)
    }
}

impl Slack for Beam {}

impl BoxOfMaterial for Beam {}

impl Constitution for Beam {}
