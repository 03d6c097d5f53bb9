//! The outlines of bodies in the plane: edges of cells that no other cell has.

use crate::fields::Fields;
use signorini_geometry::Vector;
use std::collections::{BTreeMap, BTreeSet};

/// How far from an edge, relative to it, a point is on it.
const ON: f64 = 1e-6;

/// The outlines of a body, as chains of its points.
pub fn outlines(fields: &Fields) -> Vec<Vec<u32>> {
    let mut once: BTreeSet<(u32, u32)> = BTreeSet::new();
    for (_, polygon) in &fields.cells {
        for k in 0..polygon.len() {
            let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
            toggle(&mut once, a, b);
        }
    }
    chains(within_larger(fields, once))
}

/// Adds an edge, or takes it away where it was.
fn toggle(once: &mut BTreeSet<(u32, u32)>, a: u32, b: u32) {
    let edge = (a.min(b), a.max(b));
    if a != b && !once.remove(&edge) {
        once.insert(edge);
    }
}

/// Edges without those that are parts of larger ones: beside an edge of a large cell lie those of several smaller cells.
fn within_larger(fields: &Fields, edges: BTreeSet<(u32, u32)>) -> BTreeSet<(u32, u32)> {
    let at = |k: u32| Vector::<3>::from(fields.points[k as usize]);
    let mut ends: Vec<u32> = edges.iter().flat_map(|&(a, b)| [a, b]).collect();
    ends.sort_by(|&a, &b| at(a).x.total_cmp(&at(b).x).then(a.cmp(&b)));
    ends.dedup();
    let mut out = BTreeSet::new();
    for (a, b) in edges {
        let (from, along) = (at(a), at(b) - at(a));
        let length = along.norm();
        let place = |k: u32| (at(k) - from).dot(&along) / (length * length);
        let is_on = |k: &u32| {
            let away = (at(*k) - from).cross(&along).norm() / length;
            away < ON * length && place(*k) > ON && place(*k) < 1.0 - ON
        };
        let (low, high) = (at(a).x.min(at(b).x) - ON * length, at(a).x.max(at(b).x) + ON * length);
        let first = ends.partition_point(|&k| at(k).x < low);
        let mut between: Vec<u32> =
            ends[first..].iter().copied().take_while(|&k| at(k).x <= high).filter(is_on).collect();
        between.sort_by(|&p, &q| place(p).total_cmp(&place(q)));
        let corners = std::iter::once(a).chain(between).chain([b]).collect::<Vec<u32>>();
        corners.windows(2).for_each(|pair| toggle(&mut out, pair[0], pair[1]));
    }
    out
}

/// Edges that meet as chains.
fn chains(mut once: BTreeSet<(u32, u32)>) -> Vec<Vec<u32>> {
    let mut beside: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for &(a, b) in &once {
        beside.entry(a).or_default().push(b);
        beside.entry(b).or_default().push(a);
    }
    let mut out = Vec::new();
    while let Some((first, next)) = once.pop_first() {
        let mut chain = vec![first, next];
        let mut last = next;
        while let Some(&on) = beside[&last].iter().find(|&&n| once.contains(&(last.min(n), last.max(n)))) {
            once.remove(&(last.min(on), last.max(on)));
            chain.push(on);
            last = on;
        }
        out.push(chain);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_outline_of_cells_of_two_sizes_has_no_inner_edges() {
        let points: Vec<[f64; 3]> = [[0, 0], [2, 0], [2, 2], [0, 2], [3, 0], [3, 1], [2, 1], [3, 2]]
            .map(|[x, y]| [f64::from(x), f64::from(y), 0.0])
            .to_vec();
        let cells = [[0, 1, 2, 3], [1, 4, 5, 6], [6, 5, 7, 2]].map(|c: [u32; 4]| (None, c.to_vec())).to_vec();
        let found = outlines(&Fields { name: "b".into(), points, cells, arrays: Vec::new() });
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].first(), found[0].last());
        let mut met = found[0][1..].to_vec();
        met.sort_unstable();
        assert_eq!(met, [0, 1, 2, 3, 4, 5, 7]);
    }
}
