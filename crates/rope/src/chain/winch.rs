//! A winch at an end of a rope.

use std::sync::Arc;

/// Which end of a rope a winch is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WinchEnd {
    Start,
    End,
}

/// Length by time.
pub type Length = Arc<dyn Fn(f64) -> f64 + Send + Sync>;

/// A winch.
#[derive(Clone)]
pub struct Winch {
    pub at: WinchEnd,
    /// The unstrained length that was paid out since the start; negative where it was taken in.
    pub paid_out: Length,
    pub(super) nominal: f64,
    /// Unstrained length that is out at the start.
    pub(super) out: f64,
}

impl std::fmt::Debug for Winch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Winch").field("at", &self.at).field("nominal", &self.nominal).field("out", &self.out).finish()
    }
}
