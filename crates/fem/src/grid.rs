//! Uniform background grids with the nodes of a tensor-product basis.

use crate::cut::QuadraturePoint;
use crate::lagrange::TensorBasis;
use crate::whole_rule::{box_rule, whole_order};
use signorini_geometry::{Aabb, Point};
use std::sync::Arc;

/// A box divided into equal cells, carrying the nodes of a basis of one degree.
#[derive(Clone, Debug)]
pub struct Grid<const D: usize> {
    bounds: Aabb<D>,
    cells: [usize; D],
    basis: TensorBasis<D>,
    /// Quadrature of an undivided cell, on the unit box.
    rule: Arc<[QuadraturePoint<D>]>,
}

impl<const D: usize> Grid<D> {
    pub fn new(bounds: Aabb<D>, cells: [usize; D], degree: usize) -> Self {
        let unit = Aabb::new(Point::zeros(), Point::repeat(1.0));
        let rule = box_rule(&unit, whole_order(degree)).into();
        Self { bounds, cells, basis: TensorBasis::new(degree), rule }
    }

    pub fn bounds(&self) -> &Aabb<D> {
        &self.bounds
    }

    /// Number of cells in each direction.
    pub fn cells(&self) -> [usize; D] {
        self.cells
    }

    pub fn cell_count(&self) -> usize {
        self.cells.iter().product()
    }

    pub fn basis(&self) -> &TensorBasis<D> {
        &self.basis
    }

    pub fn degree(&self) -> usize {
        self.basis.degree()
    }

    /// Edge lengths of a cell.
    pub fn cell_size(&self) -> Point<D> {
        Point::from_fn(|k, _| self.bounds.size()[k] / self.cells[k] as f64)
    }

    /// The shortest edge of a cell.
    pub fn h(&self) -> f64 {
        self.cell_size().min()
    }

    /// Position of a cell in each direction.
    pub fn cell_index(&self, cell: usize) -> [usize; D] {
        unflatten(cell, &self.cells)
    }

    pub fn cell_at(&self, index: [usize; D]) -> usize {
        flatten(&index, &self.cells)
    }

    pub fn cell_box(&self, cell: usize) -> Aabb<D> {
        let index = self.cell_index(cell);
        let corner =
            |offset: usize| self.bounds.at(&Point::from_fn(|k, _| (index[k] + offset) as f64 / self.cells[k] as f64));
        Aabb::new(corner(0), corner(1))
    }

    /// The cell that contains `x`, the nearest one for a point outside.
    pub fn cell_containing(&self, x: &Point<D>) -> usize {
        let index = std::array::from_fn(|k| {
            let t = (x[k] - self.bounds.min[k]) / self.bounds.size()[k] * self.cells[k] as f64;
            (t.max(0.0) as usize).min(self.cells[k] - 1)
        });
        self.cell_at(index)
    }

    /// The neighbour of a cell across its upper face in direction `k`, if there is one.
    pub fn upper_neighbour(&self, cell: usize, k: usize) -> Option<usize> {
        let mut index = self.cell_index(cell);
        index[k] += 1;
        (index[k] < self.cells[k]).then(|| self.cell_at(index))
    }

    /// Number of nodes in each direction.
    pub fn node_counts(&self) -> [usize; D] {
        self.cells.map(|n| n * self.degree() + 1)
    }

    pub fn node_count(&self) -> usize {
        self.node_counts().iter().product()
    }

    /// Nodes of a cell, in the order of its basis functions.
    pub fn cell_nodes(&self, cell: usize, out: &mut Vec<u32>) {
        let p = self.degree();
        let index = self.cell_index(cell);
        let counts = self.node_counts();
        out.clear();
        out.extend((0..self.basis.len()).map(|i| {
            let local: [usize; D] = unflatten(i, &[p + 1; D]);
            flatten(&std::array::from_fn(|k| index[k] * p + local[k]), &counts) as u32
        }));
    }

    /// Position of a node.
    pub fn node(&self, node: usize) -> Point<D> {
        let p = self.degree();
        let index: [usize; D] = unflatten(node, &self.node_counts());
        let nodes = self.basis.line_nodes();
        self.bounds.at(&Point::from_fn(|k, _| ((index[k] / p) as f64 + nodes[index[k] % p]) / self.cells[k] as f64))
    }

    /// Quadrature of a box, with the points of an undivided cell.
    pub fn rule_in(&self, b: &Aabb<D>) -> Vec<QuadraturePoint<D>> {
        let volume = b.volume();
        self.rule.iter().map(|p| QuadraturePoint { x: b.at(&p.x), weight: p.weight * volume }).collect()
    }

    /// Position of `x` relative to a cell.
    pub fn local(&self, cell: usize, x: &Point<D>) -> Point<D> {
        let b = self.cell_box(cell);
        (x - b.min).component_div(&b.size())
    }
}

fn unflatten<const D: usize>(mut i: usize, counts: &[usize; D]) -> [usize; D] {
    std::array::from_fn(|k| {
        let v = i % counts[k];
        i /= counts[k];
        v
    })
}

fn flatten<const D: usize>(index: &[usize; D], counts: &[usize; D]) -> usize {
    (0..D).rev().fold(0, |acc, k| acc * counts[k] + index[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_cells_share_the_nodes_of_their_face() {
        let bounds = Aabb::new(Point::<2>::new(0.0, -1.0), Point::<2>::new(2.0, 1.0));
        let grid = Grid::<2>::new(bounds, [4, 3], 3);
        let (mut a, mut b) = (Vec::new(), Vec::new());
        let cell = grid.cell_at([1, 1]);
        grid.cell_nodes(cell, &mut a);
        grid.cell_nodes(grid.upper_neighbour(cell, 0).unwrap(), &mut b);
        assert_eq!((a[3], a[7]), (b[0], b[4]));
        assert!((grid.node(a[3] as usize) - Point::<2>::new(1.0, -1.0 / 3.0)).norm() < 1e-15);
        assert_eq!(grid.cell_containing(&Point::<2>::new(0.6, 0.1)), cell);
        assert_eq!(grid.node_count(), 13 * 10);
    }
}
