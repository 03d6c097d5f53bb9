//! The pressure as it is shown: smoother than the multipliers, with the same force.
//!
//! Quadratic faces: the projection `∫ p N_l = D_l λ_l` on the Lagrange functions of the active nodes, which takes the
//! ripple between vertices and mid-side nodes away. Other degrees: the multipliers at the nodes are as good.

use crate::multiplier::PressureNodes;
use crate::segments::GapPoint;
use signorini_fem::hierarchic::Values;
use signorini_solve::SymmetricMatrix;
use signorini_solve::cholesky::Symbolic;

/// The recovered pressure of every node of a surface, from the multipliers, weights and states by node; `weightless` says
/// which nodes take part although their function has no weight.
pub fn recovered<const D: usize>(
    nodes: &PressureNodes<D>,
    points: &[Vec<GapPoint<D>>],
    multiplier: &[f64],
    weight: &[f64],
    active: &[bool],
    weightless: &[bool],
) -> Vec<f64> {
    let mut out = multiplier.to_vec();
    let quadratic = |face: usize| nodes.map(face).order() == 2 && nodes.map(face).shape().is_tensor();
    let mut number = vec![u32::MAX; nodes.len()];
    let mut list = Vec::new();
    for face in (0..nodes.face_count()).filter(|&f| quadratic(f)) {
        for (node, _) in nodes.of_face(face) {
            let k = *node as usize;
            if active[k] && (weight[k] > 0.0 || weightless[k]) && number[k] == u32::MAX {
                number[k] = list.len() as u32;
                list.push(k);
            }
        }
    }
    if list.is_empty() {
        return out;
    }
    let mut cliques = Vec::new();
    let mut matrices = Vec::new();
    let mut at = Values::default();
    for face in (0..nodes.face_count()).filter(|&f| quadratic(f) && f < points.len() && !points[f].is_empty()) {
        let own = nodes.of_face(face);
        let used: Vec<usize> = (0..own.len()).filter(|&k| number[own[k].0 as usize] != u32::MAX).collect();
        if used.is_empty() {
            continue;
        }
        let mut matrix = vec![0.0; used.len() * used.len()];
        for p in &points[face] {
            nodes.map(face).tabulate(&p.s, &mut at);
            for (a, &i) in used.iter().enumerate() {
                for (b, &j) in used.iter().enumerate() {
                    matrix[a * used.len() + b] += p.weight * at.value[i] * at.value[j];
                }
            }
        }
        cliques.push(used.iter().map(|&k| number[own[k].0 as usize]).collect::<Vec<u32>>());
        matrices.push(matrix);
    }
    let mut mass = SymmetricMatrix::from_cliques(list.len(), &cliques);
    for (clique, matrix) in cliques.iter().zip(&matrices) {
        mass.add(clique, matrix, 1.0);
    }
    let rhs: Vec<f64> = list.iter().map(|&k| weight[k] * multiplier[k]).collect();
    // Nodes folded onto others may leave the matrix singular; then the multipliers stand.
    if let Ok(found) = Symbolic::default().factor(mass).and_then(|factor| factor.solve(&rhs)) {
        for (&k, p) in list.iter().zip(found) {
            out[k] = p;
        }
    }
    out
}
