//! Winches and pulleys of ropes.

use super::Wrong;
use crate::plan::planner::Planner;
use crate::problem::units::LENGTH;
use crate::problem::{CaseError, Rope, RopeEnd, Value, Winch};
use signorini_geometry::Point;
use signorini_mechanics::Body;
use signorini_rope::chain::Chain;
use signorini_rope::chain::winch::WinchEnd;
use std::sync::Arc;

/// Times between two increments at which it is looked how much rope a winch pays out.
const BETWEEN: usize = 20;
/// How far a pulley may be from a node, as a part of the length of the rope: rounding of what is stated.
const SAME: f64 = 1e-6;

impl Planner<'_> {
    /// A rope with the pulleys and the winch that are stated.
    pub(super) fn wound(&self, name: &str, key: &Rope, chain: Chain, wrong: &Wrong) -> Result<Chain, CaseError> {
        let chain = match &key.pulleys {
            Some(list) => {
                let nodes = list.iter().map(|point| self.pulley(point, &chain)).collect::<Result<Vec<_>, _>>()?;
                chain.with_pulleys(&nodes).map_err(|e| {
                    self.problem
                        .error(list, e.to_string())
                        .help("give points between the ends, with rope on both sides of each")
                })?
            }
            None => chain,
        };
        match &key.winch {
            Some(winch) => self.winch(name, winch, chain, wrong),
            None => Ok(chain),
        }
    }

    /// The node of a rope that is a pulley.
    fn pulley(&self, point: &crate::problem::List<Value>, chain: &Chain) -> Result<usize, CaseError> {
        let x = self.position(point, LENGTH)?;
        let start = chain.start();
        let node = |k: usize| -> Point<3> { chain.position(&start, k) };
        let distance = |k: &usize| (node(*k) - x).norm();
        let nearest = (0..=chain.elements()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
        if distance(&nearest) > SAME * chain.size() {
            let at: Vec<String> = node(nearest).iter().map(|v| format!("{v:.6}")).collect();
            let message = format!("the rope has no node there; the nearest one is at ({})", at.join(", "));
            return Err(self
                .problem
                .error(point, message)
                .help("give a corner of  path.points, or the position of this node"));
        }
        Ok(nearest)
    }

    fn winch(&self, name: &str, key: &Winch, chain: Chain, wrong: &Wrong) -> Result<Chain, CaseError> {
        let problem = self.problem;
        let (at, end) = match key.at {
            RopeEnd::Start => (WinchEnd::Start, "start"),
            RopeEnd::End => (WinchEnd::End, "end"),
        };
        let holds = |on: &str| {
            on.split_once(':').is_some_and(|(b, g)| b.trim() == name && [end, "boundary"].contains(&g.trim()))
        };
        let is_free = |v: &Value| matches!(v, Value::Text(text) if text.trim() == "free");
        let held = problem
            .supports
            .values()
            .any(|s| holds(&s.on) && s.displacement.as_ref().is_some_and(|d| !d.0.iter().any(is_free)));
        if !held {
            return Err(problem
                .error(&key.at, format!("the {end} of `{name}` has a winch but no support"))
                .help(format!("[supports.winch]  on = \"{name}:{end}\"  displacement = [0, 0, 0]")));
        }
        let field = self.field(&key.length, LENGTH, wrong)?;
        let zero = Point::<3>::zeros();
        let (mut most, mut least, mut before) = (0.0f64, 0.0f64, 0.0);
        for time in self.system_increments()?.times {
            for k in 1..=BETWEEN {
                let out = field(&zero, before + (time - before) * k as f64 / BETWEEN as f64);
                (most, least) = (most.max(out), least.min(out));
            }
            before = time;
        }
        if let Some(error) = wrong.take(problem) {
            return Err(error);
        }
        let start = chain.start();
        let whole: f64 = (0..chain.elements()).map(|e| chain.unstrained_length(&start, e)).sum();
        let cell = whole / chain.elements() as f64;
        if whole + least < 0.5 * cell {
            let message = format!("{:.4} of rope are taken in, but only {whole:.4} are paid out", -least);
            return Err(problem.error(&key.length, message).help("leave at least half a cell of rope"));
        }
        let paid_out = Arc::new(move |t: f64| field(&zero, t));
        chain.with_winch(at, most, paid_out).map_err(|e| problem.error(key, e.to_string()))
    }
}
