//! Weighted gaps: the gap of two surfaces tested with the dual functions of the pressure nodes.
//!
//! `p_h = Σ λ_k ψ_k` with `ψ = D M⁻¹ N` on each slave face, `M = ∫ N Nᵀ`, `D = diag ∫ N` over its covered part, `N` the
//! Lagrange functions on the Gauss-Lobatto nodes (Wohlmuth 2000). Then `∫ ψ_k N_l = δ_kl D_k`: the pressure at a node is
//! its multiplier, weights are positive for every degree, and `Σ ψ_k = 1` makes forces balance. Corner functions of
//! quadratic triangles have no weight of their own and take a share of their neighbours (Popp, Wohlmuth, Gee & Wall
//! 2012). A node that is hardly covered gives its function to a neighbour.

use crate::multiplier::PressureNodes;
use crate::segments::GapPoint;
use crate::surface::ContactSurface;
use nalgebra::DMatrix;
use signorini_fem::CellShape;
use signorini_fem::hierarchic::Values;

/// The weighted gap of one pressure node, linear in the displacement: `∫ ψ_k g = gap + Σ coefficient · unknown ≥ 0`.
#[derive(Clone, Debug, PartialEq)]
pub struct WeightedGap {
    pub gap: f64,
    /// `∫ ψ_k` over the covered part.
    pub weight: f64,
    pub terms: Vec<(u32, f64)>,
    /// Node of [`PressureNodes`].
    pub node: u32,
}

/// Faces covered less than this keep the plain Lagrange functions; nodes covered less give theirs away.
const WEAK: f64 = 0.25;
/// Share of the area of its faces, per node, below which a node has no weight.
const WEIGHTLESS: f64 = 1e-6;
/// Share of a mid-edge function of a quadratic triangle that goes to each corner.
const SHARE: f64 = 0.2;

/// The weighted gaps of all pressure nodes that the points cover.
///
/// `folded` says which nodes must not have a pressure of their own, for example where the displacement is prescribed.
pub fn weighted_gaps<const D: usize>(
    slave: &dyn ContactSurface<D>,
    master: Option<&dyn ContactSurface<D>>,
    nodes: &PressureNodes<D>,
    points: &[Vec<GapPoint<D>>],
    folded: &dyn Fn(u32) -> bool,
) -> WeightedGaps {
    let mut rows =
        Rows { entries: vec![Vec::new(); nodes.len()], gap: vec![0.0; nodes.len()], weight: vec![0.0; nodes.len()] };
    let mut whole = vec![0.0; nodes.len()];
    let mut share_of_area = vec![0.0; nodes.len()];
    let mut at = Values::default();
    let mut trace = Vec::new();
    for (face, list) in points.iter().enumerate() {
        let map = nodes.map(face);
        let n = map.len();
        let change = quadratic_triangle(map.shape(), map.order());
        // What the functions would weigh on the whole face.
        let full = signorini_fem::rules::rule(map.shape(), map.order() + 2);
        let mut area = 0.0;
        for (s, w) in &full {
            map.tabulate(s, &mut at);
            let point = slave.at(face, s);
            let w = w * point.area_normal().norm() * slave.measure(&point.x);
            area += w;
            let values = changed(&change, &at.value);
            for ((node, _), v) in nodes.of_face(face).iter().zip(&values) {
                whole[*node as usize] += w * v;
            }
        }
        for (node, _) in nodes.of_face(face) {
            share_of_area[*node as usize] += area / n as f64;
        }
        if list.is_empty() {
            continue;
        }
        let covered: f64 = list.iter().map(|p| p.weight).sum();
        let mut functions = DMatrix::<f64>::zeros(n, list.len());
        for (q, p) in list.iter().enumerate() {
            map.tabulate(&p.s, &mut at);
            for (k, v) in changed(&change, &at.value).into_iter().enumerate() {
                functions[(k, q)] = v;
            }
        }
        let dual = dual(&functions, list, covered / area);
        for (q, p) in list.iter().enumerate() {
            trace.clear();
            slave.trace(face, &p.s, &mut trace);
            let of_slave = trace.len();
            if let (Some((other, eta)), Some(master)) = (&p.master, master) {
                master.trace(*other as usize, eta, &mut trace);
            }
            for (k, (node, _)) in nodes.of_face(face).iter().enumerate() {
                let row = *node as usize;
                let share = p.weight * dual[(k, q)];
                rows.gap[row] += share * p.gap;
                rows.weight[row] += share;
                for (m, (unknown, value)) in trace.iter().enumerate() {
                    let sign = if m < of_slave { share } else { -share };
                    for i in 0..D {
                        if p.direction[i] != 0.0 {
                            rows.entries[row].push((unknown + i as u32, sign * value * p.direction[i]));
                        }
                    }
                }
            }
        }
        // Entries of one face are added up at once, so that lists stay short.
        for (node, _) in nodes.of_face(face) {
            compress(&mut rows.entries[*node as usize]);
        }
    }
    // On the axis of a body of revolution a vertex of quadratic faces has no weight at all.
    let weightless: Vec<bool> = whole.iter().zip(&share_of_area).map(|(w, a)| *w < WEIGHTLESS * a).collect();
    let given = fold(nodes, &mut rows, &whole, &|k| weightless[k as usize] || folded(k));
    let Rows { entries, gap, weight } = rows;
    let rows = (entries.into_iter().enumerate())
        .filter(|(k, terms)| weight[*k] > 0.0 && !terms.is_empty())
        .map(|(k, terms)| WeightedGap { gap: gap[k], weight: weight[k], terms, node: k as u32 })
        .collect();
    let given = given.into_iter().map(|[from, to]| Given { from, to, weightless: weightless[from as usize] }).collect();
    WeightedGaps { rows, given }
}

/// The rows of a surface, and the nodes without rows of their own.
#[derive(Clone, Debug, Default)]
pub struct WeightedGaps {
    pub rows: Vec<WeightedGap>,
    pub given: Vec<Given>,
}

/// A node that gave its function to another and shares its pressure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Given {
    pub from: u32,
    pub to: u32,
    /// Because its function has no weight anywhere.
    pub weightless: bool,
}

struct Rows {
    entries: Vec<Vec<(u32, f64)>>,
    gap: Vec<f64>,
    weight: Vec<f64>,
}

/// Adds up entries of the same unknown.
pub fn compress(list: &mut Vec<(u32, f64)>) {
    list.sort_by_key(|e| e.0);
    list.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 += next.1;
        }
        same
    });
}

/// Values of the dual functions at the points.
fn dual<const D: usize>(functions: &DMatrix<f64>, points: &[GapPoint<D>], cover: f64) -> DMatrix<f64> {
    if cover < WEAK {
        return functions.clone();
    }
    let mut weighted = functions.clone();
    for (q, p) in points.iter().enumerate() {
        weighted.column_mut(q).scale_mut(p.weight);
    }
    let mass = &weighted * functions.transpose();
    let weights = weighted.column_sum();
    match mass.cholesky() {
        Some(factor) => DMatrix::from_diagonal(&weights) * factor.solve(functions),
        None => functions.clone(),
    }
}

/// Which nodes of a quadratic triangle lie beside each mid-edge node.
fn quadratic_triangle(shape: CellShape, order: usize) -> Option<&'static [[usize; 2]]> {
    (shape == CellShape::Triangle && order == 2).then(|| shape.edges())
}

/// Functions with positive weights: corners of quadratic triangles take a share of the mid-edge functions.
fn changed(edges: &Option<&'static [[usize; 2]]>, values: &[f64]) -> Vec<f64> {
    let mut out = values.to_vec();
    if let Some(edges) = edges {
        for (m, &[a, b]) in edges.iter().enumerate() {
            let middle = values[3 + m];
            out[a] += SHARE * middle;
            out[b] += SHARE * middle;
            out[3 + m] = (1.0 - 2.0 * SHARE) * middle;
        }
    }
    out
}

/// Nodes that are hardly covered, or must have no pressure of their own, give their function to the nearest node of one
/// of their faces that keeps its own; the functions still sum to one.
fn fold<const D: usize>(
    nodes: &PressureNodes<D>,
    rows: &mut Rows,
    whole: &[f64],
    folded: &dyn Fn(u32) -> bool,
) -> Vec<[u32; 2]> {
    let mut given = Vec::new();
    let count = nodes.len();
    let weak: Vec<bool> = (0..count)
        .map(|k| rows.weight[k] < WEAK * whole[k] || (!rows.entries[k].is_empty() && folded(k as u32)))
        .collect();
    if !weak.iter().any(|w| *w) {
        return given;
    }
    let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); count];
    for face in 0..nodes.face_count() {
        for (a, _) in nodes.of_face(face) {
            neighbours[*a as usize].extend(nodes.of_face(face).iter().map(|(b, _)| *b).filter(|b| b != a));
        }
    }
    for k in 0..count {
        if !weak[k] || rows.entries[k].is_empty() {
            continue;
        }
        // Breadth first over faces, the nearest of the first ring that has a strong node.
        let mut seen = vec![k as u32];
        let mut ring = vec![k as u32];
        let target = loop {
            let mut next: Vec<u32> = ring.iter().flat_map(|&r| neighbours[r as usize].iter().copied()).collect();
            next.sort_unstable();
            next.dedup();
            next.retain(|n| !seen.contains(n));
            if next.is_empty() {
                break None;
            }
            let distance = |n: &u32| (nodes.positions[*n as usize] - nodes.positions[k]).norm();
            let strong = (next.iter().copied().filter(|&n| !weak[n as usize] && !rows.entries[n as usize].is_empty()))
                .min_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b)));
            if strong.is_some() {
                break strong;
            }
            seen.extend(&next);
            ring = next;
        };
        let Some(target) = target.map(|t| t as usize) else { continue };
        let entries = std::mem::take(&mut rows.entries[k]);
        rows.entries[target].extend(entries);
        rows.gap[target] += std::mem::take(&mut rows.gap[k]);
        rows.weight[target] += std::mem::take(&mut rows.weight[k]);
        compress(&mut rows.entries[target]);
        given.push([k as u32, target as u32]);
    }
    given
}
