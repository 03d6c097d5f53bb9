//! The events between two states that differ little.

use super::event::{Event, EventKind, LocatedBy};
use super::parts::{Part, bridges, holes, middle, overlaps, parts, unmatched};
use super::path_point::PathPoint;
use crate::obstacle::Side;
use crate::zone::Zone;
use signorini_fem::Grid;
use signorini_geometry::Point;

/// An event somewhere between two states.
pub fn between<const D: usize, Z: Zone<D>>(
    a: &PathPoint<Z>,
    b: &PathPoint<Z>,
    kind: EventKind,
    side: Side,
    at: Point<D>,
) -> Event<D> {
    let [before, after] = [a.zone.counts(), b.zone.counts()];
    Event {
        kind,
        time: 0.5 * (a.time + b.time),
        within: b.time - a.time,
        by: LocatedBy::Bisection,
        at,
        side,
        obstacle: None,
        zones: [before.0, after.0],
        holes: [before.1, after.1],
        area: [a.area, b.area],
        force: [a.force, b.force],
        energy_released: None,
    }
}

/// The changes between two zones that differ little.
pub fn differences<const D: usize, Z: Zone<D>>(grid: &Grid<D>, a: &PathPoint<Z>, b: &PathPoint<Z>) -> Vec<Event<D>> {
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
