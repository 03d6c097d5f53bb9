//! Where fronts go on to, by the last states of a path.

use super::engine::Engine;
use super::statement::Statement;
use crate::multigrid::large::ByMultigrid;
use crate::problem::Membrane;

/// States that are kept to tell where a path goes on, how many of them do, and how far ahead at most, relative to the distance
/// between the nearest two.
const TRAIL: usize = 64;
const NEAREST: usize = 3;
const FARTHEST: f64 = 1.5;
/// States nearer than this part of an increment are at the same place.
const SAME: f64 = 1e-6;

impl<const D: usize, Z: ByMultigrid<D>> Engine<D, Z> {
    /// Where the fronts will be by the polynomial through the states nearest on the path of what drives them, and, to tell how
    /// true that is, by another one through one state less, or one more. Along a branch of equilibria the state depends on
    /// nothing else, and a path that turns comes by where it was.
    pub(super) fn ahead(
        &self,
        statement: &dyn Statement<D>,
        membrane: &Membrane<D>,
        time: f64,
    ) -> Option<(Z, Option<Z>)> {
        let times: Vec<f64> = self.trail.iter().map(|(t, _)| *t).chain([time]).collect();
        let places = statement.places(&times);
        let (next, states) = places.split_last()?;
        let counts = self.trail.last()?.1.counts();
        let alike = |k: &usize| self.trail[*k].1.counts() == counts;
        let mut near: Vec<usize> = (0..states.len()).rev().filter(alike).collect();
        near.sort_by(|&a, &b| (next - states[a]).abs().total_cmp(&(next - states[b]).abs()));
        near.truncate(NEAREST);
        let [from, second, ..] = near[..] else { return None };
        let step = (states[second] - states[from]).abs();
        let apart = |k: usize| near.iter().all(|&o| o == k || (states[o] - states[k]).abs() > SAME * step);
        if (next - states[from]).abs() > FARTHEST * step || !near.iter().all(|&k| apart(k)) {
            return None;
        }
        let through = |near: &[usize]| {
            let weight = |k: usize| {
                let others = near.iter().filter(|&&o| o != k);
                others.map(|&o| (next - states[o]) / (states[k] - states[o])).product::<f64>()
            };
            let multiples: Vec<(&Z, f64)> = near[1..].iter().map(|&k| (&self.trail[k].1, -weight(k))).collect();
            self.trail[from].1.extrapolated(&membrane.grid, &multiples)
        };
        let ahead = through(&near)?;
        // Nobody asks on a line.
        let rough = if D == 2 { through(&near[..near.len() - 1]) } else { None };
        // Short waves on fronts of degree 1, which come and go with the cells, grow with the degree of the polynomial.
        Some(match rough {
            Some(rough) if near.len() == NEAREST && membrane.cells.degree() == 1 => (rough, Some(ahead)),
            rough => (ahead, rough),
        })
    }

    /// Keeps a state as one of those that tell where the path goes on. A place that was there before is told again.
    pub(super) fn remember(&mut self, statement: &dyn Statement<D>, time: f64, zone: &Z) {
        if zone.is_empty() {
            return;
        }
        let times: Vec<f64> = self.trail.iter().map(|(t, _)| *t).chain([time]).collect();
        if let [states @ .., last] = statement.places(&times).as_slice() {
            let step = states.last().map_or(0.0, |s| (last - s).abs());
            let mut places = states.iter();
            self.trail.retain(|(_, known)| {
                let near = places.next().is_some_and(|p| (p - last).abs() <= SAME * step);
                !near || known.counts() != zone.counts()
            });
        }
        if self.trail.len() == TRAIL {
            self.trail.remove(0);
        }
        self.trail.push((time, zone.clone()));
    }
}
