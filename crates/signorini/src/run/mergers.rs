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

use super::events::{Between, Event, Known, Part, bridges_closed, differences, parts};
use signorini_fem::Grid;
use signorini_geometry::Point;
use signorini_membrane::zone::Zone;

/// States looked at.
const MOST_STATES: usize = 12;
/// States that could not be solved for before it is given up to come nearer.
const MOST_FAILURES: usize = 3;
/// States of each side through which is extrapolated.
const TRAIL: usize = 3;
/// How near the next state is to the merger, relative to the last one.
const NEARER: f64 = 0.5;

/// What came out.
pub enum Merger<Z> {
    /// All events between, located.
    Located(Vec<Event>),
    /// Something else happens as well: a state with other zones than those before and after.
    Other(Known<Z>),
    /// These are no mergers, or they follow no law.
    Unknown,
}

/// Two parts that have come near each other: the tips.
#[derive(Clone, Debug)]
pub struct Bridge<const D: usize> {
    pub tips: [Point<D>; 2],
}

impl<const D: usize> Bridge<D> {
    pub fn middle(&self) -> Point<D> {
        (self.tips[0] + self.tips[1]) * 0.5
    }

    pub fn length(&self) -> f64 {
        (self.tips[0] - self.tips[1]).norm()
    }
}

/// The states of one side of the merger, the nearest last.
struct Trail<Z> {
    states: Vec<Known<Z>>,
    /// No nearer state could be found.
    exhausted: bool,
}

impl<Z> Trail<Z> {
    fn nearest(&self) -> &Known<Z> {
        &self.states[self.states.len() - 1]
    }

    /// The last states; none while there are too few.
    fn last(&self) -> Option<&[Known<Z>]> {
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
fn at_zero(points: &[(f64, f64)]) -> f64 {
    let others = |k: usize| points.iter().enumerate().filter(move |(j, _)| *j != k).map(|(_, p)| p.0);
    points.iter().enumerate().map(|(k, (m, t))| t * others(k).map(|o| o / (o - m)).product::<f64>()).sum()
}

/// Locates mergers, or partings, between two states that differ by nothing else. `solve` looks at a time between, from the
/// first of two zones.
pub fn locate<const D: usize, Z: Zone<D>>(
    grid: &Grid<D>,
    a: &Known<Z>,
    b: &Known<Z>,
    tolerance: f64,
    solve: &mut dyn FnMut(f64, [&Z; 2]) -> Between<Z>,
) -> Merger<Z> {
    let found = differences(grid, a, b);
    let all = |kind: &str, hole: &str| {
        found.iter().any(|e| e.kind == kind) && found.iter().all(|e| e.kind == kind || e.kind == hole)
    };
    let merge = match (all("merge", "hole_opened"), all("split", "hole_closed")) {
        (true, _) => true,
        (_, true) => false,
        _ => return Merger::Unknown,
    };
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
            Between::State(state) => match counts.iter().position(|c| *c == state.zone.counts()) {
                Some(side) => trails[side].states.push(state),
                None => return Merger::Other(state),
            },
            Between::AsEarlier | Between::AsLater | Between::Unknown => {
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
    let bridges = bridges_closed(grid, &apart.zone, &joined.zone);
    for event in &mut events {
        let at = Point::<D>::from_fn(|k, _| event.at[k]);
        let nearest = (0..bridges.len())
            .min_by(|&i, &j| (bridges[i].middle() - at).norm().total_cmp(&(bridges[j].middle() - at).norm()));
        // A hole is there as soon as the last neck is, and as long as the first is not gone.
        let hole = known.iter().copied().reduce(|x, y| if (x[0] + x[1] < y[0] + y[1]) == merge { y } else { x });
        let own = if event.kind.starts_with("hole") { hole } else { nearest.map(|k| known[k]) };
        let Some([low, high]) = own else { continue };
        event.time = (0.5 * (low + high)).clamp(before.time, after.time);
        // Estimates that agree by chance say no more than was asked for.
        event.within = (2.0 * (high - low)).max(tolerance).min(bracket);
        event.by = "extrapolation";
    }
    Merger::Located(events)
}

/// The shortest way between each pair of parts.
fn between_pairs<const D: usize>(parts: &[Part<D>]) -> Vec<Bridge<D>> {
    (1..parts.len()).flat_map(|j| (0..j).filter_map(move |i| nearest(&parts[i], &parts[j]))).collect()
}

/// For every bridge the least and the greatest of the times at which its length and the width of its neck vanish.
fn estimates<const D: usize, Z: Zone<D>>(grid: &Grid<D>, trails: &[Trail<Z>; 2], merge: bool) -> Option<Vec<[f64; 2]>> {
    let [apart, joined] = if merge { [&trails[0], &trails[1]] } else { [&trails[1], &trails[0]] };
    let (apart, joined) = (apart.last()?, joined.last()?);
    let list = bridges_closed(grid, &apart[TRAIL - 1].zone, &joined[TRAIL - 1].zone);
    let pairs: Vec<Vec<Bridge<D>>> = apart.iter().map(|state| between_pairs(&parts(grid, &state.zone))).collect();
    let of_bridge = |bridge: &Bridge<D>| {
        // The same bridge in the other states.
        let open = |list: &Vec<Bridge<D>>| {
            let off = |b: &Bridge<D>| (b.middle() - bridge.middle()).norm();
            let same = list.iter().min_by(|x, y| off(x).total_cmp(&off(y)))?;
            (off(same) < 0.5 * same.length()).then(|| same.length().powi(2))
        };
        let opened: Vec<(f64, f64)> =
            pairs.iter().zip(apart).map(|(list, s)| Some((open(list)?, s.time))).collect::<Option<_>>()?;
        let closed: Vec<(f64, f64)> =
            joined.iter().map(|s| Some((neck(&s.zone, bridge)?, s.time))).collect::<Option<_>>()?;
        let all = vanishes(&opened)?.into_iter().chain(vanishes(&closed)?);
        Some(all.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], t| [l.min(t), h.max(t)]))
    };
    list.iter().map(of_bridge).collect::<Option<Vec<_>>>().filter(|list| !list.is_empty())
}

/// The width of the neck of a zone where there was a bridge.
fn neck<const D: usize, Z: Zone<D>>(zone: &Z, bridge: &Bridge<D>) -> Option<f64> {
    let (middle, length) = (bridge.middle(), bridge.length());
    let along = (bridge.tips[1] - bridge.tips[0]) / length;
    let mut sides: [Vec<Vec<Point<D>>>; 2] = Default::default();
    for outline in zone.outlines() {
        // The pieces of the outline beside the line between the tips.
        let mut last = None;
        for p in outline {
            let from = p - middle;
            let s = from.dot(&along);
            let beside = (s.abs() <= length && from.norm() <= 2.0 * length).then(|| {
                let across = from - along * s;
                usize::from(across[D - 1] * along[0] - across[0] * along[D - 1] > 0.0)
            });
            if let Some(side) = beside {
                if last != beside {
                    sides[side].push(Vec::new());
                }
                if let Some(piece) = sides[side].last_mut() {
                    piece.push(p);
                }
            }
            last = beside;
        }
    }
    nearest(&sides[0], &sides[1]).map(|b| b.length())
}

/// The nearest points of two sets of outlines.
pub fn nearest<const D: usize>(a: &[Vec<Point<D>>], b: &[Vec<Point<D>>]) -> Option<Bridge<D>> {
    let mut best: Option<(f64, Bridge<D>)> = None;
    for (points, others, swapped) in [(a, b, false), (b, a, true)] {
        for p in points.iter().flatten() {
            for ends in others.iter().flat_map(|o| o.windows(2)) {
                let d = ends[1] - ends[0];
                let s = ((p - ends[0]).dot(&d) / d.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
                let q = ends[0] + d * s;
                let square = (p - q).norm_squared();
                if best.as_ref().is_none_or(|(least, _)| square < *least) {
                    best = Some((square, Bridge { tips: if swapped { [q, *p] } else { [*p, q] } }));
                }
            }
        }
    }
    best.map(|(_, bridge)| bridge)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parabolas_and_lines_vanish_where_they_do() {
        let t = |m: f64| 0.3 - 0.7 * m + 0.2 * m * m;
        let points: Vec<(f64, f64)> = [0.4, 0.3, 0.1].iter().map(|m| (*m, t(*m))).collect();
        assert!((at_zero(&points) - 0.3).abs() < 1e-15);
        assert!((at_zero(&points[1..]) - 0.3).abs() < 0.01);
    }

    #[test]
    fn the_nearest_points_of_outlines_lie_within_their_pieces() {
        let p = |x: f64, y: f64| Point::<2>::new(x, y);
        let a = [vec![p(0.0, 0.0), p(1.0, 0.0)]];
        let b = [vec![p(0.25, 3.0), p(0.4, 0.5), p(0.5, 3.0)]];
        for bridge in [nearest(&a, &b).unwrap(), nearest(&b, &a).unwrap()] {
            assert!((bridge.length() - 0.5).abs() < 1e-15 && (bridge.middle() - p(0.4, 0.25)).norm() < 1e-15);
        }
        assert!(nearest(&a, &[]).is_none());
    }
}
