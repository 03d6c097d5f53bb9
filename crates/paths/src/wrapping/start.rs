//! Where the search for a path starts when there is none yet: an elastic band over the bodies.
//!
//! Nodes joined by springs are moved one by one to where they are in equilibrium, and out of the bodies (projected
//! successive over-relaxation). That minimises the sum of squares of the distances outside the bodies; its contacts are
//! those of a shortest path to the width of a spacing, which is enough for Newton.

use super::newton::Line;
use super::route::{Body, Leg};
use super::touch::WrapPoint;
use signorini_geometry::{Point, Vector};

/// Springs per body and for the ends, so that some lie on each body of a chain.
const SPRINGS: usize = 24;
/// Sweeps per spring: over-relaxation converges in a number of sweeps that is proportional to that of nodes.
const SWEEPS: usize = 6;
/// Motion of a sweep, relative to a spring, with which the band is close enough for Newton.
const AT_REST: f64 = 1e-4;
/// Sideways bow of the first band, relative to its length: a line through the middle of a body has no side to go to.
const BOW: f64 = 1e-3;

/// Touches from a band between the ends of a leg.
pub(crate) fn band(leg: &Leg, bodies: &[Body<'_>]) -> Vec<WrapPoint> {
    let (nodes, on) = relaxed(leg, bodies);
    touches(leg, bodies, &nodes, &on)
}

/// The stations of a leg in the order in which a band comes nearest to their bodies.
pub(crate) fn order(leg: &Leg, bodies: &[Body<'_>]) -> Vec<usize> {
    let (nodes, on) = relaxed(leg, bodies);
    let place = |order: usize| {
        let touching: Vec<usize> = (0..nodes.len()).filter(|&k| on[k] == Some(order)).collect();
        let gap = |k: &usize| bodies[leg.around[order].body].near_gap(&nodes[*k]);
        let nearest = || (0..nodes.len()).min_by(|a, b| gap(a).total_cmp(&gap(b))).unwrap_or_default();
        touching.get(touching.len() / 2).copied().unwrap_or_else(nearest)
    };
    let mut found: Vec<usize> = (0..leg.around.len()).collect();
    found.sort_by_key(|&order| place(order));
    found.into_iter().map(|order| leg.around[order].station).collect()
}

/// The nodes of a band between the ends of a leg, and on which of its bodies each lies.
fn relaxed(leg: &Leg, bodies: &[Body<'_>]) -> (Vec<Point<3>>, Vec<Option<usize>>) {
    let (from, to) = (leg.from.1, leg.to.1);
    let way = to - from;
    let mut across = Vector::<3>::zeros();
    across[way.iamin()] = 1.0;
    let bow = across.cross(&way) * BOW;
    let springs = SPRINGS * (leg.around.len() + 1);
    let mut nodes: Vec<Point<3>> = (0..=springs)
        .map(|k| {
            let t = k as f64 / springs as f64;
            from + way * t + bow * (std::f64::consts::PI * t).sin()
        })
        .collect();
    let mut on: Vec<Option<usize>> = vec![None; springs + 1];
    let relaxation = 2.0 / (1.0 + (std::f64::consts::PI / springs as f64).sin());
    for _ in 0..SWEEPS * springs {
        let mut moved = 0.0f64;
        for k in 1..springs {
            let middle = (nodes[k - 1] + nodes[k + 1]) * 0.5;
            let mut x = nodes[k] + (middle - nodes[k]) * relaxation;
            on[k] = None;
            for (order, around) in leg.around.iter().enumerate() {
                if let Some(outside) = pushed_out(&bodies[around.body], &x) {
                    x = outside;
                    on[k] = Some(order);
                }
            }
            moved = moved.max((x - nodes[k]).norm());
            nodes[k] = x;
        }
        if moved < AT_REST * way.norm() / springs as f64 {
            break;
        }
    }
    (nodes, on)
}

/// The foot of a point inside a body, in two Newton steps: the next sweep goes on from there.
fn pushed_out(body: &Body<'_>, x: &Point<3>) -> Option<Point<3>> {
    let mut y = body.inside(x);
    let mut level = body.shape.level(&y);
    if level.value >= 0.0 {
        return None;
    }
    for _ in 0..2 {
        let square = level.gradient.norm_squared();
        if square == 0.0 {
            return None;
        }
        y -= level.gradient * (level.value / square);
        level = body.shape.level(&y);
    }
    Some(body.motion.point(&y))
}

/// Runs of nodes on the same body, in the order of the route.
fn touches(leg: &Leg, bodies: &[Body<'_>], nodes: &[Point<3>], on: &[Option<usize>]) -> Vec<WrapPoint> {
    let mut runs: Vec<(usize, usize, usize)> = Vec::new();
    for (k, order) in on.iter().enumerate() {
        let Some(order) = *order else { continue };
        match runs.last_mut() {
            Some((last, _, end)) if *last == order && *end + 1 == k => *end = k,
            _ => runs.push((order, k, k)),
        }
    }
    in_order(&runs)
        .into_iter()
        .filter_map(|(order, first, last)| {
            let line = Line { from: nodes[first - 1], to: nodes[last + 1] };
            let start = nodes[first];
            let direction = if first == last { line.to - line.from } else { nodes[first + 1] - nodes[first] };
            let length: f64 = (first..last).map(|k| (nodes[k + 1] - nodes[k]).norm()).sum();
            let length = if length > 0.0 { length } else { 0.5 * line.length() };
            WrapPoint::near(order, &bodies[leg.around[order].body], &start, &direction, length).ok()
        })
        .collect()
}

/// The longest choice of runs, by nodes, whose orders do not decrease.
fn in_order(runs: &[(usize, usize, usize)]) -> Vec<(usize, usize, usize)> {
    let nodes = |r: &(usize, usize, usize)| r.2 - r.1 + 1;
    let mut best: Vec<(usize, Option<usize>)> = Vec::new();
    for (k, run) in runs.iter().enumerate() {
        let before = (0..k).filter(|&j| runs[j].0 <= run.0).max_by_key(|&j| (best[j].0, j));
        best.push((nodes(run) + before.map_or(0, |j| best[j].0), before));
    }
    let mut chosen = Vec::new();
    let mut next = (0..runs.len()).max_by_key(|&k| (best[k].0, k));
    while let Some(k) = next {
        chosen.push(runs[k]);
        next = best[k].1;
    }
    chosen.reverse();
    chosen
}

#[cfg(test)]
mod tests {
    use super::in_order;

    #[test]
    fn runs_in_the_order_of_the_route() {
        let runs = [(0, 1, 4), (2, 6, 7), (1, 9, 15), (2, 17, 18)];
        assert_eq!(in_order(&runs), [(0, 1, 4), (1, 9, 15), (2, 17, 18)]);
        assert!(in_order(&[]).is_empty());
    }
}
