//! Points of bodies: those that are tested, where they are, and what is nearest to them on another body.

use signorini_geometry::rigid_shape::{GapJet, RigidShape};
use signorini_geometry::shape::SurfaceJet;
use signorini_geometry::{Looking, Matrix, Point, Vector};
use std::sync::Arc;

/// How far derivatives are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Order {
    /// Values only: forces.
    First,
    /// Their derivatives too: the tangent.
    Second,
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
pub struct SecondDerivative {
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
    pub bends: Vec<SecondDerivative>,
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
    pub bends: Vec<SecondDerivative>,
}

/// A site where it is now.
#[derive(Clone, Debug, Default)]
pub struct SlavePoint {
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
    /// The rotation vector since the start, whole turns included, of a rigid body.
    pub turn: Option<Vector<3>>,
    /// Second derivatives of `x`; empty where it is linear in the unknowns.
    pub bends: Vec<SecondDerivative>,
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
    /// Second variations of these spins, as in [`SlavePoint`].
    pub spin_bends: Vec<Vector<3>>,
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
pub enum MasterProjection {
    /// The nearest point.
    Foot(Box<Foot>),
    /// The point on the line along the averaged normal of the slave.
    Cut(Box<Foot>),
    /// The point from which the slave lies along the averaged normal of the master.
    Along(Box<Foot>, Box<NormalField>),
    Rigid(Box<RigidFoot>),
}

impl MasterProjection {
    /// The outward normal of the surface that is met; none on a curve.
    pub fn outward(&self) -> Option<Vector<3>> {
        match self {
            MasterProjection::Rigid(foot) => Some(foot.jet.normal),
            MasterProjection::Foot(foot) | MasterProjection::Cut(foot) | MasterProjection::Along(foot, _) => {
                foot.outward
            }
        }
    }

    /// The gap of a point to what it meets, negative inside, and the normal outward from that; none on a curve itself.
    pub fn gap(&self, x: &Point<3>) -> Option<(f64, Vector<3>)> {
        match self {
            MasterProjection::Rigid(foot) => Some((foot.jet.gap, foot.jet.normal)),
            MasterProjection::Foot(foot) | MasterProjection::Cut(foot) | MasterProjection::Along(foot, _) => {
                let d = x - foot.jet.x;
                Some(match foot.outward {
                    Some(outward) => (d.norm() * d.dot(&outward).signum(), outward),
                    None => (d.norm() - foot.radius, d.try_normalize(0.0)?),
                })
            }
        }
    }
}

/// A material point where it is now, with what moves it.
#[derive(Clone, Debug, Default)]
pub struct Anchor {
    pub x: Point<3>,
    /// A direction in the surface, of any length, that moves with the material; the slopes of the functions along the
    /// first coordinate are its changes.
    pub tangent: Vector<3>,
    /// The derivative along the second coordinate of a surface of faces, of which `tangent` is that along the first; the
    /// slopes of the functions along that coordinate are its changes.
    pub across: Option<Vector<3>>,
    pub functions: Vec<Function>,
    /// What turns the section there, and how it is turned.
    pub spin: Vec<Function>,
    pub frame: Matrix<3>,
    /// Of a rigid body.
    pub turning: Option<Turning>,
}

/// How a rigid body turns that is touched at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Turning {
    /// The rotation vector since the start, whole turns included.
    pub turn: Vector<3>,
    /// The point about which the body turns, where it is now.
    pub about: Point<3>,
    /// The outward normal of the body at the material point.
    pub normal: Vector<3>,
}

/// What may be touched of a body, where it is now.
pub trait Master: Sync {
    /// Makes what many searches need, before they run side by side.
    fn prepare(&self) {}

    /// The point nearest to `x`, unless it is farther than `reach`. With `except`, a site of the same body, what lies
    /// next to that site along the body is left out: contact of a body with itself.
    fn nearest(&self, x: &Point<3>, reach: f64, except: Option<&Site>) -> Option<MasterProjection>;

    /// Of a body with edges, the point under `x` on the nearest face that `x`, inside of it, looks at.
    fn facing(&self, _x: &Point<3>, _looking: &Looking) -> Option<MasterProjection> {
        None
    }

    /// All places that a ball about `x` may touch at once, the nearest first: of rigid bodies that curve around it.
    fn places(&self, x: &Point<3>) -> Vec<MasterProjection> {
        self.nearest(x, f64::INFINITY, None).into_iter().collect()
    }

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
    fn cut(&self, _x: &Point<3>, _direction: &Vector<3>, _reach: f64) -> Option<MasterProjection> {
        None
    }

    /// The point from which `x` lies along the averaged normal of a surface of facets, where its faces go on smoothly.
    fn along(&self, _x: &Point<3>, _reach: f64) -> Option<MasterProjection> {
        None
    }

    /// The same material point of the body, where it is now: for what sticks to it.
    fn at(&self, point: &MaterialPoint) -> Anchor;
}
