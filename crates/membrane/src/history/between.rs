//! What happened between two states of a history: jumps and changes of topology; and what other states there are.

use super::event::Event;
use super::events::{jump, locate, locate_jump};
use super::increment::Increment;
use super::path_point::{Bounded, PathPoint, Trial};
use super::remark::{Remark, RemarkKind};
use super::with_zones::WithZones;
use crate::coexisting::{OtherState, others};
use crate::multigrid::large::ByMultigrid;
use crate::problem::Membrane;
use signorini_solve::Progress;
use std::collections::{HashMap, HashSet};

/// Told once where a state that was asked for is not stable.
const UNSTABLE: &str = "the results contain unstable states, as requested; see `stable` in the summary";

impl<const D: usize, Z: ByMultigrid<D> + 'static> WithZones<D, Z> {
    /// Locates the jump between two states, and tells where it landed; none if that is where the second state is.
    pub(super) fn find_jump(
        &mut self,
        index: usize,
        [a, b]: [&PathPoint<Z>; 2],
        progress: &mut dyn Progress,
    ) -> Option<PathPoint<Z>> {
        let tolerance = self.statement.increments()[index].events?;
        let (statement, engine) = (&*self.statement, &mut self.engine);
        let mut follow = |time: f64, zone: &Z| {
            let membrane = statement.at(time);
            if progress.interrupted() || statement.check(&membrane, time).is_err() {
                return None;
            }
            engine.start_from(zone.clone());
            let increment = engine.solve(statement, &membrane, (index, time), progress);
            Some((engine.known(time, &increment)?, increment.stability.jumped))
        };
        let [before, after] = locate_jump(a.clone(), b.clone(), tolerance, &mut follow);
        self.add_events(tolerance, jump(self.statement.grid(), &before, &after));
        self.engine.start_from(b.zone.clone());
        (after.time < b.time).then_some(after)
    }

    /// Locates the changes of topology within an increment.
    pub(super) fn find_events(&mut self, index: usize, [a, b]: [&PathPoint<Z>; 2], progress: &mut dyn Progress) {
        let changed = a.zone.counts() != b.zone.counts();
        let Some(tolerance) = self.statement.increments()[index].events.filter(|_| changed) else { return };
        let saved = self.engine.save();
        let (statement, engine) = (&*self.statement, &mut self.engine);
        let mut found = Vec::new();
        // Events at the same time ask for the same states.
        let mut solved: HashMap<u64, PathPoint<Z>> = HashMap::new();
        let mut failed = HashSet::new();
        let mut solve = |time: f64, [before, after]: [&Z; 2]| {
            let from = (time.to_bits(), before.counts(), after.counts());
            match solved.get(&time.to_bits()) {
                Some(state) => return Trial::State(state.clone()),
                None if failed.contains(&from) => return Trial::Unknown,
                None => {}
            }
            let membrane = statement.at(time);
            if progress.interrupted() || statement.check(&membrane, time).is_err() {
                return Trial::Unknown;
            }
            engine.start_from(before.clone());
            let mut bounded = Bounded { inner: progress, solves: 0 };
            let increment = engine.solve(statement, &membrane, (index, time), &mut bounded);
            if progress.interrupted() {
                return Trial::Unknown;
            }
            // Beside a merger zones with fronts sharper than the grid tell nothing.
            let state = engine.known(time, &increment).filter(|_| increment.resolved);
            if (before.is_empty() || after.is_empty()) && state.as_ref().is_none_or(|s| s.zone.is_empty()) {
                // A zone too small for the grid is told by the membrane without contact.
                match engine.reaches_obstacle(&membrane) {
                    Some(true) if before.is_empty() => return Trial::AsLater,
                    Some(true) => return Trial::AsEarlier,
                    _ => {}
                }
            }
            match state {
                Some(state) => {
                    solved.insert(time.to_bits(), state.clone());
                    Trial::State(state)
                }
                None => {
                    failed.insert(from);
                    Trial::Unknown
                }
            }
        };
        locate(statement.grid(), a, b, tolerance, &mut solve, &mut found);
        self.engine.restore(saved);
        self.add_events(tolerance, found);
    }

    fn add_events(&mut self, tolerance: f64, mut found: Vec<Event<D>>) {
        for event in &mut found {
            let membrane = self.statement.at(event.time);
            event.obstacle = membrane.obstacles.index_at(event.side, &event.at);
        }
        if let Some(coarse) = found.iter().find(|e| e.within > tolerance) {
            let [from, to] = [-0.5, 0.5].map(|s| coarse.time + s * coarse.within);
            let message = format!("an event between t = {from} and {to} could not be located more closely");
            self.remarks.push(Remark::new(RemarkKind::EventInterval, message).at_time(coarse.time));
        }
        self.events.extend(found);
    }

    /// Other equilibria of an adhesive membrane; with `zones` those with contact too, which are searched for.
    pub(super) fn other_states(
        &mut self,
        membrane: &Membrane<D>,
        increment: &Increment<D>,
        zones: bool,
    ) -> Vec<OtherState> {
        if !membrane.obstacles.are_sticky() || !increment.converged {
            return Vec::new();
        }
        if increment.stability.lowest_eigenvalue.is_some_and(|v| v <= 0.0) {
            self.remarks.push(Remark::new(RemarkKind::Unstable, UNSTABLE));
        }
        others::<D, Z>(membrane, self.statement.refinement(), increment.area(), zones).unwrap_or_default()
    }
}
