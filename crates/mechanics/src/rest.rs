//! Whether a system rests.

use crate::points::Order;
use crate::system::{AssemblyError, System, SystemState};

/// Gaps below this part of the size of the bodies are rounding.
const ROUNDING: f64 = 1e-12;

impl System {
    /// Whether nothing happens in a state at a time: nothing is loaded or moved, and nothing is pressed.
    ///
    /// # Errors
    /// States and places that cannot be.
    pub fn rests(&self, at: &SystemState, time: f64) -> Result<bool, AssemblyError> {
        let found = self.assemble(at, time, Order::First)?;
        let stiffness = self.contacts.iter().map(|contact| contact.stiffness(&self.bodies));
        let rounding = ROUNDING * self.size() * stiffness.filter(|c| c.is_finite()).fold(0.0, f64::max);
        let is_still = found.single.iter().chain(&found.coupled).all(|held| held.constraint.violation == 0.0);
        Ok(is_still && found.residual.iter().all(|r| r.abs() <= rounding))
    }
}
