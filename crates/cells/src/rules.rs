//! The rules of all cells: of several processes each finds those of some cells, and all get all.
//!
//! Cut cells take by far the most time, and lie together: cells are dealt out one by one.

use crate::region::{BoundaryPoint, Filling, MaterialRule};
use crate::tree::{CellTree, Leaf};
use rayon::prelude::*;
use signorini_fem::QuadraturePoint;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::processes::Processes;

/// The rule of each leaf of a tree.
pub(crate) fn rules_of<const D: usize>(
    tree: &CellTree<D>,
    processes: Option<&dyn Processes>,
    rule: impl Fn(&Leaf<D>) -> MaterialRule<D> + Send + Sync,
) -> Vec<MaterialRule<D>> {
    let leaves = tree.leaves();
    let Some(processes) = processes.filter(|processes| processes.count() > 1) else {
        return leaves.par_iter().map(rule).collect();
    };
    let (rank, count) = (processes.rank(), processes.count());
    let own: Vec<Vec<f64>> =
        (rank..leaves.len()).into_par_iter().step_by(count).map(|leaf| written(&rule(&leaves[leaf]))).collect();
    let found = processes.gather(&own.concat());
    let mut unread: Vec<&[f64]> = found.iter().map(Vec::as_slice).collect();
    (0..leaves.len()).map(|leaf| read(&mut unread[leaf % count])).collect()
}

/// A rule as numbers.
fn written<const D: usize>(rule: &MaterialRule<D>) -> Vec<f64> {
    let filling = match rule.filling {
        Filling::Full => 0.0,
        Filling::Cut => 1.0,
        Filling::Void => 2.0,
    };
    let counts = [rule.volume.len(), rule.boundary.len()].map(|n| n as f64);
    let mut out = vec![filling, f64::from(u8::from(rule.is_fitted)), counts[0], counts[1]];
    for p in &rule.volume {
        out.extend(p.x.iter().chain([&p.weight]));
    }
    for p in &rule.boundary {
        out.extend(p.x.iter().chain([&p.weight]).chain(p.normal.iter()));
    }
    out
}

/// The next rule of a list of numbers, which begins after it from then on.
fn read<const D: usize>(from: &mut &[f64]) -> MaterialRule<D> {
    let mut next = |n: usize| {
        let (first, rest) = from.split_at(n);
        *from = rest;
        first
    };
    let &[filling, is_fitted, volume, boundary] = next(4) else { return MaterialRule::empty(Filling::Void) };
    let filling = match filling as u8 {
        0 => Filling::Full,
        1 => Filling::Cut,
        _ => Filling::Void,
    };
    let vector = |part: &[f64]| Vector::<D>::from_column_slice(part);
    let volume = next(volume as usize * (D + 1)).chunks(D + 1);
    let volume = volume.map(|p| QuadraturePoint { x: Point::<D>::from(vector(&p[..D])), weight: p[D] }).collect();
    let boundary = next(boundary as usize * (2 * D + 1)).chunks(2 * D + 1);
    let boundary =
        boundary.map(|p| BoundaryPoint { x: vector(&p[..D]), weight: p[D], normal: vector(&p[D + 1..]) }).collect();
    MaterialRule { filling, volume, is_fitted: is_fitted != 0.0, boundary }
}
