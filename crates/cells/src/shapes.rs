//! Implicit shapes in any dimension: functions, balls, ellipsoids, half spaces, boxes, and rigid shapes with an offset.

use crate::domain::Domain;
use signorini_geometry::jet::Jet;
use signorini_geometry::rigid_shape::RigidShape;
use signorini_geometry::{Aabb, ImplicitShape, Matrix, Point, Vector};
use std::sync::Arc;

/// A function of position, negative inside, with its derivatives: what an expression is evaluated to.
pub struct Function<F>(pub F);

impl<const D: usize, F: Fn(&Point<D>) -> Jet<D> + Send + Sync> ImplicitShape<D> for Function<F> {
    fn value(&self, x: &Point<D>) -> f64 {
        (self.0)(x).value
    }
    fn gradient(&self, x: &Point<D>) -> Vector<D> {
        (self.0)(x).gradient
    }
    fn value_and_gradient(&self, x: &Point<D>) -> (f64, Vector<D>) {
        let jet = (self.0)(x);
        (jet.value, jet.gradient)
    }
    fn hessian(&self, x: &Point<D>) -> Matrix<D> {
        (self.0)(x).hessian
    }
}

/// An ellipsoid with its axes along the coordinate axes: `(|x/a|² - 1) a_min / 2`.
#[derive(Clone, Copy, Debug)]
pub struct Ellipsoid<const D: usize> {
    pub center: Point<D>,
    pub semi_axes: [f64; D],
}

/// A disc or a ball.
pub fn ball<const D: usize>(center: Point<D>, radius: f64) -> Ellipsoid<D> {
    Ellipsoid { center, semi_axes: [radius; D] }
}

impl<const D: usize> Ellipsoid<D> {
    fn minor(&self) -> f64 {
        self.semi_axes.iter().fold(f64::INFINITY, |m, a| m.min(*a))
    }
}

impl<const D: usize> ImplicitShape<D> for Ellipsoid<D> {
    fn value(&self, x: &Point<D>) -> f64 {
        let square: f64 = (0..D).map(|k| ((x[k] - self.center[k]) / self.semi_axes[k]).powi(2)).sum();
        0.5 * self.minor() * (square - 1.0)
    }
    fn gradient(&self, x: &Point<D>) -> Vector<D> {
        Vector::from_fn(|k, _| self.minor() * (x[k] - self.center[k]) / self.semi_axes[k].powi(2))
    }
    fn hessian(&self, _: &Point<D>) -> Matrix<D> {
        Matrix::from_diagonal(&Vector::from_fn(|k, _| self.minor() / self.semi_axes[k].powi(2)))
    }
    fn range(&self, b: &Aabb<D>) -> Option<[f64; 2]> {
        let mut sums = [0.0; 2];
        for k in 0..D {
            let [low, high] = [b.min[k], b.max[k]].map(|x| (x - self.center[k]) / self.semi_axes[k]);
            sums[0] += if low <= 0.0 && high >= 0.0 { 0.0 } else { (low * low).min(high * high) };
            sums[1] += (low * low).max(high * high);
        }
        Some(sums.map(|s| 0.5 * self.minor() * (s - 1.0)))
    }
}

/// What lies behind a plane (a line, a point); the value is the signed distance.
#[derive(Clone, Copy, Debug)]
pub struct HalfSpace<const D: usize> {
    pub point: Point<D>,
    /// Unit normal, out of the half space.
    pub normal: Vector<D>,
}

impl<const D: usize> ImplicitShape<D> for HalfSpace<D> {
    fn value(&self, x: &Point<D>) -> f64 {
        (x - self.point).dot(&self.normal)
    }
    fn gradient(&self, _: &Point<D>) -> Vector<D> {
        self.normal
    }
    fn hessian(&self, _: &Point<D>) -> Matrix<D> {
        Matrix::<D>::zeros()
    }
    fn range(&self, b: &Aabb<D>) -> Option<[f64; 2]> {
        let (center, half) = (self.value(&b.center()), 0.5 * b.size());
        let reach = self.normal.abs().dot(&half);
        Some([center - reach, center + reach])
    }
}

/// A box with its sides along the coordinate axes.
pub fn cuboid<const D: usize>(b: &Aabb<D>) -> Domain<D> {
    let side = |k: usize, point: Point<D>, sign: f64| {
        Domain::shape(HalfSpace { point, normal: Vector::from_fn(|a, _| if a == k { sign } else { 0.0 }) })
    };
    Domain::Intersection((0..D).flat_map(|k| [side(k, b.min, -1.0), side(k, b.max, 1.0)]).collect())
}

/// What is closer to a rigid shape than a distance, or deeper than it inside where it is negative. Implicit bodies of
/// space have exact offsets in this way through [`signorini_geometry::implicit_surface::ImplicitSurface`].
#[derive(Clone)]
pub struct Rigid {
    pub shape: Arc<dyn RigidShape>,
    pub offset: f64,
}

impl ImplicitShape<3> for Rigid {
    fn value(&self, x: &Point<3>) -> f64 {
        self.shape.gap(x).gap - self.offset
    }
    fn gradient(&self, x: &Point<3>) -> Vector<3> {
        self.shape.gap(x).normal
    }
    fn value_and_gradient(&self, x: &Point<3>) -> (f64, Vector<3>) {
        let at = self.shape.gap(x);
        (at.gap - self.offset, at.normal)
    }
    fn hessian(&self, x: &Point<3>) -> Matrix<3> {
        self.shape.gap(x).hessian
    }
    /// A gap changes no faster than position.
    fn range(&self, b: &Aabb<3>) -> Option<[f64; 2]> {
        let (value, reach) = (self.value(&b.center()), b.radius());
        Some([value - reach, value + reach])
    }
}

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
    fn range(&self, b: &Aabb<D>) -> Option<[f64; 2]> {
        self.0.range(&Aabb::new(spatial(&b.min), spatial(&b.max)))
    }
}

/// A position or direction in space.
pub(crate) fn spatial<const D: usize>(x: &Point<D>) -> Vector<3> {
    Vector::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 })
}
