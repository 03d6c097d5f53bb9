//! The step of the fronts in the published formulation: Newton's method in a few modes, more of them as it goes on.

use super::saddle::Saddle;
use crate::front::{Fronts, Step, StepKind};
use crate::scales::Scales;
use crate::zone::Zone;
use signorini_solve::{SolveError, dense};

/// A front moves at most this fraction of the extent of the membrane in one step.
const LIMIT: f64 = 0.15;

/// How many modes the fronts have so far.
#[derive(Clone, Copy, Debug)]
pub struct ModeSchedule {
    modes: usize,
    /// Whether the last step was cut short: while fronts are far from their place, more modes are of no use.
    limited: bool,
}

impl Default for ModeSchedule {
    fn default() -> Self {
        Self { modes: 1, limited: true }
    }
}

impl ModeSchedule {
    /// The next step: in as many modes as it takes for them to see the better part of the slope jump, nowhere longer than
    /// the limit.
    ///
    /// # Errors
    /// Equations that cannot be solved.
    pub fn step<const D: usize, Z: Zone<D>>(
        &mut self,
        fronts: &Fronts<'_, D>,
        saddle: &Saddle<D>,
        zone: &Z,
        scales: &Scales,
    ) -> Result<Step, SolveError> {
        let modes = fronts.equilibrium.membrane.modes;
        let most = zone.mode_offsets(modes.finest())[zone.front_count()];
        let count = |m: usize| zone.mode_offsets(modes.at_most(m))[zone.front_count()];
        while !self.limited && count(self.modes) < most {
            let seen = fronts.project(zone, modes.at_most(self.modes));
            if seen.remainder <= seen.norm {
                break;
            }
            self.modes = 2 * self.modes + 1;
        }
        let space = modes.at_most(self.modes);
        let n = count(self.modes);
        let rates = saddle.rates(&fronts.equilibrium.free(), zone, space)?;
        let frames = fronts.frames(zone, space);
        let excess = fronts.excess();
        let points = &fronts.equilibrium.quadrature.front;
        let (mut matrix, mut b) = (vec![0.0; n * n], vec![0.0; n]);
        for (i, p) in points.iter().enumerate() {
            for &(row, test) in &frames[i].modes {
                b[row] -= p.weight * test * excess[i];
                for (m, rate) in rates.iter().enumerate() {
                    let change = rate.slope_jump[i] + excess[i] * rate.stretch[i];
                    matrix[row * n + m] += p.weight * test * change;
                }
                for &(m, w) in &frames[i].modes {
                    matrix[row * n + m] -= p.weight * test * w * fronts.adhesive_slope_rate[i];
                }
            }
        }
        fronts.hold_modes_outside(zone, space, &frames, &mut matrix, scales.pressure / scales.tension);
        let mut coefficients = dense::solve(&matrix, &b).unwrap_or_else(|| vec![0.0; n]);
        let moved = |c: &[f64], i: usize| frames[i].modes.iter().map(|(m, v)| v * c[*m]).sum::<f64>();
        let farthest = (0..points.len()).map(|i| moved(&coefficients, i).abs()).fold(0.0, f64::max);
        let share = (LIMIT * scales.length / farthest.max(f64::MIN_POSITIVE)).min(1.0);
        self.limited = share < 1.0;
        coefficients.iter_mut().for_each(|c| *c *= share);
        let square: f64 = points.iter().enumerate().map(|(i, p)| p.weight * moved(&coefficients, i).powi(2)).sum();
        let total: f64 = points.iter().map(|p| p.weight).sum();
        let length = (square / total.max(f64::MIN_POSITIVE)).sqrt() / scales.h;
        Ok(Step { length, space, coefficients, kind: StepKind::Full, reach: f64::INFINITY })
    }
}
