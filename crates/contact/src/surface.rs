//! What contact sees of a discretised body: faces with positions, and the functions that move them.

use crate::face_maps::{FaceForm, FaceMaps};
use crate::face_point::FacePoint;
use signorini_basis::cell_map::CellMap;
use signorini_basis::{CellShape, Local};
use signorini_geometry::Point;

/// A function that moves a point of a face: the first of its unknowns, its value and its slopes along the coordinates of the
/// face (those beyond the number of its coordinates are not read).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeFunction {
    pub unknown: u32,
    pub value: f64,
    pub slopes: [f64; 2],
}

/// A face that is a span of a spline surface.
#[derive(Clone, Debug)]
pub struct SplineFace<const D: usize> {
    /// Its functions, in the coordinates of the face.
    pub map: CellMap,
    /// Of each function the control point at rest, and the first of its `D` unknowns.
    pub points: Vec<Point<D>>,
    pub unknowns: Vec<u32>,
}

impl<const D: usize> SplineFace<D> {
    /// The face at rest as a map.
    pub fn form(&self) -> FaceForm<'_, D> {
        FaceForm::Spline(&self.map, self.points.clone())
    }

    /// The control points where a displacement has brought them.
    pub fn moved(&self, u: &[f64]) -> Vec<Point<D>> {
        let of = |(x, unknown): (&Point<D>, &u32)| x + Point::<D>::from_fn(|i, _| u[*unknown as usize + i]);
        self.points.iter().zip(&self.unknowns).map(of).collect()
    }
}

/// The boundary of one or more deformable bodies.
pub trait ContactSurface<const D: usize>: Sync {
    fn face_count(&self) -> usize;
    fn shape(&self, face: usize) -> CellShape;
    /// Polynomial degree of the displacement.
    fn degree(&self, face: usize) -> usize;
    /// Polynomial degree of the geometry.
    fn order(&self, face: usize) -> usize;
    fn at(&self, face: usize, s: &Local) -> FacePoint<D>;
    /// Appends the functions that move a point of a face: the first of their `D` unknowns, and their value.
    fn trace(&self, face: usize, s: &Local, out: &mut Vec<(u32, f64)>);
    /// Those functions with their slopes, in the same order.
    fn functions(&self, face: usize, s: &Local) -> Vec<ShapeFunction>;
    /// The face as a span of a spline, where it is one: pressures then belong to its control points.
    fn spline(&self, _face: usize) -> Option<&SplineFace<D>> {
        None
    }
    /// Numbers of the vertices, in the order of the reference face; faces that meet share them.
    fn vertices(&self, face: usize) -> Vec<u32>;
    /// Thickness or circumference by which integrals are multiplied.
    fn measure(&self, x: &Point<D>) -> f64;
    /// Name of the body and number of the cell, for messages.
    fn describe(&self, face: usize) -> String;
}

/// Whether a surface with this outward normal, of any length, looks at something whose outward unit normal is the other:
/// a pressure can only push it inwards.
pub fn is_facing<const D: usize>(own: &Point<D>, other: &Point<D>) -> bool {
    own.dot(other) < -1e-6 * own.norm()
}

/// A surface where its displacement has brought it.
pub struct Moved<'a, const D: usize> {
    surface: &'a dyn ContactSurface<D>,
    maps: FaceMaps<D>,
}

impl<'a, const D: usize> Moved<'a, D> {
    /// By the values of all unknowns.
    pub fn new(surface: &'a dyn ContactSurface<D>, u: &[f64]) -> Self {
        let order = |face: usize| surface.order(face).max(surface.degree(face));
        let form = |face: usize| match surface.spline(face) {
            Some(spline) => FaceForm::Spline(&spline.map, spline.moved(u)),
            None => FaceForm::Polynomial(surface.shape(face), order(face)),
        };
        let at = |face: usize, s: &Local| {
            let mut x = surface.at(face, s).x;
            for f in surface.functions(face, s) {
                x += Point::<D>::from_fn(|i, _| u[f.unknown as usize + i]) * f.value;
            }
            x
        };
        Moved { surface, maps: FaceMaps::new((0..surface.face_count()).map(form), at) }
    }
}

impl<const D: usize> ContactSurface<D> for Moved<'_, D> {
    fn face_count(&self) -> usize {
        self.surface.face_count()
    }

    fn shape(&self, face: usize) -> CellShape {
        self.surface.shape(face)
    }

    fn degree(&self, face: usize) -> usize {
        self.surface.degree(face)
    }

    fn order(&self, face: usize) -> usize {
        self.surface.order(face).max(self.surface.degree(face))
    }

    fn at(&self, face: usize, s: &Local) -> FacePoint<D> {
        self.maps.at(face, s)
    }

    fn trace(&self, face: usize, s: &Local, out: &mut Vec<(u32, f64)>) {
        self.surface.trace(face, s, out);
    }

    fn functions(&self, face: usize, s: &Local) -> Vec<ShapeFunction> {
        self.surface.functions(face, s)
    }

    fn spline(&self, face: usize) -> Option<&SplineFace<D>> {
        self.surface.spline(face)
    }

    fn vertices(&self, face: usize) -> Vec<u32> {
        self.surface.vertices(face)
    }

    fn measure(&self, x: &Point<D>) -> f64 {
        self.surface.measure(x)
    }

    fn describe(&self, face: usize) -> String {
        self.surface.describe(face)
    }
}
