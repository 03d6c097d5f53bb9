//! Ropes that are longer than their way: they have no stiffness until they hang.
//!
//! Springs of no length at rest along them, as strong as all that acts, make them hang at once: that is a linear problem, of
//! given force densities (Schek 1974). Then the springs are taken back: the ropes sag more and more, until their length holds
//! them. In the end nothing is left of the springs.
//!
//! Ropes that hardly stretch would come to their length all at once. So they are soft at first, and then as stiff as they are
//! step by step: what they stretch is a part of what it was, and their shape changes as little.

use crate::increment::{Strategy, is_curable};
use crate::increment_error::IncrementError;
use crate::linear_solver::Solved;
use crate::points::Order;
use crate::system::{System, SystemState};
use signorini_solve::newton::Converged;

/// Share of its length by which what is slack is longer than its way: more than rounding.
const LONGER: f64 = 1e-9;
/// Force of the first springs relative to all that acts: ropes sag by a thirtieth of their span.
const FIRST: f64 = 4.0;
/// What is left of the springs after a step, the longest step, and their force, relative to all that acts, of which nothing is
/// left after the next.
const LEFT: f64 = 0.5;
const LEAST_LEFT: f64 = 0.1;
const LAST: f64 = 1e-3;
/// Stiffness of ropes at first, relative to all that acts, and how it grows.
pub(crate) const SOFT: f64 = 20.0;
pub(crate) const STIFFER: f64 = 10.0;
const LEAST_STIFFER: f64 = 1.1;
/// Steps so short that there is no way on.
const MOST_LEFT: f64 = 0.97;

impl System {
    /// Whether something has no stiffness because it is slack.
    pub(crate) fn is_slack(&self, at: &SystemState) -> bool {
        self.bodies.iter().zip(&at.bodies).any(|(body, state)| body.is_slack(state, LONGER))
    }

    /// Whether something has no stiffness across itself because it carries nothing: slack, or as long as its way.
    pub(crate) fn carries_nothing(&self, at: &SystemState) -> bool {
        self.bodies.iter().zip(&at.bodies).any(|(body, state)| body.is_slack(state, -LONGER))
    }

    /// Newton's method from a state with slack ropes.
    pub(crate) fn settled(
        &mut self,
        start: &SystemState,
        time: f64,
        solved: &mut Solved,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        // Across itself a rope is as stiff as its tension, not as along itself.
        let found = self.with_trials(&|_| true, |system, _| system.stiffened(start, time, solved, report));
        self.bodies.iter_mut().for_each(|body| body.add_sag_spring(0.0));
        self.soften(1.0);
        found
    }

    /// The energy of ropes under dead loads is convex; with tractions that are unknowns it is no measure.
    fn way(&self) -> Strategy<'static> {
        if self.contacts.is_empty() { Strategy::Down } else { Strategy::Straight }
    }

    /// The stiffest of what may be slack, of which all is as soft as a part of it.
    pub(crate) fn soften(&mut self, share: f64) -> f64 {
        self.bodies.iter_mut().map(|body| body.soften(share)).fold(0.0, f64::max)
    }

    fn stiffened(
        &mut self,
        start: &SystemState,
        time: f64,
        solved: &mut Solved,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        let (_, count) = self.numbering();
        let acts: f64 = self.assemble(start, time, Order::First)?.sizes[..count].iter().sum();
        let stiffest = self.soften(1.0);
        // What is soft would sag through what it is to lie on.
        let mut share = if self.contacts.is_empty() { (SOFT * acts / stiffest).min(1.0) } else { 1.0 };
        self.soften(share);
        let mut found = self.loosened(start, time, acts, solved, report)?;
        self.bodies.iter_mut().for_each(|body| body.add_sag_spring(0.0));
        let mut stiffer = STIFFER;
        while share < 1.0 {
            let next = (share * stiffer).min(1.0);
            self.soften(next);
            match self.by(self.way(), &found.state, time, solved, report) {
                Ok(stiff) => (found, share) = (stiff, next),
                Err(error) if !is_curable(&error) || stiffer < LEAST_STIFFER => return Err(error),
                Err(_) => stiffer = stiffer.sqrt(),
            }
        }
        Ok(found)
    }

    fn loosened(
        &mut self,
        start: &SystemState,
        time: f64,
        acts: f64,
        solved: &mut Solved,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        let mut state = start.clone();
        let (mut reached, mut force, mut left) = (f64::INFINITY, FIRST * acts, LEFT);
        loop {
            self.bodies.iter_mut().for_each(|body| body.add_sag_spring(force));
            match self.by(self.way(), &state, time, solved, report) {
                Ok(found) if force == 0.0 => return Ok(found),
                Ok(found) => {
                    (state, reached) = (found.state, force);
                    left = (left * LEFT).max(LEAST_LEFT);
                }
                Err(error) if !is_curable(&error) || left > MOST_LEFT || reached.is_infinite() => return Err(error),
                Err(_) => left = left.sqrt(),
            }
            force = if reached <= LAST * acts { 0.0 } else { reached * left };
        }
    }
}
