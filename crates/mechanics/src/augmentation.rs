//! What enforces contacts about Newton's method: outer iterations of augmented Lagrangians and of penalties that are to
//! leave a given penetration, and the state from which multipliers start.

use crate::contact::{Contact, Enforcement};
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

impl System {
    /// A state near the one that is looked for, with penalties in place of multipliers, which take the tractions that these
    /// find, and with all that touches sticking: while nothing carries yet, nothing would rub. None where there is no such
    /// state either.
    pub(crate) fn by_penalties(
        &mut self,
        start: &SystemState,
        time: f64,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Option<SystemState> {
        let by_multipliers: Vec<bool> = self.contacts.iter().map(|c| c.multipliers() > 0).collect();
        let switch = |system: &mut System, to: Enforcement| {
            let list = system.contacts.iter_mut().zip(&by_multipliers);
            list.filter(|(_, own)| **own).for_each(|(contact, _)| contact.enforcement = to);
        };
        switch(self, Enforcement::Penalty { wanted_penetration: None });
        let sticking =
            |contact: &mut Contact| contact.friction.as_mut().map(|law| std::mem::replace(law, Box::new(Sticks)));
        let laws: Vec<_> = self.contacts.iter_mut().map(sticking).collect();
        let from = SystemState { multipliers: Vec::new(), ..start.clone() };
        let found = self.inner(&from, time, report).ok();
        let tractions = found.and_then(|found| {
            let (first, _) = self.numbering();
            let mut list = Vec::new();
            for contact in self.contacts.iter().zip(&by_multipliers).filter(|(_, own)| **own).map(|(c, _)| c) {
                let sites = contact.results(&sides(&self.bodies, contact, &found.state, &first), &[]).ok()?;
                list.extend(sites.iter().flat_map(|(_, t)| t[..contact.components()].to_vec()));
            }
            Some((found.state, list))
        });
        switch(self, Enforcement::Multiplier);
        self.contacts.iter_mut().zip(laws).for_each(|(contact, law)| contact.friction = law);
        let (state, multipliers) = tractions?;
        Some(SystemState { multipliers, ..state })
    }

    /// Sets multipliers to the tractions found, penalties to what leaves the penetration that is wanted; the largest
    /// relative change.
    pub(crate) fn augment(&mut self, state: &SystemState, result: &IncrementResult) -> Result<f64, IncrementError> {
        let (first, _) = self.numbering();
        let size = self.size();
        let mut change = 0.0f64;
        for (contact, sites) in self.contacts.iter_mut().zip(&result.sites) {
            match contact.enforcement {
                Enforcement::AugmentedLagrangian => {
                    let sides = sides(&self.bodies, contact, state, &first);
                    let found = contact.results(&sides, &[]).map_err(AssemblyError::from)?;
                    let most = found.iter().map(|f| f.1[0]).fold(0.0f64, f64::max);
                    let list = contact.memory.iter_mut().zip(&contact.stiffness).zip(found);
                    for ((memory, stiffness), (_, traction)) in list {
                        let changed = (0..3).map(|i| (memory.traction[i] - traction[i]).abs()).fold(0.0, f64::max);
                        // Gaps are known to the rounding of positions only.
                        let known = ROUNDING * size * stiffness;
                        change = change.max(if changed > known { changed / most } else { 0.0 });
                        memory.traction = traction;
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
