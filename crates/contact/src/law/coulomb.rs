//! Coulomb's law, isotropic or orthotropic: friction within an ellipse of semi-axes `μ_α p`.
//!
//! The return onto the ellipse is that to the closest point: `T = (I + σ M)⁻¹ ζ` with `M = diag(1/(μ_α p)²)`, `σ > 0` from
//! `Σ T_α²/(μ_α p)² = 1` (Michałowski & Mróz 1978 for the associated law; the secular equation after Moré & Sorensen
//! 1983).

use super::{Friction, Law, LawError, checked, onto_circle, stuck};

/// Coefficients of friction along the first axis and across it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb {
    mu: [f64; 2],
}

impl Coulomb {
    /// The same in all directions.
    ///
    /// # Errors
    /// A coefficient that is negative or not finite.
    pub fn isotropic(mu: f64) -> Result<Self, LawError> {
        Self::orthotropic([mu, mu])
    }

    /// Along the first axis and across it.
    ///
    /// # Errors
    /// A coefficient that is negative or not finite.
    pub fn orthotropic(mu: [f64; 2]) -> Result<Self, LawError> {
        checked(&mu)?;
        Ok(Coulomb { mu })
    }

    /// Without friction.
    pub fn frictionless() -> Self {
        Coulomb { mu: [0.0; 2] }
    }

    pub fn mu(&self) -> [f64; 2] {
        self.mu
    }

    fn is_isotropic(&self) -> bool {
        self.mu[0] == self.mu[1]
    }
}

impl Law for Coulomb {
    fn friction(&self, trial: [f64; 2], pressure: f64) -> Friction {
        if self.is_isotropic() {
            let (found, along) = onto_circle(trial, self.mu[0] * pressure);
            return Friction { by_pressure: along.map(|a| self.mu[0] * a), ..found };
        }
        onto_ellipse(trial, self.mu, pressure)
    }

    fn utilisation(&self, traction: [f64; 2], pressure: f64) -> f64 {
        let of = |k: usize| if traction[k] == 0.0 { 0.0 } else { traction[k] / (self.mu[k] * pressure) };
        of(0).hypot(of(1))
    }

    fn per_pressure(&self) -> Option<[f64; 2]> {
        Some(self.mu)
    }
}

/// Newton steps on the secular equation, which is nearly linear: far more than it takes.
const MOST_STEPS: usize = 60;

fn onto_ellipse(trial: [f64; 2], mu: [f64; 2], pressure: f64) -> Friction {
    let axes = mu.map(|m| m * pressure);
    // Without friction along one axis the ellipse is a line.
    if let Some(k) = (0..2).find(|&k| axes[k] == 0.0) {
        let (along, across) = (1 - k, trial[k]);
        let mut clipped = trial;
        clipped[k] = 0.0;
        let (mut found, unit) = onto_circle(clipped, axes[along]);
        found.by_trial[k][k] = 0.0;
        found.by_pressure = unit.map(|u| mu[along] * u);
        found.slips |= across != 0.0;
        return found;
    }
    let scaled = [trial[0] / axes[0], trial[1] / axes[1]];
    if scaled[0].hypot(scaled[1]) <= 1.0 {
        return stuck(trial);
    }
    // Σ (ζ_α b_α / (b_α² + σ))² = 1; in units of the larger semi-axis, so that squares neither overflow nor vanish.
    let unit = axes[0].max(axes[1]);
    let [b, t] = [axes, trial].map(|v| v.map(|x| x / unit));
    let square = b.map(|b| b * b);
    let mut sigma = 0.0f64;
    for _ in 0..MOST_STEPS {
        let part = |k: usize| t[k] * b[k] / (square[k] + sigma);
        let norm = part(0).hypot(part(1));
        let slope = -(part(0).powi(2) / (square[0] + sigma) + part(1).powi(2) / (square[1] + sigma)) / norm;
        // Newton's step on 1/norm - 1, which grows from below zero.
        let step = (norm - 1.0) * norm / -slope;
        let next = sigma + step;
        if !next.is_finite() || (next - sigma).abs() <= f64::EPSILON * next.abs() {
            break;
        }
        sigma = next.max(0.0);
    }
    let share: [f64; 2] = std::array::from_fn(|k| square[k] / (square[k] + sigma));
    let normal: [f64; 2] = std::array::from_fn(|k| t[k] / (square[k] + sigma));
    let along: [f64; 2] = std::array::from_fn(|k| share[k] * normal[k]);
    let size = normal[0] * along[0] + normal[1] * along[1];
    let by_trial = std::array::from_fn(|r| {
        std::array::from_fn(|c| if r == c { share[r] } else { 0.0 } - along[r] * along[c] / size)
    });
    Friction {
        traction: std::array::from_fn(|k| share[k] * trial[k]),
        by_trial,
        by_pressure: along.map(|a| a / size * (unit / pressure)),
        slips: true,
    }
}
