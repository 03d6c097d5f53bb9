//! One increment in time: the equations of a step, solved as those of an equilibrium, and what bodies do at its end.

use crate::dynamics::{Dynamics, Moved};
use crate::energy_in_time::Solved;
use crate::increment::IncrementResult;
use crate::increment_error::IncrementError;
use crate::system::{System, SystemState};
use crate::time_step::TimeStep;

/// The forces that are not balanced in a state that was found, and the state.
type Found = (Vec<f64>, (SystemState, IncrementResult));

impl System {
    /// The state that bodies move to by a time.
    pub(crate) fn solve_in_time(
        &mut self,
        from: &SystemState,
        time: f64,
        dynamics: &Dynamics,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(SystemState, IncrementResult), IncrementError> {
        let kept = self.histories();
        let mut from = from.clone();
        let step = self.time_step(&mut from, time, dynamics)?;
        let start = self.begin(&from, time)?;
        self.step = Some(step);
        let found =
            self.outer(&start, time, report).and_then(|found| self.check_inside(&found.0, false).map(|()| found));
        let found = found.and_then(|found| Ok((self.unbalanced(&found.0)?, found)));
        self.end();
        let step = self.step.take();
        let before = SystemState { multipliers: start.multipliers, ..from };
        let found = found.and_then(|(unbalanced, (state, result))| match &step {
            Some(step) => self.in_motion(step, &before, (unbalanced, (state, result))),
            None => Ok((state, result)),
        });
        if found.is_err() {
            self.put_back(&kept);
        }
        found
    }

    /// A state that was found up to forces that are not balanced, with its velocities and forces, and the energy that it has.
    fn in_motion(
        &self,
        step: &TimeStep,
        start: &SystemState,
        (unbalanced, (mut state, mut result)): Found,
    ) -> Result<(SystemState, IncrementResult), IncrementError> {
        let mut at = self.end_time_step(step, &mut state)?;
        let before = (0..self.contacts.len()).map(|k| self.sites(k, start)).collect::<Result<_, _>>()?;
        let solved = Solved { system: self, step, start, before, after: &result.sites };
        let damping = solved.damping(&state)?;
        let damped = solved.damped(&state, &damping);
        let dissipated = solved.rubbed();
        let by_contact = solved.restore(&mut state)?;
        if step.conserves() {
            solved.conserve(&mut state, &unbalanced)?;
        }
        result.dissipated = dissipated;
        // Supports hold what moves, too.
        self.add_momenta(&state.balancing, 1.0, &mut at.residual[..state.balancing.len()]);
        damping.iter().zip(&mut at.residual).for_each(|(own, residual)| *residual += own);
        result.support_forces = self.support_forces(&at, &state);
        let inertia = self.inertia(step, &state, &damping)?;
        let damping = if step.damping[1] > 0.0 { self.resultants_of(&state, &damping) } else { Vec::new() };
        let (before, after) = (self.moving(start), self.moving(&state));
        let error = self.error_in_time(step, &state);
        result.moved = Some(Moved { before, after, inertia, damped, damping, error, by_contact });
        Ok((state, result))
    }

    /// By how much Newmark's displacement `½ h² a₀ + β h² (a₁ - a₀)` differs from the series `½ h² a + ⅙ h³ a'`, per time.
    fn error_in_time(&self, step: &TimeStep, state: &SystemState) -> f64 {
        let ends = step.accelerations.iter().zip(&state.accelerations);
        let error: Vec<f64> = ends.map(|(a, b)| step.size * (step.weights.beta - 1.0 / 6.0) * (b - a)).collect();
        self.product_by_mass(&error, &error).max(0.0).sqrt()
    }
}
