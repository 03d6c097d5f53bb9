//! What a contact is replaced by while a start is looked for: a penalty in place of what enforces it, and friction without a
//! limit where that is asked for.

use crate::enforcement::Enforcement;
use signorini_contact::Law;
use signorini_contact::law::{Friction, stuck};

/// The friction of a contact while a start is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SimplerFriction {
    /// Its own.
    Stated,
    /// All that touches sticks: while nothing carries yet, nothing would rub.
    Sticks,
}

impl SimplerFriction {
    /// Puts it in the place of a law, which is returned if another one takes its place.
    pub fn instead_of(self, law: &mut Option<Box<dyn Law>>) -> Option<Box<dyn Law>> {
        match self {
            Self::Stated => None,
            Self::Sticks => law.as_mut().map(|law| std::mem::replace(law, Box::new(Sticks))),
        }
    }
}

/// What a contact states, as long as something simpler stands in its place.
pub(crate) struct SetAside {
    /// None where it stayed.
    law: Option<Box<dyn Law>>,
    enforcement: Enforcement,
    softness: f64,
}

impl SetAside {
    /// Puts a penalty, and the friction that is asked for, in the place of what is stated.
    pub fn new(
        friction: SimplerFriction,
        law: &mut Option<Box<dyn Law>>,
        (enforcement, softness): (&mut Enforcement, &mut f64),
    ) -> Self {
        let law = friction.instead_of(law);
        let penalty = Enforcement::Penalty { wanted_penetration: None };
        SetAside {
            law,
            enforcement: std::mem::replace(enforcement, penalty),
            softness: std::mem::replace(softness, penalty.softness()),
        }
    }

    /// Puts it back.
    pub fn put_back(self, law: &mut Option<Box<dyn Law>>, (enforcement, softness): (&mut Enforcement, &mut f64)) {
        if self.law.is_some() {
            *law = self.law;
        }
        (*enforcement, *softness) = (self.enforcement, self.softness);
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
