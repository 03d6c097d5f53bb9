//! The history of a membrane: its increments by time, along a path of equilibria or to a given area, each from the one before,
//! with the changes of topology between.

mod bridge;
mod differences;
mod engine;
mod event;
mod events;
mod increment;
mod known;
mod level_set;
mod mergers;
mod nodal;
mod parts;
mod path;
mod remark;
mod seek;
mod statement;
mod trail;

pub use event::{Event, EventKind, LocatedBy};
pub use increment::{Increment, Sample, Sampler, Stability};
pub use level_set::LINEAR;
pub use remark::{Remark, RemarkKind};
pub use statement::{Control, MethodChoice, PlannedIncrement, Statement};

use crate::coexisting::{OtherState, others};
use crate::multigrid::large::ByMultigrid;
use crate::problem::Membrane;
use crate::quadrature::area;
use crate::solution::Reason;
use engine::{Engine, Saved};
use events::{jump, locate, locate_jump};
use known::{Between, Bounded, Known};
use path::{Along, Follower};
use seek::Seeker;
use serde_json::{Value, json};
use signorini_solve::{Progress, SolveError};
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

/// Told once where a state that was asked for is not stable.
const UNSTABLE: &str =
    "unstable states are among the results, where they were asked for: `stable` in the summary tells which";

/// An increment is cut to this fraction of itself before it is given up.
const SMALLEST_INCREMENT: f64 = 1.0 / 32.0;

/// What came of an increment.
pub enum Advanced<const D: usize> {
    State(Box<Found<D>>),
    /// Nothing: its step of the history has ended before.
    Nothing,
    /// No state was found any more; the last remark says why.
    Lost,
    /// The user asked to stop before there was a state.
    Interrupted,
    /// The data cannot be used at a time.
    Invalid {
        time: f64,
    },
}

/// The state at the end of an increment.
pub struct Found<const D: usize> {
    pub time: f64,
    pub increment: Increment<D>,
    /// Other equilibria at the same time.
    pub others: Vec<OtherState>,
    /// Whether the user asked to stop while events before it were looked for.
    pub interrupted: bool,
}

/// What an increment has to tell besides its state.
#[derive(Default)]
pub struct Told<const D: usize> {
    pub remarks: Vec<Remark>,
    pub events: Vec<Event<D>>,
}

/// The history of a membrane, whatever its zones are.
pub trait History<const D: usize> {
    /// Solves an increment, from the state of the one before; with what is to be told of it.
    fn advance(&mut self, index: usize, progress: &mut dyn Progress) -> (Advanced<D>, Told<D>);

    /// The state between two increments, enough to go on from to the same digits.
    fn save(&self) -> Value;

    /// Goes on from what [`History::save`] told; none where that is damaged.
    fn restore(&mut self, state: &Value) -> Option<()>;
}

/// A history with zones of a kind.
pub(crate) struct WithZones<const D: usize, Z> {
    statement: Rc<dyn Statement<D>>,
    engine: Engine<D, Z>,
    path: Option<Follower<D, Z>>,
    seeker: Option<Seeker>,
    /// The state of the last increment, where one is known.
    known: Option<Known<Z>>,
    remarks: Vec<Remark>,
    events: Vec<Event<D>>,
}

impl<const D: usize, Z: ByMultigrid<D> + 'static> WithZones<D, Z> {
    /// A history at its beginning.
    pub fn new(statement: Rc<dyn Statement<D>>) -> Self {
        let engine = Engine::new(&*statement);
        Self { statement, engine, path: None, seeker: None, known: None, remarks: Vec::new(), events: Vec::new() }
    }

    /// The state at the beginning of an increment whose events are wanted: that of the one before, or at t = 0.
    fn known(&mut self, index: usize, last: Option<Known<Z>>, progress: &mut dyn Progress) -> Option<Known<Z>> {
        let planned = &self.statement.increments()[index];
        planned.events?;
        if index > 0 || self.engine.is_asked() || planned.time <= 0.0 {
            return last;
        }
        let start = self.statement.at(0.0);
        if self.statement.check(&start, 0.0).is_err() {
            return None;
        }
        let increment = self.engine.solve(&*self.statement, &start, (0, 0.0), progress);
        self.engine.known(0.0, &increment)
    }

    /// Whether a step ended before its increments did.
    fn is_done(&self, step: usize) -> bool {
        self.path.as_ref().is_some_and(|path| path.done && path.step == step)
            || self.seeker.as_ref().is_some_and(|seeker| seeker.done && seeker.step == step)
    }

    fn step(&mut self, index: usize, progress: &mut dyn Progress) -> Advanced<D> {
        let planned = self.statement.increments()[index];
        if self.is_done(planned.step) {
            return Advanced::Nothing;
        }
        let mut time = planned.time;
        let mut solves = 0;
        let known = self.known.clone();
        let before = self.known(index, known.clone(), progress);
        // With adhesion a time may have several states, which a path tells apart.
        let by_time = planned.control == Control::Time;
        let on_path = !by_time && self.statement.at(planned.range[0]).obstacles.are_sticky();
        if !by_time && !on_path {
            match self.seek(index, &planned, known.as_ref(), progress) {
                Ok(found) => (time, solves) = found,
                Err(why) => return self.lost(why, progress.interrupted()),
            }
        }
        if on_path {
            match self.along(&planned, known.as_ref(), progress) {
                Along::State { zone, cells, time: found, solves: taken } => {
                    (time, solves) = (found, taken);
                    self.engine.start_on(zone, *cells);
                }
                Along::Ended(why) => {
                    self.remarks.push(Remark::new(RemarkKind::Path, why));
                    return Advanced::Nothing;
                }
                Along::Failed(why) => return self.lost(why, progress.interrupted()),
            }
        }
        let membrane = self.statement.at(time);
        if (index > 0 || !by_time) && self.statement.check(&membrane, time).is_err() {
            return Advanced::Invalid { time };
        }
        let last_of_step = self.statement.increments().get(index + 1).is_none_or(|next| next.step != planned.step);
        self.engine.estimates = last_of_step;
        let mut increment = self.engine.solve(&*self.statement, &membrane, (index, time), progress);
        if let (true, Reason::NoSuchState, Some(follower)) = (on_path, &increment.reason, &mut self.path) {
            // The state of the path penetrates a body: on from the one before, which did not.
            if let Some(before) = &known {
                self.engine.start_from(before.zone.clone());
            }
            let why = follower.ends();
            if let Control::ArcLength(_) = planned.control {
                follower.done = true;
                self.remarks.push(Remark::new(RemarkKind::Path, why));
                return Advanced::Nothing;
            }
            return self.lost(why, false);
        }
        if let (false, Control::Time, Some(from)) = (increment.converged, planned.control, &known)
            && let Some(taken) = self.approach(index, from, time, progress)
        {
            solves += increment.before + increment.iterations + taken;
            increment = self.engine.solve(&*self.statement, &membrane, (index, time), progress);
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
            self.remarks.push(Remark::new(RemarkKind::Path, message).at_time(time));
        }
        let mut after = self.engine.known(time, &increment);
        if on_path {
            // Nothing jumps along a path.
        } else if let (Some(before), true) = (&before, membrane.obstacles.are_sticky()) {
            let mut from = before.clone();
            while let (true, Some(state)) = (increment.stability.jumped, &after)
                && let Some(landed) = self.find_jump(index, [&from, state], progress)
            {
                // On from where the jump ended.
                self.engine.start_from(landed.zone.clone());
                from = landed;
                increment = self.engine.solve(&*self.statement, &membrane, (index, time), progress);
                after = self.engine.known(time, &increment);
            }
        } else if by_time && increment.stability.jumped && index > 0 {
            let a = known.as_ref().map_or(0.0, |k| k.area);
            let message = format!(
                "the contact jumped to another state on the way to t = {time}: its area went from {a:.6} to {:.6}; \
                 `events` in the step locates where",
                increment.area()
            );
            self.remarks.push(Remark::new(RemarkKind::Jump, message).at_time(time));
        }
        if progress.interrupted() {
            // It may have ended early; what it told is told anew when the run goes on.
            (increment.converged, increment.reason) = (false, Reason::Interrupted);
            self.forget();
        }
        let remarks = std::mem::take(&mut increment.remarks);
        self.remarks.extend(remarks);
        self.engine.estimates = false;
        let others = self.other_states(&membrane, &increment, D == 1 || last_of_step);
        let mut interrupted = false;
        if let (Some(before), Some(after), false) = (&before, &after, membrane.obstacles.are_sticky())
            && before.time < after.time
        {
            self.find_events(index, [before, after], progress);
            interrupted = progress.interrupted();
        }
        if interrupted {
            self.forget();
        } else {
            self.known = after;
        }
        Advanced::State(Box::new(Found { time, increment, others, interrupted }))
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
        let (statement, engine, mut solves, mut invalid) = (&*self.statement, &mut self.engine, 0, None);
        let mut look = |engine: &mut Engine<D, Z>, time: f64| {
            let membrane = statement.at(time);
            if let Err(error) = statement.check(&membrane, time) {
                invalid.get_or_insert(error);
                return None;
            }
            let increment = engine.solve(statement, &membrane, (index, time), progress);
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
        let mut seeker = seeker.unwrap_or_else(|| {
            Seeker::begin(planned, from[1], area(&statement.at(statement.increments()[0].range[0])))
        });
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
            let membrane = self.statement.at(target);
            self.statement.check(&membrane, target).ok()?;
            self.engine.start_from(reached.zone.clone());
            let increment = self.engine.solve(&*self.statement, &membrane, (index, target), progress);
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
                        let membrane = self.statement.at(time);
                        self.engine.solve(&*self.statement, &membrane, (0, time), progress);
                        let Some(zone) = self.engine.zone() else {
                            return Along::Failed(format!("no state was found at t = {time}"));
                        };
                        (zone, time)
                    }
                };
                let scales = match zone.is_empty() {
                    true => self.engine.measure(&self.statement.at(planned.range[1])),
                    false => self.engine.scales(),
                };
                let Some(scales) = scales else {
                    return Along::Failed("no state to begin at".into());
                };
                match Follower::begin(&*self.statement, planned, zone, time, scales) {
                    Ok(follower) => follower,
                    Err(e) => return lost(e),
                }
            }
        };
        let along = follower.advance(&*self.statement, planned, progress).unwrap_or_else(lost);
        follower.done |= matches!(along, Along::Ended(_));
        self.path = Some(follower);
        along
    }

    /// Locates the jump between two states, and tells where it landed; none if that is where the second state is.
    fn find_jump(&mut self, index: usize, [a, b]: [&Known<Z>; 2], progress: &mut dyn Progress) -> Option<Known<Z>> {
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
    fn find_events(&mut self, index: usize, [a, b]: [&Known<Z>; 2], progress: &mut dyn Progress) {
        let changed = a.zone.counts() != b.zone.counts();
        let Some(tolerance) = self.statement.increments()[index].events.filter(|_| changed) else { return };
        let saved = self.engine.save();
        let (statement, engine) = (&*self.statement, &mut self.engine);
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
            let membrane = statement.at(time);
            if progress.interrupted() || statement.check(&membrane, time).is_err() {
                return Between::Unknown;
            }
            engine.start_from(before.clone());
            let mut bounded = Bounded { inner: progress, solves: 0 };
            let increment = engine.solve(statement, &membrane, (index, time), &mut bounded);
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
    fn other_states(&mut self, membrane: &Membrane<D>, increment: &Increment<D>, zones: bool) -> Vec<OtherState> {
        if !membrane.obstacles.are_sticky() || !increment.converged {
            return Vec::new();
        }
        if increment.stability.lowest_eigenvalue.is_some_and(|v| v <= 0.0) {
            self.remarks.push(Remark::new(RemarkKind::Unstable, UNSTABLE));
        }
        others::<D, Z>(membrane, self.statement.refinement(), increment.area(), zones).unwrap_or_default()
    }

    /// No state was found any more, for a reason.
    fn lost(&mut self, why: String, interrupted: bool) -> Advanced<D> {
        self.remarks.push(Remark::new(RemarkKind::Path, why));
        if interrupted { Advanced::Interrupted } else { Advanced::Lost }
    }

    /// Takes back what was to be told: it is told anew when the history goes on.
    fn forget(&mut self) {
        self.remarks.clear();
        self.events.clear();
    }
}

impl<const D: usize, Z: ByMultigrid<D> + 'static> History<D> for WithZones<D, Z> {
    fn advance(&mut self, index: usize, progress: &mut dyn Progress) -> (Advanced<D>, Told<D>) {
        let advanced = self.step(index, progress);
        let told = Told { remarks: std::mem::take(&mut self.remarks), events: std::mem::take(&mut self.events) };
        (advanced, told)
    }

    fn save(&self) -> Value {
        json!({
            "engine": self.engine.save().to_json(|z: &Z| z.to_json()),
            "known": self.known.as_ref().map(|k| json!({
                "time": k.time, "zone": k.zone.to_json(), "area": k.area, "force": k.force,
                "energy_total": k.energy_total, "margin": k.margin,
            })),
        })
    }

    fn restore(&mut self, state: &Value) -> Option<()> {
        let zone = |v: &Value| Z::from_json(self.statement.grid(), v);
        let known = match &state["known"] {
            Value::Null => None,
            k => Some(Known {
                time: k["time"].as_f64()?,
                zone: zone(&k["zone"])?,
                area: k["area"].as_f64()?,
                force: k["force"].as_f64()?,
                energy_total: k["energy_total"].as_f64().unwrap_or(f64::NAN),
                margin: k["margin"].as_f64(),
            }),
        };
        let saved = Saved::from_json(&state["engine"], zone)?;
        self.engine.restore(saved);
        self.known = known;
        Some(())
    }
}
