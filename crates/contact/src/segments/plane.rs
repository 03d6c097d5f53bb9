//! Pieces of slave faces in the plane: intervals between the projections of the master's vertices.

use super::opposite::{Cut, FACING, GapPoint, SNAP, onto_master, onto_slave, snapped};
use signorini_basis::CellShape;
use signorini_basis::hierarchic::Values;
use signorini_basis::rules::rule;

pub(super) fn intervals<const D: usize>(cut: Cut<'_, D>, face: usize, candidates: &[usize]) -> Vec<GapPoint<D>> {
    let Cut { slave, master, nodes, sight, extra } = cut;
    let mut at = Values::default();
    let mut spans = Vec::new();
    let mut breaks = vec![-1.0, 1.0];
    let own = slave.at(face, &[0.0; 3]).area_normal().normalize();
    for &other in candidates {
        if own.dot(&master.at(other, &[0.0; 3]).area_normal().normalize()) > FACING {
            continue;
        }
        let ends = [-1.0, 1.0].map(|e| onto_slave(slave, nodes, face, &master.at(other, &[e, 0.0, 0.0]).x, &mut at));
        let [Some(p), Some(q)] = ends else { continue };
        let span = [p.min(q), p.max(q)];
        if span[1] <= -1.0 || span[0] >= 1.0 {
            continue;
        }
        breaks.extend(span.into_iter().filter(|b| b.abs() < 1.0 + SNAP));
        spans.push((other, span));
    }
    breaks.sort_by(f64::total_cmp);
    // Clusters are represented by an end of the face where they hold one, else by their first member.
    let mut clusters: Vec<f64> = Vec::new();
    for b in breaks {
        match clusters.last_mut() {
            Some(last) if b - *last < SNAP => {
                if b == 1.0 {
                    *last = 1.0;
                }
            }
            _ => clusters.push(if (b + 1.0).abs() < SNAP { -1.0 } else { b }),
        }
    }
    let mut points = Vec::new();
    for pair in clusters.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let middle = 0.5 * (from + to);
        // Where several masters lie behind each other the nearest counts.
        let (normal, _) = nodes.normal(face, &[middle, 0.0, 0.0], &mut at);
        let x = slave.at(face, &[middle, 0.0, 0.0]).x;
        let seen = (spans.iter())
            .filter(|(_, span)| span[0] <= middle && middle <= span[1])
            .filter_map(|(other, _)| {
                let (_, gap) = onto_master(master, *other, &x, &normal.normalize(), [0.0; 3])?;
                sight.includes(face, gap).then_some((gap.abs(), *other))
            })
            .min_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
        let Some((_, other)) = seen else { continue };
        let n = slave.degree(face).max(master.degree(other)) + 2 + extra;
        for (s, w) in rule(CellShape::Line, n) {
            let s = [middle + 0.5 * (to - from) * s[0], 0.0, 0.0];
            let point = slave.at(face, &s);
            let (normal, _) = nodes.normal(face, &s, &mut at);
            let normal = normal.normalize();
            let Some((eta, gap)) = onto_master(master, other, &point.x, &normal, [0.0; 3]) else { continue };
            let weight = 0.5 * (to - from) * w * point.area_normal().norm() * slave.measure(&point.x);
            let magnitude = point.x.amax();
            points.push(GapPoint {
                s,
                weight,
                master: Some((other as u32, eta)),
                direction: -normal,
                gap: snapped(gap, magnitude),
            });
        }
    }
    points
}
