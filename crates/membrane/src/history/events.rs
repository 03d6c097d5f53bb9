//! Changes of topology along a load path: which, where, and at what load.
//!
//! An increment between whose ends the numbers of zones or holes differ is halved until the change lies within the
//! tolerance that its step states; [`mergers`] have their own way. A zone that comes and another that goes within one increment, or a zone that comes and
//! goes, are seen only if the ends of a part differ.

use super::differences::{between, differences};
use super::event::{Event, EventKind};
use super::mergers::{self, Merger};
use super::parts::{for_each_sample, mean};
use super::path_point::{PathPoint, Trial};
use crate::zone::{Zone, contact_index};
use signorini_fem::Grid;
use signorini_geometry::Point;

/// Halvings towards a time that could not be solved for, from either side.
const MOST_HALVINGS: usize = 5;

/// Finds the events between two times. `solve` looks at a time between, knowing the zones before and after; where it finds
/// nothing the events are known to that interval.
pub fn locate<const D: usize, Z: Zone<D>>(
    grid: &Grid<D>,
    a: &PathPoint<Z>,
    b: &PathPoint<Z>,
    tolerance: f64,
    solve: &mut dyn FnMut(f64, [&Z; 2]) -> Trial<Z>,
    out: &mut Vec<Event<D>>,
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
        Trial::AsLater => locate(grid, a, &PathPoint { time, ..b.clone() }, tolerance, solve, out),
        Trial::AsEarlier => locate(grid, &PathPoint { time, ..a.clone() }, b, tolerance, solve, out),
        Trial::State(middle) => {
            locate(grid, a, &middle, tolerance, solve, out);
            locate(grid, &middle, b, tolerance, solve, out);
        }
        Trial::Unknown => {
            let (mut low, mut high, mut later) = (a.clone(), b.clone(), Vec::new());
            for _ in 0..MOST_HALVINGS {
                let Trial::State(state) = solve(0.5 * (low.time + time), [&low.zone, &high.zone]) else { break };
                locate(grid, &low, &state, tolerance, solve, out);
                low = state;
            }
            for _ in 0..MOST_HALVINGS {
                let Trial::State(state) = solve(0.5 * (time + high.time), [&high.zone, &low.zone]) else { break };
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

/// States tried on the way to a jump.
const MOST_TRIALS: usize = 120;

/// Closes in on the jump between a state and the next: its last state before, and the first after. `follow` continues from
/// a zone to a time, and says whether the contact jumped on the way.
///
/// The margin of a state vanishes linearly in time as the jump draws near, which tells where to look.
pub fn locate_jump<Z: Clone>(
    mut before: PathPoint<Z>,
    mut after: PathPoint<Z>,
    tolerance: f64,
    follow: &mut dyn FnMut(f64, &Z) -> Option<(PathPoint<Z>, bool)>,
) -> [PathPoint<Z>; 2] {
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
pub fn jump<const D: usize, Z: Zone<D>>(grid: &Grid<D>, a: &PathPoint<Z>, b: &PathPoint<Z>) -> Vec<Event<D>> {
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
