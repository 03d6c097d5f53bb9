//! A membrane as a model: its increments by time, along a path or to a given area, with what happens between.

mod events;
pub(super) mod increment;
mod mergers;
mod path;
mod saved;
mod seek;
mod verdict;

use super::checkpoint;
use super::driver::{Advanced, Model};
use super::record::{Record, START};
use crate::fields::ShownState;
use crate::output::film::Film;
use crate::output::{Folder, OutputError, pictures, tables, vtk};
use crate::plan::{Control, Head, MembranePlan, PlannedIncrement};
use crate::problem::CaseError;
use crate::report::{Event, OtherState, Reason, Warning, WarningKind};
use crate::snapshot::{DisplayMesh, Sample, Snapshot};
use events::{Between, Bounded, Known, jump, locate, locate_jump};
use increment::{Engine, Increment};
use path::{Along, Follower};
use seek::Seeker;
use serde_json::Value;
use signorini_geometry::Point;
use signorini_membrane::coexisting::{self, others};
use signorini_membrane::obstacle::Side;
use signorini_membrane::problem::Membrane;
use signorini_membrane::zone::Zone;
use signorini_solve::{Progress, SolveError};
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// Told once where a state that was asked for is not stable.
const UNSTABLE: &str =
    "unstable states are among the results, where they were asked for: `stable` in the summary tells which";

/// An increment is cut to this fraction of itself before it is given up.
const SMALLEST_INCREMENT: f64 = 1.0 / 32.0;

/// A membrane on its way through its history.
pub struct MembraneModel<const D: usize, Z> {
    plan: MembranePlan<D>,
    mesh: DisplayMesh<D>,
    engine: Engine<D, Z>,
    path: Option<Follower<D, Z>>,
    seeker: Option<Seeker>,
    film: Film<Snapshot<D>>,
    /// The state at t = 0, where that is one of rest.
    rest: Option<Snapshot<D>>,
    /// The state of the last increment, where one is known.
    known: Option<Known<Z>>,
    last: Option<Snapshot<D>>,
}

impl<const D: usize, Z: Zone<D>> MembraneModel<D, Z> {
    /// A membrane at its beginning.
    ///
    /// # Errors
    /// Fields that cannot be used at the first time.
    pub fn new(plan: MembranePlan<D>) -> Result<Self, CaseError> {
        if let Some(&time) = plan.known_times().first() {
            plan.check_fields(&plan.at(time), time)?;
        }
        let mesh = DisplayMesh::new(&plan, &plan.at(plan.increments[0].range[0]));
        let engine = Engine::new(&plan);
        let rest = at_rest(&plan, &mesh);
        let mut film = Film::default();
        if plan.head.pictures && plan.increments.len() > 1 {
            rest.iter().for_each(|rest| film.add(rest));
        }
        Ok(Self { plan, mesh, engine, path: None, seeker: None, film, rest, known: None, last: None })
    }

    /// The state at the beginning of an increment whose events are wanted: that of the one before, or at t = 0.
    fn known(&mut self, index: usize, last: Option<Known<Z>>, progress: &mut dyn Progress) -> Option<Known<Z>> {
        let planned = &self.plan.increments[index];
        planned.events?;
        if index > 0 || self.engine.is_asked() || planned.time <= 0.0 {
            return last;
        }
        let start = self.plan.at(0.0);
        if self.plan.check_fields(&start, 0.0).is_err() {
            return None;
        }
        let increment = self.engine.solve(&self.plan, &start, (0, 0.0), progress);
        self.engine.known(0.0, &increment)
    }

    /// Whether a step ended before its increments did.
    fn is_done(&self, step: usize) -> bool {
        self.path.as_ref().is_some_and(|path| path.done && path.step == step)
            || self.seeker.as_ref().is_some_and(|seeker| seeker.done && seeker.step == step)
    }

    /// The time of an increment without adhesion of which the area or a length is given, and the equilibrium solves it took;
    /// the increment at that time gives the state that was looked at.
    fn seek(
        &mut self,
        index: usize,
        planned: &PlannedIncrement,
        known: Option<&Known<Z>>,
        progress: &mut dyn Progress,
    ) -> Result<(f64, usize), String> {
        let (plan, engine, mut solves, mut invalid) = (&self.plan, &mut self.engine, 0, None);
        let mut look = |engine: &mut Engine<D, Z>, time: f64| {
            let membrane = plan.at(time);
            if let Err(error) = plan.check_fields(&membrane, time) {
                invalid.get_or_insert(error.one_line());
                return None;
            }
            let increment = engine.solve(plan, &membrane, (index, time), progress);
            solves += increment.before + increment.iterations;
            increment.converged.then(|| increment.area())
        };
        let from = match known {
            Some(state) => [state.time, state.area],
            None => {
                let time = planned.range[0];
                [time, look(engine, time).ok_or_else(|| format!("no state was found at t = {time}"))?]
            }
        };
        let seeker = self.seeker.take().filter(|seeker| seeker.step == planned.step);
        let mut seeker = seeker.unwrap_or_else(|| Seeker::begin(planned, from[1], plan.area()));
        let saved = engine.save();
        let found = seeker.advance(planned, from, &mut |time| {
            engine.restore(saved.clone());
            look(engine, time)
        });
        engine.restore(saved);
        self.seeker = Some(seeker);
        // A value that is none beyond some time may be why.
        let why = |why: String| invalid.map_or(why.clone(), |error| format!("{why}; on the way there: {error}"));
        found.map(|time| (time, solves)).map_err(why)
    }

    /// Leads from a state towards a time at which no state was found, by smaller increments that are cut as they need;
    /// tells the equilibrium solves it took, or none where that does not help either.
    fn approach(&mut self, index: usize, from: &Known<Z>, time: f64, progress: &mut dyn Progress) -> Option<usize> {
        let whole = time - from.time;
        let (mut reached, mut size) = (from.clone(), 0.5 * whole);
        let mut solves = 0;
        loop {
            let target = reached.time + size;
            if target >= time - 1e-9 * whole {
                self.engine.start_from(reached.zone);
                return Some(solves);
            }
            if progress.interrupted() || size < SMALLEST_INCREMENT * whole {
                return None;
            }
            let membrane = self.plan.at(target);
            self.plan.check_fields(&membrane, target).ok()?;
            self.engine.start_from(reached.zone.clone());
            let increment = self.engine.solve(&self.plan, &membrane, (index, target), progress);
            solves += increment.before + increment.iterations;
            match self.engine.known(target, &increment) {
                Some(state) => reached = state,
                None => size *= 0.5,
            }
        }
    }

    /// One increment along a path of equilibria.
    fn along(
        &mut self,
        planned: &PlannedIncrement,
        known: Option<&Known<Z>>,
        progress: &mut dyn Progress,
    ) -> Along<D, Z> {
        let lost = |e: SolveError| Along::Failed(e.to_string());
        let mut follower = match self.path.take().filter(|p| p.step == planned.step) {
            Some(follower) => follower,
            None => {
                let (zone, time) = match known {
                    Some(state) => (state.zone.clone(), state.time),
                    None => {
                        let time = planned.range[0];
                        let membrane = self.plan.at(time);
                        self.engine.solve(&self.plan, &membrane, (0, time), progress);
                        let Some(zone) = self.engine.zone() else {
                            return Along::Failed(format!("no state was found at t = {time}"));
                        };
                        (zone, time)
                    }
                };
                let scales = match zone.is_empty() {
                    true => self.engine.measure(&self.plan.at(planned.range[1])),
                    false => self.engine.scales(),
                };
                let Some(scales) = scales else {
                    return Along::Failed("no state to begin at".into());
                };
                match Follower::begin(&self.plan, planned, zone, time, scales) {
                    Ok(follower) => follower,
                    Err(e) => return lost(e),
                }
            }
        };
        let along = follower.advance(&self.plan, planned, progress).unwrap_or_else(lost);
        follower.done |= matches!(along, Along::Ended(_));
        self.path = Some(follower);
        along
    }

    /// Locates the jump between two states, and tells where it landed; none if that is where the second state is.
    fn find_jump(
        &mut self,
        index: usize,
        [a, b]: [&Known<Z>; 2],
        record: &mut Record,
        progress: &mut dyn Progress,
    ) -> Option<Known<Z>> {
        let tolerance = self.plan.increments[index].events?;
        let (plan, engine) = (&self.plan, &mut self.engine);
        let mut follow = |time: f64, zone: &Z| {
            let membrane = plan.at(time);
            if progress.interrupted() || plan.check_fields(&membrane, time).is_err() {
                return None;
            }
            engine.start_from(zone.clone());
            let increment = engine.solve(plan, &membrane, (index, time), progress);
            Some((engine.known(time, &increment)?, increment.stability.jumped))
        };
        let [before, after] = locate_jump(a.clone(), b.clone(), tolerance, &mut follow);
        self.add_events(record, tolerance, jump(&self.plan.grid, &before, &after));
        self.engine.start_from(b.zone.clone());
        (after.time < b.time).then_some(after)
    }

    /// Locates the changes of topology within an increment.
    fn find_events(&mut self, index: usize, [a, b]: [&Known<Z>; 2], record: &mut Record, progress: &mut dyn Progress) {
        let changed = a.zone.counts() != b.zone.counts();
        let Some(tolerance) = self.plan.increments[index].events.filter(|_| changed) else { return };
        let saved = self.engine.save();
        let (plan, engine) = (&self.plan, &mut self.engine);
        let mut found = Vec::new();
        // Events at the same time ask for the same states.
        let mut solved: HashMap<u64, Known<Z>> = HashMap::new();
        let mut failed = HashSet::new();
        let mut solve = |time: f64, [before, after]: [&Z; 2]| {
            let from = (time.to_bits(), before.counts(), after.counts());
            match solved.get(&time.to_bits()) {
                Some(state) => return Between::State(state.clone()),
                None if failed.contains(&from) => return Between::Unknown,
                None => {}
            }
            let membrane = plan.at(time);
            if progress.interrupted() || plan.check_fields(&membrane, time).is_err() {
                return Between::Unknown;
            }
            engine.start_from(before.clone());
            let mut bounded = Bounded { inner: progress, solves: 0 };
            let increment = engine.solve(plan, &membrane, (index, time), &mut bounded);
            if progress.interrupted() {
                return Between::Unknown;
            }
            // Beside a merger zones with fronts sharper than the grid tell nothing.
            let state = engine.known(time, &increment).filter(|_| increment.resolved);
            if (before.is_empty() || after.is_empty()) && state.as_ref().is_none_or(|s| s.zone.is_empty()) {
                // A zone too small for the grid is told by the membrane without contact.
                match engine.reaches_obstacle(&membrane) {
                    Some(true) if before.is_empty() => return Between::AsLater,
                    Some(true) => return Between::AsEarlier,
                    _ => {}
                }
            }
            match state {
                Some(state) => {
                    solved.insert(time.to_bits(), state.clone());
                    Between::State(state)
                }
                None => {
                    failed.insert(from);
                    Between::Unknown
                }
            }
        };
        locate(&plan.grid, a, b, tolerance, &mut solve, &mut found);
        self.engine.restore(saved);
        self.add_events(record, tolerance, found);
    }

    fn add_events(&self, record: &mut Record, tolerance: f64, mut found: Vec<Event>) {
        for event in &mut found {
            let membrane = self.plan.at(event.time);
            let at = Point::<D>::from_fn(|k, _| event.at[k]);
            let side = if event.above { Side::Above } else { Side::Below };
            let touched = membrane.obstacles.index_at(side, &at).and_then(|k| self.plan.contacts.get(k));
            event.load_force = self.plan.load_resultants(&membrane, event.time).values().sum();
            event.contact = touched.map_or(String::new(), |c| c.name.clone());
        }
        if let Some(coarse) = found.iter().find(|e| e.within > tolerance) {
            let [from, to] = [-0.5, 0.5].map(|s| coarse.time + s * coarse.within);
            let message = format!("an event between t = {from} and {to} could not be located more closely");
            record.warnings.push(Warning::new(WarningKind::EventInterval, message).at_time(coarse.time));
        }
        record.events.extend(found);
    }

    /// Other equilibria of an adhesive membrane; with `zones` those with contact too, which are searched for.
    fn other_states(
        &self,
        record: &mut Record,
        membrane: &Membrane<D>,
        increment: &Increment<D>,
        zones: bool,
    ) -> Vec<coexisting::OtherState> {
        if !membrane.obstacles.are_sticky() || !increment.converged {
            return Vec::new();
        }
        if increment.stability.lowest_eigenvalue.is_some_and(|v| v <= 0.0) {
            record.warn_once(Warning::new(WarningKind::Unstable, UNSTABLE));
        }
        others::<D, Z>(membrane, &self.plan.refinement, increment.area(), zones).unwrap_or_default()
    }
}

/// The state at t = 0 where the membrane is flat then and clear of what it may touch: without loads and displacements of
/// supports. None where a history does not begin at t = 0, or not with that state.
fn at_rest<const D: usize>(plan: &MembranePlan<D>, mesh: &DisplayMesh<D>) -> Option<Snapshot<D>> {
    let first = plan.increments.first()?;
    let [from, to] = first.range;
    // A path of equilibria begins somewhere else.
    if from != 0.0 || to <= 0.0 || plan.initial_zone.is_some() || first.control != Control::Time {
        return None;
    }
    let membrane = plan.at(0.0);
    let still = |x: &Point<D>| {
        membrane.load.value(x) == 0.0
            && membrane.supports.iter().flatten().all(|s| s.displacement.value(x) == 0.0)
            && membrane.obstacles.least_gap(x, 0.0).0 > 0.0
    };
    let flat = |_: &Point<D>| Some(Sample { displacement: 0.0, in_contact: false, pressure: 0.0 });
    mesh.points.iter().all(still).then(|| Snapshot::new(mesh, &membrane, 0.0, Vec::new(), flat))
}

impl<const D: usize, Z: Zone<D>> Model for MembraneModel<D, Z> {
    fn head(&self) -> &Head {
        &self.plan.head
    }

    fn increments(&self) -> usize {
        self.plan.increments.len()
    }

    fn time(&self, index: usize) -> f64 {
        self.plan.increments[index].time
    }

    fn begins_at_rest(&self) -> bool {
        self.rest.is_some()
    }

    fn advance(
        &mut self,
        index: usize,
        record: &mut Record,
        progress: &mut dyn Progress,
    ) -> Result<Advanced, CaseError> {
        let planned = self.plan.increments[index];
        if self.is_done(planned.step) {
            return Ok(Advanced::Nothing);
        }
        let mut time = planned.time;
        let mut solves = 0;
        let told = (record.events.len(), record.warnings.len());
        let known = self.known.clone();
        let before = self.known(index, known.clone(), progress);
        // With adhesion a time may have several states, which a path tells apart.
        let by_time = planned.control == Control::Time;
        let on_path = !by_time && self.plan.at(planned.range[0]).obstacles.are_sticky();
        if !by_time && !on_path {
            match self.seek(index, &planned, known.as_ref(), progress) {
                Ok(found) => (time, solves) = found,
                Err(why) => return Ok(lost(record, why, progress.interrupted())),
            }
        }
        if on_path {
            match self.along(&planned, known.as_ref(), progress) {
                Along::State { zone, cells, time: found, solves: taken } => {
                    (time, solves) = (found, taken);
                    self.engine.start_on(zone, *cells);
                }
                Along::Ended(why) => {
                    record.warnings.push(Warning::new(WarningKind::Path, why));
                    return Ok(Advanced::Nothing);
                }
                Along::Failed(why) => return Ok(lost(record, why, progress.interrupted())),
            }
        }
        let membrane = self.plan.at(time);
        if index > 0 || !by_time {
            self.plan.check_fields(&membrane, time)?;
        }
        let last_of_step = self.plan.increments.get(index + 1).is_none_or(|next| next.step != planned.step);
        self.engine.estimates = last_of_step;
        let mut increment = self.engine.solve(&self.plan, &membrane, (index, time), progress);
        if let (true, Reason::NoSuchState, Some(follower)) = (on_path, increment.reason, &mut self.path) {
            // The state of the path penetrates a body: on from the one before, which did not.
            if let Some(before) = &known {
                self.engine.start_from(before.zone.clone());
            }
            let why = follower.ends();
            if let Control::ArcLength(_) = planned.control {
                follower.done = true;
                record.warnings.push(Warning::new(WarningKind::Path, why));
                return Ok(Advanced::Nothing);
            }
            return Ok(lost(record, why, false));
        }
        if let (false, Control::Time, Some(from)) = (increment.converged, planned.control, &known)
            && let Some(taken) = self.approach(index, from, time, progress)
        {
            solves += increment.before + increment.iterations + taken;
            increment = self.engine.solve(&self.plan, &membrane, (index, time), progress);
        }
        increment.before += solves;
        if let (Control::ArcLength(_), true, true) = (planned.control, increment.converged, last_of_step)
            && !self.is_done(planned.step)
        {
            let [_, to] = planned.range;
            let message = format!(
                "the path goes on: its last increment is at t = {time}, and the step ends at t = {to}; give the step more \
                 increments, or leave them out to follow the path to its end"
            );
            record.warnings.push(Warning::new(WarningKind::Path, message).at_time(time));
        }
        let mut after = self.engine.known(time, &increment);
        if on_path {
            // Nothing jumps along a path.
        } else if let (Some(before), true) = (&before, membrane.obstacles.are_sticky()) {
            let mut from = before.clone();
            while let (true, Some(state)) = (increment.stability.jumped, &after)
                && let Some(landed) = self.find_jump(index, [&from, state], record, progress)
            {
                // On from where the jump ended.
                self.engine.start_from(landed.zone.clone());
                from = landed;
                increment = self.engine.solve(&self.plan, &membrane, (index, time), progress);
                after = self.engine.known(time, &increment);
            }
        } else if by_time && increment.stability.jumped && index > 0 {
            let a = known.as_ref().map_or(0.0, |k| k.area);
            let message = format!(
                "the contact jumped to another state on the way to t = {time}: its area went from {a:.6} to {:.6}; \
                 `events` in the step locates where",
                increment.area()
            );
            record.warnings.push(Warning::new(WarningKind::Jump, message).at_time(time));
        }
        if progress.interrupted() {
            // It may have ended early; what it told is told anew when the run goes on.
            (increment.converged, increment.reason) = (false, Reason::Interrupted);
            forget(record, told);
        }
        record.unknowns = record.unknowns.max(increment.unknowns);
        increment.warnings.iter().for_each(|warning| record.warn_once(warning.clone()));
        let snapshot = increment.snapshot(&self.mesh, &membrane, time);
        self.engine.estimates = false;
        let others = self.other_states(record, &membrane, &increment, D == 1 || last_of_step);
        let loads = self.plan.load_resultants(&membrane, time);
        let mut step = increment.step_report(&self.plan, (record.steps.len(), time), &loads);
        let state =
            |o: &coexisting::OtherState| OtherState { area: o.area, energy_total: o.energy_total, stable: o.stable };
        for contact in step.contacts.values_mut() {
            contact.other_states = others.iter().map(state).collect();
        }
        record.steps.push(step);
        if let (Some(before), Some(after), false) = (&before, &after, membrane.obstacles.are_sticky())
            && before.time < after.time
        {
            self.find_events(index, [before, after], record, progress);
            if progress.interrupted() {
                forget(record, told);
                self.last = snapshot.or(self.last.take());
                return Ok(Advanced::Failed(Reason::Interrupted));
            }
        }
        if let (Some(snapshot), true) = (&snapshot, self.plan.head.pictures && self.plan.increments.len() > 1) {
            self.film.add(snapshot);
        }
        self.last = snapshot.or(self.last.take());
        self.known = after;
        Ok(Advanced::State)
    }

    fn write_fields(&mut self, index: usize, record: &mut Record) -> Result<(), OutputError> {
        let Some(s) = &self.last else { return Ok(()) };
        let name = format!("{index:05}");
        let units = record.units.clone();
        if let Some(rest) = self.rest.as_ref().filter(|_| record.frames.is_empty()) {
            let file = format!("fields/fields_{START}.vtu");
            record.folder.write(&file, &vtk::fields(&self.mesh, rest, units.as_ref())?)?;
            record.add_frame(0.0, START.into(), &["contact"])?;
        }
        record.folder.write(&format!("fields/fields_{name}.vtu"), &vtk::fields(&self.mesh, s, units.as_ref())?)?;
        record.folder.write(&format!("contact/contact_{name}.vtp"), &vtk::outlines(s)?)?;
        record.folder.write(&format!("contact/outlines_{name}.csv"), tables::outlines(s).as_bytes())?;
        record.add_frame(s.time, name, &["contact"])
    }

    fn shown(&self) -> Option<ShownState> {
        let last = self.last.as_ref()?;
        let bodies = vec![last.to_fields(&self.plan.body, &self.mesh)];
        Some(ShownState { time: last.time, bodies, contacts: vec![last.edges()] })
    }

    fn draw(&self, record: &Record) -> Result<(), OutputError> {
        let Some(last) = &self.last else { return Ok(()) };
        let states = record.history(self.rest.is_some());
        let history = (&*states, record.events.as_slice());
        pictures::draw(&record.folder, &self.plan, &self.mesh, last, self.film.frames(), history)
    }

    fn first_picture(&self) -> Option<String> {
        self.last.as_ref().map(|_| "pictures/deflection.png".into())
    }

    fn verdict(&self, record: &Record, reason: Reason) -> String {
        verdict::verdict::<D, Z>(&self.plan, record, reason)
    }

    fn method(&self) -> String {
        self.plan.method.name().into()
    }

    fn save(&self, folder: &Folder, next: usize) -> Result<Option<Value>, OutputError> {
        // Along a path the way back leads to the beginning of its step.
        if self.plan.increments[next - 1].control != Control::Time {
            return Ok(None);
        }
        if let Some(frame) = self.last.as_ref().filter(|_| self.plan.head.pictures) {
            saved::write_frame(folder, next - 1, frame)?;
        }
        Ok(Some(saved::to_json(&self.engine.save(), self.known.as_ref())))
    }

    fn restore(&mut self, state: Value, folder: &Path, next: usize) -> Result<(), String> {
        let damaged = || checkpoint::damaged(folder);
        let (engine, known) = saved::from_json(&state, &self.plan.grid).ok_or_else(damaged)?;
        self.engine.restore(engine);
        self.known = known;
        for frame in saved::frames(folder, next).ok_or_else(damaged)? {
            self.film.add(&frame);
        }
        Ok(())
    }
}

/// The end of a run of which no state was found any more, for a reason.
fn lost(record: &mut Record, why: String, interrupted: bool) -> Advanced {
    record.warnings.push(Warning::new(WarningKind::Path, why));
    Advanced::Failed(if interrupted { Reason::Interrupted } else { Reason::PathLost })
}

/// Takes back the events and warnings beyond the given numbers of them.
fn forget(record: &mut Record, (events, warnings): (usize, usize)) {
    record.events.truncate(events);
    record.warnings.truncate(warnings);
}
