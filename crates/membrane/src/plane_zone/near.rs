//! Which fronts are near a cell, and which enclose it.

use signorini_fem::Grid;
use signorini_geometry::{ClosedCurve, polygon};

/// For cells near curves, pairs of curve and sample in or next to them.
#[derive(Clone, Debug)]
pub(super) struct NearFronts {
    /// Ascending, and where the pairs of each begin and end.
    pub(super) cells: Vec<u32>,
    begin: Vec<u32>,
    pairs: Vec<(u32, u32)>,
}

impl NearFronts {
    pub fn new(grid: &Grid<2>, curves: &[ClosedCurve]) -> Self {
        let (bounds, size, cells) = (grid.bounds(), grid.cell_size(), grid.cells());
        let mut all: Vec<(u32, u32, u32)> = Vec::new();
        for (c, curve) in curves.iter().enumerate() {
            for (s, (a, b)) in polygon::edges(curve.samples()).enumerate() {
                // Samples may be further from each other than the smallest cells are large.
                let parts = ((b - a).component_div(&size).amax().ceil()).max(1.0);
                for part in 0..parts as usize {
                    let x = a + (b - a) * (part as f64 / parts);
                    let at: [isize; 2] = std::array::from_fn(|k| ((x[k] - bounds.min[k]) / size[k]).floor() as isize);
                    let range = |k: usize| (at[k] - 1).max(0)..(at[k] + 2).min(cells[k] as isize);
                    for j in range(1) {
                        for i in range(0) {
                            all.push((grid.cell_at([i as usize, j as usize]) as u32, c as u32, s as u32));
                        }
                    }
                }
            }
        }
        all.sort_unstable();
        all.dedup();
        let mut near = Self { cells: Vec::new(), begin: vec![0], pairs: Vec::with_capacity(all.len()) };
        for (cell, curve, sample) in all {
            if near.cells.last() != Some(&cell) {
                near.cells.push(cell);
                near.begin.push(near.pairs.len() as u32);
            }
            near.pairs.push((curve, sample));
            if let Some(end) = near.begin.last_mut() {
                *end = near.pairs.len() as u32;
            }
        }
        near
    }

    /// Those of all cells of a row from one to another, cell by cell.
    pub fn between(&self, first: usize, last: usize) -> &[(u32, u32)] {
        let from = self.cells.partition_point(|&cell| (cell as usize) < first);
        let to = from + self.cells[from..].partition_point(|&cell| cell as usize <= last);
        &self.pairs[self.begin[from] as usize..self.begin[to] as usize]
    }
}

/// For each row of cells the stretches whose centres a curve encloses, by the crossings of the curve with the line through
/// these.
pub(super) fn rows_enclosed(grid: &Grid<2>, curves: &[ClosedCurve]) -> Vec<Vec<[u32; 3]>> {
    let cells = grid.cells();
    let mut rows = vec![Vec::new(); cells[1]];
    let (bounds, size) = (grid.bounds(), grid.cell_size());
    for (c, curve) in curves.iter().enumerate() {
        let mut crossings = vec![Vec::new(); cells[1]];
        for (a, b) in polygon::edges(curve.samples()) {
            let row = |y: f64| ((y - bounds.min[1]) / size[1] - 0.5).ceil().max(0.0) as usize;
            let (low, high) = (a[1].min(b[1]), a[1].max(b[1]));
            for j in row(low)..row(high).min(cells[1]) {
                let y = bounds.min[1] + (j as f64 + 0.5) * size[1];
                crossings[j].push(a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]));
            }
        }
        for (row, mut xs) in rows.iter_mut().zip(crossings) {
            xs.sort_by(f64::total_cmp);
            for pair in xs.chunks_exact(2) {
                let column = |x: f64| ((x - bounds.min[0]) / size[0] - 0.5).ceil().max(0.0) as usize;
                let (from, to) = (column(pair[0]), column(pair[1]).min(cells[0]));
                if from < to {
                    row.push([from as u32, to as u32, c as u32]);
                }
            }
        }
    }
    rows
}
