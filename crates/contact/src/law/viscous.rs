//! Coulomb's law regularised by the velocity of slip: `T = μ p v/√(v² + v_0²)` along the slip (Oden & Pires 1983).
//!
//! Nothing sticks: what the law of Coulomb holds creeps, at a velocity far below `v_0` as long as it needs little of the
//! friction. The traction is an implicit function of the trial `ζ = T + ρ v`, with the trial traction `ρ` per velocity:
//!
//! | symbol | meaning |
//! |---|---|
//! | `x = v/v_0`, `φ = x/√(1 + x²)`, `s = ρ v_0` | velocity, share of the friction, and scale of the trial |
//! | `|ζ| = s x + μ p φ(x)` | increasing and concave, so that Newton's method comes to `x` from below without overshooting |
//! | `t = μ p φ`, `dt/d|ζ| = μ p φ'/(s + μ p φ')`, `dt/dp = μ φ s/(s + μ p φ')` | with `φ' = (1 + x²)^{-3/2}` |
//!
//! In no time (`ρ = 0`) it is the law of Coulomb.

use super::{Coulomb, Friction, Law, LawError, LawPoint, checked};

/// Coulomb's law, isotropic, regularised below a velocity of slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viscous {
    limit: Coulomb,
    mu: f64,
    velocity: f64,
}

/// Newton steps to the velocity: far more than it takes.
const MOST_STEPS: usize = 100;

impl Viscous {
    /// With the velocity of slip, in length per unit of time, at which `1/√2` of the friction `μ p` acts.
    ///
    /// # Errors
    /// A coefficient or a velocity that is negative or not finite, or no velocity.
    pub fn new(mu: f64, velocity: f64) -> Result<Self, LawError> {
        checked(&[mu, velocity])?;
        if velocity == 0.0 {
            return Err(LawError { value: velocity });
        }
        Ok(Viscous { limit: Coulomb::isotropic(mu)?, mu, velocity })
    }

    pub fn mu(&self) -> f64 {
        self.mu
    }

    pub fn velocity(&self) -> f64 {
        self.velocity
    }
}

impl Law for Viscous {
    fn friction(&self, trial: [f64; 2], pressure: f64) -> Friction {
        self.limit.friction(trial, pressure)
    }

    fn friction_at(&self, trial: [f64; 2], pressure: f64, point: &LawPoint) -> Friction {
        let scale = point.per_velocity() * self.velocity;
        let most = self.mu * pressure;
        if scale <= 0.0 || most <= 0.0 {
            return self.limit.friction(trial, pressure);
        }
        let size = trial[0].hypot(trial[1]);
        // Two bounds from below: the slope at rest is the steepest, and there is no more friction than `most`.
        let mut x = (size / (scale + most)).max((size - most) / scale);
        let slope = |x: f64| scale + most * (1.0 + x * x).powf(-1.5);
        for _ in 0..MOST_STEPS {
            let step = (size - scale * x - most * x / x.hypot(1.0)) / slope(x);
            x += step;
            if step.abs() <= 2.0 * f64::EPSILON * x.abs() {
                break;
            }
        }
        let share = x / x.hypot(1.0);
        let along = if size > 0.0 { [trial[0] / size, trial[1] / size] } else { [1.0, 0.0] };
        // Along the slip, and across it.
        let stiff = 1.0 - scale / slope(x);
        let across = if size > 0.0 { most * share / size } else { stiff };
        let entry = |i: usize, j: usize| {
            let own = if i == j { across } else { 0.0 };
            own + (stiff - across) * along[i] * along[j]
        };
        let by_pressure = self.mu * share * scale / slope(x);
        Friction {
            traction: along.map(|a| most * share * a),
            by_trial: [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]],
            by_pressure: along.map(|a| by_pressure * a),
            slips: x > 1.0,
        }
    }

    fn is_rate_dependent(&self) -> bool {
        true
    }

    fn utilisation(&self, traction: [f64; 2], pressure: f64) -> f64 {
        self.limit.utilisation(traction, pressure)
    }

    fn per_pressure(&self) -> Option<[f64; 2]> {
        self.limit.per_pressure()
    }
}
