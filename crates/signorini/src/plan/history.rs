//! The history of a case: its steps cut into increments, and what is given in each.

use super::{MembranePlan, Planner};
use crate::expression::Scope;
use crate::problem;
use crate::problem::CaseError;
use crate::problem::units::TIME;
use signorini_membrane::history::{Control, PlannedIncrement};

/// Points at which is looked what drives a membrane, and how far from a straight line its path may be.
const DRIVEN_AT: usize = 9;
const STRAIGHT: f64 = 1e-9;

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

impl Planner<'_> {
    /// The ends of all increments of a history in which time is given.
    pub(super) fn times(&self) -> Result<Vec<f64>, CaseError> {
        for step in &self.problem.steps {
            match &step.control {
                None | Some(problem::Control::Time(_)) => {}
                Some(control) => return Err(self.unavailable(control, "control of solids by arc length or area")),
            }
        }
        Ok(self.increments(0, &[])?.into_iter().map(|i| i.time).collect())
    }

    /// The increments of a membrane of a dimension, whose contacts have names.
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
                            let message = format!("with increments of {size} a path takes too many of them to its end");
                            return Err(self
                                .problem
                                .error(&arc.size, message)
                                .help("give the step `increments`, or make them larger: try 0.02"));
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
                let message = format!("{} is no tolerance of time", events);
                return Err(self.problem.error(events, message).help("a number greater than zero, such as 1e-3"));
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
        if let (true, problem::Control::ArcLength(_) | problem::Control::Area(_)) = (contacts.is_empty(), control) {
            return Err(self.problem.error(control, "there is no contact to control"));
        }
        match control {
            problem::Control::Time(_) => Ok(Control::Time),
            problem::Control::ArcLength(arc) => {
                let size = arc.size;
                if !(SHORTEST..=1.0).contains(&size) {
                    return Err(self
                        .problem
                        .error(&arc.size, format!("an increment of {size} is not between {SHORTEST} and 1"))
                        .help("1 is the area of the membrane, or the time that the step takes: try 0.02"));
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
                    return Err(self.unavailable(control, "control by the area of one contact of several"));
                }
                // On a line the area is a length; of a round membrane it is that of the disc.
                let power = if self.space == problem::Space::Line { 1 } else { 2 };
                let to = self.reader.number(&area.to, [power, 0, 0])?;
                if !(to > 0.0 && to.is_finite()) || dimension == 0 {
                    return Err(self.problem.error(&area.to, format!("an area of {to} is not positive")));
                }
                Ok(Control::Area { to, part, parts })
            }
        }
    }
}

impl<const D: usize> MembranePlan<D> {
    /// The times at which a run is sure to look at the membrane: the ends of the increments whose time is given, and the
    /// beginnings of the others; one where nothing depends on time.
    pub fn known_times(&self) -> Vec<f64> {
        let known = |i: &PlannedIncrement| if i.control == Control::Time { i.time } else { i.range[0] };
        let mut times: Vec<f64> = self.increments.iter().map(known).collect();
        times.dedup();
        if !self.expressions().any(|p| p.expression.uses_time()) {
            times.truncate(1);
        }
        times
    }

    /// Where times lie along the path of what drives the membrane, the values at a few points of all that depends on time;
    /// the times themselves where that path is no straight line.
    pub fn places(&self, times: &[f64]) -> Vec<f64> {
        let bounds = self.grid.bounds();
        // Fractions that no pattern of a load is likely to share.
        let fraction = |i: usize, k: usize| (i as f64 * [0.754_877_666_2, 0.569_840_291_0][k]).fract();
        let at = |i: usize, k: usize| if k < D { bounds.min[k] + fraction(i, k) * bounds.size()[k] } else { 0.0 };
        let points: Vec<[f64; 3]> = (1..=DRIVEN_AT).map(|i| std::array::from_fn(|k| at(i, k))).collect();
        let driving: Vec<_> = self.expressions().map(|p| &p.expression).filter(|e| e.uses_time()).collect();
        let values = |time: f64| -> Vec<f64> {
            let scopes = points.iter().map(|&position| Scope { position, time });
            scopes.flat_map(|scope| driving.iter().map(move |e| e.evaluate(&scope))).collect()
        };
        let Some(first) = times.first().map(|&t| values(t)) else { return Vec::new() };
        let way = |&time: &f64| values(time).iter().zip(&first).map(|(b, a)| b - a).collect::<Vec<_>>();
        let ways: Vec<Vec<f64>> = times.iter().map(way).collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let longest = ways.iter().max_by(|a, b| dot(a, a).total_cmp(&dot(b, b))).filter(|w| dot(w, w) > 0.0);
        let straight = longest.and_then(|line| {
            let square = dot(line, line);
            let place = |way: &Vec<f64>| {
                let place = dot(way, line) / square;
                let aside = way.iter().zip(line).map(|(w, l)| (w - place * l).abs()).fold(0.0, f64::max);
                (aside <= STRAIGHT * square.sqrt()).then_some(place)
            };
            ways.iter().map(place).collect()
        });
        straight.unwrap_or_else(|| times.to_vec())
    }
}
