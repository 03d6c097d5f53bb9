//! What a body is to the system: unknowns with forces and tangent, places that are held or loaded, points that touch.
//!
//! Positions and forces have three components; a plane or axisymmetric body has no unknowns along z, and integrates over
//! its thickness or circumference. A body numbers its own unknowns from 0. A configuration may hold more numbers than
//! there are unknowns (a quaternion turns by three): a step of the unknowns reaches it through [`Body::advance`].

pub use crate::points::{
    Anchor, Direction, Foot, Function, Master, MasterProjection, MaterialPoint, Order, RigidFoot, Sampling,
    SecondDerivative, Site, SlavePoint,
};

use crate::axes::Axes;
pub use crate::constitution::{BoxOfMaterial, Constitution, Means, PointValues, Samples, UnstableMaterial};
use crate::curve::Curve;
pub use crate::dynamics::{Inertial, Mass};
pub use crate::heat::Thermal;
use crate::linear_solver::Subspaces;
use crate::surface::Surface;
use signorini_geometry::polyhedra::Placed;
use signorini_geometry::{Matrix, Point, Vector};

/// What a body carries from one increment to the next, as plain numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyState {
    /// Displacements, rotations.
    pub configuration: Vec<f64>,
    /// Whatever else: stresses predicted for the next iteration, history variables.
    pub internal: Vec<f64>,
}

/// Forces on unknowns and their derivatives, summed up in the body's own numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contribution {
    /// Residual: internal forces positive, loads negative.
    pub forces: Vec<f64>,
    /// Its derivative as dense blocks, row by row, of a few unknowns each.
    pub blocks: Vec<(Vec<u32>, Vec<f64>)>,
}

impl Contribution {
    /// No forces on so many unknowns.
    pub fn new(unknowns: usize) -> Self {
        Contribution { forces: vec![0.0; unknowns], blocks: Vec::new() }
    }

    /// Multiplies all by a factor.
    pub(crate) fn scale(&mut self, factor: f64) {
        if factor != 1.0 {
            let values = self.blocks.iter_mut().flat_map(|block| &mut block.1);
            self.forces.iter_mut().chain(values).for_each(|v| *v *= factor);
        }
    }

    /// Multiplies the rows of some unknowns by a factor.
    pub(crate) fn scale_rows(&mut self, is_scaled: impl Fn(u32) -> bool, factor: f64) {
        let scaled = |(k, v): (u32, &mut f64)| *v *= if is_scaled(k) { factor } else { 1.0 };
        (0u32..).zip(&mut self.forces).for_each(scaled);
        for (unknowns, values) in &mut self.blocks {
            let rows = values.chunks_mut(unknowns.len().max(1)).zip(unknowns.iter());
            rows.for_each(|(row, k)| row.iter_mut().for_each(|v| scaled((*k, v))));
        }
    }

    /// Adds to the derivative a dense block, row by row.
    pub fn add_block(&mut self, unknowns: &[u32], values: &[f64]) {
        debug_assert_eq!(unknowns.len() * unknowns.len(), values.len());
        self.blocks.push((unknowns.to_vec(), values.to_vec()));
    }
}

/// A value that varies in space and time: at a reference position.
pub type Field<'a> = &'a dyn Fn(&Point<3>) -> f64;
/// A vector that varies in space.
pub type VectorField<'a> = &'a dyn Fn(&Point<3>) -> Vector<3>;

/// How a place is held. Components that are free are `None`.
#[derive(Default)]
pub struct Hold<'a> {
    /// Prescribed displacement, along the axes of space if no others are given.
    pub displacement: [Option<Field<'a>>; 3],
    /// The axes of the components of the displacement.
    pub axes: Option<Axes>,
    /// Prescribed rotation vector of the sections of a beam or of a rigid body, against the start.
    pub rotation: [Option<Field<'a>>; 3],
    /// Prescribed displacement along a unit vector.
    pub along: Option<(Vector<3>, Field<'a>)>,
    /// Components of the displacement that are the same all over the place, and free.
    pub uniform: [bool; 3],
}

impl Hold<'_> {
    /// Refuses what only solids can be held by.
    ///
    /// # Errors
    /// A displacement along a direction or axes, or components that are uniform.
    pub fn check_components(&self, body: &str) -> Result<(), PlaceError> {
        if self.along.is_none() && self.axes.is_none() && self.uniform == [false; 3] {
            return Ok(());
        }
        let message = "only solids can be held along an inclined normal or axes of their own, or uniformly".to_string();
        Err(PlaceError::Unsuitable { body: body.to_string(), message })
    }
}

/// An equation between unknowns: the step of the unknowns times `terms`, plus `violation`, is zero.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Constraint {
    pub terms: Vec<(u32, f64)>,
    /// How far what is held is from where it should be.
    pub violation: f64,
    /// Force and moment of the support on the body per unit of its multiplier.
    pub reaction: [Vector<3>; 2],
}

impl Constraint {
    /// Prescribes a component of displacements (0..3) or rotations (3..6), whose reaction is a force or moment along it.
    pub fn of_component(terms: Vec<(u32, f64)>, violation: f64, component: usize) -> Self {
        let mut reaction = [Vector::<3>::zeros(); 2];
        reaction[component / 3][component % 3] = 1.0;
        Constraint { terms, violation, reaction }
    }

    /// Whether it prescribes a rotation.
    pub fn turns(&self) -> bool {
        self.reaction[1] != Vector::<3>::zeros()
    }
}

/// What acts on a place.
pub enum Load<'a> {
    /// Force per volume (per length of a curve), on the reference configuration.
    BodyForce(VectorField<'a>),
    /// Force per reference area, in a fixed direction.
    Traction(VectorField<'a>),
    /// Force per current area along the inward normal.
    Pressure(Field<'a>),
    /// Resultant.
    Force(Vector<3>),
    /// Force on each node.
    NodalForce(Vector<3>),
    /// Resultant moment about fixed axes.
    Moment(Vector<3>),
    /// Moment about axes that turn with the section.
    FollowerMoment(Vector<3>),
    /// Force along the end of a rope, pulling.
    Tension(f64),
    /// Springs to the ground at the place: force per displacement along each axis.
    Springs(Vector<3>),
}

/// A body that cannot follow.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BodyError {
    /// A cell is turned inside out, or a rope shrunk to a point.
    #[error("cell {cell} of `{body}` is inverted or has no volume")]
    Inverted { body: String, cell: usize },
    #[error("cell {cell} of `{body}`: {message}")]
    Material { body: String, cell: usize, message: String },
    /// What happened on one of several processes.
    #[error("{message}")]
    OfProcess { message: String },
}

/// A place that a body does not have, or that cannot be used in this way.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlaceError {
    #[error("`{body}` has no group `{group}`; valid are {}", known.join(", "))]
    Unknown { body: String, group: String, known: Vec<String> },
    #[error("`{body}`: {message}")]
    Unsuitable { body: String, message: String },
}

impl PlaceError {
    /// The name of the body.
    pub fn body(&self) -> &str {
        let (Self::Unknown { body, .. } | Self::Unsuitable { body, .. }) = self;
        body
    }
}

/// Points, cells and named arrays of a body, as it is shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyFields {
    /// Reference positions.
    pub points: Vec<Point<3>>,
    /// Displacement of each point.
    pub displacement: Vec<Vector<3>>,
    /// Point numbers of each cell: two make a segment, three a triangle, four a quadrilateral, eight a
    /// hexahedron. A tetrahedron is `a b c c d d d d`, a wedge `a b c c d e f f`.
    pub cells: Vec<Vec<u32>>,
    /// Name, number of components, values point by point.
    pub point_data: Vec<(String, usize, Vec<f64>)>,
    /// Name, number of components, values cell by cell.
    pub cell_data: Vec<(String, usize, Vec<f64>)>,
}

/// A body of a system: unknowns, forces, and points that may touch. What only some bodies have is in the traits that it builds on;
/// a body without it implements these as they are.
pub trait Body:
    Kinematics + Elimination + ContactSides + Slack + BoxOfMaterial + Constitution + Inertial + Thermal + Send + Sync
{
    fn name(&self) -> &str;

    /// Number of unknowns.
    fn unknowns(&self) -> usize;

    /// At rest, or as the body starts.
    fn start(&self) -> BodyState;

    /// The state after `share` of a step of the unknowns: a retraction, exact to second order along straight steps.
    fn advance(&self, state: &BodyState, step: &[f64], share: f64) -> BodyState;

    /// Adds internal forces, and their derivative if asked for; the energy stored.
    ///
    /// # Errors
    /// States that the body cannot have.
    fn internal(&self, state: &BodyState, order: Order, out: &mut Contribution) -> Result<f64, BodyError>;

    /// The equations of a place that is held; `None` for the whole body.
    ///
    /// # Errors
    /// A place that is not there, or has nothing to hold.
    fn hold(&self, on: Option<&str>, hold: &Hold<'_>, state: &BodyState) -> Result<Vec<Constraint>, PlaceError>;

    /// Adds a load: minus the force, and its derivative.
    ///
    /// # Errors
    /// A place that is not there, or a load that cannot act on it.
    fn load(
        &self,
        on: Option<&str>,
        load: &Load<'_>,
        state: &BodyState,
        order: Order,
        out: &mut Contribution,
    ) -> Result<(), PlaceError>;

    /// The points of a place that are tested for contact.
    ///
    /// # Errors
    /// A place that is not there, or without such points.
    fn sites(&self, on: Option<&str>, sampling: Sampling) -> Result<Vec<Site>, PlaceError>;

    /// A site where it is now.
    fn placed(&self, state: &BodyState, site: &Site) -> SlavePoint;

    /// A place as it may be touched.
    ///
    /// # Errors
    /// A place that is not there, or that cannot be touched.
    fn master<'a>(&'a self, on: Option<&str>, state: &'a BodyState) -> Result<Box<dyn Master + 'a>, PlaceError>;

    /// The force that moves a site by a unit of length, about: the scale of penalties.
    fn site_stiffness(&self, site: &Site) -> f64;

    /// The six unit motions of the whole body in its unknowns, at a state (three translations, three turns about the
    /// origin): for resultants and free motions.
    fn rigid_modes(&self, state: &BodyState) -> [Vec<f64>; 6];

    /// The largest extent of the body: the scale of lengths.
    fn size(&self) -> f64;

    fn fields(&self, state: &BodyState) -> BodyFields;
}

/// How a body moves, beyond a step of its unknowns.
pub trait Kinematics {
    /// Brings what is prescribed in a state, such as the motion of a rigid body, to a time.
    fn prescribe(&self, _time: f64, _state: &mut BodyState) {}

    /// The state at a share of the way from one state to another.
    fn between(&self, from: &BodyState, to: &BodyState, share: f64) -> BodyState {
        let at = |(a, b): (&f64, &f64)| a + share * (b - a);
        let configuration = from.configuration.iter().zip(&to.configuration).map(at).collect();
        BodyState { configuration, internal: from.internal.clone() }
    }

    /// Unknowns that are spins, by threes: of the sections of a beam, of a rigid body.
    fn spins(&self) -> Vec<[u32; 3]> {
        Vec::new()
    }

    /// Where a place is that is a single point, before the body deforms.
    fn point(&self, _on: Option<&str>) -> Option<Point<3>> {
        None
    }

    /// Whether the body has no stiffness of its own.
    fn is_rigid(&self) -> bool {
        false
    }

    /// Whether what a support holds of the body changes with time.
    fn holds_change(&self) -> bool {
        false
    }
}

/// What a linear solver may know of a body.
pub trait Elimination {
    /// Whether the derivative of the internal forces is the same in all states.
    fn is_linear(&self) -> bool {
        false
    }

    /// Unknowns that the body couples, element by element, from which the size of a factorisation is told; none of bodies with
    /// few of them.
    fn cliques(&self) -> Vec<Vec<u32>> {
        Vec::new()
    }

    /// Where each unknown is, about, before the body deforms: for the order of elimination. None where that is not known.
    fn places(&self) -> Vec<[f64; 3]> {
        Vec::new()
    }

    /// From now on [`internal`](Body::internal) adds forces, derivative and energy of these cells only, in the order of
    /// [`cliques`](Elimination::cliques): others are with other processes. Whether the body can do so.
    fn keep_cells(&mut self, _keep: &[bool]) -> bool {
        false
    }

    /// What iterations need in place of a factorisation: of linear bodies that have it.
    fn subspaces(&self) -> Option<Subspaces<'_>> {
        None
    }

    /// Above so many unknowns of the system iterations with [`subspaces`](Elimination::subspaces) are faster than a factorisation;
    /// none where there are none.
    fn many_unknowns(&self) -> Option<usize> {
        None
    }

    /// Adds the terms that hold a place which no equation between unknowns can hold, such as a boundary that runs through
    /// cells; the force of the support on the body. None where [`hold`](Body::hold) says it all.
    ///
    /// # Errors
    /// A place that is not there, or has nothing to hold.
    fn hold_weakly(
        &self,
        _on: Option<&str>,
        _hold: &Hold<'_>,
        _state: &BodyState,
        _order: Order,
        _out: &mut Contribution,
    ) -> Result<Option<Vector<3>>, PlaceError> {
        Ok(None)
    }
}

/// What moves a point of a rigid body.
#[derive(Clone, Debug, Default)]
pub struct Carried {
    /// Changes of its position, and spins, by unknown.
    pub functions: Vec<Function>,
    pub spin: Vec<Function>,
    /// Second derivatives of the position.
    pub bends: Vec<SecondDerivative>,
    /// The rotation of the body.
    pub frame: Matrix<3>,
}

/// What contact may ask of the surface of a body, beyond points and a master.
pub trait ContactSides {
    /// A place as a curve, if it is one, such as a rope, a beam, an edge of a solid: contact between curves is for such.
    fn curve<'a>(&'a self, _on: Option<&str>) -> Option<Box<dyn Curve + 'a>> {
        None
    }

    /// A place as a surface of faces in a state, if it is one: contact by mortar is for such.
    fn surface<'a>(&'a self, _on: Option<&str>, _state: &'a BodyState) -> Option<Box<dyn Surface + 'a>> {
        None
    }

    /// The traction `σ n` at a site by the stress of the body, per area of the site, with what changes it; none of a body
    /// whose stress is not known at its sites. For Nitsche's method.
    fn traction(&self, _state: &BodyState, _site: &Site) -> Option<Direction> {
        None
    }

    /// Where a site of a surface is now, without what moves it. None where that costs as much as [`placed`](Body::placed), where
    /// sites may rest or have radii.
    fn position(&self, _state: &BodyState, _site: &Site) -> Option<Point<3>> {
        None
    }

    /// Where a site is now, and the size of its [`traction`](ContactSides::traction), without what changes them: enough to see
    /// that a site of zero radius is far from what it may touch. None where that costs as much as [`placed`](Body::placed).
    fn position_and_traction(&self, _state: &BodyState, _site: &Site) -> Option<(Point<3>, f64)> {
        None
    }

    /// The pressure per gap that makes Nitsche's method at a site stable; none where [`traction`](ContactSides::traction) is none.
    fn stabilisation(&self, _site: &Site) -> Option<f64> {
        None
    }

    /// The points of a place spread evenly, at least a distance apart, with what they stand for, and the largest distance
    /// between neighbours: for contact by discs. None of a body without such points.
    ///
    /// # Errors
    /// A place that is not there.
    fn spread_sites(&self, _on: Option<&str>, _spacing: f64) -> Result<Option<(Vec<Site>, f64)>, PlaceError> {
        Ok(None)
    }

    /// Places on a surface without faces, and how far apart forces near each may act so that its functions follow them: as the
    /// points of its own quadrature. None where that is not known.
    fn points_apart(&self, _on: Option<&str>) -> Vec<(Point<3>, f64)> {
        Vec::new()
    }

    /// A rigid body that facets, edges and corners bound, where it is in a state; none of others.
    fn polyhedron<'a>(&'a self, _state: &BodyState) -> Option<Placed<'a>> {
        None
    }

    /// What moves a point of a rigid body, which is there in a state; none of others.
    fn carried(&self, _state: &BodyState, _x: &Point<3>) -> Option<Carried> {
        None
    }

    /// Tests a place at points of quadrature at most as far apart as told for the points near them, from now on. Bodies whose
    /// points cannot be more leave them.
    fn test_at_least_every(&mut self, _on: Option<&str>, _apart: &dyn Fn(&Point<3>) -> f64) {}
}

/// A body that may hang without carrying anything.
pub trait Slack {
    /// Whether all parts of the body are longer than their way by more than a share of their length, and carry nothing: an
    /// unstretched rope is longer than its way by more than -1e-9.
    fn is_slack(&self, _state: &BodyState, _longer: f64) -> bool {
        false
    }

    /// Until the next call what may be slack is also a spring of no length at rest, with this force at the unstrained length of
    /// the body: to find a shape from which it hangs soon.
    fn add_sag_spring(&mut self, _force: f64) {}

    /// Until the next call what may be slack is as stiff as a part of its stiffness: to find a shape near the one that it has
    /// when it hardly stretches. The stiffness itself, as a force; 0 of what is never slack.
    fn soften(&mut self, _share: f64) -> f64 {
        0.0
    }
}
