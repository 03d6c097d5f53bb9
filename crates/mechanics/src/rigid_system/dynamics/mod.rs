//! Rigid bodies that move with inertia: time stepping after Moreau (1988) and Jean (1999), of the second order between impacts.
//!
//! - `masses`: momenta, and velocities by the midpoint rule;
//! - `driven`: what is prescribed;
//! - `step`: a step without impacts; `impact`: velocities that change at once;
//! - `increment`: one after the other, to the end of an increment; `error`: what that is wrong by.
//!
//! Contact forces are the means of an increment: their impulses over its duration, impacts included.

mod driven;
mod error;
mod impact;
mod increment;
mod masses;
mod step;

use super::motion::{Motion, Stepped};
use crate::dynamics::Moved;
use crate::increment::IncrementResult;
use crate::increment_error::IncrementError;
use crate::system::{System, SystemState};
use error::error_of_halves;
use increment::InTime;
use masses::Masses;

impl System {
    /// Rigid bodies at a time.
    pub(super) fn solve_rigid_in_time(
        &mut self,
        from: &SystemState,
        time: f64,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(SystemState, IncrementResult), IncrementError> {
        let (_, count) = self.numbering();
        let mut from = from.clone();
        if from.velocities.len() != count {
            from.velocities = self.bodies.iter().flat_map(|b| b.initial_velocity()).collect();
        }
        let motion = Motion::new(self, &from, time)?;
        let masses = Masses::new(self)?;
        let duration = time - from.time;
        let mut state = SystemState { time, ..from.clone() };
        let mut run = InTime::new(&motion, &masses);
        let mut error = 0.0;
        if duration > 0.0 {
            let mut moved = run.advance(&from, time, report)?;
            if self.dynamics.is_some_and(|dynamics| dynamics.tells_error) {
                let whole = moved;
                run = InTime::new(&motion, &masses);
                let half = from.time + 0.5 * duration;
                let first = run.advance(&from, half, report)?;
                let (bodies, velocities) = (first.bodies, first.velocities);
                moved = run.advance(&SystemState { time: half, bodies, velocities, ..from.clone() }, time, report)?;
                error = error_of_halves(self, &masses, [&whole.bodies, &moved.bodies]) / duration;
            }
            (state.bodies, state.velocities) = (moved.bodies, moved.velocities);
        }
        let loaded = run.loaded(&state.bodies, duration);
        let found = Stepped { step: Vec::new(), bodies: Vec::new(), loaded, reactions: Vec::new(), iterations: 0 };
        let contacts = 0..motion.contacts.len();
        let mean = if duration > 0.0 { 1.0 / duration } else { 0.0 };
        let (before, after) = (self.moving(&from), self.moving(&state));
        let inertia = before.iter().zip(&after).map(|(a, b)| ((a.momentum - b.momentum) * mean, None)).collect();
        let result = IncrementResult {
            iterations: run.so_far.iterations,
            history: run.so_far.history.clone(),
            way: std::mem::take(&mut run.so_far.way),
            sites: contacts.clone().map(|c| motion.sites(c, &state, (&found, &run.so_far))).collect(),
            support_forces: run.supports.iter().map(|own| own.map(|impulse| impulse * mean)).collect(),
            dissipated: contacts.map(|c| run.so_far.work(c)).collect(),
            unknowns: count,
            moved: Some(Moved { before, after, inertia, error, ..Moved::default() }),
            ..IncrementResult::default()
        };
        let memory = motion.memory(&found, &run.so_far);
        let values = self.contacts.iter().zip(&memory).flat_map(|(c, own)| c.as_points().map(|c| c.values(&own.0)));
        state.multipliers = values.flatten().collect();
        for (contact, own) in self.contacts.iter_mut().zip(memory) {
            if let Some(contact) = contact.as_points_mut() {
                (contact.law.kept, contact.memory) = own;
            }
        }
        Ok((state, result))
    }
}
