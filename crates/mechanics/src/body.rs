//! What a body is to the system: unknowns with forces and tangent, places that are held or loaded, points that touch.
//!
//! Positions and forces have three components; a plane or axisymmetric body has no unknowns along z, and integrates over
//! its thickness or circumference. A body numbers its own unknowns from 0. A configuration may hold more numbers than
//! there are unknowns (a quaternion turns by three): a step of the unknowns reaches it through [`Body::advance`].

use crate::curve::Curve;
use crate::iterative::Subspaces;
use crate::surface::Surface;
use signorini_geometry::rigid_shape::{GapJet, RigidShape};
use signorini_geometry::shape::SurfaceJet;
use signorini_geometry::{Matrix, Point, Vector};
use std::sync::Arc;

/// What a body carries from one increment to the next, as plain numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyState {
    /// Displacements, rotations.
    pub configuration: Vec<f64>,
    /// Whatever else: stresses predicted for the next iteration, history variables.
    pub internal: Vec<f64>,
}

/// How far derivatives are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Order {
    /// Values only: forces.
    First,
    /// Their derivatives too: the tangent.
    Second,
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

    /// Adds to the derivative a dense block, row by row.
    pub fn add_block(&mut self, unknowns: &[u32], values: &[f64]) {
        debug_assert_eq!(unknowns.len() * unknowns.len(), values.len());
        self.blocks.push((unknowns.to_vec(), values.to_vec()));
    }
}

/// How one unknown moves a point: the derivative of its position, and of its tangents along up to two coordinates, in
/// that unknown. `e_i N` for displacements, `e_i × y` for the spin of a rigid body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Function {
    pub unknown: u32,
    pub value: Vector<3>,
    pub slopes: [Vector<3>; 2],
    /// Second derivatives along the coordinates: 11, 12, 22. They count only with the gap.
    pub second: [Vector<3>; 3],
}

/// Second derivative of a position in two unknowns; listed once for `i <= j`, and standing for both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bend {
    pub unknowns: [u32; 2],
    pub value: Vector<3>,
}

/// A material point whose contact is tested: which part of the body (face, element, node), where in it, and the area,
/// length or number of points that it stands for, in the reference configuration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Site {
    pub patch: u32,
    pub xi: [f64; 2],
    pub weight: f64,
}

/// Which points of a body are tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    Nodes,
    GaussPoints,
}

/// A direction that turns with a body: that of a vector, of any length, with what moves it.
#[derive(Clone, Debug, Default)]
pub struct Direction {
    pub vector: Vector<3>,
    /// The values are the changes of the vector.
    pub functions: Vec<Function>,
    /// Second derivatives of the vector.
    pub bends: Vec<Bend>,
}

/// The averaged normal of a surface of facets at a point of it, of any length: with its slopes along the coordinates, and what
/// moves them.
#[derive(Clone, Debug, Default)]
pub struct NormalField {
    pub vector: Vector<3>,
    pub slopes: [Vector<3>; 2],
    /// The values are the changes of the vector, the slopes those of its slopes.
    pub functions: Vec<Function>,
    /// Second derivatives of the vector.
    pub bends: Vec<Bend>,
}

/// A site where it is now.
#[derive(Clone, Debug, Default)]
pub struct Placed {
    pub x: Point<3>,
    /// Outward unit normal of a surface; none for a curve or a point, which faces every way.
    pub outward: Option<Vector<3>>,
    /// Outward normal of a surface of facets, averaged over those that meet: it changes without jumps from facet to facet.
    pub averaged: Option<Direction>,
    /// Whether it is not tested now: what is on a winch.
    pub rests: bool,
    /// Tangent of a curve, of any length; its changes are the slopes of the functions along the first coordinate.
    pub tangent: Option<Vector<3>>,
    /// Radius of a section or ball about `x` that touches instead of `x`.
    pub radius: f64,
    /// What moves `x`.
    pub functions: Vec<Function>,
    /// What turns the section or ball about `x`: the value is the spin per unit of the unknown.
    pub spin: Vec<Function>,
    /// Second variations of these spins, row by row; empty where the unknowns are spins themselves.
    pub spin_bends: Vec<Vector<3>>,
    /// How the section or ball is turned; the identity where nothing turns.
    pub frame: Matrix<3>,
    /// Second derivatives of `x`; empty where it is linear in the unknowns.
    pub bends: Vec<Bend>,
}

/// A material point of a body that may be touched: which part of it, and where in it. Of a rigid body the coordinates are
/// those of the body's own axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MaterialPoint {
    pub patch: u32,
    pub xi: [f64; 3],
}

/// A point of a body that is met: its position with derivatives, and what moves them.
#[derive(Clone, Debug)]
pub struct Foot {
    pub point: MaterialPoint,
    /// Position and derivatives; of a curve only those in the first coordinate count, of a vertex only the position.
    pub jet: SurfaceJet,
    /// Number of coordinates: 2 on a surface, 1 on an edge or curve, 0 at a vertex or end.
    pub coordinates: usize,
    /// Outward unit normal of a surface at `jet.x`; at an edge or vertex of a surface the mean one, which tells outside
    /// from inside. None for a curve.
    pub outward: Option<Vector<3>>,
    /// Radius of a section about the curve that touches instead of it.
    pub radius: f64,
    pub functions: Vec<Function>,
    /// What turns the section, and how it is turned now.
    pub spin: Vec<Function>,
    pub frame: Matrix<3>,
}

/// The gap of a point to a body that is rigid, with its derivatives where the body is now.
#[derive(Clone)]
pub struct RigidFoot {
    /// The foot in the axes of the body.
    pub point: MaterialPoint,
    /// Gap, normal and Hessian in space.
    pub jet: GapJet<3>,
    /// The shape, in the axes of the body.
    pub shape: Arc<dyn RigidShape>,
    /// The point about which the body turns: at the start, where the axes of the body are those of space, and now.
    pub origin: Point<3>,
    pub centre: Point<3>,
    /// How the body is turned.
    pub rotation: Matrix<3>,
    /// Unknowns of the motion of the centre and of the spin; none where a component does not move or is prescribed.
    pub unknowns: [Option<u32>; 6],
}

/// What a point meets.
#[derive(Clone)]
pub enum Met {
    /// The nearest point.
    Foot(Box<Foot>),
    /// The point on the line along the averaged normal of the slave.
    Cut(Box<Foot>),
    /// The point from which the slave lies along the averaged normal of the master.
    Along(Box<Foot>, Box<NormalField>),
    Rigid(Box<RigidFoot>),
}

/// A material point where it is now, with what moves it.
#[derive(Clone, Debug, Default)]
pub struct Anchor {
    pub x: Point<3>,
    /// A direction in the surface, of any length, that moves with the material; the slopes of the functions along the
    /// first coordinate are its changes.
    pub tangent: Vector<3>,
    pub functions: Vec<Function>,
    /// What turns the section there, and how it is turned.
    pub spin: Vec<Function>,
    pub frame: Matrix<3>,
}

/// A value that varies in space and time: at a reference position.
pub type Field<'a> = &'a dyn Fn(&Point<3>) -> f64;
/// A vector that varies in space.
pub type VectorField<'a> = &'a dyn Fn(&Point<3>) -> Vector<3>;

/// How a place is held. Components that are free are `None`.
pub struct Hold<'a> {
    /// Prescribed displacement.
    pub displacement: [Option<Field<'a>>; 3],
    /// Prescribed rotation vector of the sections of a beam or of a rigid body, against the start.
    pub rotation: [Option<Field<'a>>; 3],
}

/// An equation between unknowns: the step of the unknowns times `terms`, plus `lack`, is zero.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Constraint {
    pub terms: Vec<(u32, f64)>,
    /// How far what is held is from where it should be.
    pub lack: f64,
    /// Which component of the reaction its multiplier counts for (0..3 force, 3..6 moment), and how much.
    pub component: usize,
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
    #[error("cell {cell} of `{body}` is turned inside out or shrunk to nothing")]
    Inverted { body: String, cell: usize },
    #[error("cell {cell} of `{body}`: {message}")]
    Material { body: String, cell: usize, message: String },
}

/// A place that a body does not have, or that cannot be used in this way.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlaceError {
    #[error("`{body}` has no group `{group}`: it has {}", known.join(", "))]
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
    /// Point numbers of each cell: two make a segment, three a triangle, four a quadrilateral; with eight a hexahedron.
    pub cells: Vec<Vec<u32>>,
    /// Name, number of components, values point by point.
    pub point_data: Vec<(String, usize, Vec<f64>)>,
    /// Name, number of components, values cell by cell.
    pub cell_data: Vec<(String, usize, Vec<f64>)>,
}

/// What may be touched of a body, where it is now.
pub trait Master: Sync {
    /// The point nearest to `x`, unless it is farther than `reach`. With `except`, a site of the same body, what lies
    /// next to that site along the body is left out: contact of a body with itself.
    fn nearest(&self, x: &Point<3>, reach: f64, except: Option<&Site>) -> Option<Met>;

    /// The distance of that point, negative inside, where it is found with less work than what moves the point.
    fn gap(&self, _x: &Point<3>, _reach: f64, _except: Option<&Site>) -> Option<f64> {
        None
    }

    /// Whether the surface has facets, so that gaps are better measured along the averaged normal of a slave that has one.
    fn is_faceted(&self) -> bool {
        false
    }

    /// The point on the line through `x` along a direction of any length, on a side that faces it, at most `reach` ahead or
    /// behind.
    fn cut(&self, _x: &Point<3>, _direction: &Vector<3>, _reach: f64) -> Option<Met> {
        None
    }

    /// The point from which `x` lies along the averaged normal of a surface of facets, where its faces go on smoothly.
    fn along(&self, _x: &Point<3>, _reach: f64) -> Option<Met> {
        None
    }

    /// The same material point of the body, where it is now: for what sticks to it.
    fn at(&self, point: &MaterialPoint) -> Anchor;
}

/// A body of a system.
pub trait Body: Send + Sync {
    fn name(&self) -> &str;

    /// Number of unknowns.
    fn unknowns(&self) -> usize;

    /// At rest, or as the body starts.
    fn start(&self) -> BodyState;

    /// Brings what is prescribed in a state, such as the motion of a rigid body, to a time.
    fn prescribe(&self, _time: f64, _state: &mut BodyState) {}

    /// The state after `share` of a step of the unknowns: a retraction, exact to second order along straight steps.
    fn advance(&self, state: &BodyState, step: &[f64], share: f64) -> BodyState;

    /// Adds internal forces, and their derivative if asked for; the energy stored.
    ///
    /// # Errors
    /// States that the body cannot have.
    fn internal(&self, state: &BodyState, order: Order, out: &mut Contribution) -> Result<f64, BodyError>;

    /// Whether the derivative of the internal forces is the same in all states.
    fn is_linear(&self) -> bool {
        false
    }

    /// Unknowns that the body couples, element by element, from which the size of a factorisation is told; none of bodies with
    /// few of them.
    fn cliques(&self) -> Vec<Vec<u32>> {
        Vec::new()
    }

    /// What iterations need in place of a factorisation: of linear bodies that have it.
    fn subspaces(&self) -> Option<Subspaces<'_>> {
        None
    }

    /// Above so many unknowns of the system iterations with [`subspaces`](Body::subspaces) are faster than a factorisation;
    /// none where there are none.
    fn many_unknowns(&self) -> Option<usize> {
        None
    }

    /// The equations of a place that is held; `None` for the whole body.
    ///
    /// # Errors
    /// A place that is not there, or has nothing to hold.
    fn hold(&self, on: Option<&str>, hold: &Hold<'_>, state: &BodyState) -> Result<Vec<Constraint>, PlaceError>;

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
    fn placed(&self, state: &BodyState, site: &Site) -> Placed;

    /// A place as it may be touched.
    ///
    /// # Errors
    /// A place that is not there, or that cannot be touched.
    fn master<'a>(&'a self, on: Option<&str>, state: &'a BodyState) -> Result<Box<dyn Master + 'a>, PlaceError>;

    /// The force that moves a site by a unit of length, about: the scale of penalties.
    fn site_stiffness(&self, site: &Site) -> f64;

    /// The traction `σ n` at a site by the stress of the body, per area of the site, with what changes it; none of a body
    /// whose stress is not known at its sites. For Nitsche's method.
    fn traction(&self, _state: &BodyState, _site: &Site) -> Option<Direction> {
        None
    }

    /// The pressure per gap that makes Nitsche's method at a site stable.
    fn stabilisation(&self, site: &Site) -> f64 {
        self.site_stiffness(site) / site.weight
    }

    /// The points of a place spread evenly, at least a distance apart, with what they stand for, and the largest distance
    /// between neighbours: for contact by discs.
    ///
    /// # Errors
    /// A place that is not there, or a body without such points.
    fn spread_sites(&self, _on: Option<&str>, _spacing: f64) -> Result<(Vec<Site>, f64), PlaceError> {
        let message = "discs touch on bodies of cells only".to_string();
        Err(PlaceError::Unsuitable { body: self.name().to_string(), message })
    }

    /// The six unit motions of the whole body in its unknowns, at a state (three translations, three turns about the
    /// origin): for resultants and free motions.
    fn rigid_modes(&self, state: &BodyState) -> [Vec<f64>; 6];

    /// Whether the body has no stiffness of its own.
    fn is_rigid(&self) -> bool {
        false
    }

    /// A place as a curve, if it is one, such as a rope, a beam, an edge of a solid: contact between curves is for such.
    fn curve<'a>(&'a self, _on: Option<&str>) -> Option<Box<dyn Curve + 'a>> {
        None
    }

    /// A place as a surface of faces in a state, if it is one: contact by mortar is for such.
    fn surface<'a>(&'a self, _on: Option<&str>, _state: &'a BodyState) -> Option<Box<dyn Surface + 'a>> {
        None
    }

    /// Whether what a support holds of the body changes with time.
    fn holds_change(&self) -> bool {
        false
    }

    /// Unknowns that are spins, by threes: of the sections of a beam, of a rigid body.
    fn spins(&self) -> Vec<[u32; 3]> {
        Vec::new()
    }

    /// The largest extent of the body: the scale of lengths.
    fn size(&self) -> f64;

    fn fields(&self, state: &BodyState) -> BodyFields;

    /// What a body in a box of cells is like as a whole: none of other bodies.
    fn means(&self, _state: &BodyState) -> Option<Means> {
        None
    }
}

/// A body as a piece of a material that fills its box.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Means {
    /// Normal stresses along the axes, summed over the material and divided by the volume of the box.
    pub stress: [f64; 3],
    /// How far the material on opposite sides of the box moved apart, over their distance; none where there is none on one.
    pub strain: [Option<f64>; 3],
}
