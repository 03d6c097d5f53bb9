//! Surfaces that are glued: whatever their trial asks for is transmitted.

use super::{Friction, Law, LawPoint, Projected, Status, stuck};

/// A bond without a limit, in all directions: `Π(ζ) = ζ`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tied;

impl Law for Tied {
    fn friction(&self, trial: [f64; 2], _: f64) -> Friction {
        stuck(trial)
    }

    fn is_compliant(&self) -> bool {
        true
    }

    fn is_tied(&self) -> bool {
        true
    }

    fn strength(&self) -> [f64; 2] {
        [f64::INFINITY; 2]
    }

    fn range(&self) -> f64 {
        f64::INFINITY
    }

    fn utilisation(&self, _: [f64; 2], _: f64) -> f64 {
        0.0
    }

    fn per_pressure(&self) -> Option<[f64; 2]> {
        None
    }

    fn traction(&self, trial: [f64; 3], _: &LawPoint) -> Projected {
        let derivative = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Projected { traction: trial, derivative, status: Status::Stick }
    }
}
