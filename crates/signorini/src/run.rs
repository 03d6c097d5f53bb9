//! From a plan to results: increments, files, the summary and the verdict.

mod checkpoint;
mod environment;
pub(crate) mod events;
mod increment;
mod mergers;
mod path;
mod seek;
mod sizes;
pub(crate) mod solid;
mod solid_checkpoint;

use crate::case::statement::Space;
use crate::case::{CaseError, Document};
use crate::output::figure::told;
use crate::output::film::Film;
use crate::output::{Folder, OutputError, pictures, tables, vtk};
use crate::plan::{Contact, Control, MembranePlan, MethodChoice, Plan, PlannedIncrement, plan};
use crate::report::{
    ContactReport, Event, OtherState, Reason, SCHEMA, StepReport, Summary, UnitNames, Warning, WarningKind, history,
};
use crate::snapshot::{DisplayMesh, Snapshot};
use checkpoint::Checkpoint;
use events::{Between, Bounded, Known, jump, locate, locate_jump};
use increment::{Engine, Increment};
use path::{Along, Follower};
use seek::Seeker;
use serde_json::{Value, json};
use signorini_geometry::Point;
use signorini_membrane::coexisting::{self, others};
use signorini_membrane::line_zone::LineZone;
use signorini_membrane::obstacle::Side;
use signorini_membrane::plane_zone::PlaneZone;
use signorini_membrane::problem::Membrane;
use signorini_membrane::zone::Zone;
use signorini_solve::SolveError;
pub use signorini_solve::{Iteration, Progress, Silent};
pub use sizes::{preview, sizes};
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// What a run of solids would have to do, after checking that their supports and contacts make sense.
fn solid_sizes<const D: usize>(plan: &crate::plan::solid::SolidPlan<D>) -> Result<Value, CaseError> {
    let mut model = solid::model(plan)?;
    let judged = solid::judge(plan, &mut model)?;
    let cost = solid::cost(plan, &model)?;
    let free: Vec<String> = model
        .free_modes()
        .iter()
        .map(|m| format!("`{}` is free {} until contact holds it", m.body, m.motion))
        .collect();
    Ok(json!({
        "method": "mortar",
        "bodies": plan.bodies.len(),
        "cells": plan.bodies.iter().map(|b| b.mesh.cell_count()).sum::<usize>(),
        "unknowns": model.unknowns(),
        "memory_about": format!("{:.2} GiB", solid::memory(&cost) / f64::from(1u32 << 30)),
        "factorisation_about": format!("{:.1} s", cost.operations / solid::OPERATIONS_PER_SECOND),
        "increments": plan.times.len(),
        "supports": plan.document.case.supports.len(),
        "loads": plan.loads.len(),
        "contacts": plan.contacts.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", "),
        "free": free,
        "interpreted": plan.interpreted,
        "warnings": plan.warnings.iter().cloned().chain(sizes::odd_solids(plan).into_iter().chain(judged).map(Warning::from)).collect::<Vec<_>>(),
    }))
}

/// Told once where a state that was asked for is not stable.
const UNSTABLE: &str =
    "unstable states are among the results, where they were asked for: `stable` in the summary tells which";

/// An increment is cut to this fraction of itself before it is given up.
const SMALLEST_INCREMENT: f64 = 1.0 / 32.0;

/// Why a run has no summary.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    #[error(transparent)]
    Case(#[from] Box<CaseError>),
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl From<CaseError> for RunError {
    fn from(error: CaseError) -> Self {
        RunError::Case(Box::new(error))
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    Converged,
    NotConverged,
    Interrupted,
}

/// What a run leaves behind.
pub struct Outcome {
    pub summary: Summary,
    pub ending: Ending,
}

/// Runs a case and writes its results into a folder, with the threads of rayon's current pool.
pub fn run(document: &Document, folder: &Path, progress: &mut dyn Progress) -> Result<Outcome, RunError> {
    begin(document, folder, Begun::Fresh, progress)
}

/// Where a run begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Begun {
    /// At its beginning, as was asked.
    Fresh,
    /// After the last increment that an earlier run kept.
    Resumed,
    /// At its beginning, as the earlier run kept no increment.
    Anew,
    /// Nowhere: the earlier run is done.
    Done,
}

/// Where a run of a case would go on in the folder of an earlier one.
///
/// # Errors
/// A folder without a run, or with one of another case.
pub fn begun(document: &Document, folder: &Path) -> Result<Begun, CaseError> {
    checkpoint::begun(folder, &document.text).map_err(not_resumed)
}

/// Goes on with a run that was interrupted or killed, from its last increment; to the same digits. Of a run that is done
/// the summary is read, and nothing is written.
///
/// # Errors
/// Those of [`run`], and a folder without such a run, or with one of another case.
pub fn resume(document: &Document, folder: &Path, progress: &mut dyn Progress) -> Result<Outcome, RunError> {
    let begun = begun(document, folder)?;
    if begun == Begun::Done {
        let summary = checkpoint::summary(folder).map_err(not_resumed)?;
        return Ok(Outcome { summary, ending: Ending::Converged });
    }
    begin(document, folder, begun, progress)
}

fn begin(document: &Document, folder: &Path, begun: Begun, progress: &mut dyn Progress) -> Result<Outcome, RunError> {
    let start = std::time::Instant::now();
    match plan(document)? {
        Plan::Line(p) => Runner::<1, LineZone>::new(p, folder, begun)?.run(start, progress),
        Plan::Plane(p) => Runner::<2, PlaneZone>::new(p, folder, begun)?.run(start, progress),
        Plan::PlaneSolids(p) => solid::run(*p, folder, begun, start, progress),
        Plan::Solids(p) => solid::run(*p, folder, begun, start, progress),
    }
}

/// Why there is nothing to go on with, for a user.
fn not_resumed(why: String) -> CaseError {
    CaseError::new(why).help("run it from the beginning, without --resume")
}

struct Runner<const D: usize, Z> {
    plan: MembranePlan<D>,
    folder: Folder,
    engine: Engine<D, Z>,
    steps: Vec<StepReport>,
    warnings: Vec<Warning>,
    frames: Vec<(f64, String)>,
    unknowns: usize,
    events: Vec<Event>,
    path: Option<Follower<D, Z>>,
    seeker: Option<Seeker>,
    film: Film<D>,
    /// The state to go on from.
    resumed: Option<(usize, Option<Known<Z>>)>,
}

/// Writes every iteration to the log on its way to the user's progress.
struct Logged<'a> {
    folder: &'a Folder,
    inner: &'a mut dyn Progress,
}

impl Progress for Logged<'_> {
    fn step(&mut self, index: usize, count: usize, time: f64) {
        self.inner.step(index, count, time);
    }
    fn iteration(&mut self, i: &Iteration) {
        let mut line = json!({
            "event": "iteration", "step": i.step, "time": i.time, "iteration": i.iteration,
            "residual": i.residual, "action": i.action,
        });
        for (name, value) in i.figures {
            line[*name] = json!(value);
        }
        // A log that cannot be written will be told by the files that follow.
        let _ = self.folder.log(&line);
        self.inner.iteration(i);
    }
    fn interrupted(&self) -> bool {
        self.inner.interrupted()
    }
}

impl<const D: usize, Z: Zone<D>> Runner<D, Z> {
    fn new(plan: MembranePlan<D>, folder: &Path, begun: Begun) -> Result<Self, RunError> {
        // Everything that can be checked is checked before the folder is touched.
        if let Some(&time) = plan.known_times().first() {
            plan.check_fields(&plan.at(time), time)?;
        }
        if begun == Begun::Resumed {
            return Self::resume(plan, folder);
        }
        let folder = Folder::create(folder)?;
        folder.write("case.toml", plan.document.text.as_bytes())?;
        let warnings = plan.warnings.clone();
        Ok(Self {
            engine: Engine::new(&plan),
            plan,
            folder,
            steps: vec![],
            warnings,
            frames: vec![],
            unknowns: 0,
            events: vec![],
            path: None,
            seeker: None,
            film: Film::default(),
            resumed: None,
        })
    }

    /// A run that goes on where an earlier one ended.
    fn resume(plan: MembranePlan<D>, path: &Path) -> Result<Self, RunError> {
        let found = Checkpoint::<D, Z>::read(path, &plan.document.text, &plan.grid).map_err(not_resumed)?;
        let mut engine = Engine::new(&plan);
        engine.restore(found.engine);
        let mut film = Film::default();
        found.film.iter().for_each(|frame| film.add(frame));
        Ok(Self {
            engine,
            plan,
            folder: Folder::of_earlier_run(path),
            steps: found.steps,
            warnings: found.warnings,
            frames: found.frames,
            unknowns: found.unknowns,
            events: found.events,
            path: None,
            seeker: None,
            film,
            resumed: Some((found.next, found.known)),
        })
    }

    /// Writes what a later run needs to go on.
    fn checkpoint(
        &self,
        next: usize,
        known: &Option<Known<Z>>,
        frame: Option<&Snapshot<D>>,
    ) -> Result<(), OutputError> {
        let checkpoint = Checkpoint::<D, Z> {
            next,
            engine: self.engine.save(),
            known: known.clone(),
            steps: self.steps.clone(),
            warnings: self.warnings.clone(),
            frames: self.frames.clone(),
            unknowns: self.unknowns,
            events: self.events.clone(),
            film: frame.cloned().into_iter().collect(),
        };
        checkpoint.write(&self.folder, &self.plan.document.text)
    }

    fn run(mut self, start: std::time::Instant, progress: &mut dyn Progress) -> Result<Outcome, RunError> {
        let increments = self.plan.increments.clone();
        let mesh = DisplayMesh::new(&self.plan, &self.plan.at(increments[0].range[0]));
        let mut ending = Ending::Converged;
        let mut reason = Reason::Converged;
        let mut last: Option<Snapshot<D>> = None;
        let (first, mut known) = self.resumed.take().unwrap_or((0, None));
        for (index, planned) in increments.iter().enumerate().skip(first) {
            if self.is_done(planned.step) {
                continue;
            }
            progress.step(index, increments.len(), planned.time);
            let folder = self.folder.clone();
            let mut logged = Logged { folder: &folder, inner: progress };
            let mut time = planned.time;
            let mut solves = 0;
            let told = (self.events.len(), self.warnings.len());
            let before = self.known(index, known.clone(), &mut logged);
            // With adhesion a time may have several states, which a path tells apart.
            let by_time = planned.control == Control::Time;
            let on_path = !by_time && self.plan.at(planned.range[0]).obstacles.are_sticky();
            if !by_time && !on_path {
                match self.seek(index, planned, known.as_ref(), &mut logged) {
                    Ok(found) => (time, solves) = found,
                    Err(why) => {
                        (ending, reason) = self.lost(why, logged.interrupted());
                        break;
                    }
                }
            }
            if on_path {
                match self.along(planned, known.as_ref(), &mut logged)? {
                    Along::State { zone, cells, time: found, solves: taken } => {
                        (time, solves) = (found, taken);
                        self.engine.start_on(zone, *cells);
                    }
                    Along::Ended(why) => {
                        self.warnings.push(Warning::new(WarningKind::Path, why));
                        continue;
                    }
                    Along::Failed(why) => {
                        (ending, reason) = self.lost(why, logged.interrupted());
                        break;
                    }
                }
            }
            let membrane = self.plan.at(time);
            let checked = if index == 0 && by_time { Ok(()) } else { self.plan.check_fields(&membrane, time) };
            if let Err(error) = checked {
                // What was found so far stays; the summary says how far it goes.
                self.finish(Ending::NotConverged, Reason::Input, start, &mesh, last.as_ref())?;
                return Err(error.into());
            }
            let last_of_step = increments.get(index + 1).is_none_or(|next| next.step != planned.step);
            self.engine.estimates = last_of_step;
            let mut increment = self.engine.solve(&self.plan, &membrane, (index, time), &mut logged);
            if let (true, Reason::NoSuchState, Some(follower)) = (on_path, increment.reason, &mut self.path) {
                // The state of the path penetrates a body: on from the one before, which did not.
                if let Some(before) = &known {
                    self.engine.start_from(before.zone.clone());
                }
                let why = follower.ends();
                if let Control::ArcLength(_) = planned.control {
                    follower.done = true;
                    self.warnings.push(Warning::new(WarningKind::Path, why));
                    continue;
                }
                (ending, reason) = self.lost(why, false);
                break;
            }
            if let (false, Control::Time, Some(from)) = (increment.converged, planned.control, &known)
                && let Some(taken) = self.approach(index, from, time, &mut logged)
            {
                solves += increment.before + increment.iterations + taken;
                increment = self.engine.solve(&self.plan, &membrane, (index, time), &mut logged);
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
                self.warnings.push(Warning::new(WarningKind::Path, message).at_time(time));
            }
            let mut after = self.engine.known(time, &increment);
            if on_path {
                // Nothing jumps along a path.
            } else if let (Some(before), true) = (&before, membrane.obstacles.are_sticky()) {
                let mut from = before.clone();
                while let (true, Some(state)) = (increment.stability.jumped, &after)
                    && let Some(landed) = self.find_jump(index, &from, state, &mut logged)
                {
                    // On from where the jump ended.
                    self.engine.start_from(landed.zone.clone());
                    from = landed;
                    increment = self.engine.solve(&self.plan, &membrane, (index, time), &mut logged);
                    after = self.engine.known(time, &increment);
                }
            } else if by_time && increment.stability.jumped && index > 0 {
                let a = known.as_ref().map_or(0.0, |k| k.area);
                let message = format!(
                    "the contact jumped to another state on the way to t = {time}: its area went from {a:.6} to {:.6}; \
                     `events` in the step locates where",
                    increment.area()
                );
                self.warnings.push(Warning::new(WarningKind::Jump, message).at_time(time));
            }
            if logged.interrupted() {
                // It may have ended early; what it told is told anew when the run goes on.
                (increment.converged, increment.reason) = (false, Reason::Interrupted);
                self.forget(told);
            }
            self.unknowns = self.unknowns.max(increment.unknowns);
            for warning in &increment.warnings {
                // What is said of many increments is said once, of the first.
                if !self.warnings.iter().any(|w| w.kind == warning.kind) {
                    self.warnings.push(warning.clone());
                }
            }
            let snapshot = increment.snapshot(&mesh, &membrane, time);
            self.engine.estimates = false;
            let others = self.other_states(&membrane, &increment, D == 1 || last_of_step);
            self.record(time, &membrane, &increment, others);
            if let (Some(before), Some(after), false) = (&before, &after, membrane.obstacles.are_sticky())
                && before.time < after.time
            {
                self.find_events(index, before, after, &mut logged);
                if logged.interrupted() {
                    self.forget(told);
                    (ending, reason) = (Ending::Interrupted, Reason::Interrupted);
                    last = snapshot.or(last);
                    break;
                }
            }
            known = after;
            if let Some(snapshot) = &snapshot
                && (index % self.plan.every == self.plan.every - 1
                    || index + 1 == increments.len()
                    || !increment.converged)
            {
                self.write_fields(index, time, &mesh, snapshot)?;
            }
            if let (Some(snapshot), true) = (&snapshot, self.plan.pictures && increments.len() > 1) {
                self.film.add(snapshot);
            }
            last = snapshot.or(last);
            if !increment.converged {
                ending =
                    if increment.reason == Reason::Interrupted { Ending::Interrupted } else { Ending::NotConverged };
                reason = increment.reason;
                break;
            }
            if increments.len() == 1 {
                reason = increment.reason;
            }
            // Along a path the way back leads to the beginning of its step.
            if planned.control == Control::Time && increments.len() > 1 {
                let frame = if self.plan.pictures { last.as_ref() } else { None };
                self.checkpoint(index + 1, &known, frame)?;
            }
        }
        let summary = self.finish(ending, reason, start, &mesh, last.as_ref())?;
        if ending == Ending::Converged {
            self.folder.remove(checkpoint::FILE);
            self.folder.remove("checkpoint");
        }
        Ok(Outcome { summary, ending })
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

    /// The end of a run of which no state was found any more, for a reason.
    fn lost(&mut self, why: String, interrupted: bool) -> (Ending, Reason) {
        self.warnings.push(Warning::new(WarningKind::Path, why));
        match interrupted {
            true => (Ending::Interrupted, Reason::Interrupted),
            false => (Ending::NotConverged, Reason::PathLost),
        }
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

    /// Takes back the events and warnings beyond the given numbers of them.
    fn forget(&mut self, (events, warnings): (usize, usize)) {
        self.events.truncate(events);
        self.warnings.truncate(warnings);
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
    ) -> Result<Along<D, Z>, RunError> {
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
                            return Ok(Along::Failed(format!("no state was found at t = {time}")));
                        };
                        (zone, time)
                    }
                };
                let scales = match zone.is_empty() {
                    true => self.engine.measure(&self.plan.at(planned.range[1])),
                    false => self.engine.scales(),
                };
                let Some(scales) = scales else {
                    return Ok(Along::Failed("no state to begin at".into()));
                };
                match Follower::begin(&self.plan, planned, zone, time, scales) {
                    Ok(follower) => follower,
                    Err(e) => return Ok(lost(e)),
                }
            }
        };
        let along = follower.advance(&self.plan, planned, progress).unwrap_or_else(lost);
        follower.done |= matches!(along, Along::Ended(_));
        self.path = Some(follower);
        Ok(along)
    }

    /// Locates the jump between two states, and tells where it landed; none if that is where the second state is.
    fn find_jump(&mut self, index: usize, a: &Known<Z>, b: &Known<Z>, progress: &mut dyn Progress) -> Option<Known<Z>> {
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
        self.add_events(tolerance, jump(&self.plan.grid, &before, &after));
        self.engine.start_from(b.zone.clone());
        (after.time < b.time).then_some(after)
    }

    /// Locates the changes of topology within an increment.
    fn find_events(&mut self, index: usize, a: &Known<Z>, b: &Known<Z>, progress: &mut dyn Progress) {
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
        self.add_events(tolerance, found);
    }

    fn add_events(&mut self, tolerance: f64, mut found: Vec<Event>) {
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
            self.warnings.push(Warning::new(WarningKind::EventInterval, message).at_time(coarse.time));
        }
        self.events.extend(found);
    }

    /// Other equilibria of an adhesive membrane; with `zones` those with contact too, which are searched for.
    fn other_states(
        &mut self,
        membrane: &Membrane<D>,
        increment: &Increment<D>,
        zones: bool,
    ) -> Vec<coexisting::OtherState> {
        if !membrane.obstacles.are_sticky() || !increment.converged {
            return Vec::new();
        }
        if increment.stability.lowest_eigenvalue.is_some_and(|v| v <= 0.0)
            && !self.warnings.iter().any(|w| w.kind == WarningKind::Unstable)
        {
            self.warnings.push(Warning::new(WarningKind::Unstable, UNSTABLE));
        }
        others::<D, Z>(membrane, &self.plan.refinement, increment.area(), zones).unwrap_or_default()
    }

    fn record(
        &mut self,
        time: f64,
        membrane: &Membrane<D>,
        increment: &Increment<D>,
        others: Vec<coexisting::OtherState>,
    ) {
        let loads = self.plan.load_resultants(membrane, time);
        let mut step = increment.step_report(&self.plan, (self.steps.len(), time), &loads);
        let state =
            |o: &coexisting::OtherState| OtherState { area: o.area, energy_total: o.energy_total, stable: o.stable };
        for contact in step.contacts.values_mut() {
            contact.other_states = others.iter().map(state).collect();
        }
        self.steps.push(step);
    }

    fn write_fields(
        &mut self,
        index: usize,
        time: f64,
        mesh: &DisplayMesh<D>,
        s: &Snapshot<D>,
    ) -> Result<(), OutputError> {
        let name = format!("{index:05}");
        self.folder.write(&format!("fields/fields_{name}.vtu"), &vtk::fields(mesh, s)?)?;
        self.folder.write(&format!("contact/contact_{name}.vtp"), &vtk::outlines(s)?)?;
        self.folder.write(&format!("contact/outlines_{name}.csv"), tables::outlines(s).as_bytes())?;
        self.frames.push((time, name));
        let list = |of: &dyn Fn(&str) -> String| -> Vec<(f64, String)> {
            self.frames.iter().map(|(t, n)| (*t, of(n))).collect()
        };
        let fields = list(&|n| format!("fields/fields_{n}.vtu"));
        let contact = list(&|n| format!("contact/contact_{n}.vtp"));
        self.folder.write("fields.pvd", vtk::collection(&fields).as_bytes())?;
        self.folder.write("contact.pvd", vtk::collection(&contact).as_bytes())
    }

    fn finish(
        &self,
        ending: Ending,
        reason: Reason,
        start: std::time::Instant,
        mesh: &DisplayMesh<D>,
        last: Option<&Snapshot<D>>,
    ) -> Result<Summary, OutputError> {
        self.folder.write("history.csv", history(&self.steps, self.plan.unit_names().as_ref()).as_bytes())?;
        if let (true, Some(snapshot)) = (self.plan.pictures, last) {
            self.film.write(&self.folder, &self.plan, mesh)?;
            pictures::draw(&self.folder, &self.plan, mesh, snapshot, &self.steps, &self.events)?;
        }
        let summary = Summary {
            schema: SCHEMA,
            case: self.plan.document.case.title.clone().unwrap_or_else(|| self.plan.document.name.clone()),
            converged: ending == Ending::Converged,
            reason,
            verdict: self.verdict(ending, reason),
            method: self.plan.method.name().into(),
            unknowns: self.unknowns,
            units: self.plan.unit_names(),
            first_picture: (self.plan.pictures && last.is_some()).then(|| "pictures/deflection.png".into()),
            warnings: self.warnings.clone(),
            interpreted: self.plan.interpreted.clone(),
            steps: self.steps.clone(),
            events: self.events.clone(),
            environment: environment::describe(start, rayon::current_num_threads(), &self.plan.document.text),
        };
        self.folder.write("summary.json", summary.to_json().as_bytes())?;
        Ok(summary)
    }

    /// The result in a sentence, with what to try where there is none.
    fn verdict(&self, ending: Ending, reason: Reason) -> String {
        let done = self.steps.iter().filter(|s| s.converged).count();
        let count = self.plan.increments.len();
        match ending {
            Ending::Interrupted => format!("Interrupted: {done} of {count} increments are done and on disk."),
            Ending::NotConverged => {
                let advice = match reason {
                    Reason::LinearSolver => {
                        "the equations could not be solved: check that the membrane is held and that its data are of one scale"
                    }
                    Reason::Input => "a value became invalid along the way",
                    Reason::NoSuchState => {
                        "there is no equilibrium with contact near `initial_zone`: at this load adhesion may hold none; try another zone, a larger adhesion energy, or the load at which the contact exists"
                    }
                    Reason::PathLost => "the last warning says where; try smaller increments, or more cells",
                    _ => {
                        "try more cells where the zones are small or close to each other, a lower degree, or smaller increments; method.active_set = {} shows a coarse picture of the zones"
                    }
                };
                let residuals = self.steps.last().map_or(&[][..], |s| &s.residual_history);
                let last: Vec<String> =
                    residuals[residuals.len().saturating_sub(3)..].iter().map(|v| format!("{v:.1e}")).collect();
                let history = match last.is_empty() {
                    true => String::new(),
                    false => format!(" (last residuals relative to the tolerance: {})", last.join(", ")),
                };
                format!("Not converged in increment {} of {count}{history}: {advice}.", self.steps.len().max(1))
            }
            Ending::Converged => {
                let Some(step) = self.steps.last() else { return "Nothing was asked.".into() };
                if self.plan.contacts.is_empty() {
                    return "The membrane is in equilibrium; no contact was stated.".into();
                }
                let found = |c: &Contact| step.contacts.get(&c.name).filter(|found| found.zones > 0);
                let told: Vec<(&Contact, &ContactReport)> =
                    self.plan.contacts.iter().filter_map(|c| Some((c, found(c)?))).collect();
                let balance = step.equilibrium_residual.unwrap_or(f64::NAN);
                let unstable = told.iter().any(|(_, found)| found.stable == Some(false));
                let sentences: Vec<String> = told.iter().map(|(c, found)| self.contact_verdict(c, found)).collect();
                match sentences.is_empty() {
                    true => {
                        let why = sizes::clearance::<D, Z>(&self.plan, step.time);
                        format!("The membrane touches nothing{}.", why.map_or(String::new(), |why| format!(": {why}")))
                    }
                    false => format!(
                        "{}; forces balance to {balance:.0e}.{}",
                        sentences.join("; ").replacen('i', "I", 1),
                        if unstable { " This equilibrium is unstable." } else { "" }
                    ),
                }
            }
        }
    }

    /// One contact in a clause.
    fn contact_verdict(&self, contact: &Contact, c: &ContactReport) -> String {
        let units = self.plan.unit_names();
        let unit = |of: fn(&UnitNames) -> &String| units.as_ref().map_or("", |u| of(u));
        let measure = if D == 1 && self.plan.space == Space::Line { "length" } else { "area" };
        let staircase = if let MethodChoice::ActiveSet(_) = self.plan.method { " (a staircase of nodes)" } else { "" };
        format!(
            "in contact{} over {measure} {}{staircase} in {} zone{}{}, pushed {} by {}",
            if self.plan.contacts.len() > 1 { format!(" with {}", contact.body) } else { String::new() },
            told(c.area, c.error_estimate.map(|e| e.area), unit(|u| &u.area)),
            c.zones,
            if c.zones == 1 { "" } else { "s" },
            match c.holes.unwrap_or(0) {
                0 => String::new(),
                1 => " with 1 hole".into(),
                n => format!(" with {n} holes"),
            },
            if contact.side == Side::Below { "up" } else { "down" },
            told(contact.side.sign() * c.force[2], c.error_estimate.map(|e| e.force), unit(|u| &u.force)),
        )
    }
}
