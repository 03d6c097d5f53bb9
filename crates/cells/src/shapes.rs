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
