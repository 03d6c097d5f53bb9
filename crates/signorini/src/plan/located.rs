//! Expressions with their keys, and as fields of a membrane.

use crate::expression::{Expression, Scope};
use crate::problem::KeyPath;
use signorini_geometry::{Jet, Point, Real};
use signorini_membrane::field::{Constant, Field, SharedField};
use std::sync::Arc;

/// An expression and the key it comes from.
#[derive(Clone)]
pub struct LocatedExpression {
    pub expression: Expression,
    pub key: KeyPath,
}

/// An expression as a field, at a fixed time.
struct ExpressionField(Expression);

impl<const D: usize> Field<D> for ExpressionField {
    fn value(&self, x: &Point<D>) -> f64 {
        let position = std::array::from_fn(|k| if k < D { x[k] } else { 0.0 });
        self.0.evaluate(&Scope { position, time: f64::NAN })
    }
    fn jet(&self, x: &Point<D>) -> Jet<D> {
        let position = std::array::from_fn(|k| if k < D { Jet::variable(x[k], k) } else { Jet::constant(0.0) });
        self.0.evaluate(&Scope { position, time: Jet::constant(f64::NAN) })
    }
    fn constant(&self) -> Option<f64> {
        self.0.constant()
    }
}

/// An expression at a time, as a field.
pub(crate) fn field<const D: usize>(expression: &Expression, time: f64) -> SharedField<D> {
    let fixed = expression.at_time(time);
    match fixed.constant() {
        Some(v) => Arc::new(Constant(v)),
        None => Arc::new(ExpressionField(fixed)),
    }
}
