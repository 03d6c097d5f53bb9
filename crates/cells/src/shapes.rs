//! Shapes of space as bodies of the plane see them, and back.

use signorini_geometry::jet::Jet;
use signorini_geometry::{Aabb, ImplicitShape, Matrix, Point, Vector};
use std::sync::Arc;

pub use signorini_geometry::implicit::{Ellipsoid, Function, HalfSpace, Level, Offset, ball, cuboid};

/// A shape of space as a body sees it: its section with the plane `z = 0` in the plane, itself in space.
#[derive(Clone)]
pub struct Section(pub Arc<dyn ImplicitShape<3>>);

impl<const D: usize> ImplicitShape<D> for Section {
    fn value(&self, x: &Point<D>) -> f64 {
        self.0.value(&spatial(x))
    }
    fn gradient(&self, x: &Point<D>) -> Vector<D> {
        let g = self.0.gradient(&spatial(x));
        Vector::from_fn(|k, _| g[k])
    }
    fn value_and_gradient(&self, x: &Point<D>) -> (f64, Vector<D>) {
        let (value, g) = self.0.value_and_gradient(&spatial(x));
        (value, Vector::from_fn(|k, _| g[k]))
    }
    fn hessian(&self, x: &Point<D>) -> Matrix<D> {
        let h = self.0.hessian(&spatial(x));
        Matrix::from_fn(|i, j| h[(i, j)])
    }
    fn jet(&self, x: &Point<D>) -> Jet<D> {
        let at = self.0.jet(&spatial(x));
        let gradient = Vector::from_fn(|k, _| at.gradient[k]);
        Jet { value: at.value, gradient, hessian: Matrix::from_fn(|i, j| at.hessian[(i, j)]) }
    }
    fn range(&self, b: &Aabb<D>) -> Option<[f64; 2]> {
        self.0.range(&Aabb::new(spatial(&b.min), spatial(&b.max)))
    }
}

/// What is nearer than a radius to a box along the axes.
#[derive(Clone, Copy, Debug)]
pub struct RoundedBox<const D: usize> {
    pub bounds: Aabb<D>,
    pub radius: f64,
}

impl<const D: usize> ImplicitShape<D> for RoundedBox<D> {
    fn value(&self, x: &Point<D>) -> f64 {
        self.jet(x).value
    }
    fn gradient(&self, x: &Point<D>) -> Vector<D> {
        self.jet(x).gradient
    }
    fn hessian(&self, x: &Point<D>) -> Matrix<D> {
        self.jet(x).hessian
    }
    fn jet(&self, x: &Point<D>) -> Jet<D> {
        let off = x - self.bounds.clamp(x);
        let distance = off.norm();
        if distance > 0.0 {
            let normal = off / distance;
            // Only across the edge or about the corner that is nearest does the normal turn.
            let free = Matrix::from_fn(|i, j| f64::from(u8::from(i == j && off[i] != 0.0)));
            let hessian = (free - normal * normal.transpose()) / distance;
            return Jet { value: distance - self.radius, gradient: normal, hessian };
        }
        let to_face = |k: usize| [(self.bounds.min[k] - x[k], -1.0), (x[k] - self.bounds.max[k], 1.0)].map(|f| (f, k));
        let nearest = (0..D).flat_map(to_face).max_by(|a, b| a.0.0.total_cmp(&b.0.0));
        let ((value, sign), axis) = nearest.unwrap_or(((0.0, 1.0), 0));
        let gradient = Vector::from_fn(|k, _| if k == axis { sign } else { 0.0 });
        Jet { value: value - self.radius, gradient, hessian: Matrix::zeros() }
    }
    /// A distance changes no faster than position.
    fn range(&self, b: &Aabb<D>) -> Option<[f64; 2]> {
        let (value, reach) = (self.value(&b.center()), b.radius());
        Some([value - reach, value + reach])
    }
}

/// A shape of the plane as a cylinder along z; itself in space.
pub(crate) struct Cylinder<const D: usize>(pub Arc<dyn ImplicitShape<D>>);

impl<const D: usize> ImplicitShape<3> for Cylinder<D> {
    fn value(&self, x: &Point<3>) -> f64 {
        self.0.value(&across(x))
    }
    fn gradient(&self, x: &Point<3>) -> Vector<3> {
        spatial(&self.0.gradient(&across(x)))
    }
    fn hessian(&self, x: &Point<3>) -> Matrix<3> {
        self.jet(x).hessian
    }
    fn jet(&self, x: &Point<3>) -> Jet<3> {
        let at = self.0.jet(&across(x));
        let inside = |i: usize, j: usize| if i < D && j < D { at.hessian[(i, j)] } else { 0.0 };
        Jet { value: at.value, gradient: spatial(&at.gradient), hessian: Matrix::<3>::from_fn(inside) }
    }
}

/// The coordinates of a point across the cylinders.
fn across<const D: usize>(x: &Point<3>) -> Point<D> {
    Point::from_fn(|k, _| x[k])
}

/// A position or direction in space.
pub(crate) fn spatial<const D: usize>(x: &Point<D>) -> Vector<3> {
    Vector::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 })
}
