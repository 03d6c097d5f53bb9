//! Faces of shells that share no edges in the data: edges in one place are made one.

use super::SolidData;
use super::edge::foot_on;
use crate::Point;

/// Makes vertices within `tolerance` of each other one, then edges between the same vertices that run along each other. Shells
/// of surfaces are stated so by some programs.
pub(super) fn merge(data: &mut SolidData, tolerance: f64) {
    let first = |x: &Point<3>, before: usize, vertices: &[Point<3>]| {
        (0..before).find(|k| (vertices[*k] - x).norm() <= tolerance).unwrap_or(before)
    };
    let same: Vec<usize> = data.vertices.iter().enumerate().map(|(k, x)| first(x, k, &data.vertices)).collect();
    for edge in &mut data.edges {
        edge.ends = edge.ends.map(|v| same[v]);
    }
    // Of each edge the one that stands for it, and whether that runs the same way.
    let mut stands: Vec<(usize, bool)> = Vec::with_capacity(data.edges.len());
    for (k, edge) in data.edges.iter().enumerate() {
        let [from, to] = edge.curve.domain();
        let middle = edge.curve.jet(0.5 * (from + to));
        let alike = (0..k).find_map(|other| {
            let own = &data.edges[other];
            let [p, q] = own.ends;
            if stands[other].0 != other || ![[p, q], [q, p]].contains(&edge.ends) {
                return None;
            }
            // Near a sample of it, and then near the curve itself.
            const SAMPLES: usize = 16;
            let [a, b] = own.curve.domain();
            let at = |i: usize| a + (b - a) * i as f64 / SAMPLES as f64;
            let off = |t: f64| (own.curve.position(t) - middle.x).norm();
            let near = (0..=SAMPLES).map(at).min_by(|s, t| off(*s).total_cmp(&off(*t)))?;
            let (_, jet, _) = foot_on(&own.curve, &middle.x, near);
            ((jet.x - middle.x).norm() <= tolerance).then(|| (other, jet.d1.dot(&middle.d1) > 0.0))
        });
        stands.push(alike.unwrap_or((k, true)));
    }
    for (edge, forward) in data.faces.iter_mut().flat_map(|f| f.loops.iter_mut().flatten()) {
        let (other, runs) = stands[*edge];
        (*edge, *forward) = (other, *forward == runs);
    }
}
