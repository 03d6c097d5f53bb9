//! Tresca's law: friction up to a limit that does not depend on the pressure.

use super::{Friction, Law, LawError, checked, onto_circle};

/// The largest friction traction, per reference area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tresca {
    limit: f64,
}

impl Tresca {
    /// # Errors
    /// A limit that is negative or not finite.
    pub fn new(limit: f64) -> Result<Self, LawError> {
        checked(&[limit])?;
        Ok(Tresca { limit })
    }

    pub fn limit(&self) -> f64 {
        self.limit
    }
}

impl Law for Tresca {
    fn friction(&self, trial: [f64; 2], _: f64) -> Friction {
        onto_circle(trial, self.limit).0
    }

    fn utilisation(&self, traction: [f64; 2], _: f64) -> f64 {
        let size = traction[0].hypot(traction[1]);
        if size == 0.0 { 0.0 } else { size / self.limit }
    }

    fn per_pressure(&self) -> Option<[f64; 2]> {
        None
    }
}
