//! Ropes beside what they come to lie on.
//!
//! A rope that hardly stretches moves along what it lies on as a whole. Newton's method opens or closes all points at once there,
//! by steps as long as the rope. The energy leads to the state: at first ropes stretch by a part of their length, what they touch
//! gives way, without friction, and each step goes down the energy, which is convex but for the shape of what is touched. Then
//! ropes become as stiff as they are, and contacts stiffer, step by step. What is left of penetration is then so little that
//! Newton's method finds the state itself, with multipliers and friction.

use crate::equilibrium::Way;
use crate::increment::{Strategy, is_curable};
use crate::increment_error::IncrementError;
use crate::linear_solver::Solved;
use crate::points::Order;
use crate::slack::{SOFT, STIFFER};
use crate::system::{System, SystemState};
use signorini_solve::newton::Converged;

/// Force of contact per penetration, in all that acts per size: what is touched gives way by a hundredth of the size at first,
/// and in the end by less than the sagitta of the chord of a cell, beside which Newton's method finds nothing.
const FIRST_SCALE: f64 = 1e2;
const LAST_SCALE: f64 = 1e5;
/// Gap, relative to the size of the bodies, that is none but for rounding.
const NEAR: f64 = 1e-9;
/// Springs to where the step began, in all that acts per size: what carries nothing stays there.
const SPRINGS: f64 = 1e-3;

impl System {
    /// Newton's method from where ropes are drawn tight over what they touch; none where that leads nowhere.
    pub(crate) fn laid_down(
        &mut self,
        start: &SystemState,
        time: f64,
        solved: &mut Solved,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Option<Result<Converged<SystemState>, IncrementError>> {
        let beside = match self.drawn_tight(start, time, solved, report) {
            Ok(beside) => beside?,
            Err(error) => return Some(Err(error)),
        };
        match self.by(Strategy::Straight, &beside, time, solved, report) {
            Err(error) if is_curable(&error) => None,
            found => Some(found),
        }
    }

    /// The same where nothing touches at the start, so that no friction has begun anywhere.
    pub(crate) fn laid_from_afar(
        &mut self,
        start: &SystemState,
        time: f64,
        solved: &mut Solved,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Option<Result<Converged<SystemState>, IncrementError>> {
        if self.soften(1.0) == 0.0 {
            return None;
        }
        match self.touches_nothing(start) {
            Ok(true) => self.laid_down(start, time, solved, report),
            Ok(false) => None,
            Err(error) => Some(Err(error)),
        }
    }

    /// Whether all that may touch is apart in a state.
    fn touches_nothing(&self, state: &SystemState) -> Result<bool, IncrementError> {
        let near = NEAR * self.size();
        for k in 0..self.contacts.len() {
            if self.sites_at_limit(k, state)?.iter().any(|site| site.gap.is_some_and(|gap| gap <= near)) {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// A state near equilibrium, with multipliers that bear what acts, of ropes that touch something; none where there are no
    /// such ropes, a contact cannot give way, or none is found.
    ///
    /// # Errors
    /// An interruption.
    fn drawn_tight(
        &mut self,
        start: &SystemState,
        time: f64,
        solved: &mut Solved,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Option<SystemState>, IncrementError> {
        let stiffest = self.soften(1.0);
        let is_simplified = self.contacts.iter().any(|contact| contact.law().is_simplified());
        if stiffest == 0.0 || self.contacts.is_empty() || is_simplified || self.step.is_some() {
            return Ok(None);
        }
        if !self.contacts.iter_mut().all(|contact| contact.give_way(None)) {
            return Ok(None);
        }
        let found = self.down_to_rest(start, time, stiffest, solved, report);
        self.soften(1.0);
        self.contacts.iter_mut().for_each(|contact| _ = contact.give_way(None));
        match found {
            Ok(state) => Ok(Some(state)),
            Err(IncrementError::Interrupted) => Err(IncrementError::Interrupted),
            Err(_) => Ok(None),
        }
    }

    fn down_to_rest(
        &mut self,
        start: &SystemState,
        time: f64,
        stiffest: f64,
        solved: &mut Solved,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<SystemState, IncrementError> {
        let (_, count) = self.numbering();
        let mut at = self.assemble(start, time, Order::First)?;
        at.single.iter().for_each(|h| at.residual[h.constraint.terms[0].0 as usize] = 0.0);
        let out_of_balance: f64 = at.residual[..count].iter().map(|r| r.abs()).sum();
        let acts = at.sizes[..count].iter().fold(out_of_balance, |most, size| most.max(*size));
        let per_size = acts / self.size();
        let mut state = start.clone();
        let (mut share, mut scale) = ((SOFT * acts / stiffest).min(1.0), FIRST_SCALE);
        loop {
            self.soften(share);
            self.contacts.iter_mut().for_each(|contact| _ = contact.give_way(Some(scale * per_size)));
            let mut problem = self.problem(&state, time, *solved)?;
            problem.way = Way::Down;
            let found = problem.held_step(SPRINGS * per_size, &state, report)?;
            *solved = problem.solved;
            state = found.state;
            if share < 1.0 {
                share = (share * STIFFER).min(1.0);
            } else if scale < LAST_SCALE {
                scale *= STIFFER;
            } else {
                state.travel.clone_from(&start.travel);
                return Ok(state);
            }
        }
    }
}
