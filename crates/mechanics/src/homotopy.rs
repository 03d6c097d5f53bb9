//! Other ways to the same state, where Newton's method does not find it from the last one.
//!
//! What is out of balance may be let go bit by bit. A body that nothing but contact holds has no stiffness until it
//! touches: it is followed in pseudo-time, held by springs to where it was a step before, until it is at rest or far away.

use crate::equilibrium::Problem;
use crate::increment::is_curable;
use crate::increment_error::IncrementError;
use crate::points::Order;
use crate::system::SystemState;
use signorini_solve::newton::Converged;

/// Stiffness of the springs to the last state, in largest loads per size: at first, when a body moves by a hundredth of its size;
/// below what they are let go, and beyond what nothing moves any more.
const STIFFEST: f64 = 1e2;
const SOFTEST: f64 = 1e-6;
const STIFFER_THAN_ALL: f64 = 1e8;
/// How they are weakened, and the most steps.
const WEAKER: f64 = 0.1;
const MOST_STEPS: usize = 300;
/// States of an iteration that came soon to its end.
const SOON: usize = 12;
/// The first bit of what is out of balance that is let go, and the least.
const FIRST_BIT: f64 = 0.125;
const LEAST_BIT: f64 = 1e-4;

impl Problem<'_> {
    /// Solves with the forces that are out of balance at the start, and what supports prescribe beyond it, held back and
    /// let go bit by bit.
    pub(crate) fn load_homotopy(
        &mut self,
        start: &SystemState,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        let at = self.system.assemble(start, self.time, Order::First)?;
        let count = self.is_spin.len();
        let lacks: Vec<f64> = at.single.iter().chain(&at.coupled).map(|h| h.constraint.violation).collect();
        let (mut reached, mut size) = (0.0, FIRST_BIT);
        let mut state = start.clone();
        let held_back = (at.residual[..count].to_vec(), lacks);
        loop {
            let to = if reached + size > 1.0 - 1e-9 { 1.0 } else { reached + size };
            self.held_back = (to < 1.0).then(|| (1.0 - to, held_back.0.clone(), held_back.1.clone()));
            let found = match self.solve(&state, report) {
                Ok(found) if self.passes(&state, &found.state) => {
                    Err(IncrementError::NotConverged { history: found.history, worst: None })
                }
                found => found,
            };
            self.held_back = None;
            match found {
                Ok(found) if to == 1.0 => return Ok(found),
                Ok(found) => {
                    state = found.state;
                    reached = to;
                    size *= 1.5;
                }
                Err(error) if !is_curable(&error) || size < LEAST_BIT => return Err(error),
                Err(_) => size *= 0.25,
            }
        }
    }

    /// A solve that springs hold to a state: an implicit step of a motion without inertia. Its travel counts from there.
    pub(crate) fn held_step(
        &mut self,
        springs: f64,
        from: &SystemState,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        self.springs = springs;
        let held = SystemState { travel: vec![0.0; from.travel.len()], ..from.clone() };
        let found = self.solve(&held, report);
        self.springs = 0.0;
        found
    }

    /// Follows the bodies to rest in pseudo-time: each solve is held by springs to the state that the last one found, weaker after a
    /// success and stiffer after a failure: implicit steps of a motion without inertia (proximal point method, Rockafellar
    /// 1976; Kelley & Keyes 1998). In the end nothing is left of the springs.
    pub(crate) fn pseudo_time(
        &mut self,
        start: &SystemState,
        error: IncrementError,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        let load = self.load(start)?;
        let unit = load / self.system.size();
        let mut state = start.clone();
        let mut total = vec![0.0; start.travel.len()];
        let mut factor = STIFFEST;
        for _ in 0..MOST_STEPS {
            let ends = factor < SOFTEST;
            let found = self.held_step(if ends { 0.0 } else { factor * unit }, &state, report);
            match found {
                // A body that leaps is not followed.
                Ok(found) if self.leaps(&state, &found.state) || self.passes(&state, &found.state) => {
                    factor = factor.max(SOFTEST) / WEAKER
                }
                Ok(mut found) => {
                    total.iter_mut().zip(&found.state.travel).for_each(|(t, s)| *t += s);
                    self.gone = self.sizes_moved(&total);
                    found.state.travel.clone_from(&total);
                    if self.is_far(&total) {
                        return Err(self.free(&found.state));
                    }
                    if ends {
                        return Ok(found);
                    }
                    let soon = found.history.len() <= SOON;
                    state = found.state;
                    factor *= if soon { WEAKER * WEAKER } else { WEAKER };
                }
                Err(IncrementError::Interrupted) => return Err(IncrementError::Interrupted),
                Err(_) if factor > STIFFER_THAN_ALL => break,
                Err(_) => factor = factor.max(SOFTEST) / WEAKER,
            }
        }
        Err(self.named(error, &state))
    }

    /// The largest force that acts.
    fn load(&self, at: &SystemState) -> Result<f64, IncrementError> {
        let size = self.system.size();
        let sizes = self.system.assemble(at, self.time, Order::First)?.sizes;
        let force = |(k, s): (usize, &f64)| if self.is_spin[k] { s / size } else { *s };
        Ok(sizes[..self.is_spin.len()].iter().enumerate().map(force).fold(f64::MIN_POSITIVE, f64::max))
    }
}
