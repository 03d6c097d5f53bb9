//! What enforces contacts about Newton's method: outer iterations of augmented Lagrangians and of penalties that are to
//! leave a given penetration, and the state from which multipliers start.

use crate::equilibrium::ROUNDING;
use crate::increment::IncrementResult;
use crate::increment_error::IncrementError;
use crate::interaction::{Bodies, Interaction, OuterIteration};
use crate::linear_solver::Solved;
use crate::points::Order;
use crate::simpler::SimplerFriction;
use crate::system::{AssemblyError, System, SystemState};

/// Gap beyond the least one, relative to the size of the body, of contacts in which it lands at the same time.
const LANDS: f64 = 1e-9;

impl System {
    /// A state near the one that is looked for, with contacts that give way as by penalties, or else with all that touches
    /// sticking too. None where there is no such state either.
    pub(crate) fn by_penalties(
        &mut self,
        start: &SystemState,
        time: f64,
        solved: &mut Solved,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Option<SystemState> {
        let has_friction = self.contacts.iter().any(|contact| contact.friction().is_some());
        let ways = [SimplerFriction::Stated, SimplerFriction::Sticks];
        ways[..if has_friction { 2 } else { 1 }].iter().find_map(|friction| {
            self.contacts.iter_mut().for_each(|contact| contact.law_mut().simplify(*friction));
            let found = self.inner(start, time, solved, report).ok();
            self.contacts.iter_mut().for_each(|contact| contact.law_mut().restore());
            found.map(|found| found.state)
        })
    }

    /// Multipliers that bear what is out of balance without them.
    pub(crate) fn initial_multipliers(&self, state: &SystemState, time: f64) -> Result<Vec<f64>, IncrementError> {
        let residual = self.assemble(state, time, Order::First)?.residual;
        let (first, _) = self.numbering();
        let at = self.bodies_in(state, &first);
        let lands = self.lands(at);
        let list = self.contacts.iter().map(AsRef::as_ref);
        let of = |(contact, lands): (&dyn Interaction, &bool)| match lands {
            true => contact.initial_multipliers(at, &residual).unwrap_or_else(|| contact.law().multipliers()),
            false => contact.law().multipliers(),
        };
        Ok(list.zip(&lands).flat_map(of).collect())
    }

    /// Which contacts may guess what carries: of those that guess by gaps the one with the least gap about each body that
    /// nothing else holds.
    fn lands(&self, at: Bodies<'_>) -> Vec<bool> {
        let gaps: Vec<Option<f64>> = self.contacts.iter().map(|contact| contact.least_gap(at)).collect();
        let mut out: Vec<bool> =
            self.contacts.iter().zip(&gaps).map(|(c, gap)| gap.is_none() && c.law().is_exact()).collect();
        for body in (0..self.bodies.len()).filter(|body| self.is_unheld(*body)) {
            let of_body = |k: &usize| self.contacts[*k].bodies().contains(&body);
            let near = LANDS * self.bodies[body].size();
            let least = (0..gaps.len()).filter(of_body).filter_map(|k| gaps[k]).fold(f64::INFINITY, f64::min);
            for k in (0..gaps.len()).filter(of_body) {
                out[k] |= gaps[k].is_some_and(|gap| gap <= least + near);
            }
        }
        out
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
        let known = ROUNDING * self.size();
        let own = self.own(state);
        let at = Bodies { bodies: &self.bodies, states: &state.bodies, first: &first };
        let around = OuterIteration { known, before };
        let mut change = 0.0f64;
        for ((contact, own), sites) in self.contacts.iter_mut().zip(own).zip(&result.sites) {
            change = change.max(contact.augment(at, own, sites, around).map_err(AssemblyError::from)?);
        }
        Ok(change)
    }
}
