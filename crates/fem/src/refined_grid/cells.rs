//! The grid as the cells of a membrane.

use super::RefinedGrid;
use super::leaf::{Leaf, beside, box_of};
use crate::cells::{BoundarySide, Cells, Divided, Neighbours, SidePoint, divided_box, on_box_side};
use crate::cut::{CellPartition, CellRule, QuadraturePoint, cut_cell};
use crate::grid::Grid;
use crate::lagrange::{MAX_DEGREE, Tabulation};
use signorini_geometry::outline::outlines_between;
use signorini_geometry::{Aabb, Point, Vector};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Cells of unlike size are compared over the nearer part of the larger one only, which holds its polynomial less firmly:
/// this makes up for it. Between 4 and 16 slivers of all kinds stay positive definite up to degree 6.
const NEARER: f64 = 8.0;

impl Cells<2> for RefinedGrid {
    fn degree(&self) -> usize {
        self.coarse.degree()
    }
    fn count(&self) -> usize {
        self.leaves.len()
    }
    fn bounds_of(&self, cell: usize) -> Aabb<2> {
        box_of(&self.coarse, self.leaves[cell])
    }
    fn size(&self, cell: usize) -> f64 {
        self.coarse.h() / f64::from(1u32 << self.leaves[cell].level)
    }
    fn volume(&self, cell: usize) -> f64 {
        self.bounds_of(cell).volume()
    }
    fn containing(&self, x: &Point<2>) -> Option<usize> {
        Some(self.leaf_containing(x))
    }
    fn function_count(&self) -> usize {
        self.nodes.len()
    }
    fn functions(&self, cell: usize, out: &mut Vec<u32>) {
        out.clone_from(&self.cells[cell].functions);
    }
    fn tabulate(&self, cell: usize, x: &Point<2>, out: &mut Tabulation<2>) {
        let b = self.bounds_of(cell);
        let size = b.size();
        let local = (x - b.min).component_div(&size);
        let of = &self.cells[cell];
        if of.hanging.is_empty() {
            return self.coarse.basis().tabulate(&local, &size, out);
        }
        let mut own = Tabulation::default();
        self.coarse.basis().tabulate(&local, &size, &mut own);
        let n = of.functions.len();
        out.value.clear();
        out.value.resize(n, 0.0);
        out.gradient.clear();
        out.gradient.resize(n, Vector::zeros());
        for (k, list) in of.hanging.iter().enumerate() {
            for &(at, weight) in list {
                out.value[at as usize] += weight * own.value[k];
                out.gradient[at as usize] += weight * own.gradient[k];
            }
        }
    }
    fn node(&self, function: usize) -> Point<2> {
        self.nodes[function]
    }
    fn linear(&self, finer: usize) -> Arc<dyn Cells<2>> {
        let coarse = Grid::new(*self.coarse.bounds(), self.coarse.cells().map(|n| n * finer), 1);
        let parts = |leaf: &Leaf| {
            let (level, from) = (leaf.level, leaf.index.map(|i| i * finer as u32));
            let part = move |k: usize| [from[0] + (k % finer) as u32, from[1] + (k / finer) as u32];
            (0..finer * finer).map(move |k| Leaf { level, index: part(k) })
        };
        Arc::new(Self::from_leaves(coarse, self.leaves.iter().flat_map(parts).collect()))
    }
    fn as_grid(&self) -> Option<&Grid<2>> {
        Some(&self.coarse)
    }
    fn divisions(&self, cell: usize) -> usize {
        self.leaves[cell].level.into()
    }
    fn outlines(&self, value: &dyn Fn(&Point<2>) -> f64) -> Option<Vec<Vec<Point<2>>>> {
        let bounds = self.coarse.bounds();
        let ends = self.coarse.cells().map(|n| (n << self.levels) as f64);
        let place = |v: [u32; 2]| bounds.at(&Point::<2>::new(f64::from(v[0]) / ends[0], f64::from(v[1]) / ends[1]));
        let cells = self.leaves.iter().map(|&leaf| self.corners(leaf));
        outlines_between(cells, |corner| value(&place(corner)), place, 1e-12 * bounds.radius())
    }
    fn raised(&self) -> Option<Arc<dyn Cells<2>>> {
        let degree = self.coarse.degree() + 1;
        let coarse = || Grid::new(*self.coarse.bounds(), self.coarse.cells(), degree);
        (degree <= MAX_DEGREE)
            .then(|| -> Arc<dyn Cells<2>> { Arc::new(Self::from_leaves(coarse(), self.leaves.clone())) })
    }
    fn coarser(&self) -> Option<Arc<dyn Cells<2>>> {
        if self.levels == 0 {
            return self.coarse.coarser();
        }
        // Without the last divisions.
        let coarse = Grid::new(*self.coarse.bounds(), self.coarse.cells(), 1);
        let last = |leaf: &Leaf| usize::from(leaf.level) == self.levels;
        let kept: BTreeSet<Leaf> =
            self.leaves.iter().map(|leaf| leaf.parent().filter(|_| last(leaf)).unwrap_or(*leaf)).collect();
        Some(Arc::new(Self::from_leaves(coarse, kept.into_iter().collect())))
    }
    fn rule(&self, cell: usize) -> Vec<QuadraturePoint<2>> {
        self.coarse.rule_in(&self.bounds_of(cell))
    }
    fn cut(&self, cell: usize, partition: &CellPartition<'_, 2>, order: usize) -> CellRule<2> {
        cut_cell(partition, &self.bounds_of(cell), order)
    }
    fn kind(&self, cell: usize) -> Option<usize> {
        self.cells[cell].kind
    }
    fn kinds(&self) -> Vec<usize> {
        self.kinds.clone()
    }
    fn neighbours(&self) -> Vec<Neighbours> {
        self.neighbours.clone()
    }
    fn compared_over(&self, pair: &Neighbours) -> Vec<(usize, QuadraturePoint<2>)> {
        // The smaller cell is the first. Beyond its own width its polynomial would be carried too far.
        let [small, other] = pair.cells.map(|cell| self.bounds_of(cell));
        let mut beside = other;
        for k in 0..2 {
            if small.max[k] <= other.min[k] + 1e-9 * small.size()[k] {
                beside.max[k] = other.min[k] + small.size()[k];
            } else if small.min[k] >= other.max[k] - 1e-9 * small.size()[k] {
                beside.min[k] = other.max[k] - small.size()[k];
            } else {
                (beside.min[k], beside.max[k]) = (small.min[k], small.max[k]);
            }
        }
        let [level, of_other] = pair.cells.map(|cell| self.leaves[cell].level);
        let weight = if level == of_other { 1.0 } else { NEARER };
        let rule = |b: &Aabb<2>, of: usize| {
            self.coarse.rule_in(b).into_iter().map(move |p| (of, QuadraturePoint { weight: weight * p.weight, ..p }))
        };
        rule(&small, 0).chain(rule(&beside, 1)).collect()
    }
    fn boundary_sides(&self) -> Vec<BoundarySide> {
        (self.leaves.iter().enumerate())
            .flat_map(|(cell, &leaf)| {
                let outer = (0..4).filter(move |&side| beside(&self.coarse, leaf, side).is_none());
                outer.map(move |side| BoundarySide { cell, side, piece: side })
            })
            .collect()
    }
    fn on_side(&self, side: &BoundarySide, t: f64) -> SidePoint<2> {
        on_box_side(&self.bounds_of(side.cell), side.side, t)
    }
    fn divided(&self, cell: usize, n: usize) -> Divided<2> {
        divided_box(&self.bounds_of(cell), n)
    }
}
