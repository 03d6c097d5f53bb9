//! Shapes given by a function that is negative inside: one trait for cut cells, bodies of finite cells, exact distances and
//! fronts.
//!
//! | file | what it holds |
//! |---|---|
//! | `mod` | [`ImplicitShape`]: value, gradient, Hessian |
//! | `shapes` | [`Function`], [`Ellipsoid`], [`HalfSpace`], [`Offset`] of a rigid shape, [`Complement`] |
//! | `body` | [`ImplicitBody`]: unions, intersections and complements of shapes |

mod body;
mod shapes;

pub use body::{ImplicitBody, Restricted, cuboid};
pub use shapes::{Complement, Ellipsoid, Function, HalfSpace, Level, Offset, ball};

use crate::jet::Jet;
use crate::{Aabb, Matrix, Point, Vector};

/// What looks at the value and the slope of a function along a line.
pub type OnLine<'a> = dyn FnMut(&dyn Fn(f64) -> (f64, f64)) + 'a;

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
    /// Shows the value and the slope along a line through `x` in direction `axis`, by the coordinate in that direction, which
    /// stays between two ends.
    fn on_line(&self, x: &Point<D>, axis: usize, _ends: [f64; 2], find: &mut OnLine<'_>) {
        find(&|t| {
            let mut y = *x;
            y[axis] = t;
            let (value, gradient) = self.value_and_gradient(&y);
            (value, gradient[axis])
        });
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
    /// All three at once, where that is cheaper.
    fn jet(&self, x: &Point<D>) -> Jet<D> {
        let (value, gradient) = self.value_and_gradient(x);
        Jet { value, gradient, hessian: self.hessian(x) }
    }
}

/// What lends a shape is the shape.
macro_rules! lent {
    ($lender:ty) => {
        impl<const D: usize, S: ImplicitShape<D> + ?Sized> ImplicitShape<D> for $lender {
            fn value(&self, x: &Point<D>) -> f64 {
                (**self).value(x)
            }
            fn gradient(&self, x: &Point<D>) -> Vector<D> {
                (**self).gradient(x)
            }
            fn range(&self, b: &Aabb<D>) -> Option<[f64; 2]> {
                (**self).range(b)
            }
            fn on_line(&self, x: &Point<D>, axis: usize, ends: [f64; 2], find: &mut OnLine<'_>) {
                (**self).on_line(x, axis, ends, find);
            }
            fn value_and_gradient(&self, x: &Point<D>) -> (f64, Vector<D>) {
                (**self).value_and_gradient(x)
            }
            fn hessian(&self, x: &Point<D>) -> Matrix<D> {
                (**self).hessian(x)
            }
            fn jet(&self, x: &Point<D>) -> Jet<D> {
                (**self).jet(x)
            }
        }
    };
}

lent!(&S);
lent!(std::sync::Arc<S>);
