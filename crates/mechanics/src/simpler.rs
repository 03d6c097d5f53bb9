//! The friction of a contact while a start is looked for: without a limit, or none, where that is asked for.

use signorini_contact::Law;
use signorini_contact::law::{Friction, stuck};

/// The friction of a contact while a start is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SimplerFriction {
    /// Its own.
    Stated,
    /// All that touches sticks: while nothing carries yet, nothing would rub.
    Sticks,
    /// Nothing rubs.
    Smooth,
}

impl SimplerFriction {
    /// Puts it in the place of a law, which is returned if another one takes its place.
    pub fn instead_of(self, law: &mut Option<Box<dyn Law>>) -> Option<Box<dyn Law>> {
        match self {
            Self::Stated => None,
            Self::Sticks => {
                let law = law.as_mut().filter(|law| !law.is_compliant())?;
                Some(std::mem::replace(law, Box::new(Sticks)))
            }
            Self::Smooth => Some(std::mem::replace(law.as_mut()?, Box::new(Smooth))),
        }
    }
}

/// Friction without a limit.
#[derive(Debug)]
struct Sticks;

impl Law for Sticks {
    fn friction(&self, trial: [f64; 2], _: f64) -> Friction {
        stuck(trial)
    }

    fn utilisation(&self, _: [f64; 2], _: f64) -> f64 {
        0.0
    }

    fn per_pressure(&self) -> Option<[f64; 2]> {
        None
    }
}

/// No friction at all.
#[derive(Debug)]
struct Smooth;

impl Law for Smooth {
    fn friction(&self, _: [f64; 2], _: f64) -> Friction {
        Friction { traction: [0.0; 2], by_trial: [[0.0; 2]; 2], by_pressure: [0.0; 2], slips: true }
    }

    fn utilisation(&self, _: [f64; 2], _: f64) -> f64 {
        1.0
    }

    fn per_pressure(&self) -> Option<[f64; 2]> {
        Some([0.0; 2])
    }
}
