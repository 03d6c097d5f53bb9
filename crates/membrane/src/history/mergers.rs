//! When zones merge or part, told from both sides.
//!
//! Before two zones merge they grow tips towards each other that are sharper than any cell, and after it the neck between
//! them is thinner than any: no state close by can be solved for, and halving an increment comes to nothing. But what
//! happens there is known. The tips and the neck are thin, and act on the membrane as a force along their line; that
//! force is where a membrane with a thin obstacle touches it. As the load differs by `ε` from that of the merger, its
//! density in the middle is linear in `ε`, negative at the side of the tips, where it opens over a distance `δ ~ √|ε|`,
//! positive at the other, where it is the pressure times the width `w ~ ε` of the neck (the cusps of D. G. Schaeffer, Some
//! examples of singularities in a free boundary, Ann. Sc. Norm. Super. Pisa 4 (1977) 133). So `δ²` from states before,
//! and `w` from states after, both tell the load at which they vanish; how far they differ tells how well it is known.

use super::bridge::Bridge;
use super::differences::differences;
use super::event::{Event, EventKind, LocatedBy};
use super::parts::{bridges_closed, mouths_closed};
use super::path_point::{PathPoint, Trial};
use crate::zone::Zone;
use signorini_fem::Grid;

/// States looked at.
const MOST_STATES: usize = 12;
/// States that could not be solved for before it is given up to come nearer.
const MOST_FAILURES: usize = 3;
/// States of each side through which is extrapolated.
const TRAIL: usize = 3;
/// How near the next state is to the merger, relative to the last one.
const NEARER: f64 = 0.5;

/// What came out.
pub enum Merger<const D: usize, Z> {
    /// All events between, located.
    Located(Vec<Event<D>>),
    /// Something else happens as well: a state with other zones than those before and after.
    Other(PathPoint<Z>),
    /// These are no mergers, or they follow no law.
    Unknown,
}

/// The states of one side of the merger, the nearest last.
struct Trail<Z> {
    states: Vec<PathPoint<Z>>,
    /// No nearer state could be found.
    exhausted: bool,
}

impl<Z> Trail<Z> {
    fn nearest(&self) -> &PathPoint<Z> {
        &self.states[self.states.len() - 1]
    }

    /// The last states; none while there are too few.
    fn last(&self) -> Option<&[PathPoint<Z>]> {
        Some(&self.states[self.states.len().checked_sub(TRAIL)?..])
    }
}

/// When a measure of some states vanishes, linearly in time or nearly so: by the line through the last two, and by the
/// parabola through all three.
fn vanishes(known: &[(f64, f64)]) -> Option<[f64; 2]> {
    // Each nearer than the one before, or there is no law.
    known.windows(2).all(|w| w[1].0 < w[0].0).then(|| [at_zero(&known[1..]), at_zero(known)])
}

/// The polynomial through points, at zero.
pub fn at_zero(points: &[(f64, f64)]) -> f64 {
    let others = |k: usize| points.iter().enumerate().filter(move |(j, _)| *j != k).map(|(_, p)| p.0);
    points.iter().enumerate().map(|(k, (m, t))| t * others(k).map(|o| o / (o - m)).product::<f64>()).sum()
}

/// Locates mergers, or partings, between two states that differ by nothing else. `solve` looks at a time between, from the
/// first of two zones.
pub fn locate<const D: usize, Z: Zone<D>>(
    grid: &Grid<D>,
    a: &PathPoint<Z>,
    b: &PathPoint<Z>,
    tolerance: f64,
    solve: &mut dyn FnMut(f64, [&Z; 2]) -> Trial<Z>,
) -> Merger<D, Z> {
    let found = differences(grid, a, b);
    let all =
        |kind: EventKind, hole: EventKind| !found.is_empty() && found.iter().all(|e| e.kind == kind || e.kind == hole);
    let merge = match (all(EventKind::Merge, EventKind::HoleOpened), all(EventKind::Split, EventKind::HoleClosed)) {
        (true, _) => true,
        (_, true) => false,
        _ => return Merger::Unknown,
    };
    let [apart, joined] = if merge { [&a.zone, &b.zone] } else { [&b.zone, &a.zone] };
    if bridges(grid, apart, joined).is_none() {
        return Merger::Unknown;
    }
    let counts = [a.zone.counts(), b.zone.counts()];
    let mut trails = [a, b].map(|state| Trail { states: vec![state.clone()], exhausted: false });
    let mut failed: Vec<f64> = Vec::new();
    for _ in 0..MOST_STATES {
        let [from, to] = [0, 1].map(|k: usize| trails[k].nearest().time);
        if to - from <= tolerance {
            break;
        }
        let known = estimates(grid, &trails, merge);
        if let Some(known) = &known
            && known.iter().all(|[low, high]| 2.0 * (high - low) <= tolerance)
        {
            break;
        }
        // Nearer on the side that is farther away; until the laws say where to look in the middle, or beside what could not
        // be solved for, on the side that has fewer states.
        let (near, time) = match &known {
            Some(known) => {
                let [low, high] = known
                    .iter()
                    .fold([to, from], |[l, h], [low, high]| [low.clamp(from, to).min(l), high.clamp(from, to).max(h)]);
                let side = if trails[0].exhausted || (!trails[1].exhausted && to - high > low - from) { 1 } else { 0 };
                (side, if side == 0 { low - NEARER * (low - from) } else { high + NEARER * (to - high) })
            }
            None => {
                let side = usize::from(!failed.is_empty() && trails[1].states.len() < trails[0].states.len());
                let least = failed.iter().copied().fold(to, f64::min);
                let greatest = failed.iter().copied().fold(from, f64::max);
                (side, if side == 0 { 0.5 * (from + least) } else { 0.5 * (greatest + to) })
            }
        };
        if trails[near].exhausted || !(from < time && time < to) {
            break;
        }
        match solve(time, [&trails[near].nearest().zone, &trails[1 - near].nearest().zone]) {
            Trial::State(state) => match counts.iter().position(|c| *c == state.zone.counts()) {
                Some(side) => trails[side].states.push(state),
                None => return Merger::Other(state),
            },
            Trial::AsEarlier | Trial::AsLater | Trial::Unknown => {
                failed.push(time);
                trails[near].exhausted = known.is_some();
                if failed.len() == MOST_FAILURES {
                    break;
                }
            }
        }
    }
    let [before, after] = [trails[0].nearest(), trails[1].nearest()];
    let mut events = differences(grid, before, after);
    let bracket = after.time - before.time;
    let Some(known) = estimates(grid, &trails, merge).filter(|_| bracket > tolerance) else {
        return if bracket <= tolerance { Merger::Located(events) } else { Merger::Unknown };
    };
    let (apart, joined) = if merge { (before, after) } else { (after, before) };
    let bridges = bridges(grid, &apart.zone, &joined.zone).unwrap_or_default();
    let of_zones = events.iter().any(|e| !e.kind.is_of_hole());
    for event in &mut events {
        let at = event.at;
        let nearest = (0..bridges.len())
            .min_by(|&i, &j| (bridges[i].middle() - at).norm().total_cmp(&(bridges[j].middle() - at).norm()));
        // A hole between zones is there as soon as the last neck is, and as long as the first is not gone.
        let hole = known.iter().copied().reduce(|x, y| if (x[0] + x[1] < y[0] + y[1]) == merge { y } else { x });
        let own = if of_zones && event.kind.is_of_hole() { hole } else { nearest.map(|k| known[k]) };
        let Some([low, high]) = own else { continue };
        event.time = (0.5 * (low + high)).clamp(before.time, after.time);
        // Estimates that agree by chance say no more than was asked for.
        event.within = (2.0 * (high - low)).max(tolerance).min(bracket);
        event.by = LocatedBy::Extrapolation;
    }
    Merger::Located(events)
}

/// The ways between zones, or between two places of one zone, that a merger closes; none where a hole is none of them.
fn bridges<const D: usize, Z: Zone<D>>(grid: &Grid<D>, apart: &Z, joined: &Z) -> Option<Vec<Bridge<D>>> {
    let between = bridges_closed(grid, apart, joined);
    let all = if between.is_empty() { mouths_closed(grid, apart, joined)? } else { between };
    (!all.is_empty()).then_some(all)
}

/// For every bridge the least and the greatest of the times at which its length and the width of its neck vanish.
fn estimates<const D: usize, Z: Zone<D>>(grid: &Grid<D>, trails: &[Trail<Z>; 2], merge: bool) -> Option<Vec<[f64; 2]>> {
    let [apart, joined] = if merge { [&trails[0], &trails[1]] } else { [&trails[1], &trails[0]] };
    let (apart, joined) = (apart.last()?, joined.last()?);
    let list = bridges(grid, &apart[TRAIL - 1].zone, &joined[TRAIL - 1].zone)?;
    let of_bridge = |bridge: &Bridge<D>| {
        let measured = |list: &[PathPoint<Z>], measure: &dyn Fn(&Z) -> Option<f64>| {
            list.iter().map(|s| Some((measure(&s.zone)?, s.time))).collect::<Option<Vec<_>>>()
        };
        let opened = measured(apart, &|zone| Some(bridge.between(zone)?.length().powi(2)))?;
        let closed = measured(joined, &|zone| Some(bridge.neck(zone)?.length()))?;
        let all = vanishes(&opened)?.into_iter().chain(vanishes(&closed)?);
        Some(all.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], t| [l.min(t), h.max(t)]))
    };
    list.iter().map(of_bridge).collect()
}
