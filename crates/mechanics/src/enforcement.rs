//! How contact at a site is enforced, and the scale of its trials.

/// How the contact conditions are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Enforcement {
    /// Up to a penetration: the one wanted, or what a hundred times the stiffness of the bodies leaves.
    Penalty { wanted_penetration: Option<f64> },
    /// Exactly in the limit of outer iterations.
    AugmentedLagrangian,
    /// Exactly, with tractions as unknowns; between rigid bodies by augmentation.
    Multiplier,
    /// Weakly and consistently, with the stress of the slave, which has to know it.
    Nitsche,
}

/// Stiffness of a half-space against a pressure wave as long as a cell is deep, `k E / (2 - 2ν²)` with `k = 2π/h`, in those
/// of a cell, `E/h`: less for trials, and sites are opened and closed by the tractions of the last step alone.
pub(crate) const WAVE: f64 = std::f64::consts::PI;

/// What trials are scaled by where Newton's method fails, and for curves on what deforms: a power of two, so that nothing is
/// rounded.
pub(crate) const SOFTER: f64 = 1.0 / 128.0;

/// The scale of trials over a penalty of a hundred times the stiffness of the bodies: what a contact that carries gives way
/// is a hundredth of what they do.
const SOFTNESS: f64 = WAVE / 100.0;

/// What an outer iteration does with the tractions that were found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Outer {
    Nothing,
    /// Takes them as those to give way from.
    TakesOver,
    /// Changes penalties towards the penetration that is wanted.
    Towards(f64),
}

impl Enforcement {
    /// Whether its tractions are exact multipliers.
    pub(crate) fn is_exact(self) -> bool {
        self == Enforcement::Multiplier
    }

    /// Whether its trials are the stress of the slave, which has a stiffness of its own for it.
    pub(crate) fn takes_stress(self) -> bool {
        self == Enforcement::Nitsche
    }

    /// What serves between two rigid bodies: what several of their points carry is not unique, and the least of it is found
    /// by augmentation.
    pub(crate) fn between_rigid_bodies(self) -> Self {
        if self.is_exact() { Enforcement::AugmentedLagrangian } else { self }
    }

    /// The traction with which a site that gives way has no gap and no slip, after those that it carried.
    pub(crate) fn base(self, [p, t1, t2]: [f64; 3]) -> [f64; 3] {
        match self {
            Enforcement::Multiplier | Enforcement::Nitsche => [0.0; 3],
            Enforcement::AugmentedLagrangian => [p, t1, t2],
            Enforcement::Penalty { .. } => [0.0, t1, t2],
        }
    }

    /// What its outer iterations do.
    pub(crate) fn outer(self) -> Outer {
        match self {
            Enforcement::AugmentedLagrangian => Outer::TakesOver,
            Enforcement::Penalty { wanted_penetration: Some(wanted) } => Outer::Towards(wanted),
            _ => Outer::Nothing,
        }
    }

    /// Scale of trials over the penalty, to begin with.
    pub(crate) fn softness(self) -> f64 {
        match self {
            Enforcement::Multiplier => 0.0,
            Enforcement::Nitsche => 1.0,
            Enforcement::Penalty { .. } | Enforcement::AugmentedLagrangian => SOFTNESS,
        }
    }
}
