//! Functions, ellipsoids, half spaces, and what lies within a distance of rigid shapes.

use super::{ImplicitShape, OnLine};
use crate::jet::Jet;
use crate::rigid_shape::RigidShape;
use crate::{Aabb, Matrix, Point, Vector};
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
    fn jet(&self, x: &Point<D>) -> Jet<D> {
        (self.0)(x)
    }
}

/// An ellipsoid, or an ellipse in the plane, with its axes along the coordinate axes; a ball or a disc where they agree.
///
/// The value is `(|x/a|² - 1) a_min / 2`, of unit slope at the ends of the minor axis.
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
    fn scaled(&self, x: &Point<D>) -> [f64; D] {
        std::array::from_fn(|k| (x[k] - self.center[k]) / self.semi_axes[k])
    }

    fn minor(&self) -> f64 {
        self.semi_axes.iter().fold(f64::INFINITY, |m, a| m.min(*a))
    }
}

impl<const D: usize> ImplicitShape<D> for Ellipsoid<D> {
    fn value(&self, x: &Point<D>) -> f64 {
        let square: f64 = self.scaled(x).iter().map(|s| s * s).sum();
        0.5 * self.minor() * (square - 1.0)
    }
    fn gradient(&self, x: &Point<D>) -> Vector<D> {
        let s = self.scaled(x);
        self.minor() * Vector::<D>::from_fn(|k, _| s[k] / self.semi_axes[k])
    }
    fn hessian(&self, _: &Point<D>) -> Matrix<D> {
        Matrix::from_diagonal(&Vector::from_fn(|k, _| self.minor() / self.semi_axes[k].powi(2)))
    }
    fn range(&self, b: &Aabb<D>) -> Option<[f64; 2]> {
        let (low, high) = (self.scaled(&b.min), self.scaled(&b.max));
        let mut sums = [0.0; 2];
        for (low, high) in low.into_iter().zip(high) {
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

impl HalfSpace<2> {
    /// The half plane to the left of the way from `a` to `b`.
    pub fn left_of(a: &Point<2>, b: &Point<2>) -> Self {
        let d = (b - a).normalize();
        Self { point: *a, normal: Vector::<2>::new(d[1], -d[0]) }
    }
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

/// What is closer to a rigid shape than a distance, or deeper than it inside where it is negative. Implicit bodies of
/// space have exact offsets in this way through [`ImplicitSurface`](crate::implicit_surface::ImplicitSurface).
#[derive(Clone)]
pub struct Offset {
    pub shape: Arc<dyn RigidShape>,
    pub distance: f64,
}

impl ImplicitShape<3> for Offset {
    fn value(&self, x: &Point<3>) -> f64 {
        self.shape.gap(x).gap - self.distance
    }
    fn gradient(&self, x: &Point<3>) -> Vector<3> {
        self.shape.gap(x).normal
    }
    fn value_and_gradient(&self, x: &Point<3>) -> (f64, Vector<3>) {
        let at = self.shape.gap(x);
        (at.gap - self.distance, at.normal)
    }
    fn hessian(&self, x: &Point<3>) -> Matrix<3> {
        self.shape.gap(x).hessian
    }
    fn jet(&self, x: &Point<3>) -> Jet<3> {
        let at = self.shape.gap(x);
        Jet { value: at.gap - self.distance, gradient: at.normal, hessian: at.hessian }
    }
    /// A gap changes no faster than position.
    fn range(&self, b: &Aabb<3>) -> Option<[f64; 2]> {
        let (value, reach) = (self.value(&b.center()), b.radius());
        Some([value - reach, value + reach])
    }
}

/// A rigid shape by the smooth function whose zero it is, [`RigidShape::level`], in place of its distance.
#[derive(Clone)]
pub struct Level(pub Arc<dyn RigidShape>);

impl ImplicitShape<3> for Level {
    fn value(&self, x: &Point<3>) -> f64 {
        self.0.level(x).value
    }
    fn gradient(&self, x: &Point<3>) -> Vector<3> {
        self.0.level(x).gradient
    }
    fn hessian(&self, x: &Point<3>) -> Matrix<3> {
        self.0.level(x).hessian
    }
    fn jet(&self, x: &Point<3>) -> Jet<3> {
        self.0.level(x)
    }
}

/// What is outside a shape.
pub struct Complement<S>(pub S);

impl<const D: usize, S: ImplicitShape<D>> ImplicitShape<D> for Complement<S> {
    fn value(&self, x: &Point<D>) -> f64 {
        -self.0.value(x)
    }
    fn gradient(&self, x: &Point<D>) -> Vector<D> {
        -self.0.gradient(x)
    }
    fn range(&self, b: &Aabb<D>) -> Option<[f64; 2]> {
        self.0.range(b).map(|[low, high]| [-high, -low])
    }
    fn on_line(&self, x: &Point<D>, axis: usize, ends: [f64; 2], find: &mut OnLine<'_>) {
        self.0.on_line(x, axis, ends, &mut |f| {
            find(&|t| {
                let (value, slope) = f(t);
                (-value, -slope)
            });
        });
    }
    fn value_and_gradient(&self, x: &Point<D>) -> (f64, Vector<D>) {
        let (value, gradient) = self.0.value_and_gradient(x);
        (-value, -gradient)
    }
    fn hessian(&self, x: &Point<D>) -> Matrix<D> {
        -self.0.hessian(x)
    }
    fn jet(&self, x: &Point<D>) -> Jet<D> {
        -self.0.jet(x)
    }
}
