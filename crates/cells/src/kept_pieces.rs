//! Which pieces of the material have unknowns, and their quadrature.

use crate::cell::Findings;
use crate::components::PieceGraph;
use crate::discretisation::Islands;
use crate::error::CellsError;
use crate::region::{Filling, MaterialRule};
use crate::tree::CellTree;
use signorini_geometry::Point;

/// The points of a rule by piece, one rule a piece.
pub(crate) fn rules_of_pieces<const D: usize>(
    tree: &CellTree<D>,
    graph: &PieceGraph<D>,
    rules: Vec<MaterialRule<D>>,
) -> Vec<MaterialRule<D>> {
    let mut out = Vec::with_capacity(graph.touching.len());
    for (leaf, rule) in rules.into_iter().enumerate() {
        let pieces = &graph.leaves[leaf];
        if pieces.count == 1 {
            out.push(rule);
            continue;
        }
        let first = out.len();
        out.extend((0..pieces.count).map(|_| MaterialRule::empty(Filling::Cut)));
        // A surface point belongs to the material just below it.
        let depth = 0.02 * tree.leaves()[leaf].size();
        rule.volume.into_iter().for_each(|p| out[first + pieces.at(&p.x)].volume.push(p));
        for p in rule.boundary {
            out[first + pieces.at(&(p.x - p.normal * depth))].boundary.push(p);
        }
    }
    out
}

/// Which pieces are kept.
pub(crate) fn kept_pieces<const D: usize>(
    tree: &CellTree<D>,
    graph: &PieceGraph<D>,
    rules: &[MaterialRule<D>],
    islands: Islands,
    findings: &mut Findings,
) -> Result<Vec<bool>, CellsError> {
    let (part, count) = graph.parts();
    let mut volume = vec![0.0; count];
    let mut middle = vec![Point::<D>::zeros(); count];
    for (piece, rule) in rules.iter().enumerate() {
        let b = tree.leaves()[graph.leaf_of(piece)].bounds;
        let v = rule.measure(b.volume());
        volume[part[piece]] += v;
        middle[part[piece]] += b.center() * v;
    }
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|a, b| volume[*b].total_cmp(&volume[*a]).then(a.cmp(b)));
    findings.parts = order.iter().map(|p| volume[*p]).collect();
    // A piece of which no sample saw material holds none.
    let mut kept: Vec<bool> = rules.iter().map(|r| r.filling == Filling::Full || !r.volume.is_empty()).collect();
    if let [_, second, ..] = order[..] {
        match islands {
            Islands::Keep => {}
            Islands::Drop => {
                findings.dropped = findings.parts[1..].iter().sum();
                (0..kept.len()).for_each(|p| kept[p] &= part[p] == order[0]);
            }
            Islands::Refuse => {
                let at = (middle[second] / volume[second]).iter().copied().collect();
                return Err(CellsError::Islands { count: count - 1, volume: volume[second], at });
            }
        }
    }
    Ok(kept)
}
