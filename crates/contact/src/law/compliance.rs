//! Rough surfaces: a pressure that is a function of the gap between the mean planes.
//!
//! | compliance | pressure |
//! |---|---|
//! | exponential | `p = p_0 exp(-g/l)` at any gap (Greenwood & Williamson 1966, with heights of asperities that fall off exponentially) |
//! | power | `p = C (-g)^m` at a penetration, else none (Oden & Martins 1985) |
//!
//! With the trial `ζ = p - c g` the pressure is an implicit function of `ζ`, increasing, with a slope below one.

use super::{Friction, Law, LawError, LawPoint, checked, free};

/// How the pressure follows from the gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Compliance {
    /// The pressure at no gap, and the gap over which it falls to `1/e` of its value.
    Exponential { pressure: f64, length: f64 },
    /// The pressure at a penetration of 1, and the exponent.
    Power { coefficient: f64, exponent: f64 },
}

/// Newton steps: far more than it takes.
const MOST_STEPS: usize = 100;

impl Compliance {
    fn check(&self) -> Result<(), LawError> {
        let [a, b] = match *self {
            Self::Exponential { pressure, length } => [pressure, length],
            Self::Power { coefficient, exponent } => [coefficient, exponent],
        };
        checked(&[a, b])?;
        let least = if matches!(self, Self::Power { .. }) { 1.0 } else { f64::MIN_POSITIVE };
        [(a, f64::MIN_POSITIVE), (b, least)]
            .into_iter()
            .find(|(v, least)| v < least)
            .map_or(Ok(()), |(value, _)| Err(LawError { value }))
    }

    /// The gap at a pressure.
    pub fn gap(&self, p: f64) -> f64 {
        match *self {
            Self::Exponential { pressure, length } => -length * (p / pressure).ln(),
            Self::Power { coefficient, exponent } => -(p.max(0.0) / coefficient).powf(1.0 / exponent),
        }
    }

    /// The pressure under a trial with a traction `c` per gap, and its derivative.
    fn under(&self, trial: f64, c: f64) -> [f64; 2] {
        match *self {
            // `p + c l y = ζ` with `y = ln(p/p_0)`, convex in `y`: Newton's method comes to it from above.
            Self::Exponential { pressure, length } => {
                let softness = c * length;
                let mut y = (trial / softness).min((trial / pressure).max(1.0).ln());
                for _ in 0..MOST_STEPS {
                    let p = pressure * y.exp();
                    let step = (p + softness * y - trial) / (p + softness);
                    y -= step;
                    if step.abs() <= 4.0 * f64::EPSILON * y.abs().max(1.0) {
                        break;
                    }
                }
                let p = pressure * y.exp();
                [p, p / (p + softness)]
            }
            // `C d^m + c d = ζ` with the penetration `d`, convex: from above again.
            Self::Power { coefficient, exponent } => {
                if trial <= 0.0 {
                    return [0.0, 0.0];
                }
                let mut d = (trial / c).min((trial / coefficient).powf(1.0 / exponent));
                for _ in 0..MOST_STEPS {
                    let p = coefficient * d.powf(exponent);
                    let step = (p + c * d - trial) / (exponent * p / d + c);
                    d -= step;
                    if step.abs() <= 4.0 * f64::EPSILON * d {
                        break;
                    }
                }
                let p = coefficient * d.powf(exponent);
                let stiffness = exponent * p / d;
                [p, stiffness / (stiffness + c)]
            }
        }
    }
}

/// Rough surfaces, with the friction of another law or none.
#[derive(Debug)]
pub struct Rough {
    compliance: Compliance,
    friction: Option<Box<dyn Law>>,
}

impl Rough {
    /// # Errors
    /// A coefficient that is not positive, an exponent below one.
    pub fn new(compliance: Compliance, friction: Option<Box<dyn Law>>) -> Result<Self, LawError> {
        compliance.check()?;
        Ok(Rough { compliance, friction })
    }
}

impl Law for Rough {
    fn begin(&mut self, time: f64) {
        self.friction.iter_mut().for_each(|law| law.begin(time));
    }

    fn friction(&self, trial: [f64; 2], pressure: f64) -> Friction {
        self.friction_at(trial, pressure, &LawPoint::default())
    }

    fn friction_at(&self, trial: [f64; 2], pressure: f64, point: &LawPoint) -> Friction {
        self.friction.as_ref().map_or_else(free, |law| law.friction_at(trial, pressure, point))
    }

    fn pressure(&self, trial: f64, point: &LawPoint) -> [f64; 2] {
        self.compliance.under(trial, point.per_gap)
    }

    fn range(&self) -> f64 {
        if matches!(self.compliance, Compliance::Exponential { .. }) { f64::INFINITY } else { 0.0 }
    }

    fn is_compliant(&self) -> bool {
        true
    }

    fn compliance(&self) -> Option<Compliance> {
        Some(self.compliance)
    }

    fn is_tangential(&self) -> bool {
        self.friction.is_some()
    }

    fn is_rate_dependent(&self) -> bool {
        self.friction.as_ref().is_some_and(|law| law.is_rate_dependent())
    }

    fn utilisation(&self, traction: [f64; 2], pressure: f64) -> f64 {
        self.friction.as_ref().map_or(0.0, |law| law.utilisation(traction, pressure))
    }

    fn per_pressure(&self) -> Option<[f64; 2]> {
        self.friction.as_ref().map_or(Some([0.0; 2]), |law| law.per_pressure())
    }
}
