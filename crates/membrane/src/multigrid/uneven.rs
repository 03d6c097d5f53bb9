//! The equations of regular nodes of a grid under a tension that varies from place to place: they are stored.

use crate::field::Field;
use signorini_fem::lagrange::Tabulation;
use signorini_fem::{Cells, Grid};

/// Entries of all rows, each in the order of the pattern of its node.
pub(super) struct Uneven {
    start: Vec<usize>,
    value: Vec<f64>,
}

impl Uneven {
    /// The stiffness of a grid, whose rows have the given patterns: by the place of a node in its cell, what is added to the
    /// number of each neighbour.
    pub fn new<'a>(grid: &Grid<2>, tension: &dyn Field<2>, pattern: impl Fn(usize) -> &'a [(isize, f64)]) -> Self {
        let n = grid.basis().len();
        let [width, rows] = grid.node_counts();
        let mut start = Vec::with_capacity(width * rows + 1);
        start.push(0);
        for node in 0..width * rows {
            start.push(start[node] + pattern(node).len());
        }
        // Products of slopes are the same in all cells, and so is where the entries go.
        let mut t = Tabulation::default();
        let products: Vec<Vec<f64>> = (grid.rule(0).iter())
            .map(|point| {
                grid.tabulate(0, &point.x, &mut t);
                (0..n * n).map(|k| point.weight * t.gradient[k / n].dot(&t.gradient[k % n])).collect()
            })
            .collect();
        let mut nodes = Vec::new();
        grid.cell_nodes(0, &mut nodes);
        let step = |a: usize, b: usize| nodes[b] as isize - nodes[a] as isize;
        let place = |a: usize, b: usize| pattern(nodes[a] as usize).iter().position(|e| e.0 == step(a, b)).unwrap_or(0);
        let places: Vec<usize> = (0..n * n).map(|k| place(k / n, k % n)).collect();

        let mut value = vec![0.0; start[width * rows]];
        let mut matrix = vec![0.0; n * n];
        for cell in 0..grid.cell_count() {
            matrix.fill(0.0);
            for (point, products) in grid.rule(cell).iter().zip(&products) {
                let t = tension.value(&point.x);
                matrix.iter_mut().zip(products).for_each(|(m, v)| *m += t * v);
            }
            grid.cell_nodes(cell, &mut nodes);
            for (k, (v, place)) in matrix.iter().zip(&places).enumerate() {
                value[start[nodes[k / n] as usize] + place] += v;
            }
        }
        Self { start, value }
    }

    /// The entries of a node.
    pub fn row(&self, node: usize) -> &[f64] {
        &self.value[self.start[node]..self.start[node + 1]]
    }
}
