//! Values of the case as fields over position and time. One that is no number somewhere is remembered, and told after the
//! solver has stopped at it.

use crate::expression::{Expression, Scope};
use crate::plan::planner::Planner;
use crate::problem::units::Dimension;
use crate::problem::{CaseError, KeyPath, List, Problem, Space, Value};
use signorini_geometry::{Point, Vector};
use signorini_mechanics::system::{TimeField, TimeVectorField};
use std::sync::{Arc, Mutex};

/// The first value of the case that was no number, with its key.
#[derive(Clone, Default)]
pub struct Wrong(Arc<Mutex<Option<(KeyPath, String)>>>);

impl Wrong {
    /// Remembers a value.
    fn note(&self, key: &KeyPath, message: String) {
        if let Ok(mut first) = self.0.lock() {
            first.get_or_insert((key.clone(), message));
        }
    }

    /// The error of what was remembered, which is forgotten.
    pub fn take(&self, problem: &Problem) -> Option<CaseError> {
        let (key, message) = self.0.lock().ok()?.take()?;
        Some(problem.error(&key, message))
    }

    /// The value of an expression at a place and time; not a number is remembered.
    pub fn evaluate(&self, expression: &Expression, key: &KeyPath, x: &Point<3>, time: f64) -> f64 {
        let value = expression.evaluate(&Scope { position: [x[0], x[1], x[2]], time });
        if !value.is_finite() {
            let at: Vec<String> = x.iter().map(|v| format!("{v:.6}")).collect();
            let place = format!("at ({}), t = {time}", at.join(", "));
            self.note(key, format!("`{key}` is {value} {place}: not a finite number"));
        }
        value
    }
}

impl Planner<'_> {
    /// Names of coordinates and time.
    pub(super) fn variables(&self) -> &'static [&'static str] {
        if self.space == Space::ThreeD { &["x", "y", "z", "t"] } else { &["x", "y", "t"] }
    }

    /// A value as a field.
    pub(super) fn field(&self, value: &Value, dimension: Dimension, wrong: &Wrong) -> Result<TimeField, CaseError> {
        let expression = self.reader.expression(value, dimension, self.variables())?;
        let (key, wrong) = (self.key(value), wrong.clone());
        Ok(Arc::new(move |x, t| wrong.evaluate(&expression, &key, x, t)))
    }

    /// The tension at the end of a rope as a field: one that pushes is remembered, and stops the solver.
    pub(super) fn pull(&self, value: &Value, dimension: Dimension, wrong: &Wrong) -> Result<TimeField, CaseError> {
        let (tension, key, wrong) = (self.field(value, dimension, wrong)?, self.key(value), wrong.clone());
        Ok(Arc::new(move |x, t| {
            let pull = tension(x, t);
            if pull < 0.0 {
                wrong.note(&key, format!("`{key}` is {pull:.6} at t = {t}, but a rope carries tension only"));
                return f64::NAN;
            }
            pull
        }))
    }

    /// Values as a vector field; in the plane the third component is zero.
    pub(super) fn vector_field(
        &self,
        values: &List<Value>,
        dimension: Dimension,
        wrong: &Wrong,
    ) -> Result<TimeVectorField, CaseError> {
        let wanted = if self.space == Space::ThreeD { 3 } else { 2 };
        if values.len() != wanted {
            return Err(self.problem.error(values, format!("expected {wanted} components, found {}", values.len())));
        }
        let list = values.iter().map(|v| self.field(v, dimension, wrong)).collect::<Result<Vec<_>, _>>()?;
        Ok(Arc::new(move |x, t| Vector::<3>::from_fn(|k, _| list.get(k).map_or(0.0, |f| f(x, t)))))
    }

    /// A moment: in space a vector, in the plane the one about z.
    pub(super) fn moment_field(
        &self,
        values: &List<Value>,
        dimension: Dimension,
        wrong: &Wrong,
    ) -> Result<TimeVectorField, CaseError> {
        if self.space == Space::ThreeD {
            return self.vector_field(values, dimension, wrong);
        }
        let [value] = &values[..] else {
            let message = format!("in the plane a moment has one component, about z: found {}", values.len());
            return Err(self.problem.error(values, message).help("moment = [1.0]"));
        };
        let field = self.field(value, dimension, wrong)?;
        Ok(Arc::new(move |x, t| Vector::<3>::z() * field(x, t)))
    }
}
