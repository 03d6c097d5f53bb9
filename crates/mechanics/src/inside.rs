//! Sites that lie inside of a rigid body, where no contact sees them: they face away from the side that is nearest to them.

use crate::points::{Master, SlavePoint};
use signorini_geometry::Point;

/// A site inside of a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inside {
    pub depth: f64,
    /// Where the site is.
    pub x: Point<3>,
}

/// Cosine between the outward normals of a site and of what is nearest to it from which on nothing pushes the site out.
const AWAY: f64 = 0.5;
/// Share of the distance of sites that edges and the chords of faces may lie inside.
const EXPLAINED: f64 = 0.5;
/// Share of the size of a body by which it may start inside of a rigid one that pushes it out.
const INTERFERENCE: f64 = 0.25;

/// The deepest of the sites of a surface that are inside and face away: deeper than chords, and than what carries.
pub(crate) fn unseen(master: &dyn Master, sites: &[SlavePoint]) -> Option<Inside> {
    let found = depths(master, sites);
    let least = EXPLAINED * distance(sites);
    let carried = found.iter().filter(|(_, away)| !away).map(|(inside, _)| inside.depth).fold(0.0, f64::max);
    deepest(found.iter().filter(|(_, away)| *away).map(|(inside, _)| *inside))
        .filter(|found| found.depth > least.max(2.0 * carried))
}

/// The deepest of the sites of a surface of a body of a given size, if nothing sees it or if that is no interference any more.
pub(crate) fn at_start(master: &dyn Master, sites: &[SlavePoint], size: f64) -> Option<Inside> {
    let all = deepest(depths(master, sites).into_iter().map(|(inside, _)| inside));
    unseen(master, sites).or(all.filter(|found| found.depth > INTERFERENCE * size))
}

/// The deepest of balls in a state at the start that is no interference any more, of a body of a given size.
pub(crate) fn balls_at_start(master: &dyn Master, sites: &[SlavePoint], size: f64) -> Option<Inside> {
    let of = |placed: &SlavePoint| {
        let (gap, _) = master.nearest(&placed.x, f64::INFINITY, None)?.gap(&placed.x)?;
        Some(Inside { depth: placed.radius - gap, x: placed.x })
    };
    deepest(sites.iter().filter_map(of)).filter(|found| found.depth > INTERFERENCE * size)
}

fn deepest(list: impl Iterator<Item = Inside>) -> Option<Inside> {
    list.max_by(|a, b| a.depth.total_cmp(&b.depth))
}

/// The sites inside, and whether they face away.
fn depths(master: &dyn Master, sites: &[SlavePoint]) -> Vec<(Inside, bool)> {
    let of = |placed: &SlavePoint| {
        let outward = placed.outward.filter(|_| !placed.rests)?;
        let (gap, normal) = master.nearest(&placed.x, f64::INFINITY, None)?.gap(&placed.x)?;
        let away = outward.dot(&normal) > AWAY * outward.norm();
        (gap < placed.radius).then_some((Inside { depth: placed.radius - gap, x: placed.x }, away))
    };
    sites.iter().filter_map(of).collect()
}

/// How far sites are apart, about.
pub(crate) fn distance(sites: &[SlavePoint]) -> f64 {
    let Some(first) = sites.first() else { return 0.0 };
    let (low, high) = sites.iter().fold((first.x, first.x), |(l, h), s| (l.inf(&s.x), h.sup(&s.x)));
    let in_space = sites.iter().any(|s| s.functions.iter().any(|f| f.value.z != 0.0));
    let count = sites.len() as f64;
    (high - low).norm() / if in_space { count.sqrt() } else { count }
}
