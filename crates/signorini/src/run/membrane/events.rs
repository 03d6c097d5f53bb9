//! Changes of topology along a load path: which, where, and at what load.
//!
//! An increment between whose ends the numbers of zones or holes differ is halved until the change lies within the
//! tolerance that its step states; [`mergers`] have their own way. A zone that comes and another that goes within one increment, or a zone that comes and
//! goes, are seen only if the ends of a part differ.

use super::mergers::{self, Bridge, Merger, nearest};
use crate::report::{Event, EventKind, LocatedBy, vector};
use signorini_fem::Grid;
use signorini_geometry::Point;
use signorini_membrane::obstacle::Side;
use signorini_membrane::zone::{Zone, contact_index, is_free};
use signorini_solve::{Iteration, Progress};

/// A state on the path.
#[derive(Clone)]
pub struct Known<Z> {
    pub time: f64,
    pub zone: Z,
    pub area: f64,
    /// Force of the floor on the membrane along z.
    pub force: f64,
    pub energy_total: f64,
    /// How far an adhesive state is from its loss.
    pub margin: Option<f64>,
}

/// Equilibrium solves that one time between may take: beside a merger, where fronts nearly touch, a state may take
/// hundreds.
const MOST_SOLVES: usize = 100;

/// A progress that asks to stop after [`MOST_SOLVES`].
pub struct Bounded<'a> {
    pub inner: &'a mut dyn Progress,
    pub solves: usize,
}

impl Progress for Bounded<'_> {
    fn iteration(&mut self, iteration: &Iteration) {
        self.solves += 1;
        self.inner.iteration(iteration);
    }
    fn interrupted(&self) -> bool {
        self.solves >= MOST_SOLVES || self.inner.interrupted()
    }
}

/// What a time between two others has.
pub enum Between<Z> {
    State(Known<Z>),
    /// Contact as at the earlier or the later time, in zones smaller than the grid can tell.
    AsEarlier,
    AsLater,
    Unknown,
}

/// Halvings towards a time that could not be solved for, from either side.
const MOST_HALVINGS: usize = 5;

/// Finds the events between two times. `solve` looks at a time between, knowing the zones before and after; where it finds
/// nothing the events are known to that interval.
pub fn locate<const D: usize, Z: Zone<D>>(
    grid: &Grid<D>,
    a: &Known<Z>,
    b: &Known<Z>,
    tolerance: f64,
    solve: &mut dyn FnMut(f64, [&Z; 2]) -> Between<Z>,
    out: &mut Vec<Event>,
) {
    if a.zone.counts() == b.zone.counts() {
        return;
    }
    if D > 1 && b.time - a.time > tolerance {
        match mergers::locate(grid, a, b, tolerance, solve) {
            Merger::Located(events) => return out.extend(events),
            Merger::Other(middle) => {
                locate(grid, a, &middle, tolerance, solve, out);
                return locate(grid, &middle, b, tolerance, solve, out);
            }
            Merger::Unknown => {}
        }
    }
    if b.time - a.time <= tolerance {
        return out.extend(differences(grid, a, b));
    }
    let time = 0.5 * (a.time + b.time);
    match solve(time, [&a.zone, &b.zone]) {
        Between::AsLater => locate(grid, a, &Known { time, ..b.clone() }, tolerance, solve, out),
        Between::AsEarlier => locate(grid, &Known { time, ..a.clone() }, b, tolerance, solve, out),
        Between::State(middle) => {
            locate(grid, a, &middle, tolerance, solve, out);
            locate(grid, &middle, b, tolerance, solve, out);
        }
        Between::Unknown => {
            let (mut low, mut high, mut later) = (a.clone(), b.clone(), Vec::new());
            for _ in 0..MOST_HALVINGS {
                let Between::State(state) = solve(0.5 * (low.time + time), [&low.zone, &high.zone]) else { break };
                locate(grid, &low, &state, tolerance, solve, out);
                low = state;
            }
            for _ in 0..MOST_HALVINGS {
                let Between::State(state) = solve(0.5 * (time + high.time), [&high.zone, &low.zone]) else { break };
                let mut found = Vec::new();
                locate(grid, &state, &high, tolerance, solve, &mut found);
                later.splice(0..0, found);
                high = state;
            }
            out.extend(differences(grid, &low, &high));
            out.extend(later);
        }
    }
}

/// Steps by which the width of a mouth is felt, relative to a cell, and how many at most.
const MOUTH_STEP: f64 = 0.02;
const MOST_MOUTH: usize = 1000;

/// States tried on the way to a jump.
const MOST_TRIALS: usize = 120;

/// Closes in on the jump between a state and the next: its last state before, and the first after. `follow` continues from
/// a zone to a time, and says whether the contact jumped on the way.
///
/// The margin of a state vanishes linearly in time as the jump draws near, which tells where to look.
pub fn locate_jump<Z: Clone>(
    mut before: Known<Z>,
    mut after: Known<Z>,
    tolerance: f64,
    follow: &mut dyn FnMut(f64, &Z) -> Option<(Known<Z>, bool)>,
) -> [Known<Z>; 2] {
    let mut last: Option<(f64, f64)> = None;
    for trial in 0..MOST_TRIALS {
        let (a, b) = (before.time, after.time);
        if b - a <= tolerance {
            break;
        }
        let predicted = match (last, before.margin) {
            (Some((t, m)), Some(now)) if m != now => Some(a + now * (a - t) / (m - now)),
            _ => None,
        };
        // Just before the prediction, just after it, and now and then in the middle, lest it mislead.
        let near =
            predicted.and_then(|p| [p - 0.3 * tolerance, p + 0.3 * tolerance].into_iter().find(|t| a < *t && *t < b));
        let time = near.filter(|_| trial % 3 != 2).unwrap_or(0.5 * (a + b));
        match follow(time, &before.zone) {
            Some((state, true)) => after = state,
            Some((state, false)) => {
                last = before.margin.map(|m| (a, m));
                before = state;
            }
            None => break,
        }
    }
    [before, after]
}

/// The events of one jump.
pub fn jump<const D: usize, Z: Zone<D>>(grid: &Grid<D>, a: &Known<Z>, b: &Known<Z>) -> Vec<Event> {
    let mut events = differences(grid, a, b);
    for event in &mut events {
        event.kind = match event.kind {
            EventKind::Nucleation => EventKind::SnapIn,
            EventKind::Release => EventKind::PullOff,
            other => other,
        };
    }
    if events.is_empty() {
        let kind = if b.area > a.area { EventKind::SnapIn } else { EventKind::PullOff };
        let side = if b.zone.is_empty() { a.zone.side_of(0) } else { b.zone.side_of(0) };
        events.push(between(a, b, kind, side, moved(grid, &a.zone, &b.zone)));
    }
    for (k, event) in events.iter_mut().enumerate() {
        event.energy_released = Some(if k == 0 { a.energy_total - b.energy_total } else { 0.0 });
    }
    events
}

/// The middle of what one of two zones covers and the other does not.
fn moved<const D: usize, Z: Zone<D>>(grid: &Grid<D>, a: &Z, b: &Z) -> Point<D> {
    let mut out = Vec::new();
    for_each_sample(grid, |x| {
        if contact_index(a.region_at(&x)).is_some() != contact_index(b.region_at(&x)).is_some() {
            out.push(x);
        }
    });
    mean(&out)
}

/// An event somewhere between two states.
fn between<const D: usize, Z: Zone<D>>(a: &Known<Z>, b: &Known<Z>, kind: EventKind, side: Side, at: Point<D>) -> Event {
    let [before, after] = [a.zone.counts(), b.zone.counts()];
    Event {
        contact: String::new(),
        kind,
        time: 0.5 * (a.time + b.time),
        within: b.time - a.time,
        by: LocatedBy::Bisection,
        at: vector(&at),
        above: side == Side::Above,
        zones_before: before.0,
        zones_after: after.0,
        holes_before: before.1,
        holes_after: after.1,
        area_before: a.area,
        area_after: b.area,
        force_before: a.force,
        force_after: b.force,
        load_force: 0.0,
        energy_released: None,
    }
}

/// The changes between two zones that differ little.
pub fn differences<const D: usize, Z: Zone<D>>(grid: &Grid<D>, a: &Known<Z>, b: &Known<Z>) -> Vec<Event> {
    let (parts_a, parts_b) = (parts(grid, &a.zone), parts(grid, &b.zone));
    let overlap = overlaps(grid, &a.zone, &b.zone, [parts_a.len(), parts_b.len()]);
    let mut out = Vec::new();
    let mut add = |kind, side, at: Point<D>| out.push(between(a, b, kind, side, at));
    for (j, part) in parts_b.iter().enumerate() {
        let from: Vec<&Part<D>> = (0..parts_a.len()).filter(|&i| overlap[i][j]).map(|i| &parts_a[i]).collect();
        if from.is_empty() {
            add(EventKind::Nucleation, b.zone.side_of(j), middle(grid, part));
        }
        bridges(&from).iter().for_each(|bridge| add(EventKind::Merge, b.zone.side_of(j), bridge.middle()));
    }
    for (i, part) in parts_a.iter().enumerate() {
        let into: Vec<&Part<D>> = (0..parts_b.len()).filter(|&j| overlap[i][j]).map(|j| &parts_b[j]).collect();
        if into.is_empty() {
            add(EventKind::Release, a.zone.side_of(i), middle(grid, part));
        }
        bridges(&into).iter().for_each(|bridge| add(EventKind::Split, a.zone.side_of(i), bridge.middle()));
    }
    for side in Side::BOTH {
        let [holes_a, holes_b] = [a, b].map(|state| holes(grid, &state.zone, side));
        unmatched(&holes_b, &holes_a).into_iter().for_each(|x| add(EventKind::HoleOpened, side, x));
        unmatched(&holes_a, &holes_b).into_iter().for_each(|x| add(EventKind::HoleClosed, side, x));
    }
    out
}

/// The outlines of a connected zone.
pub type Part<const D: usize> = Vec<Vec<Point<D>>>;

/// The connected zones.
pub fn parts<const D: usize, Z: Zone<D>>(grid: &Grid<D>, zone: &Z) -> Vec<Part<D>> {
    let mut out = vec![Vec::new(); zone.counts().0];
    for (k, outline) in zone.outlines().into_iter().enumerate() {
        // In one dimension every outline is an interval; in two the zone lies on the left of its fronts.
        let of = if D == 1 { Some(k) } else { inside(grid, zone, &outline) };
        if let Some(part) = of.and_then(|k| out.get_mut(k)) {
            part.push(outline);
        }
    }
    out
}

/// The zone beside an outline.
fn inside<const D: usize, Z: Zone<D>>(grid: &Grid<D>, zone: &Z, outline: &[Point<D>]) -> Option<usize> {
    let step = 1e-3 * grid.h();
    outline.iter().zip(outline.iter().skip(1)).find_map(|(p, q)| {
        let along = (q - p).try_normalize(0.0)?;
        contact_index(zone.region_at(&((p + q) * 0.5 + mergers::turned(&along) * step)))
    })
}

/// The narrowest places between zones that are one in another state.
pub fn bridges_closed<const D: usize, Z: Zone<D>>(grid: &Grid<D>, apart: &Z, joined: &Z) -> Vec<Bridge<D>> {
    let (parts, whole) = (parts(grid, apart), joined.counts().0);
    let overlap = overlaps(grid, apart, joined, [parts.len(), whole]);
    let of_whole =
        |j: usize| bridges(&(0..parts.len()).filter(|&i| overlap[i][j]).map(|i| &parts[i]).collect::<Vec<_>>());
    (0..whole).flat_map(of_whole).collect()
}

/// The mouths of what is a hole in one state, and no hole in another: where the contact about it is narrowest, how far it
/// is from front to front across the mouth. None where the zone fills that place: such a hole closed by shrinking to nothing.
pub fn mouths_closed<const D: usize, Z: Zone<D>>(grid: &Grid<D>, open: &Z, closed: &Z) -> Option<Vec<Bridge<D>>> {
    let outlines = closed.outlines();
    let mut new: Vec<usize> = (0..outlines.len()).filter(|&k| is_hole(&outlines[k])).collect();
    let places: Vec<Point<D>> = new.iter().map(|&k| mean(&outlines[k])).collect();
    let before: Vec<Point<D>> = open.outlines().iter().filter(|o| is_hole(o)).map(|o| mean(o)).collect();
    let unmatched = unmatched(&places, &before);
    new.retain(|&k| unmatched.contains(&mean(&outlines[k])));
    let mouth = |&k: &usize| {
        let others: Vec<_> = (0..outlines.len()).filter(|j| *j != k).map(|j| outlines[j].clone()).collect();
        let neck = nearest(&outlines[k..=k], &others)?;
        let along = mergers::turned(&(neck.tips[1] - neck.tips[0])).try_normalize(0.0)?;
        let middle = neck.middle();
        let reach = |way: Point<D>| {
            let step = MOUTH_STEP * grid.h();
            let taken =
                (1..MOST_MOUTH).find(|&i| contact_index(open.region_at(&(middle + way * (i as f64 * step)))).is_some());
            Some(middle + way * (taken? as f64 * step))
        };
        is_free(open.region_at(&middle)).then_some(())?;
        Some(Bridge { tips: [reach(-along)?, reach(along)?] })
    };
    new.iter().map(mouth).collect()
}

/// Which zones of both states share points of a grid of samples.
fn overlaps<const D: usize, Z: Zone<D>>(grid: &Grid<D>, a: &Z, b: &Z, counts: [usize; 2]) -> Vec<Vec<bool>> {
    let mut out = vec![vec![false; counts[1]]; counts[0]];
    for_each_sample(grid, |x| {
        let [i, j] = [a, b].map(|zone| contact_index(zone.region_at(&x)));
        if let (Some(i), Some(j)) = (i, j)
            && let Some(cell) = out.get_mut(i).and_then(|row| row.get_mut(j))
        {
            *cell = true;
        }
    });
    out
}

/// Visits the points of a grid of samples, four to each side of a cell.
fn for_each_sample<const D: usize>(grid: &Grid<D>, mut visit: impl FnMut(Point<D>)) {
    let n = grid.cells().map(|n| n * 4);
    for k in 0..n.iter().product::<usize>() {
        let mut rest = k;
        visit(grid.bounds().at(&Point::<D>::from_fn(|axis, _| {
            let i = rest % n[axis];
            rest /= n[axis];
            (i as f64 + 0.5) / n[axis] as f64
        })));
    }
}

/// The narrowest places between parts, one less than there are parts: those of the shortest tree that joins them.
fn bridges<const D: usize>(parts: &[&Part<D>]) -> Vec<Bridge<D>> {
    let mut out = Vec::new();
    let mut joined = vec![0];
    while joined.len() < parts.len() {
        let next = (0..parts.len())
            .filter(|k| !joined.contains(k))
            .flat_map(|k| {
                joined.iter().filter_map(move |&j| Some((k, nearest(parts[j], parts[k])?))).collect::<Vec<_>>()
            })
            .min_by(|a, b| a.1.length().total_cmp(&b.1.length()));
        let Some((k, bridge)) = next else { break };
        joined.push(k);
        out.push(bridge);
    }
    out
}

/// The middle of a zone; of one that reaches the lower end of a line that end, which is the axis of a round membrane.
fn middle<const D: usize>(grid: &Grid<D>, part: &Part<D>) -> Point<D> {
    let low = grid.bounds().min;
    let points: Vec<Point<D>> = part.iter().flatten().copied().collect();
    if D == 1 && points.iter().any(|x| x[0] <= low[0]) { low } else { mean(&points) }
}

fn mean<const D: usize>(points: &[Point<D>]) -> Point<D> {
    points.iter().sum::<Point<D>>() / points.len().max(1) as f64
}

/// Centres of the holes in the zones that touch one side.
fn holes<const D: usize, Z: Zone<D>>(grid: &Grid<D>, zone: &Z, side: Side) -> Vec<Point<D>> {
    if D == 1 {
        return Vec::new();
    }
    let of_side = |o: &Vec<Point<D>>| inside(grid, zone, o).is_none_or(|k| zone.side_of(k) == side);
    zone.outlines().iter().filter(|o| is_hole(o) && of_side(o)).map(|o| mean(o)).collect()
}

/// Whether an outline is that of a hole: it runs clockwise.
fn is_hole<const D: usize>(outline: &[Point<D>]) -> bool {
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).map(|(p, q)| p[0] * q[D - 1] - p[D - 1] * q[0]).sum::<f64>() < 0.0
}

/// The places of a list that have none of the other list as their nearest partner.
fn unmatched<const D: usize>(list: &[Point<D>], other: &[Point<D>]) -> Vec<Point<D>> {
    let mut left = list.to_vec();
    for x in other {
        let nearest = (0..left.len()).min_by(|&i, &j| (left[i] - x).norm().total_cmp(&(left[j] - x).norm()));
        if let Some(k) = nearest {
            left.remove(k);
        }
    }
    left
}
