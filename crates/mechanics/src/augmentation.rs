//! What enforces contacts about Newton's method: outer iterations of augmented Lagrangians and of penalties that are to
//! leave a given penetration, and the state from which multipliers start.

use crate::contact::Enforcement;
use crate::equilibrium::ROUNDING;
use crate::increment::{IncrementError, IncrementResult};
use crate::system::{AssemblyError, System, SystemState, sides};
use signorini_contact::law::{Friction, stuck};
use signorini_contact::{Law, Status};

/// Friction without a limit.
#[derive(Debug)]
struct Sticks;

impl Law for Sticks {
    fn friction(&self, trial: [f64; 2], _: f64) -> Friction {
        stuck(trial)
    }

    fn utilisation(&self, _: [f64; 2], _: f64) -> f64 {
        0.0
    }

    fn per_pressure(&self) -> Option<[f64; 2]> {
        None
    }
}

/// The part of a change that the next outer iteration may leave.
const SLOW: f64 = 0.25;
/// The part of its compliance that a contact keeps then, and the least.
const HARDER: f64 = 0.1;
const HARDEST: f64 = 1e-6;

impl System {
    /// A state near the one that is looked for, with contacts that give way as by penalties, and with all that touches
    /// sticking: while nothing carries yet, nothing would rub. None where there is no such state either.
    pub(crate) fn by_penalties(
        &mut self,
        start: &SystemState,
        time: f64,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Option<SystemState> {
        let penalty = Enforcement::Penalty { wanted_penetration: None };
        let kept: Vec<_> = (self.contacts.iter_mut())
            .map(|contact| {
                let law = contact.friction.as_mut().map(|law| std::mem::replace(law, Box::new(Sticks)));
                let kept = (law, contact.enforcement, contact.softness);
                (contact.enforcement, contact.softness) = (penalty, penalty.softness());
                kept
            })
            .collect();
        let found = self.inner(start, time, report).ok();
        for (contact, (law, enforcement, softness)) in self.contacts.iter_mut().zip(kept) {
            (contact.friction, contact.enforcement, contact.softness) = (law, enforcement, softness);
        }
        found.map(|found| found.state)
    }

    /// Sets multipliers to the tractions found, penalties to what leaves the penetration that is wanted; the largest
    /// relative change.
    pub(crate) fn augment(
        &mut self,
        state: &SystemState,
        result: &IncrementResult,
        before: Option<f64>,
    ) -> Result<f64, IncrementError> {
        let (first, _) = self.numbering();
        let size = self.size();
        let mut change = 0.0f64;
        let mut own = 0;
        for (contact, sites) in self.contacts.iter_mut().zip(&result.sites) {
            let lambda = &state.multipliers[own..own + contact.multipliers()];
            own += lambda.len();
            match contact.enforcement {
                Enforcement::AugmentedLagrangian => {
                    let sides = sides(&self.bodies, contact, state, &first);
                    let found = contact.results(&sides, lambda).map_err(AssemblyError::from)?;
                    let most = found.iter().map(|f| f.1[0]).fold(0.0f64, f64::max);
                    let list = contact.memory.iter_mut().zip(&contact.stiffness).zip(found);
                    for ((memory, stiffness), (_, traction)) in list {
                        let changed = (0..3).map(|i| (memory.traction[i] - traction[i]).abs()).fold(0.0, f64::max);
                        // Gaps are known to the rounding of positions only.
                        let known = ROUNDING * size * stiffness;
                        change = change.max(if changed > known { changed / most } else { 0.0 });
                        memory.traction = traction;
                    }
                    // Where a step leaves more than a quarter of the error, the next ones are to leave less (Bertsekas 1982):
                    // what enforces has tractions as unknowns, so that Newton's method suffers no harm.
                    if before.is_some_and(|before| change > SLOW * before) {
                        contact.softness = (HARDER * contact.softness).max(HARDEST);
                    }
                }
                Enforcement::Penalty { wanted_penetration: Some(wanted) } => {
                    let depth = sites.iter().filter(|s| s.status != Status::Open).filter_map(|s| s.gap);
                    let depth = depth.fold(0.0f64, |m, g| m.max(-g));
                    // The penetration is inverse to the penalty but for what the bodies give way.
                    if depth > 0.0 && (depth / wanted - 1.0).abs() > 1e-2 {
                        contact.stiffness.iter_mut().for_each(|c| *c *= depth / wanted);
                        change = change.max((depth / wanted - 1.0).abs());
                    }
                }
                _ => {}
            }
        }
        Ok(change)
    }
}
