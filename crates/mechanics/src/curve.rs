//! Bodies that are curves, as contact between curves sees them.
//!
//! A curve is a row of elements, with parameters from 0 to 1 in each, and a circular section about it that touches. It is a
//! body of its own, or the edge of one, which has an inside.

mod nearest;

pub use nearest::{CurveMaster, Minimum, are_apart, boxes, minima, samples};

use crate::points::{Foot, Function, MaterialPoint};
use signorini_geometry::shape::{CurveJet, SurfaceJet};
use signorini_geometry::{Matrix, Point, Vector};

/// Whether a curve returns to its start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Closure {
    Open,
    Closed,
}

/// How a curve runs between its nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Continuity {
    /// Straight from node to node.
    C0,
    /// Cubic, with a continuous tangent.
    C1,
}

/// A body that is a curve. A `configuration` is that of a state of the body.
pub trait Curve: Sync {
    /// Number of elements.
    fn elements(&self) -> usize;

    fn closure(&self) -> Closure;

    fn continuity(&self) -> Continuity;

    /// Length along the curve, of the reference, at a parameter of an element.
    fn arc(&self, element: usize, xi: f64) -> f64;

    /// Length of the curve, of the reference.
    fn length(&self) -> f64 {
        self.arc(self.elements() - 1, 1.0)
    }

    /// Radius of the section about the curve that touches.
    fn radius(&self) -> f64;

    /// Points of Gauss of each element at which contact along a line is tested.
    fn contact_points(&self) -> usize;

    /// The force that moves a point of an element by a unit of length, about: the scale of penalties.
    fn stiffness(&self, element: usize) -> f64;

    /// Outward normals of the two faces that meet at an edge; none of a curve that has no inside.
    fn faces(&self, _configuration: &[f64], _element: usize, _xi: f64) -> Option<[Vector<3>; 2]> {
        None
    }

    /// How deep inside what an edge is of something may be that came in over it: what is deeper is on another side.
    fn depth(&self, _element: usize) -> f64 {
        f64::INFINITY
    }

    /// Position and derivatives in the parameter of an element.
    fn jet(&self, configuration: &[f64], element: usize, xi: f64) -> CurveJet;

    /// Points whose hull holds an element.
    fn hull(&self, configuration: &[f64], element: usize) -> Vec<Point<3>>;

    /// A point of the curve with all that moves it; `coordinates` is 0 where it cannot be passed by: an end, a kink, or a
    /// point that is given.
    fn foot(&self, configuration: &[f64], element: usize, xi: f64, coordinates: usize) -> Foot;

    /// Second variations of the spin of the section at a point, row by row of the spins of its [`Foot`], in the convention of
    /// tangents: along geodesics of the rotations. Empty where it turns as a rigid section, by half the product of both spins.
    fn spin_bends(&self, _configuration: &[f64], _element: usize, _xi: f64) -> Vec<Vector<3>> {
        Vec::new()
    }
}

/// A point of a curve: free to move along it, or held at an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    pub element: usize,
    pub xi: f64,
    /// 1 along the curve, 0 at an end or a kink.
    pub coordinates: usize,
}

impl CurvePoint {
    /// The foot at this point of a curve whose sections do not turn by themselves.
    pub fn foot(&self, jet: &CurveJet, radius: f64, functions: Vec<Function>) -> Foot {
        let CurveJet { x, d1, d2, d3 } = *jet;
        let zero = Vector::<3>::zeros();
        Foot {
            point: MaterialPoint { patch: self.element as u32, xi: [self.xi, 0.0, 0.0] },
            jet: SurfaceJet { x, u: d1, v: zero, uu: d2, uv: zero, vv: zero, uuu: d3, uuv: zero, uvv: zero, vvv: zero },
            coordinates: self.coordinates,
            outward: None,
            radius,
            functions,
            spin: Vec::new(),
            spin_bends: Vec::new(),
            frame: Matrix::<3>::identity(),
        }
    }
}
