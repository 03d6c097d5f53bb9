//! Dual functions of the pressure nodes, with which the gap of two surfaces is tested.
//!
//! `p_h = Σ λ_k ψ_k` with `ψ = D M⁻¹ N` on each slave face, `M = ∫ N Nᵀ`, `D = diag ∫ N` over its covered part, `N` the
//! Lagrange functions on the Gauss-Lobatto nodes (Wohlmuth 2000). Then `∫ ψ_k N_l = δ_kl D_k`: the pressure at a node is
//! its multiplier, weights are positive for every degree, and `Σ ψ_k = 1` makes forces balance. Corner functions of
//! quadratic triangles have no weight of their own and take a share of their neighbours (Popp, Wohlmuth, Gee & Wall
//! 2012). A node that is hardly covered gives its function to a neighbour.

use crate::face_point::FacePoint;
use crate::multiplier::{MergedNode, PressureNodes};
use crate::segments::GapPoint;
use crate::surface::ContactSurface;
use nalgebra::DMatrix;
use signorini_basis::CellShape;
use signorini_basis::cell_map::CellMap;
use signorini_basis::hierarchic::Values;
use signorini_basis::rules::rule;
use signorini_geometry::Point;

/// Faces covered less than this keep the plain Lagrange functions; nodes covered less give theirs away.
const WEAK: f64 = 0.25;
/// Share of the area of its faces, per node, below which a node has no weight.
const WEIGHTLESS: f64 = 1e-6;
/// Share of a mid-edge function of a quadratic triangle that goes to each corner.
const SHARE: f64 = 0.2;

/// How much every point counts for which pressure node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DualWeights {
    /// For every point of every face: nodes, and value of the dual function times the weight of the point.
    pub of_point: Vec<Vec<Vec<(u32, f64)>>>,
    /// `∫ ψ_k` over the covered part, by node; zero for nodes without a row of their own.
    pub weight: Vec<f64>,
    pub given: Vec<MergedNode>,
}

/// The dual functions of all pressure nodes at the points.
///
/// `merged` says which nodes must not have a pressure of their own, for example where the displacement is prescribed.
pub fn shares<const D: usize>(
    slave: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    points: &[Vec<GapPoint<D>>],
    merged: &dyn Fn(u32) -> bool,
) -> DualWeights {
    shares_above(WEAK, slave, nodes, points, merged)
}

/// The same for sides that slide: nodes that are hardly covered keep their functions, since what they gave away would jump
/// from node to node. Their weights may be small, or for high degrees even negative.
pub fn dual_weights_unmerged<const D: usize>(
    slave: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    points: &[Vec<GapPoint<D>>],
    merged: &dyn Fn(u32) -> bool,
) -> DualWeights {
    shares_above(f64::NEG_INFINITY, slave, nodes, points, merged)
}

/// The dual functions, of which nodes with less than a part of their weight give theirs away.
fn shares_above<const D: usize>(
    least: f64,
    slave: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    points: &[Vec<GapPoint<D>>],
    merged: &dyn Fn(u32) -> bool,
) -> DualWeights {
    let mut out = DualWeights { of_point: Vec::new(), weight: vec![0.0; nodes.len()], given: Vec::new() };
    let mut whole = vec![0.0; nodes.len()];
    let mut covered = vec![false; nodes.len()];
    let mut at = Values::default();
    for (face, list) in points.iter().enumerate() {
        let map = nodes.map(face);
        let n = map.len();
        let change = quadratic_triangle(map.shape(), map.order());
        // What the functions would weigh on the whole face.
        let full = rule(map.shape(), map.order() + 2);
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
            covered[*node as usize] |= !list.is_empty();
        }
        let mut functions = DMatrix::<f64>::zeros(n, list.len());
        for (q, p) in list.iter().enumerate() {
            map.tabulate(&p.s, &mut at);
            for (k, v) in changed(&change, &at.value).into_iter().enumerate() {
                functions[(k, q)] = v;
            }
        }
        let cover: f64 = list.iter().map(|p| p.weight).sum();
        let dual = if list.is_empty() { functions } else { dual(&functions, list, cover / area) };
        let of_face = (list.iter().enumerate())
            .map(|(q, p)| {
                let values = nodes.of_face(face).iter().enumerate();
                values.map(|(k, (node, _))| (*node, p.weight * dual[(k, q)])).collect::<Vec<_>>()
            })
            .inspect(|list| list.iter().for_each(|(node, share)| out.weight[*node as usize] += share))
            .collect();
        out.of_point.push(of_face);
    }
    // On the axis of a body of revolution a vertex of quadratic faces has no weight at all.
    let weightless = without_integral(slave, nodes, &quadratic_triangle);
    let weak: Vec<bool> = (0..nodes.len())
        .map(|k| out.weight[k] < least * whole[k] || covered[k] && (weightless[k] || merged(k as u32)))
        .collect();
    for [from, to] in fold(nodes, &weak, &covered) {
        out.weight[to as usize] += std::mem::take(&mut out.weight[from as usize]);
        out.given.push(MergedNode { from, to, weightless: weightless[from as usize] });
    }
    if !out.given.is_empty() {
        let mut target: Vec<u32> = (0..nodes.len() as u32).collect();
        out.given.iter().for_each(|g| target[g.from as usize] = g.to);
        for list in out.of_point.iter_mut().flatten() {
            list.iter_mut().for_each(|(node, _)| *node = target[*node as usize]);
            compress(list);
        }
    }
    out
}

/// The nodes whose Lagrange functions have no integral, such as the vertices of quadratic triangles and, from degree 2, the
/// nodes on an axis, and the folded ones: each with the nearest node that keeps its own.
pub fn weightless<const D: usize>(
    slave: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    merged: &dyn Fn(u32) -> bool,
) -> Vec<MergedNode> {
    let weightless = without_integral(slave, nodes, &|_, _| None);
    let weak: Vec<bool> = (0..nodes.len()).map(|k| weightless[k] || merged(k as u32)).collect();
    let pairs = fold(nodes, &weak, &vec![true; nodes.len()]);
    pairs.into_iter().map(|[from, to]| MergedNode { from, to, weightless: weightless[from as usize] }).collect()
}

/// Whether the functions of the nodes have no integral on flat faces. A little curvature gives them a little, of either
/// sign, and a force divided by that is no pressure.
fn without_integral<const D: usize>(
    slave: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    change: &dyn Fn(CellShape, usize) -> Change,
) -> Vec<bool> {
    let (mut whole, mut share_of_area) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
    let (mut at, mut linear) = (Values::default(), Values::default());
    let mut flats: Vec<CellMap> = Vec::new();
    for face in 0..nodes.face_count() {
        let map = nodes.map(face);
        let flat = flats.iter().position(|f| f.shape() == map.shape()).unwrap_or_else(|| {
            flats.push(CellMap::new(map.shape(), 1));
            flats.len() - 1
        });
        let flat = &flats[flat];
        let corners: Vec<Point<D>> = flat.nodes().iter().map(|s| slave.at(face, s).x).collect();
        let change = change(map.shape(), map.order());
        let own = nodes.of_face(face);
        for (s, w) in rule(map.shape(), map.order() + 2) {
            map.tabulate(&s, &mut at);
            flat.tabulate(&s, &mut linear);
            let x: Point<D> = corners.iter().zip(&linear.value).map(|(x, v)| x * *v).sum();
            let along = |k: usize| corners.iter().zip(&linear.gradient).map(|(x, g)| x * g[k]).sum::<Point<D>>();
            let tangents = [along(0), if D == 3 { along(1) } else { Point::zeros() }];
            let area = w * FacePoint { x, tangents }.area_normal().norm() * slave.measure(&x);
            for ((node, _), v) in own.iter().zip(changed(&change, &at.value)) {
                whole[*node as usize] += area * v;
                share_of_area[*node as usize] += area / own.len() as f64;
            }
        }
    }
    whole.iter().zip(&share_of_area).map(|(w, a)| *w < WEIGHTLESS * a).collect()
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

/// The nodes of a quadratic triangle beside each mid-edge node, from which they take a share.
type Change = Option<&'static [[usize; 2]]>;

/// Which nodes of a quadratic triangle lie beside each mid-edge node.
fn quadratic_triangle(shape: CellShape, order: usize) -> Change {
    (shape == CellShape::Triangle && order == 2).then(|| shape.edges())
}

/// Functions with positive weights: corners of quadratic triangles take a share of the mid-edge functions.
fn changed(edges: &Change, values: &[f64]) -> Vec<f64> {
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
fn fold<const D: usize>(nodes: &PressureNodes<D>, weak: &[bool], covered: &[bool]) -> Vec<[u32; 2]> {
    let mut given = Vec::new();
    let count = nodes.len();
    if !weak.iter().zip(covered).any(|(w, c)| *w && *c) {
        return given;
    }
    let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); count];
    for face in 0..nodes.face_count() {
        for (a, _) in nodes.of_face(face) {
            neighbours[*a as usize].extend(nodes.of_face(face).iter().map(|(b, _)| *b).filter(|b| b != a));
        }
    }
    for k in (0..count).filter(|&k| weak[k] && covered[k]) {
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
            let strong = (next.iter().copied().filter(|&n| !weak[n as usize] && covered[n as usize]))
                .min_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b)));
            if strong.is_some() {
                break strong;
            }
            seen.extend(&next);
            ring = next;
        };
        if let Some(target) = target {
            given.push([k as u32, target]);
        }
    }
    given
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::segments::segments;
    use crate::testing::Polyline;

    #[test]
    fn dual_functions_sum_to_one_and_each_meets_its_own_function_alone() {
        let slave = Polyline::at(&[0.0, 0.6, 1.3, 2.0], |x| 0.1 + 0.05 * x);
        let master = Polyline::at(&[3.0, 1.7, 0.9, -1.0], |_| 0.0);
        let nodes = PressureNodes::new(&slave);
        let points = segments(&slave, &master, &nodes, crate::testing::ANY);
        let shares = shares(&slave, &nodes, &points, &|_| false);
        let mut products = DMatrix::<f64>::zeros(nodes.len(), nodes.len());
        for (face, list) in points.iter().enumerate() {
            for (p, of) in list.iter().zip(&shares.of_point[face]) {
                assert!((of.iter().map(|s| s.1).sum::<f64>() - p.weight).abs() < 1e-15);
                let values = [0.5 * (1.0 - p.s[0]), 0.5 * (1.0 + p.s[0])];
                for (node, share) in of {
                    for ((other, _), v) in nodes.of_face(face).iter().zip(values) {
                        products[(*node as usize, *other as usize)] += share * v;
                    }
                }
            }
        }
        for k in 0..nodes.len() {
            for l in 0..nodes.len() {
                let exact = if k == l { shares.weight[k] } else { 0.0 };
                assert!((products[(k, l)] - exact).abs() < 1e-14, "{k}, {l}: {}", products[(k, l)]);
            }
        }
        assert!((shares.weight.iter().sum::<f64>() - 2.0 * 0.05f64.hypot(1.0)).abs() < 1e-13);
    }
}
