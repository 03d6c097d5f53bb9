//! Coulomb's law with a coefficient that changes with time: in an increment that of its end.

use super::{Coulomb, Friction, Law};

/// A coefficient by time.
pub type Schedule = Box<dyn Fn(f64) -> f64 + Send + Sync>;

/// Isotropic friction with the coefficient of the present time.
pub struct Scheduled {
    schedule: Schedule,
    now: Coulomb,
}

impl Scheduled {
    /// A coefficient by time; what is negative or not a number counts as zero.
    pub fn new(schedule: Schedule) -> Self {
        let mut out = Scheduled { schedule, now: Coulomb::frictionless() };
        out.begin(0.0);
        out
    }
}

impl std::fmt::Debug for Scheduled {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Scheduled").field("now", &self.now).finish()
    }
}

impl Law for Scheduled {
    fn begin(&mut self, time: f64) {
        let mu = (self.schedule)(time);
        self.now = Coulomb::isotropic(mu).unwrap_or(Coulomb::frictionless());
    }

    fn friction(&self, trial: [f64; 2], pressure: f64) -> Friction {
        self.now.friction(trial, pressure)
    }

    fn utilisation(&self, traction: [f64; 2], pressure: f64) -> f64 {
        self.now.utilisation(traction, pressure)
    }

    fn per_pressure(&self) -> Option<[f64; 2]> {
        self.now.per_pressure()
    }
}
