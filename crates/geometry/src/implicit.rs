//! Shapes given by a function that is negative inside.

use crate::{Aabb, Matrix, Point, Vector};

/// A shape `{x : value(x) < 0}`; its boundary is where the value vanishes and the gradient does not.
pub trait ImplicitShape<const D: usize>: Send + Sync {
    /// Negative inside, positive outside.
    fn value(&self, x: &Point<D>) -> f64;
    /// Derivative of [`value`](Self::value); points outwards on the boundary.
    fn gradient(&self, x: &Point<D>) -> Vector<D>;
    /// Bounds of the value in a box, where they are known.
    fn range(&self, _: &Aabb<D>) -> Option<[f64; 2]> {
        None
    }
    /// Second derivatives of the value; central differences of the gradient where there is no formula.
    fn hessian(&self, x: &Point<D>) -> Matrix<D> {
        // The step at which rounding and the next term are alike, for positions and lengths of about this size.
        let step = f64::EPSILON.cbrt() * x.amax().max(1e-3);
        let mut out = Matrix::<D>::zeros();
        for k in 0..D {
            let e = Vector::<D>::from_fn(|i, _| if i == k { step } else { 0.0 });
            out.set_column(k, &((self.gradient(&(x + e)) - self.gradient(&(x - e))) / (2.0 * step)));
        }
        (out + out.transpose()) * 0.5
    }
    /// Both at once, where that is cheaper.
    fn value_and_gradient(&self, x: &Point<D>) -> (f64, Vector<D>) {
        (self.value(x), self.gradient(x))
    }
}

impl<const D: usize, S: ImplicitShape<D> + ?Sized> ImplicitShape<D> for &S {
    fn value(&self, x: &Point<D>) -> f64 {
        (**self).value(x)
    }
    fn gradient(&self, x: &Point<D>) -> Vector<D> {
        (**self).gradient(x)
    }
    fn range(&self, b: &Aabb<D>) -> Option<[f64; 2]> {
        (**self).range(b)
    }
    fn value_and_gradient(&self, x: &Point<D>) -> (f64, Vector<D>) {
        (**self).value_and_gradient(x)
    }
    fn hessian(&self, x: &Point<D>) -> Matrix<D> {
        (**self).hessian(x)
    }
}

impl<const D: usize, S: ImplicitShape<D> + ?Sized> ImplicitShape<D> for std::sync::Arc<S> {
    fn value(&self, x: &Point<D>) -> f64 {
        (**self).value(x)
    }
    fn gradient(&self, x: &Point<D>) -> Vector<D> {
        (**self).gradient(x)
    }
    fn range(&self, b: &Aabb<D>) -> Option<[f64; 2]> {
        (**self).range(b)
    }
    fn value_and_gradient(&self, x: &Point<D>) -> (f64, Vector<D>) {
        (**self).value_and_gradient(x)
    }
    fn hessian(&self, x: &Point<D>) -> Matrix<D> {
        (**self).hessian(x)
    }
}

/// An ellipse with its axes along the coordinate axes; a disc where both semi-axes agree.
///
/// The value is `(|x/a|² - 1) a_min / 2`, of unit slope at the ends of the minor axis.
#[derive(Clone, Copy, Debug)]
pub struct Ellipse {
    pub center: Point<2>,
    pub semi_axes: [f64; 2],
}

impl Ellipse {
    fn scaled(&self, x: &Point<2>) -> [f64; 2] {
        std::array::from_fn(|k| (x[k] - self.center[k]) / self.semi_axes[k])
    }

    fn minor(&self) -> f64 {
        self.semi_axes[0].min(self.semi_axes[1])
    }
}

impl ImplicitShape<2> for Ellipse {
    fn value(&self, x: &Point<2>) -> f64 {
        let [s, t] = self.scaled(x);
        0.5 * self.minor() * (s * s + t * t - 1.0)
    }

    fn range(&self, b: &Aabb<2>) -> Option<[f64; 2]> {
        let (low, high) = (self.scaled(&b.min), self.scaled(&b.max));
        let squares = [0, 1].map(|k| {
            let (a, b) = (low[k] * low[k], high[k] * high[k]);
            [if low[k] <= 0.0 && high[k] >= 0.0 { 0.0 } else { a.min(b) }, a.max(b)]
        });
        Some([0, 1].map(|e| 0.5 * self.minor() * (squares[0][e] + squares[1][e] - 1.0)))
    }

    fn gradient(&self, x: &Point<2>) -> Vector<2> {
        let [s, t] = self.scaled(x);
        self.minor() * Vector::<2>::new(s / self.semi_axes[0], t / self.semi_axes[1])
    }
}

/// The half plane to the left of a directed line; the value is the signed distance.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    pub point: Point<2>,
    /// Unit normal, out of the half plane.
    pub normal: Vector<2>,
}

impl Line {
    /// The line through two points; the half plane is to the left of the way from `a` to `b`.
    pub fn through(a: &Point<2>, b: &Point<2>) -> Self {
        let d = (b - a).normalize();
        Self { point: *a, normal: Vector::<2>::new(d[1], -d[0]) }
    }
}

impl ImplicitShape<2> for Line {
    fn value(&self, x: &Point<2>) -> f64 {
        (x - self.point).dot(&self.normal)
    }

    fn gradient(&self, _: &Point<2>) -> Vector<2> {
        self.normal
    }
}
