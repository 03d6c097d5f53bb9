//! Archard's law of wear: a depth `k p |e|` is worn off where a pressure `p` slips by `e` (Archard 1953).
//!
//! Within an increment the gap grows with the wear of that increment, so that steps of any length are stable. The slip of the
//! increment is what the friction leaves of its trial, `c |e| = |ζ_t - t|`, and with it
//!
//! `p (1 + k |ζ_t - t(p)|) = ζ_n`.
//!
//! What was worn off before is part of the gap.

use super::{Friction, Law, LawError, LawPoint, Projected, checked, rubbing};

/// Wear with the friction of another law or none.
#[derive(Debug)]
pub struct Worn {
    /// Depth per pressure and slip.
    coefficient: f64,
    friction: Box<dyn Law>,
}

/// Newton steps: far more than it takes.
const MOST_STEPS: usize = 50;

impl Worn {
    /// `coefficient` is a depth per pressure and distance: hardness over Archard's number, one over a pressure.
    ///
    /// # Errors
    /// A coefficient that is negative or not finite.
    pub fn new(coefficient: f64, friction: Box<dyn Law>) -> Result<Self, LawError> {
        checked(&[coefficient])?;
        Ok(Worn { coefficient, friction })
    }
}

impl Law for Worn {
    fn begin(&mut self, time: f64) {
        self.friction.begin(time);
    }

    fn friction(&self, trial: [f64; 2], pressure: f64) -> Friction {
        self.friction.friction(trial, pressure)
    }

    fn friction_at(&self, trial: [f64; 2], pressure: f64, point: &LawPoint) -> Friction {
        self.friction.friction_at(trial, pressure, point)
    }

    fn wear(&self) -> f64 {
        self.coefficient
    }

    fn is_rate_dependent(&self) -> bool {
        self.friction.is_rate_dependent()
    }

    fn utilisation(&self, traction: [f64; 2], pressure: f64) -> f64 {
        // Without friction there is none that could be used.
        match self.friction.per_pressure() {
            Some([0.0, 0.0]) => 0.0,
            _ => self.friction.utilisation(traction, pressure),
        }
    }

    fn per_pressure(&self) -> Option<[f64; 2]> {
        self.friction.per_pressure()
    }

    fn traction(&self, trial: [f64; 3], point: &LawPoint) -> Projected {
        if trial[0] <= 0.0 {
            return Projected::default();
        }
        let along = [trial[1], trial[2]];
        let k = self.coefficient;
        // Friction, the slip that it leaves with its direction, and the slope of the equation.
        let at = |p: f64| {
            let friction = self.friction.friction_at(along, p, point);
            let left: [f64; 2] = std::array::from_fn(|i| along[i] - friction.traction[i]);
            let size = left[0].hypot(left[1]);
            let unit = if size > 0.0 { left.map(|v| v / size) } else { [0.0; 2] };
            let by_pressure = -(unit[0] * friction.by_pressure[0] + unit[1] * friction.by_pressure[1]);
            (friction, size, unit, 1.0 + k * (size + p * by_pressure))
        };
        let mut p = trial[0];
        for _ in 0..MOST_STEPS {
            let (_, size, _, slope) = at(p);
            let next = p - (p * (1.0 + k * size) - trial[0]) / slope;
            // Steps that would leave the interval in which the pressure lies halve it.
            let next = if next > 0.0 && next <= trial[0] { next } else { 0.5 * p };
            let moved = (next - p).abs();
            p = next;
            if moved <= 4.0 * f64::EPSILON * p {
                break;
            }
        }
        let (friction, _, unit, slope) = at(p);
        let d = friction.by_trial;
        // How the slip changes with its trial at this pressure.
        let left = |j: usize| (0..2).map(|i| unit[i] * (f64::from(u8::from(i == j)) - d[i][j])).sum::<f64>();
        let p_by = [1.0 / slope, -k * p * left(0) / slope, -k * p * left(1) / slope];
        rubbing(&friction, p, p_by)
    }
}
