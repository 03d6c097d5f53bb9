//! An increment, solved at once or in parts: where it has no solution at once, where each part is to add a small error in time, or
//! where an event of a contact is to be located.

use super::events::{self, Condition};
use super::{Failure, MechanicsModel, recovered, tell_iteration};
use crate::problem::CaseError;
use crate::report::{ContactEvent, Reason, Warning, WarningKind};
use serde::{Deserialize, Serialize};
use signorini_mechanics::{BodyState, IncrementError, IncrementResult, Moved, Moving, Stability};
use signorini_solve::Progress;

/// Share of an increment below which it is not cut any more.
const SMALLEST_INCREMENT: f64 = 1e-3;
/// An increment is cut to this part of itself, and grows by this factor after a success.
const CUT: f64 = 0.25;
const GROWTH: f64 = 1.5;
/// Part of the size that the tolerance would allow, so that few parts have to be solved again; least and largest change of the size.
const SAFE: f64 = 0.9;
const CHANGE: [f64; 2] = [0.2, 2.0];
/// Part of the time that events are located to at best, and of the kinetic energy that is none.
const ROUNDING: f64 = 1e-12;

/// Iterations of Newton's method for one increment, with all its parts and all ways to its states, after which it is given up:
/// as many as take about as long in small systems, and in large ones never less than a hard increment may take.
const MOST_ITERATIONS: usize = 1000;
pub(super) const LEAST_ITERATIONS: usize = 300;
const MOST_SOLVED: usize = 800_000;

/// What decides how increments are cut, from one to the next.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Control {
    /// Largest velocity so far, in the norm of the mass.
    largest: f64,
    /// The size of a part that the tolerance allows; none before the first.
    size: Option<f64>,
    /// What each contact does; nothing before it is known.
    conditions: Vec<Condition>,
}

impl Control {
    /// Forgets what was learned of a motion.
    pub fn come_to_rest(&mut self) {
        (self.largest, self.size) = (0.0, None);
    }

    /// The error of a part in time over its tolerance, which also decides the size of the next one.
    fn judge(&mut self, moved: &Moved, size: f64, tolerance: f64) -> f64 {
        let velocity = |list: &[Moving]| (2.0 * list.iter().map(|m| m.kinetic_energy).sum::<f64>()).sqrt();
        self.largest = self.largest.max(velocity(&moved.before)).max(velocity(&moved.after));
        if self.largest == 0.0 {
            return 0.0;
        }
        // The error is of third order: per time of second.
        let error = moved.error / self.largest / tolerance;
        let next = size * (SAFE / error.sqrt()).clamp(CHANGE[0], CHANGE[1]);
        // A part that only fills an increment says nothing against a larger one.
        let larger = self.size.filter(|own| error <= 1.0 && *own > size);
        self.size = Some(larger.map_or(next, |own| own.max(next)));
        error
    }
}

/// What is still to be told of the parts of an increment.
#[derive(Default)]
pub struct Told {
    pub events: Vec<ContactEvent>,
    pub warning: Option<Warning>,
}

/// What the parts of an increment came to.
#[derive(Default)]
struct Total {
    iterations: usize,
    residuals: Vec<f64>,
    way: Vec<Vec<BodyState>>,
    dissipated: Vec<f64>,
    dissipated_in_bodies: Vec<f64>,
    lost: Option<Stability>,
    moved: Option<Vec<Moving>>,
    damped: f64,
}

impl Total {
    /// Adds a part.
    fn add(&mut self, result: &mut IncrementResult) {
        self.iterations += result.iterations;
        self.way.append(&mut result.way);
        for (sums, own) in
            [(&mut self.dissipated, &result.dissipated), (&mut self.dissipated_in_bodies, &result.dissipated_in_bodies)]
        {
            sums.resize(own.len(), 0.0);
            sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
        }
        if let Some(own) = &mut result.moved {
            own.before.clone_from(self.moved.get_or_insert_with(|| own.before.clone()));
            self.damped += own.damped;
            own.damped = self.damped;
        }
        // An increment that was cut tells of the first part that lost its stability.
        if let Some(told) = &mut result.stability {
            if let Some(before) = self.lost.take() {
                told.since(before);
            }
            self.lost = Some(told.clone());
        }
    }

    /// The increment as a whole, of which the last part is given.
    fn result(self, last: IncrementResult) -> IncrementResult {
        let Total { iterations, residuals: history, way, dissipated, dissipated_in_bodies, .. } = self;
        IncrementResult { iterations, history, way, dissipated, dissipated_in_bodies, ..last }
    }
}

impl MechanicsModel {
    /// Solves for the end of an increment.
    pub(super) fn reach(
        &mut self,
        index: usize,
        [before, time]: [f64; 2],
        progress: &mut dyn Progress,
    ) -> Result<Result<IncrementResult, Failure>, CaseError> {
        let tolerance = self.plan.motion.tolerance.get(index).copied().flatten();
        let within = self.plan.events.get(index).copied().flatten().map(|within| within.max(ROUNDING * time));
        let may_be_rejected = within.is_some() || self.plan.system.dynamics.is_some();
        if self.control.conditions.is_empty() {
            self.control.conditions = vec![Condition::Apart; self.plan.system.contacts.len()];
        }
        let whole = time - before;
        let smallest = SMALLEST_INCREMENT * whole;
        let mut reached = before;
        let mut size = self.control.size.filter(|_| tolerance.is_some()).unwrap_or(whole).min(whole);
        // By when something happens to a contact.
        let mut bound: Option<f64> = None;
        let mut total = Total::default();
        // Iterations that do not count any more: of parts that control made.
        let mut spent = 0;
        let unknowns: usize = self.plan.system.bodies.iter().map(|b| b.unknowns()).sum();
        let most = (MOST_SOLVED / unknowns.max(1)).clamp(LEAST_ITERATIONS, MOST_ITERATIONS);
        let mut reason: Option<IncrementError> = None;
        loop {
            let mut target = if whole <= 0.0 || reached + size >= time - 1e-9 * whole { time } else { reached + size };
            if let (Some(bound), Some(within)) = (bound, within) {
                target = target.min(if bound - reached <= within { bound } else { 0.5 * (reached + bound) });
            }
            let part = target - reached;
            let mut seen = Vec::new();
            let mut is_given_up = false;
            let mut report = |iteration: usize, residual: f64| {
                tell_iteration(progress, index, target, (iteration, residual));
                seen.push(residual);
                is_given_up = total.residuals.len() + seen.len() - spent >= most;
                !is_given_up && !progress.interrupted()
            };
            let kept = if may_be_rejected { self.plan.system.histories() } else { Vec::new() };
            let found = self.plan.system.solve(&self.state, target, &mut report);
            if let Some(error) = self.plan.wrong.take(&self.plan.head.problem) {
                return Err(error);
            }
            total.residuals.append(&mut seen);
            let curable = |error: &IncrementError| {
                !matches!(
                    error,
                    IncrementError::Interrupted | IncrementError::Free { .. } | IncrementError::Unstable { .. }
                )
            };
            let is_last = match &found {
                Ok(_) => false,
                Err(IncrementError::Interrupted) => is_given_up,
                Err(error) => curable(error) && (part <= smallest || whole <= 0.0),
            };
            let other = if is_last { self.by_other_friction(target, progress) } else { None };
            let (found, slides) = match other {
                Some(Ok(state)) => {
                    spent = total.residuals.len();
                    (Ok(*state), None)
                }
                Some(Err(slides)) => (found, Some(slides)),
                None => (found, None),
            };
            match found {
                Ok((state, mut result)) => {
                    if may_be_rejected {
                        spent = total.residuals.len();
                    }
                    let error = match (tolerance, &result.moved) {
                        (Some(tolerance), Some(moved)) => self.control.judge(moved, part, tolerance),
                        _ => 0.0,
                    };
                    let is_inexact = error > 1.0 || result.moved.as_ref().is_some_and(gains_by_contact);
                    if is_inexact && part > smallest {
                        self.plan.system.put_back(&kept);
                        let allowed = self.control.size.filter(|_| error > 1.0);
                        size = allowed.map_or(part * CUT, |size| size.max(smallest));
                        continue;
                    }
                    let conditions = events::conditions(&self.plan.system, &result.sites);
                    let happens = within.is_some() && conditions != self.control.conditions;
                    if happens && within.is_some_and(|within| part > within) {
                        self.plan.system.put_back(&kept);
                        bound = Some(target);
                        continue;
                    }
                    if error > 1.0 {
                        self.told.warning = Some(not_kept(error * tolerance.unwrap_or_default(), [reached, target]));
                    }
                    if happens {
                        self.told.events.extend(self.events(&conditions, [reached, target]));
                    }
                    // What happened in a long part need not in short ones.
                    bound = bound.filter(|bound| !happens && *bound > target);
                    self.control.conditions = conditions;
                    total.add(&mut result);
                    if target == time {
                        self.state = state;
                        let mut found = total.result(result);
                        recovered::recover_at_nodes(&self.plan, &mut found);
                        return Ok(Ok(found));
                    }
                    if let Err(error) = self.plan.system.accept(&state) {
                        return Ok(Err(self.failed(&error, total.residuals)));
                    }
                    if self.plan.system.is_rigid() {
                        total.way.push(state.bodies.clone());
                    }
                    self.state = state;
                    reached = target;
                    size = match self.control.size.filter(|_| tolerance.is_some()) {
                        Some(size) => size.max(smallest),
                        None => size * GROWTH,
                    };
                }
                Err(IncrementError::Interrupted) if is_given_up => {
                    let remedy = slides.unwrap_or_else(|| NO_EQUILIBRIUM.to_string());
                    return Ok(Err(given_up(reason.as_ref(), target, total.residuals, &remedy)));
                }
                Err(error) => {
                    if is_last || !curable(&error) {
                        let mut failure = self.failed(&error, total.residuals);
                        if let IncrementError::NotConverged { .. } = &error {
                            failure.text += &slides.map_or(String::new(), |slides| format!("; {slides}"));
                        }
                        if reached > before {
                            failure.text += &format!(" (the last equilibrium is at t = {reached:.6})");
                        }
                        return Ok(Err(failure));
                    }
                    reason = Some(error);
                    size = part * CUT;
                }
            }
        }
    }

    /// What happened to the contacts in a part of an increment.
    fn events(&self, after: &[Condition], [from, to]: [f64; 2]) -> Vec<ContactEvent> {
        let contacts = self.plan.system.contacts.iter().zip(self.control.conditions.iter().zip(after));
        contacts
            .filter_map(|(contact, (before, after))| {
                let kind = events::event(*before, *after)?;
                Some(ContactEvent { contact: contact.name().into(), kind, time: 0.5 * (from + to), within: to - from })
            })
            .collect()
    }
}

/// Whether contact gave energy in a part of an increment, as it closed or opened, beyond rounding.
fn gains_by_contact(moved: &Moved) -> bool {
    let kinetic: f64 = moved.before.iter().chain(&moved.after).map(|m| m.kinetic_energy).sum();
    moved.by_contact.abs() > ROUNDING * kinetic
}

/// What is said of a tolerance that the smallest parts do not keep to.
fn not_kept(error: f64, [from, to]: [f64; 2]) -> Warning {
    let message = format!(
        "between t = {from} and {to} the error of the motion is {error:.1e} of the largest velocity, more than the tolerance: \
         something strikes with its mass; use more increments there"
    );
    Warning::new(WarningKind::ErrorInTime, message).at_time(to)
}

const NO_EQUILIBRIUM: &str = "there may be no equilibrium: check that every loaded body is supported; use more increments, or \
                              more cells";

/// An increment that is given up, with what went wrong before.
fn given_up(before: Option<&IncrementError>, time: f64, residuals: Vec<f64>, remedy: &str) -> Failure {
    let recent = &residuals[residuals.len().saturating_sub(LEAST_ITERATIONS / 3)..];
    let [low, high] = [(f64::min as fn(f64, f64) -> f64, f64::INFINITY), (f64::max, 0.0)]
        .map(|(choose, start)| recent.iter().copied().fold(start, choose));
    let count = residuals.len();
    let round = format!(
        "no state at t = {time} in {count} iterations of Newton's method: the residual alternates between {low:.1e} \
         and {high:.1e} tolerances; {remedy}"
    );
    let (reason, text) = match before {
        Some(IncrementError::NotConverged { worst: Some(worst), .. }) => (Reason::Newton, format!("{round}{worst}")),
        _ => (Reason::Newton, round),
    };
    Failure { reason, text, residuals }
}
