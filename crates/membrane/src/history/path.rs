//! Increments along a path of equilibria, given by its arc length or by the area of contact.

use super::statement::{Control, PlannedIncrement, Statement};
use crate::coexisting::zone_of_area;
use crate::continuation::{Constraint, Path, PathState};
use crate::problem::Membrane;
use crate::quadrature::area;
use crate::scales::Scales;
use crate::zone::Zone;
use signorini_solve::{Progress, SolveError};

/// Halvings of an increment before the path is given up.
const MOST_HALVINGS: i32 = 7;

/// Where a path stands within its step.
pub struct ArcLengthControl<const D: usize, Z> {
    pub step: usize,
    /// The last state; none before the first where the membrane is free.
    state: Option<PathState<D, Z>>,
    /// Area and time at the beginning of the step.
    begin: [f64; 2],
    /// Scales of area and time.
    size: [f64; 2],
    scales: Scales,
    /// Whether the step has come to its end.
    pub done: bool,
}

/// What came of an increment.
pub enum Along<const D: usize, Z> {
    State {
        zone: Z,
        /// The membrane on the cells that the zone was found on.
        cells: Box<Membrane<D>>,
        time: f64,
        solves: usize,
    },
    /// The path ends here, for a reason.
    Ended(String),
    Failed(String),
}

impl<const D: usize, Z: Zone<D>> ArcLengthControl<D, Z> {
    /// Begins a step at a state of equilibrium, or at a free membrane.
    pub fn begin(
        statement: &dyn Statement<D>,
        planned: &PlannedIncrement,
        zone: Z,
        time: f64,
        scales: Scales,
    ) -> Result<Self, SolveError> {
        let [from, to] = planned.range;
        let size = [area(&statement.at(statement.increments()[0].range[0])), to - from];
        let path = Path { membrane: &|t| statement.at(t), refinement: statement.refinement(), scales, size };
        let state = if zone.is_empty() { None } else { Some(path.begin(zone, time, (to - time).signum())?) };
        let area = state.as_ref().map_or(0.0, |s| s.area);
        Ok(Self { step: planned.step, state, begin: [area, time], size, scales, done: false })
    }

    /// One increment on.
    pub fn advance(
        &mut self,
        statement: &dyn Statement<D>,
        planned: &PlannedIncrement,
        progress: &dyn Progress,
    ) -> Result<Along<D, Z>, SolveError> {
        let (scales, size) = (self.scales, self.size);
        let path = Path { membrane: &|t| statement.at(t), refinement: statement.refinement(), scales, size };
        match planned.control {
            Control::ArcLength(size) => self.by_arc_length(&path, size, planned.range[1], progress),
            Control::Area { to, part, parts } => {
                let target = self.begin[0] + (to - self.begin[0]) * part as f64 / parts as f64;
                self.by_area(&path, target, (to - self.begin[0]).signum(), progress)
            }
            Control::Time => Ok(Along::Failed("the time is given".into())),
        }
    }

    fn by_area(
        &mut self,
        path: &Path<'_, D>,
        target: f64,
        sense: f64,
        progress: &dyn Progress,
    ) -> Result<Along<D, Z>, SolveError> {
        let mut total = 0;
        let mut part = 1.0;
        for _ in 0..1 << MOST_HALVINGS {
            let from = self.state.as_ref().map_or(0.0, |s| s.area);
            let value = if part < 1.0 { from + part * (target - from) } else { target };
            let constraint = Constraint { weights: [1.0, 0.0], value };
            let (zone, time) = match &self.state {
                Some(state) => path.predict(state, &constraint),
                None => match zone_of_area(&(path.membrane)(self.begin[1]), target)? {
                    Some(zone) => (zone, self.begin[1]),
                    None => return Ok(Along::Failed(format!("no initial zone of the area {target} was found"))),
                },
            };
            let (found, solves) = path.correct(zone, time, constraint, [sense, 0.0], progress)?;
            total += solves;
            match found {
                Some(state) if value == target => return Ok(self.accept(state, total)),
                Some(state) => {
                    self.state = Some(state);
                    part = (2.0 * part).min(1.0);
                }
                None if self.state.is_none() || progress.interrupted() => break,
                None => part *= 0.5,
            }
            if part < 0.5f64.powi(MOST_HALVINGS) {
                break;
            }
        }
        Ok(Along::Failed(format!("no equilibrium with a contact area of {target} was found")))
    }

    fn by_arc_length(
        &mut self,
        path: &Path<'_, D>,
        size: f64,
        to: f64,
        progress: &dyn Progress,
    ) -> Result<Along<D, Z>, SolveError> {
        let Some(state) = self.state.clone() else {
            return Ok(Along::Failed(
                "control.arc_length begins at a state with contact: use a step with time or area control before it, \
                 or `initial_zone`"
                    .into(),
            ));
        };
        let mut ds = size;
        let mut total = 0;
        let mut vanishing = false;
        for _ in 0..MOST_HALVINGS {
            let constraint = path.constraint(&state, ds);
            let (zone, time) = path.predict(&state, &constraint);
            vanishing = zone.is_empty();
            let (found, solves) = path.correct(zone, time, constraint, state.tangent, progress)?;
            total += solves;
            if let Some(next) = found {
                if (next.time - to) * (state.time - to) > 0.0 {
                    return Ok(self.accept(next, total));
                }
                // The last increment ends where the step does.
                let constraint = Constraint { weights: [0.0, 1.0], value: to };
                let (zone, time) = path.predict(&state, &constraint);
                let (last, solves) = path.correct(zone, time, constraint, next.tangent, progress)?;
                self.done = true;
                return Ok(self.accept(last.unwrap_or(next), total + solves));
            }
            ds *= 0.5;
        }
        let (area, time) = (state.area, state.time);
        Ok(if vanishing || (state.tangent[0] < 0.0 && area < 0.5 * size * self.size[0]) {
            Along::Ended(format!("the path ends near t = {time}, where the zone, of area {area}, vanishes"))
        } else {
            Along::Failed(format!("the path was lost after t = {time}, at a contact area of {area}"))
        })
    }

    /// Why the path ends where it is, once its last state turned out to be none.
    pub fn ends(&self) -> String {
        let (time, area) = self.state.as_ref().map_or((f64::NAN, f64::NAN), |state| (state.time, state.area));
        format!(
            "the path ends near t = {time}, at a contact area of {area}: beyond this point the membrane would \
             penetrate a body elsewhere, or lose its support"
        )
    }

    fn accept(&mut self, state: PathState<D, Z>, solves: usize) -> Along<D, Z> {
        let (zone, cells, time) = (state.zone.clone(), Box::new(state.cells.clone()), state.time);
        self.state = Some(state);
        Along::State { zone, cells, time, solves }
    }
}
