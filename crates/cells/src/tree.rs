//! The cells: a grid of boxes, any of which may be halved in every direction again and again.

use crate::error::CellsError;
use signorini_geometry::{Aabb, Point};
use std::collections::BTreeSet;

/// The deepest level of refinement.
pub const MAX_LEVEL: usize = 12;

/// A cell that is not refined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaf<const D: usize> {
    /// How often a cell of the grid was halved.
    pub level: usize,
    /// Place among the cells of its level.
    pub index: [usize; D],
    pub bounds: Aabb<D>,
}

impl<const D: usize> Leaf<D> {
    /// Coordinates in `[-1, 1]^D`, of points beyond the cell too.
    pub fn local(&self, x: &Point<D>) -> Point<D> {
        Point::from_fn(|k, _| {
            let (a, b) = (self.bounds.min[k], self.bounds.max[k]);
            (2.0 * x[k] - a - b) / (b - a)
        })
    }

    /// Least extent.
    pub fn size(&self) -> f64 {
        self.bounds.size().min()
    }
}

/// Bytes that every leaf takes at least, with material or without: its place in the tree, while that grows.
const BYTES_OF_A_LEAF: f64 = 200.0;

/// A grid of cells with refinement.
#[derive(Clone, Debug)]
pub struct CellTree<const D: usize> {
    bounds: Aabb<D>,
    cells: [usize; D],
    /// Bytes that the tree may take.
    memory: f64,
    /// The refined cells of each level.
    refined: Vec<BTreeSet<[usize; D]>>,
    leaves: Vec<Leaf<D>>,
}

impl<const D: usize> CellTree<D> {
    /// A uniform grid of `cells` in each direction of a box.
    ///
    /// # Errors
    /// A box without extent or with corners that are not finite; no cells in some direction.
    pub fn new(bounds: Aabb<D>, cells: [usize; D]) -> Result<Self, CellsError> {
        Self::within(f64::INFINITY, bounds, cells)
    }

    /// A uniform grid that takes no more than some bytes, and never grows beyond.
    ///
    /// # Errors
    /// Those of [`CellTree::new`]; a grid that needs more.
    pub fn within(memory: f64, bounds: Aabb<D>, cells: [usize; D]) -> Result<Self, CellsError> {
        let corners: Vec<f64> = bounds.min.iter().chain(&bounds.max).copied().collect();
        if corners.iter().any(|x| !x.is_finite()) || bounds.size().iter().any(|s| *s <= 0.0) {
            return Err(CellsError::Box { corners });
        }
        if cells.contains(&0) {
            return Err(CellsError::NoCells { cells: cells.to_vec() });
        }
        let mut tree = CellTree { bounds, cells, memory, refined: Vec::new(), leaves: Vec::new() };
        tree.check_leaves(cells.iter().map(|n| *n as f64).product())?;
        tree.update();
        Ok(tree)
    }

    fn check_leaves(&self, leaves: f64) -> Result<(), CellsError> {
        CellsError::check_memory(leaves, leaves * BYTES_OF_A_LEAF, self.memory)
    }

    /// Halves in every direction all leaves that are named; gives how many there were.
    ///
    /// # Errors
    /// More leaves than the memory holds; the tree is then as before.
    pub fn refine(&mut self, mut which: impl FnMut(&Leaf<D>) -> bool) -> Result<usize, CellsError> {
        let chosen: Vec<Leaf<D>> = self.leaves.iter().filter(|l| l.level < MAX_LEVEL && which(l)).copied().collect();
        let children = (1 << D) - 1;
        self.check_leaves((self.leaves.len() + children * chosen.len()) as f64)?;
        for leaf in &chosen {
            while self.refined.len() <= leaf.level {
                self.refined.push(BTreeSet::new());
            }
            self.refined[leaf.level].insert(leaf.index);
        }
        if !chosen.is_empty() {
            self.update();
        }
        Ok(chosen.len())
    }

    pub fn bounds(&self) -> &Aabb<D> {
        &self.bounds
    }

    /// Cells of the grid in each direction.
    pub fn cells(&self) -> [usize; D] {
        self.cells
    }

    /// Number of cells along a direction on a level.
    pub fn count(&self, level: usize, axis: usize) -> usize {
        self.cells[axis] << level
    }

    /// The leaves, in the order of the grid, those of a refined cell in its place.
    pub fn leaves(&self) -> &[Leaf<D>] {
        &self.leaves
    }

    pub fn is_refined(&self, level: usize, index: &[usize; D]) -> bool {
        self.refined.get(level).is_some_and(|set| set.contains(index))
    }

    /// Whether a cell of a level is a leaf or an ancestor of leaves.
    pub fn exists(&self, level: usize, index: &[usize; D]) -> bool {
        level == 0 || self.is_refined(level - 1, &index.map(|i| i / 2))
    }

    /// The box of a cell of a level.
    pub fn cell_box(&self, level: usize, index: &[usize; D]) -> Aabb<D> {
        let corner = |add: usize| {
            Point::from_fn(|k, _| {
                let n = self.count(level, k);
                let i = index[k] + add;
                // The outer sides exactly.
                if i == n {
                    self.bounds.max[k]
                } else {
                    self.bounds.min[k] + self.bounds.size()[k] * i as f64 / n as f64
                }
            })
        };
        Aabb::new(corner(0), corner(1))
    }

    /// The leaf that contains a point, that of the greater place on sides between two; points outside belong to the
    /// nearest leaf.
    pub fn leaf_at(&self, x: &Point<D>) -> usize {
        let mut level = 0;
        loop {
            let index: [usize; D] = std::array::from_fn(|k| {
                let n = self.count(level, k);
                let t = (x[k] - self.bounds.min[k]) / self.bounds.size()[k] * n as f64;
                (t.max(0.0) as usize).min(n - 1)
            });
            if self.refined.is_empty() {
                return (0..D).rev().fold(0, |n, k| n * self.cells[k] + index[k]);
            }
            if !self.is_refined(level, &index) {
                let key = self.key(level, &index);
                return self.leaves.partition_point(|l| self.key(l.level, &l.index) < key);
            }
            level += 1;
        }
    }

    /// Sorts leaves: the grid cell, last direction slowest, then the digits of the place within it.
    fn key(&self, level: usize, index: &[usize; D]) -> (usize, Vec<usize>) {
        let root = (0..D).rev().fold(0, |n, k| n * self.cells[k] + (index[k] >> level));
        let digit = |l: usize| (0..D).map(|k| (index[k] >> (level - l) & 1) << k).sum();
        (root, (1..=level).map(digit).collect())
    }

    fn update(&mut self) {
        let mut leaves = Vec::new();
        for mut number in 0..self.cells.iter().product() {
            let index: [usize; D] = std::array::from_fn(|k| {
                let i = number % self.cells[k];
                number /= self.cells[k];
                i
            });
            self.collect(0, index, &mut leaves);
        }
        self.leaves = leaves;
    }

    fn collect(&self, level: usize, index: [usize; D], out: &mut Vec<Leaf<D>>) {
        if !self.is_refined(level, &index) {
            out.push(Leaf { level, index, bounds: self.cell_box(level, &index) });
            return;
        }
        for child in 0..1usize << D {
            self.collect(level + 1, std::array::from_fn(|k| 2 * index[k] + (child >> k & 1)), out);
        }
    }
}
