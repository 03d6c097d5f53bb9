//! The times of a membrane's history, and where they lie on the path of what drives it.

use super::MembranePlan;
use crate::expression::Scope;
use signorini_membrane::history::{Control, PlannedIncrement};

/// Points at which is looked what drives a membrane, and how far from a straight line its path may be.
const DRIVEN_AT: usize = 9;
const STRAIGHT: f64 = 1e-9;

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
