//! A history with zones of a kind: increments by time, to a given area, along a path, each from the one before.

use super::engine::{Engine, Saved};
use super::event::Event;
use super::messages::{Advanced, Found, History, Messages};
use super::path::{Along, ArcLengthControl};
use super::path_point::PathPoint;
use super::remark::{Remark, RemarkKind};
use super::seek::AreaController;
use super::statement::{Control, PlannedIncrement, Statement};
use crate::multigrid::large::ByMultigrid;
use crate::quadrature::area;
use crate::solution::Reason;
use serde_json::{Value, json};
use signorini_solve::{Progress, SolveError};
use std::rc::Rc;

/// An increment is cut to this fraction of itself before it is given up.
const SMALLEST_INCREMENT: f64 = 1.0 / 32.0;

/// A history with zones of a kind.
pub(crate) struct WithZones<const D: usize, Z> {
    pub(super) statement: Rc<dyn Statement<D>>,
    pub(super) engine: Engine<D, Z>,
    pub(super) path: Option<ArcLengthControl<D, Z>>,
    pub(super) seeker: Option<AreaController>,
    /// The state of the last increment, where one is known.
    pub(super) known: Option<PathPoint<Z>>,
    pub(super) remarks: Vec<Remark>,
    pub(super) events: Vec<Event<D>>,
}

impl<const D: usize, Z: ByMultigrid<D> + 'static> WithZones<D, Z> {
    /// A history at its beginning.
    pub fn new(statement: Rc<dyn Statement<D>>) -> Self {
        let engine = Engine::new(&*statement);
        Self { statement, engine, path: None, seeker: None, known: None, remarks: Vec::new(), events: Vec::new() }
    }

    /// The state at the beginning of an increment whose events are wanted: that of the one before, or at t = 0.
    fn known(&mut self, index: usize, last: Option<PathPoint<Z>>, progress: &mut dyn Progress) -> Option<PathPoint<Z>> {
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
                "the path goes on: its last increment is at t = {time}, and the step ends at t = {to}; use more \
                 increments, or leave `increments` out to follow the path to its end"
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
                "the contact jumped to another state before t = {time}: its area changed from {a:.6} to {:.6}; \
                 `events` in the step locates the jump",
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
        known: Option<&PathPoint<Z>>,
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
            AreaController::begin(planned, from[1], area(&statement.at(statement.increments()[0].range[0])))
        });
        let saved = engine.save();
        let found = seeker.advance(planned, from, &mut |time| {
            engine.restore(saved.clone());
            look(engine, time)
        });
        engine.restore(saved);
        self.seeker = Some(seeker);
        // A value that is none beyond some time may be why.
        let why = |why: String| invalid.map_or(why.clone(), |error| format!("{why}; before it: {error}"));
        found.map(|time| (time, solves)).map_err(why)
    }

    /// Leads from a state towards a time at which no state was found, by smaller increments that are cut as they need;
    /// tells the equilibrium solves it took, or none where that does not help either.
    fn approach(&mut self, index: usize, from: &PathPoint<Z>, time: f64, progress: &mut dyn Progress) -> Option<usize> {
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
        known: Option<&PathPoint<Z>>,
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
                    return Along::Failed("there is no initial state".into());
                };
                match ArcLengthControl::begin(&*self.statement, planned, zone, time, scales) {
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
    fn advance(&mut self, index: usize, progress: &mut dyn Progress) -> (Advanced<D>, Messages<D>) {
        let advanced = self.step(index, progress);
        let told = Messages { remarks: std::mem::take(&mut self.remarks), events: std::mem::take(&mut self.events) };
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
            k => Some(PathPoint {
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
