//! Fields that a program states as functions of its own.

use super::scope::Scope;
use signorini_geometry::{Jet, Real};
use std::fmt;
use std::sync::Arc;

/// A function of position and time with its derivatives.
#[derive(Clone)]
pub struct FieldFunction {
    value: Arc<dyn Fn([Jet<3>; 3], f64) -> Jet<3> + Send + Sync>,
    in_time: InTime,
}

/// Whether a field depends on time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InTime {
    Varying,
    Fixed,
    /// It does, and is taken at one time.
    At(f64),
}

impl FieldFunction {
    /// From a function of a place and a time that is evaluated on jets of the place.
    pub fn new(f: impl Fn([Jet<3>; 3], f64) -> Jet<3> + Send + Sync + 'static, in_time: InTime) -> Self {
        Self { value: Arc::new(f), in_time }
    }

    /// Whether it depends on time.
    pub fn varies(&self) -> bool {
        self.in_time == InTime::Varying
    }

    /// The field at one time.
    #[must_use]
    pub fn at_time(&self, time: f64) -> Self {
        let in_time = if self.varies() { InTime::At(time) } else { self.in_time };
        Self { value: Arc::clone(&self.value), in_time }
    }

    /// The value, with the derivatives of the place where that is a jet.
    pub fn evaluate<R: Real>(&self, scope: &Scope<R>) -> R {
        let place = scope.position.map(|x| x.value());
        let time = if let InTime::At(time) = self.in_time { time } else { scope.time.value() };
        let jet = (self.value)([0, 1, 2].map(|k| Jet::variable(place[k], k)), time);
        jet.expanded([0, 1, 2].map(|k| scope.position[k] - R::constant(place[k])))
    }
}

impl fmt::Debug for FieldFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("FieldFunction")
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Expression, Names, parse};
    use super::*;

    /// A function of the program has the value and the derivatives of the same expression.
    #[test]
    fn a_function_is_the_expression_that_states_the_same() {
        let names = Names { variables: vec!["x", "y", "z", "t"], ..Names::default() };
        let expression = parse("x^2*y - sin(y) + t*x*z", &names).unwrap();
        let f = |[x, y, z]: [Jet<3>; 3], t: f64| x * x * y - y.sin() + x * z * t;
        let function = Expression::function(FieldFunction::new(f, InTime::Varying));
        let position = [Jet::<2>::variable(0.3, 0), Jet::variable(-0.7, 1), Jet::constant(0.4)];
        let scope = Scope { position, time: Jet::constant(1.5) };
        let [a, b] = [&expression, &function.at_time(1.5)].map(|e| e.evaluate(&scope));
        assert!((a.value - b.value).abs() < 1e-15 && (a.gradient - b.gradient).norm() < 1e-15);
        assert!((a.hessian - b.hessian).norm() < 1e-15, "{} {}", a.hessian, b.hessian);
        assert!(function.uses_time() && !function.at_time(1.0).uses_time() && function.uses_position(1));
    }
}
