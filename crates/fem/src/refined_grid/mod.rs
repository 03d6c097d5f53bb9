//! Grids with cells that are divided again and again where it matters, and continuous functions on them.
//!
//! Nodes on a side that a larger cell shares hang: there the functions of the smaller cells follow those of the larger
//! one. A function is one of a node that does not hang; a cell sees all functions that its own nodes follow.

mod cells;
mod functions;
mod leaf;
#[cfg(test)]
mod tests;

use crate::cells::Neighbours;
use crate::grid::Grid;
use leaf::{Leaf, balance, beside, box_of};
use signorini_geometry::{Aabb, Point};
use std::collections::{BTreeMap, HashMap};

/// Most divisions of a cell of the coarse grid.
pub const MOST_LEVELS: usize = 12;

/// A grid whose cells are divided where it matters; neighbours differ by at most one division.
#[derive(Clone, Debug)]
pub struct RefinedGrid {
    coarse: Grid<2>,
    leaves: Vec<Leaf>,
    number: HashMap<Leaf, u32>,
    levels: usize,
    /// Where the node of each function lies.
    nodes: Vec<Point<2>>,
    cells: Vec<Functions>,
    /// A cell of each kind: those of one level whose nodes do not hang.
    kinds: Vec<usize>,
    neighbours: Vec<Neighbours>,
}

/// The functions of a cell, and how its own nodes follow them.
#[derive(Clone, Debug)]
struct Functions {
    kind: Option<usize>,
    functions: Vec<u32>,
    /// For each node of the cell, pairs of place in `functions` and value; empty where they are the same.
    hanging: Vec<Vec<(u32, f64)>>,
}

impl RefinedGrid {
    /// Divides the cells of a grid as long as `wanted`, called with the box of a cell and how often it was divided, says so.
    pub fn new(coarse: &Grid<2>, wanted: impl Fn(&Aabb<2>, usize) -> bool) -> Self {
        let mut open: Vec<Leaf> = (0..coarse.cell_count())
            .map(|cell| Leaf { level: 0, index: coarse.cell_index(cell).map(|i| i as u32) })
            .collect();
        let mut leaves = BTreeMap::new();
        while let Some(leaf) = open.pop() {
            if usize::from(leaf.level) < MOST_LEVELS && wanted(&box_of(coarse, leaf), leaf.level.into()) {
                open.extend(leaf.children());
            } else {
                leaves.insert(leaf, ());
            }
        }
        balance(coarse, &mut leaves);
        Self::from_leaves(coarse.clone(), leaves.into_keys().collect())
    }

    fn from_leaves(coarse: Grid<2>, leaves: Vec<Leaf>) -> Self {
        let number: HashMap<Leaf, u32> = leaves.iter().enumerate().map(|(i, l)| (*l, i as u32)).collect();
        let levels = leaves.iter().map(|l| usize::from(l.level)).max().unwrap_or(0);
        let mut grid =
            Self { coarse, leaves, number, levels, nodes: vec![], cells: vec![], kinds: vec![], neighbours: vec![] };
        grid.number_functions();
        grid.find_neighbours();
        grid
    }

    fn leaf_containing(&self, x: &Point<2>) -> usize {
        let bounds = self.coarse.bounds();
        let cells = self.coarse.cells();
        for level in 0..=self.levels {
            let index = [0, 1].map(|k| {
                let n = cells[k] << level;
                let t = (x[k] - bounds.min[k]) / bounds.size()[k] * n as f64;
                (t.max(0.0) as usize).min(n - 1) as u32
            });
            if let Some(&leaf) = self.number.get(&Leaf { level: level as u8, index }) {
                return leaf as usize;
            }
        }
        // Leaves cover the box.
        0
    }

    /// The larger leaf across a side of a leaf, where there is one.
    fn larger(&self, leaf: Leaf, side: usize) -> Option<Leaf> {
        let beside = beside(&self.coarse, leaf, side)?;
        let parent = beside.parent()?;
        self.number.contains_key(&parent).then_some(parent)
    }
}
