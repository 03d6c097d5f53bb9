//! A polyline as a surface of the plane, for unit tests.

use crate::face_point::FacePoint;
use crate::segments::Sight;
use crate::surface::{ContactSurface, ShapeFunction};
use signorini_basis::{CellShape, Local};
use signorini_geometry::Point;

/// All faces see each other up to a gap of one.
pub(crate) const ANY: Sight<'_> = Sight { reach: 1.0, deepest: &|_| f64::INFINITY, sees: &|_, _| true };

/// Straight faces from point to point, linear functions; outward is to the right of the way.
pub(crate) struct Polyline(pub Vec<Point<2>>);

impl Polyline {
    /// At a height above places from left to right, facing down; from right to left it faces up.
    pub fn at(places: &[f64], height: impl Fn(f64) -> f64) -> Self {
        Polyline(places.iter().map(|x| Point::<2>::new(*x, height(*x))).collect())
    }
}

impl ContactSurface<2> for Polyline {
    fn face_count(&self) -> usize {
        self.0.len() - 1
    }
    fn shape(&self, _: usize) -> CellShape {
        CellShape::Line
    }
    fn degree(&self, _: usize) -> usize {
        1
    }
    fn order(&self, _: usize) -> usize {
        1
    }
    fn at(&self, face: usize, s: &Local) -> FacePoint<2> {
        let (a, b) = (self.0[face], self.0[face + 1]);
        FacePoint { x: 0.5 * (a + b) + 0.5 * s[0] * (b - a), tangents: [0.5 * (b - a), Point::zeros()] }
    }
    fn trace(&self, face: usize, s: &Local, out: &mut Vec<(u32, f64)>) {
        out.extend(self.functions(face, s).iter().map(|f| (f.unknown, f.value)));
    }
    fn functions(&self, face: usize, s: &Local) -> Vec<ShapeFunction> {
        let of = |k: usize, sign: f64| ShapeFunction {
            unknown: 2 * (face + k) as u32,
            value: 0.5 * (1.0 + sign * s[0]),
            slopes: [0.5 * sign, 0.0],
        };
        vec![of(0, -1.0), of(1, 1.0)]
    }
    fn vertices(&self, face: usize) -> Vec<u32> {
        vec![face as u32, face as u32 + 1]
    }
    fn measure(&self, _: &Point<2>) -> f64 {
        1.0
    }
    fn describe(&self, face: usize) -> String {
        format!("face {face}")
    }
}
