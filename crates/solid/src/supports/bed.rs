//! Elastic beds.

use super::statement::{Support, SupportKind};
use crate::body::Bodies;
use signorini_contact::ContactSurface;
use signorini_fem::rules::rule;

/// Stiffness of elastic beds: the support, the unknowns of each side, and its matrix.
pub(crate) fn beds<const D: usize>(bodies: &Bodies<D>, supports: &[Support]) -> Vec<(usize, Vec<u32>, Vec<f64>)> {
    let mut out = Vec::new();
    for (number, support) in supports.iter().enumerate() {
        let SupportKind::Spring(stiffness) = &support.kind else { continue };
        let surface = bodies.surface(support.body, support.group.sides.clone());
        let mut trace = Vec::new();
        for face in 0..surface.sides.len() {
            let mut matrix = Vec::new();
            let mut unknowns = Vec::new();
            for (s, w) in rule(surface.shape(face), bodies.list[support.body].degree + 1) {
                let point = surface.at(face, &s);
                let w = w * point.area_normal().norm() * surface.measure(&point.x);
                trace.clear();
                surface.trace(face, &s, &mut trace);
                let n = trace.len() * D;
                if matrix.is_empty() {
                    matrix = vec![0.0; n * n];
                    unknowns = trace.iter().flat_map(|(u, _)| (0..D as u32).map(move |i| u + i)).collect();
                }
                for (a, (_, va)) in trace.iter().enumerate() {
                    for (b, (_, vb)) in trace.iter().enumerate() {
                        for i in 0..D {
                            matrix[(a * D + i) * n + b * D + i] += w * stiffness[i] * va * vb;
                        }
                    }
                }
            }
            out.push((number, unknowns, matrix));
        }
    }
    out
}
