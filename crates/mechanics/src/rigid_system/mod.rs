//! Systems in which all that moves is rigid: contact and friction as a cone complementarity problem.
//!
//! - `touching`: points that may touch, their gaps and slips; `polyhedra`: pairs of facets, edges and corners;
//! - `complementarity`: contact forces of a linearised system; `interior`: from where Newton's method finds them;
//! - `rest`: whether bodies may rest where they are;
//! - `motion`: implicit steps of an overdamped motion in pseudo-time;
//! - `stability`: whether the state that they lead to is stable;
//! - `increment`: from one state of rest to the next; `results`: what is told of it;
//! - `dynamics`: motion with inertia.
//!
//! What can rest where it is rests. Else bodies move, prescribed motions bit by bit, until they rest. No elastic body gives
//! a scale here, and none is needed: sizes and loads do.

mod complementarity;
mod dynamics;
mod increment;
mod interior;
mod motion;
mod polyhedra;
mod rest;
mod results;
mod stability;
mod touching;

use crate::contact::Contact;
use crate::enforcement::Enforcement;
use crate::increment::IncrementResult;
use crate::increment_error::IncrementError;
use crate::system::{System, SystemState};
use increment::Increment;
use motion::Motion;
use signorini_contact::Law;

impl System {
    /// Whether all that moves is rigid and touches in points, with friction that knows no time and surfaces that do not wear.
    pub fn is_rigid(&self) -> bool {
        let suits = |c: &Contact| {
            let by_state = |law: &dyn Law| law.is_rate_dependent() || law.is_compliant() || law.wear() > 0.0;
            let by_state = c.law.friction.as_deref().is_some_and(by_state);
            c.law.enforcement == Enforcement::AugmentedLagrangian && !by_state && self.bodies[c.master.body].is_rigid()
        };
        self.bodies.iter().all(|b| b.is_rigid())
            && self.bodies.iter().any(|b| b.unknowns() > 0)
            && self.contacts.iter().all(|c| c.as_points().is_some_and(suits))
    }

    /// Equilibrium of rigid bodies at a time.
    pub(crate) fn solve_rigid(
        &mut self,
        from: &SystemState,
        time: f64,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(SystemState, IncrementResult), IncrementError> {
        if self.dynamics.is_some() {
            return self.solve_rigid_in_time(from, time, report);
        }
        let motion = Motion::new(self, from, time)?;
        let mut run = Increment::new(&motion, report);
        let (mut state, found) = run.solve(from, time)?;
        let result = motion.result(&state, time, (&found, &run.so_far))?;
        let memory = motion.memory(&found, &run.so_far);
        state.multipliers = self
            .contacts
            .iter()
            .zip(&memory)
            .flat_map(|(c, own)| c.as_points().map(|c| c.values(&own.0)))
            .flatten()
            .collect();
        state.reactions = found.reactions;
        for (contact, own) in self.contacts.iter_mut().zip(memory) {
            if let Some(contact) = contact.as_points_mut() {
                (contact.law.kept, contact.memory) = own;
            }
        }
        Ok((state, result))
    }
}
