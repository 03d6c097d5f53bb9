//! Where Newton's method finds no state with friction: states with more and with less of it, that come nearer to what the case states.

use super::MechanicsModel;
use super::parts::LEAST_ITERATIONS;
use crate::plan::mechanics::other_friction::laws_with_friction_times;
use signorini_mechanics::{IncrementResult, SiteResult, SystemState};
use signorini_solve::Progress;

/// How much more friction is tried where there seems to be no equilibrium, and how much less: what rests with more, and not with
/// less, slides.
const MORE: f64 = 4.0;
/// Steps, each by the same factor, from there to the friction that the case states.
const STEPS: u32 = 4;
/// Iterations for one of them: the state before is near.
const NEARBY: usize = 60;
/// Part of the available friction of a contact, in the mean over its pressure, that is all of it but for the size of increments.
const NEAR_LIMIT: f64 = 0.95;
const NOT_FOUND: &str = "there are equilibria with more and with less friction, so the iteration does not find this one: use more \
                         increments, or other cells";

/// A state, and how it was found.
type Solution = (SystemState, IncrementResult);

impl MechanicsModel {
    /// Where there seems to be no equilibrium, one that is found from those with more or with less friction, which come nearer to what
    /// the case states; or else, in words, what slides because there is one with more friction only. The state stays as it is.
    pub(super) fn by_other_friction(
        &mut self,
        target: f64,
        progress: &mut dyn Progress,
    ) -> Option<Result<Box<Solution>, String>> {
        if self.plan.system.dynamics.is_some() || self.plan.system.is_rigid() {
            return None;
        }
        let (from_more, _) = self.with_friction(MORE, None, target, progress)?;
        if let Some(found) = self.brought_back(from_more, MORE, progress) {
            return Some(Ok(Box::new(found)));
        }
        // What rests with less friction as well does not slide for want of it.
        if let Some((from_less, _)) = self.with_friction(1.0 / MORE, None, target, progress) {
            let found = self.brought_back(from_less, 1.0 / MORE, progress);
            return Some(found.map(Box::new).ok_or_else(|| NOT_FOUND.to_string()));
        }
        Some(Err(format!(
            "with {MORE} times the friction there is an equilibrium at t = {target:.6}, so friction is too small, and what it \
             does not hold slides{}; hold it otherwise, or use more friction or a smaller load",
            self.at_the_limit().unwrap_or_default()
        )))
    }

    /// The state with the friction that the case states, from one with so many times of it. None with heat: friction heats, and the
    /// temperatures would be those of the last state.
    fn brought_back(&mut self, mut near: SystemState, times: f64, progress: &mut dyn Progress) -> Option<Solution> {
        if self.plan.system.heat.is_some() {
            return None;
        }
        let target = near.time;
        for step in 1..STEPS {
            let left = 1.0 - f64::from(step) / f64::from(STEPS);
            (near, _) = self.with_friction(times.powf(left), Some(&near), target, progress)?;
        }
        self.with_friction(1.0, Some(&near), target, progress)
    }

    /// The state with so many times the friction, from the last one or from a guess; with the friction that the case states histories
    /// go on from it.
    fn with_friction(
        &mut self,
        times: f64,
        guess: Option<&SystemState>,
        target: f64,
        progress: &mut dyn Progress,
    ) -> Option<Solution> {
        let system = &mut self.plan.system;
        let names: Vec<String> = system.contacts.iter().map(|c| c.name().to_string()).collect();
        let laws = laws_with_friction_times(&self.plan.head.problem, &names, times).ok()?;
        if progress.interrupted() || laws.iter().all(Option::is_none) {
            return None;
        }
        let kept = system.histories();
        let stated: Vec<_> = (system.contacts.iter_mut().zip(laws))
            .map(|(contact, law)| Some(contact.law_mut().friction.replace(law?)))
            .collect();
        let (mut iterations, most) = (0, if guess.is_some() { NEARBY } else { LEAST_ITERATIONS });
        let mut goes_on = |_: usize, _: f64| {
            iterations += 1;
            iterations < most && !progress.interrupted()
        };
        let found = match guess {
            Some(guess) => system.solve_near(&self.state, guess, &mut goes_on),
            None => system.solve(&self.state, target, &mut goes_on),
        };
        for (contact, law) in system.contacts.iter_mut().zip(stated) {
            if let Some(law) = law {
                contact.law_mut().friction = law;
            }
        }
        if times != 1.0 || found.is_err() {
            system.put_back(&kept);
        }
        found.ok()
    }

    /// Which contacts use all of their friction in the last state, in words.
    fn at_the_limit(&self) -> Option<String> {
        let system = &self.plan.system;
        let used = |k: usize| {
            let sites = system.sites(k, &self.state).ok()?;
            let force = |s: &SiteResult| s.weight * s.pressure.max(0.0);
            let whole: f64 = sites.iter().map(force).sum();
            Some(sites.iter().map(|s| force(s) * s.utilisation).sum::<f64>() / whole)
        };
        let of = |k: usize| {
            let share = used(k).filter(|share| *share > NEAR_LIMIT)?;
            Some(format!("`{}` uses {:.1} % of its friction", system.contacts[k].name(), 100.0 * share.min(1.0)))
        };
        let list: Vec<String> = (0..system.contacts.len()).filter_map(of).collect();
        (!list.is_empty())
            .then(|| format!("; at t = {:.6}, the last equilibrium, {}", self.state.time, list.join(", ")))
    }
}
