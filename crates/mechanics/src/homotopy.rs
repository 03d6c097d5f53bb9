//! Other ways to the same state, where Newton's method does not find it from the last one.
//!
//! What is out of balance may be let go bit by bit. A body that nothing but contact holds has no stiffness until it
//! touches: weak springs hold all bodies where they were and are taken back step by step; what they still carried in the
//! end shows what holds nothing.

use crate::equilibrium::Problem;
use crate::free::AWAY;
use crate::increment::is_curable;
use crate::increment_error::IncrementError;
use crate::points::Order;
use crate::system::SystemState;
use signorini_solve::newton::Converged;

/// Stiffness of the springs that hold free bodies at first, in largest loads per size, and what they are taken back to. The
/// first let a body move by a hundredth of its size: contact reaches farther.
const SPRINGS: [f64; 7] = [1e2, 1.0, 1e-2, 1e-4, 1e-6, 1e-8, 0.0];
/// Springs to the last state: how they are weakened, below what the bodies are let go, in largest loads per size, and how
/// often.
const WEAKER: f64 = 0.25;
const SETTLED: f64 = 1e-2;
const MOST_SETTLING: usize = 300;
/// States of an iteration that came soon to its end.
const SOON: usize = 12;
/// The first bit of what is out of balance that is let go, and the least.
const FIRST_BIT: f64 = 0.125;
const LEAST_BIT: f64 = 1e-4;

impl Problem<'_> {
    /// Solves with the forces that are out of balance at the start, and what supports prescribe beyond it, held back and
    /// let go bit by bit.
    pub(crate) fn bit_by_bit(
        &mut self,
        start: &SystemState,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        let at = self.system.assemble(start, self.time, Order::First)?;
        let count = self.is_spin.len();
        let lacks: Vec<f64> = at.single.iter().chain(&at.coupled).map(|h| h.constraint.lack).collect();
        let (mut reached, mut size) = (0.0, FIRST_BIT);
        let mut state = start.clone();
        let held_back = (at.residual[..count].to_vec(), lacks);
        loop {
            let to = if reached + size > 1.0 - 1e-9 { 1.0 } else { reached + size };
            self.held_back = (to < 1.0).then(|| (1.0 - to, held_back.0.clone(), held_back.1.clone()));
            let found = self.solve(&state, report);
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

    /// Solves with weak springs that hold all bodies where they were, and are taken back step by step.
    pub(crate) fn with_springs(
        &mut self,
        start: &SystemState,
        error: IncrementError,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        let load = self.load(start)?;
        let mut state = start.clone();
        let mut last = None;
        let mut before = 0.0;
        for factor in SPRINGS {
            self.springs = factor * load / self.system.size();
            match self.solve(&state, report) {
                Ok(found) => {
                    if factor < 1.0
                        && let Some(body) = self.away(&found.state, load)
                    {
                        return Err(body);
                    }
                    state = found.state.clone();
                    last = Some(found);
                }
                Err(IncrementError::Interrupted) => return Err(IncrementError::Interrupted),
                Err(_) => {
                    // What the last springs carried tells what nothing else does.
                    self.springs = before;
                    let free = last.is_some().then(|| self.away(&state, load)).flatten();
                    return Err(free.unwrap_or_else(|| self.named(error, &state)));
                }
            }
            before = self.springs;
        }
        last.ok_or(error)
    }

    /// Follows the bodies to rest: each solve is held by springs to the state that the last one found, weaker after a success
    /// and stiffer after a failure: implicit steps of a motion without inertia (proximal point method, Rockafellar 1976;
    /// Kelley & Keyes 1998). For ropes without tension that fall until they hang.
    pub(crate) fn settling(
        &mut self,
        start: &SystemState,
        error: IncrementError,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        let load = self.load(start)?;
        // What is not slack does not fall: that it has no equilibrium is no matter of the way.
        if !self.system.is_slack(start) || load == f64::MIN_POSITIVE {
            return Err(error);
        }
        let unit = load / self.system.size();
        let mut state = start.clone();
        let mut total = vec![0.0; start.travel.len()];
        let mut factor = SPRINGS[0];
        for _ in 0..MOST_SETTLING {
            self.springs = factor * unit;
            let held = SystemState { travel: vec![0.0; total.len()], ..state.clone() };
            let found = self.solve(&held, report);
            self.springs = 0.0;
            match found {
                Ok(found) => {
                    total.iter_mut().zip(&found.state.travel).for_each(|(t, s)| *t += s);
                    let soon = found.history.len() <= SOON;
                    state = found.state;
                    let far = |(k, t): (usize, &f64)| !self.is_spin[k] && t.abs() > AWAY * self.system.size();
                    if total.iter().enumerate().any(far) {
                        return Err(error);
                    }
                    if soon {
                        factor *= WEAKER;
                    }
                    if factor < SETTLED
                        && let Ok(mut found) = self.solve(&state, report)
                    {
                        found.state.travel = total;
                        return Ok(found);
                    }
                }
                Err(IncrementError::Interrupted) => return Err(IncrementError::Interrupted),
                Err(_) => factor /= WEAKER,
            }
        }
        Err(error)
    }

    /// The largest force that acts.
    fn load(&self, at: &SystemState) -> Result<f64, IncrementError> {
        let size = self.system.size();
        let sizes = self.system.assemble(at, self.time, Order::First)?.sizes;
        let force = |(k, s): (usize, &f64)| if self.is_spin[k] { s / size } else { *s };
        Ok(sizes[..self.is_spin.len()].iter().enumerate().map(force).fold(f64::MIN_POSITIVE, f64::max))
    }
}
