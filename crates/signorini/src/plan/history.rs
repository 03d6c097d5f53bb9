//! The history of a case: its steps cut into increments, and what is given in each.

use super::planner::Planner;
use crate::problem;
use crate::problem::CaseError;
use crate::problem::units::TIME;
use signorini_membrane::history::{Control, PlannedIncrement};

/// The length of the longest path, in areas of the membrane and times of its step, and of the shortest increment on it.
const LONGEST: f64 = 10.0;
const SHORTEST: f64 = 1e-6;
/// Increments of a step.
const MOST_INCREMENTS: usize = 100_000;

/// A time without round-off: 0.4 is not 0.39999999999999997.
fn plain(time: f64, step: f64) -> f64 {
    let digits = 10f64.powi(13 - step.log10().ceil() as i32);
    let rounded = (time * digits).round() / digits;
    if rounded.is_finite() { rounded } else { time }
}

/// An increment along a path of equilibria of a system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcLengthIncrement {
    pub step: usize,
    /// In the scales of the path.
    pub length: f64,
    /// Beginning and end of the step.
    pub range: [f64; 2],
}

/// The increments of a system.
pub(super) struct SystemIncrements {
    /// Their ends as far as they are known before.
    pub times: Vec<f64>,
    /// Of those along a path of equilibria.
    pub arc_lengths: Vec<Option<ArcLengthIncrement>>,
    /// Time to which events are located.
    pub events: Vec<Option<f64>>,
    /// The step of each.
    pub steps: Vec<usize>,
}

impl Planner<'_> {
    /// The increments of a system.
    pub(super) fn system_increments(&self) -> Result<SystemIncrements, CaseError> {
        for step in &self.problem.steps {
            if let Some(control @ problem::Control::Area(_)) = &step.control {
                return Err(self.unavailable(control, "area control of solids"));
            }
        }
        let of = |planned: &PlannedIncrement| match planned.control {
            Control::ArcLength(length) => Some(ArcLengthIncrement { step: planned.step, length, range: planned.range }),
            _ => None,
        };
        let planned = self.increments(0, &[])?;
        Ok(SystemIncrements {
            times: planned.iter().map(|i| i.time).collect(),
            arc_lengths: planned.iter().map(of).collect(),
            events: planned.iter().map(|i| i.events).collect(),
            steps: planned.iter().map(|i| i.step).collect(),
        })
    }

    /// The increments of a membrane of a dimension, whose contacts have names; of a system of the dimension 0.
    pub(super) fn increments(&self, dimension: usize, contacts: &[&str]) -> Result<Vec<PlannedIncrement>, CaseError> {
        let mut out = Vec::new();
        let mut t = 0.0;
        for (step, key) in self.problem.steps.iter().enumerate() {
            let to = self.reader.number(&key.to, TIME)?;
            if to <= t {
                return Err(self.problem.error(&key.to, format!("the step ends at t = {to}, not after t = {t}")));
            }
            let n = match &key.increments {
                None => match key.control.as_ref() {
                    // As far as the path goes, which nobody knows before.
                    Some(problem::Control::ArcLength(arc)) => {
                        let size = arc.size;
                        if (SHORTEST..LONGEST / MOST_INCREMENTS as f64).contains(&size) {
                            let message =
                                format!("with increments of length {size} the path needs too many increments");
                            return Err(self
                                .problem
                                .error(&arc.size, message)
                                .help("give the number of `increments`, or increase the size; 0.02 is a good start"));
                        }
                        ((LONGEST / size) as usize).clamp(1, MOST_INCREMENTS)
                    }
                    _ => 1,
                },
                Some(n) if (1..=MOST_INCREMENTS as i64).contains(n) => *n as usize,
                Some(n) => {
                    return Err(self
                        .problem
                        .error(n, format!("{} increments: give a number from 1 to {MOST_INCREMENTS}", n)));
                }
            };
            let events = key.events;
            if let Some(events) = &key.events
                && !(*events > 0.0 && events.is_finite())
            {
                let message = format!("{} is not a valid time tolerance", events);
                return Err(self.problem.error(events, message).help("give a number greater than zero, such as 1e-3"));
            }
            for part in 1..=n {
                // The last time is exactly the stated one.
                let time = if part == n { to } else { plain(t + (to - t) * part as f64 / n as f64, to - t) };
                let control = self.control(key, dimension, contacts, part, n)?;
                out.push(PlannedIncrement { step, range: [t, to], time, control, events });
            }
            t = to;
        }
        if out.is_empty() {
            out.push(PlannedIncrement { step: 0, range: [0.0; 2], time: 0.0, control: Control::Time, events: None });
        }
        Ok(out)
    }

    fn control(
        &self,
        key: &problem::Step,
        dimension: usize,
        contacts: &[&str],
        part: usize,
        parts: usize,
    ) -> Result<Control, CaseError> {
        let Some(control) = &key.control else { return Ok(Control::Time) };
        let is_membrane = dimension > 0;
        if is_membrane && contacts.is_empty() && !matches!(control, problem::Control::Time(_)) {
            return Err(self.problem.error(control, "the case has no contact to control"));
        }
        match control {
            problem::Control::Time(_) => Ok(Control::Time),
            problem::Control::ArcLength(arc) => {
                let size = arc.size;
                if !(SHORTEST..=1.0).contains(&size) {
                    return Err(self
                        .problem
                        .error(&arc.size, format!("an increment of {size} is not between {SHORTEST} and 1"))
                        .help("1 is the area of the membrane or the extent of the bodies, and the duration of the step; 0.02 is a good start"));
                }
                Ok(Control::ArcLength(size))
            }
            problem::Control::Area(area) => {
                if !contacts.contains(&area.of.as_str()) {
                    return Err(self
                        .problem
                        .error(&area.of, format!("there is no contact `{}`", area.of))
                        .help(format!("of = \"{}\"", contacts.first().unwrap_or(&""))));
                }
                if contacts.len() > 1 {
                    return Err(self.unavailable(control, "area control of one of several contacts"));
                }
                // On a line the area is a length; of a round membrane it is that of the disc.
                let power = if self.space == problem::Space::Line { 1 } else { 2 };
                let to = self.reader.number(&area.to, [power, 0, 0, 0])?;
                if !(to > 0.0 && to.is_finite()) || dimension == 0 {
                    return Err(self.problem.error(&area.to, format!("an area of {to} is not positive")));
                }
                Ok(Control::Area { to, part, parts })
            }
        }
    }
}
