//! Pressures that oscillate from node to node.
//!
//! The multipliers of a slave surface are one for each of its nodes. Where the slave is stiffer than the master, or as stiff, and
//! its faces are smaller, the master cannot follow them all: nodes between those of the master open and close in turn. Resultants
//! come out right, pressures do not.

use signorini_contact::Status;
use signorini_mechanics::{ShownSurface, SiteResult};
use std::collections::BTreeSet;

/// Nodes in contact from which the pressure of a zone is resolved: between fewer it has to change from node to node.
const RESOLVED: usize = 8;
/// Change against both neighbours, relative to the largest pressure, that is not one of a smooth field on so many nodes.
const CHANGE: f64 = 0.1;
/// Part of the pairs of neighbours in contact between which the change changes its sign: at the two ends of a smooth zone, or of
/// one with peaks at its ends, it does so too.
const PART: f64 = 1.0 / 3.0;

/// Whether the pressure of a surface oscillates.
pub fn oscillates(surface: &ShownSurface, sites: &[SiteResult]) -> bool {
    let closed = sites.iter().filter(|s| s.status != Status::Open).count();
    if closed < RESOLVED {
        return false;
    }
    let pairs = neighbours(surface);
    let mut sums = vec![(0.0, 0usize); sites.len()];
    for &(i, j) in &pairs {
        for (own, other) in [(i, j), (j, i)] {
            sums[own].0 += sites[other].pressure;
            sums[own].1 += 1;
        }
    }
    let largest = sites.iter().map(|s| s.pressure).fold(0.0, f64::max);
    let change = |k: usize| sites[k].pressure - sums[k].0 / sums[k].1 as f64;
    let presses = |(i, j): &&(usize, usize)| sites[*i].pressure.max(sites[*j].pressure) > 0.0;
    let alternates = |(i, j): &&(usize, usize)| {
        let [a, b] = [change(*i), change(*j)];
        a * b < 0.0 && a.abs().min(b.abs()) > CHANGE * largest
    };
    let pressing = pairs.iter().filter(presses).count();
    let alternating = pairs.iter().filter(presses).filter(alternates).count();
    alternating as f64 > PART * pressing as f64
}

/// Sites that share a side of a face, or a line in the plane.
fn neighbours(surface: &ShownSurface) -> BTreeSet<(usize, usize)> {
    let sides = surface.faces.iter().flat_map(|face| {
        let count = if face.len() > 2 { face.len() } else { face.len().saturating_sub(1) };
        (0..count).map(|k| [face[k], face[(k + 1) % face.len()]].map(|site| site as usize))
    });
    sides.filter(|[a, b]| a != b).map(|[a, b]| (a.min(b), a.max(b))).collect()
}
