//! The nodes of the cells, those that hang, and the functions of those that do not.

use super::leaf::{Leaf, beside, box_of};
use super::{Functions, MOST_LEVELS, RefinedGrid};
use crate::cells::Neighbours;
use signorini_geometry::Point;
use std::collections::HashMap;

/// A node, by what it lies on: Gauss-Lobatto points of cells of unlike size share no lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Node {
    /// In units of the smallest cells that may be.
    Vertex([u64; 2]),
    /// Direction, level, place of the lower end in cells of that level, and number along the side.
    Edge(u8, u8, [u32; 2], u8),
    /// Level, place and number within the cell.
    Interior(u8, [u32; 2], u16),
}

impl RefinedGrid {
    fn vertex(&self, leaf: Leaf, corner: [u32; 2]) -> Node {
        let shift = MOST_LEVELS - usize::from(leaf.level);
        Node::Vertex([0, 1].map(|k| u64::from(leaf.index[k] + corner[k]) << shift))
    }

    /// The corners of a leaf and of smaller ones beside it, counter-clockwise, in units of the smallest leaves.
    pub(super) fn corners(&self, leaf: Leaf) -> Vec<[u32; 2]> {
        let unit = 1 << (self.levels - usize::from(leaf.level));
        let smaller = |side: usize| {
            beside(&self.coarse, leaf, side).is_some_and(|b| !self.number.contains_key(&b))
                && self.larger(leaf, side).is_none()
        };
        let at = |o: [u32; 2]| [0, 1].map(|k| leaf.index[k] * unit + o[k] * unit / 2);
        let mut corners = Vec::with_capacity(8);
        for (corner, middle, side) in
            [([0, 0], [1, 0], 2), ([2, 0], [2, 1], 1), ([2, 2], [1, 2], 3), ([0, 2], [0, 1], 0)]
        {
            corners.push(at(corner));
            if smaller(side) {
                corners.push(at(middle));
            }
        }
        corners
    }

    /// The nodes along a side of a leaf: `p + 1` in the positive direction.
    fn side_nodes(&self, leaf: Leaf, side: usize) -> Vec<Node> {
        let (normal, upper) = (side / 2, (side % 2) as u32);
        let along = 1 - normal;
        let mut low = [0; 2];
        low[normal] = upper;
        let mut high = low;
        high[along] = 1;
        let mut from = leaf.index;
        from[normal] += upper;
        let p = self.coarse.degree();
        let inner = (1..p).map(|i| Node::Edge(along as u8, leaf.level, from, i as u8));
        [self.vertex(leaf, low)].into_iter().chain(inner).chain([self.vertex(leaf, high)]).collect()
    }

    /// The nodes of a leaf, in the order of the basis.
    pub(super) fn nodes(&self, leaf: Leaf) -> Vec<Node> {
        let p = self.coarse.degree();
        let sides: [Vec<Node>; 4] = [0, 1, 2, 3].map(|side| self.side_nodes(leaf, side));
        (0..(p + 1) * (p + 1))
            .map(|k| {
                let (i, j) = (k % (p + 1), k / (p + 1));
                match (i, j) {
                    (0, _) => sides[0][j],
                    (i, _) if i == p => sides[1][j],
                    (_, 0) => sides[2][i],
                    (_, j) if j == p => sides[3][i],
                    _ => Node::Interior(leaf.level, leaf.index, k as u16),
                }
            })
            .collect()
    }

    /// Numbers the nodes that do not hang, and lets the others follow them.
    pub(super) fn number_functions(&mut self) {
        // What each hanging node follows: the nodes of the larger side that it lies on.
        let mut follows: HashMap<Node, Vec<(Node, f64)>> = HashMap::new();
        let basis = self.coarse.basis();
        let places = basis.line_nodes();
        for &leaf in &self.leaves {
            for side in 0..4 {
                let Some(large) = self.larger(leaf, side) else { continue };
                let masters = self.side_nodes(large, side ^ 1);
                let along = 1 - side / 2;
                let half = f64::from(leaf.index[along] % 2);
                for (node, place) in self.side_nodes(leaf, side).into_iter().zip(places) {
                    let t = 0.5 * (half + place);
                    if let Some(same) = masters.iter().position(|m| *m == node) {
                        debug_assert!((places[same] - t).abs() < 1e-12);
                        continue;
                    }
                    let values = basis.line(t)[0];
                    let list = masters.iter().zip(values).filter(|(_, v)| *v != 0.0).map(|(m, v)| (*m, v)).collect();
                    follows.insert(node, list);
                }
            }
        }
        let mut numbers: HashMap<Node, u32> = HashMap::new();
        let mut placed = Vec::new();
        let mut kinds: Vec<Option<usize>> = vec![None; self.levels + 1];
        let mut representatives = Vec::new();
        let mut cells = Vec::with_capacity(self.leaves.len());
        for (cell, &leaf) in self.leaves.iter().enumerate() {
            let nodes = self.nodes(leaf);
            let mut functions = Vec::new();
            let mut own: Vec<Vec<(u32, f64)>> = Vec::new();
            let bounds = box_of(&self.coarse, leaf);
            for (k, node) in nodes.iter().enumerate() {
                let mut list: Vec<(u32, f64)> = Vec::new();
                // A node of a larger side may hang on a side that is larger still.
                let mut open = vec![(*node, 1.0)];
                while let Some((node, weight)) = open.pop() {
                    if let Some(masters) = follows.get(&node) {
                        open.extend(masters.iter().map(|(m, v)| (*m, v * weight)));
                        continue;
                    }
                    let function = *numbers.entry(node).or_insert_with(|| {
                        placed.push(Point::<2>::zeros());
                        placed.len() as u32 - 1
                    });
                    let at = functions.iter().position(|f| *f == function).unwrap_or_else(|| {
                        functions.push(function);
                        functions.len() - 1
                    }) as u32;
                    match list.iter_mut().find(|(a, _)| *a == at) {
                        Some((_, v)) => *v += weight,
                        None => list.push((at, weight)),
                    }
                }
                if !follows.contains_key(node) {
                    let at = [k % places.len(), k / places.len()].map(|i| places[i]);
                    placed[functions[list[0].0 as usize] as usize] = bounds.at(&Point::<2>::from(at));
                }
                own.push(list);
            }
            let hangs = nodes.iter().any(|n| follows.contains_key(n));
            let kind = (!hangs).then(|| {
                *kinds[usize::from(leaf.level)].get_or_insert_with(|| {
                    representatives.push(cell);
                    representatives.len() - 1
                })
            });
            cells.push(Functions { kind, functions, hanging: if hangs { own } else { Vec::new() } });
        }
        self.nodes = placed;
        self.cells = cells;
        self.kinds = representatives;
    }

    pub(super) fn find_neighbours(&mut self) {
        let size = self.coarse.cell_size();
        let mut pairs = Vec::new();
        for (cell, &leaf) in self.leaves.iter().enumerate() {
            for side in 0..4 {
                let k = side / 2;
                let width = size[k] / f64::from(1u32 << leaf.level);
                if let Some(large) = self.larger(leaf, side) {
                    pairs.push(Neighbours { cells: [cell, self.number[&large] as usize], width, kind: None });
                } else if side % 2 == 1
                    && let Some(&other) = beside(&self.coarse, leaf, side).and_then(|b| self.number.get(&b))
                {
                    let both = self.cells[cell].kind.is_some() && self.cells[other as usize].kind.is_some();
                    // The penalty of cells of one shape does not depend on their size in the plane.
                    let kind = both.then_some(k);
                    pairs.push(Neighbours { cells: [cell, other as usize], width, kind });
                }
            }
        }
        self.neighbours = pairs;
    }
}
