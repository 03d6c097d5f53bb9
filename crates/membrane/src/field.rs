//! Scalar fields of position: tension, load, floor height, prescribed displacement.

use signorini_geometry::{Jet, Point, Real};
use std::sync::Arc;

/// A scalar field with exact derivatives.
pub trait Field<const D: usize>: Send + Sync {
    fn value(&self, x: &Point<D>) -> f64;
    /// Value, gradient and Hessian.
    fn jet(&self, x: &Point<D>) -> Jet<D>;
    /// The value, if it is the same everywhere.
    fn constant(&self) -> Option<f64> {
        None
    }
}

/// A field shared between problems.
pub type SharedField<const D: usize> = Arc<dyn Field<D>>;

/// A field that is the same everywhere.
#[derive(Clone, Copy, Debug)]
pub struct Constant(pub f64);

impl<const D: usize> Field<D> for Constant {
    fn value(&self, _: &Point<D>) -> f64 {
        self.0
    }
    fn jet(&self, _: &Point<D>) -> Jet<D> {
        Jet::constant(self.0)
    }
    fn constant(&self) -> Option<f64> {
        Some(self.0)
    }
}

/// A field given by a formula on jets.
pub struct Formula<F>(pub F);

impl<const D: usize, F: Fn([Jet<D>; D]) -> Jet<D> + Send + Sync> Field<D> for Formula<F> {
    fn value(&self, x: &Point<D>) -> f64 {
        self.jet(x).value
    }
    fn jet(&self, x: &Point<D>) -> Jet<D> {
        (self.0)(std::array::from_fn(|k| Jet::variable(x[k], k)))
    }
}

/// A field moved and lifted: `value(x - shift) + rise`.
pub struct Moved<const D: usize> {
    pub field: SharedField<D>,
    pub shift: Point<D>,
    pub rise: f64,
}

impl<const D: usize> Field<D> for Moved<D> {
    fn value(&self, x: &Point<D>) -> f64 {
        self.field.value(&(x - self.shift)) + self.rise
    }
    fn jet(&self, x: &Point<D>) -> Jet<D> {
        let mut jet = self.field.jet(&(x - self.shift));
        jet.value += self.rise;
        jet
    }
    fn constant(&self) -> Option<f64> {
        self.field.constant().map(|v| v + self.rise)
    }
}

/// The sum of fields.
pub struct Sum<const D: usize>(pub Vec<SharedField<D>>);

impl<const D: usize> Field<D> for Sum<D> {
    fn value(&self, x: &Point<D>) -> f64 {
        self.0.iter().map(|f| f.value(x)).sum()
    }
    fn jet(&self, x: &Point<D>) -> Jet<D> {
        self.0.iter().fold(Jet::constant(0.0), |sum, f| sum + f.jet(x))
    }
    fn constant(&self) -> Option<f64> {
        self.0.iter().map(|f| f.constant()).sum()
    }
}
