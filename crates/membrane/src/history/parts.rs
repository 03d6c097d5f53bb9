//! The connected parts of zones, which of them overlap, and where they are nearest to each other.

use super::bridge::{Bridge, nearest, turned};
use crate::obstacle::Side;
use crate::zone::{Zone, contact_index, is_free};
use signorini_fem::Grid;
use signorini_geometry::Point;

/// Steps by which the width of a mouth is felt, relative to a cell, and how many at most.
const MOUTH_STEP: f64 = 0.02;
const MOST_MOUTH: usize = 1000;

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
        contact_index(zone.region_at(&((p + q) * 0.5 + turned(&along) * step)))
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
        let along = turned(&(neck.tips[1] - neck.tips[0])).try_normalize(0.0)?;
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
pub fn overlaps<const D: usize, Z: Zone<D>>(grid: &Grid<D>, a: &Z, b: &Z, counts: [usize; 2]) -> Vec<Vec<bool>> {
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
pub fn for_each_sample<const D: usize>(grid: &Grid<D>, mut visit: impl FnMut(Point<D>)) {
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
pub fn bridges<const D: usize>(parts: &[&Part<D>]) -> Vec<Bridge<D>> {
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
pub fn middle<const D: usize>(grid: &Grid<D>, part: &Part<D>) -> Point<D> {
    let low = grid.bounds().min;
    let points: Vec<Point<D>> = part.iter().flatten().copied().collect();
    if D == 1 && points.iter().any(|x| x[0] <= low[0]) { low } else { mean(&points) }
}

/// The mean of some points.
pub fn mean<const D: usize>(points: &[Point<D>]) -> Point<D> {
    points.iter().sum::<Point<D>>() / points.len().max(1) as f64
}

/// Centres of the holes in the zones that touch one side.
pub fn holes<const D: usize, Z: Zone<D>>(grid: &Grid<D>, zone: &Z, side: Side) -> Vec<Point<D>> {
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
pub fn unmatched<const D: usize>(list: &[Point<D>], other: &[Point<D>]) -> Vec<Point<D>> {
    let mut left = list.to_vec();
    for x in other {
        let nearest = (0..left.len()).min_by(|&i, &j| (left[i] - x).norm().total_cmp(&(left[j] - x).norm()));
        if let Some(k) = nearest {
            left.remove(k);
        }
    }
    left
}
