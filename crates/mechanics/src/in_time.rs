//! One increment in time: the equations of a step, solved as those of an equilibrium, and what bodies do at its end.

use crate::dynamics::{Dynamics, Moved};
use crate::energy_in_time::Solved;
use crate::increment::IncrementResult;
use crate::increment_error::IncrementError;
use crate::system::{System, SystemState};
use crate::time_step::TimeStep;

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
        self.end();
        let step = self.step.take();
        let before = SystemState { multipliers: start.multipliers, ..from };
        let found = found.and_then(|(state, result)| match &step {
            Some(step) => self.in_motion(step, &before, state, result),
            None => Ok((state, result)),
        });
        if found.is_err() {
            self.put_back(&kept);
        }
        found
    }

    /// A state that was found, with its velocities and forces, and the energy that it has.
    fn in_motion(
        &self,
        step: &TimeStep,
        start: &SystemState,
        mut state: SystemState,
        mut result: IncrementResult,
    ) -> Result<(SystemState, IncrementResult), IncrementError> {
        let mut at = self.end_time_step(step, &mut state)?;
        let before = (0..self.contacts.len()).map(|k| self.sites(k, start)).collect::<Result<_, _>>()?;
        let solved = Solved { system: self, step, start, before, after: &result.sites };
        let damped = solved.damped(&state)?;
        let dissipated = solved.rubbed();
        solved.restore(&mut state)?;
        result.dissipated = dissipated;
        // Supports hold what moves, too.
        self.add_momenta(&state.balancing, 1.0, &mut at.residual[..state.balancing.len()]);
        result.support_forces = self.support_forces(&at, &state);
        let (before, after, inertia) = (self.moving(start), self.moving(&state), self.inertia(&state));
        result.moved = Some(Moved { before, after, inertia, damped });
        Ok((state, result))
    }
}
