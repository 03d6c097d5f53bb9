//! From one level to the next: interpolation by the functions of the coarser grid, and its transpose.

use signorini_fem::Grid;

/// The functions of the coarser grid along one direction at the nodes of the finer one.
pub(super) struct Interpolation {
    degree: usize,
    /// For every node of the two fine cells in a coarse one, but the last: nodes of that with their weights.
    from: Vec<Vec<(usize, f64)>>,
    /// For every node of a coarse cell but the last: fine nodes, counted from the first of the cell, with their weights.
    to: Vec<Vec<(isize, f64)>>,
}

impl Interpolation {
    pub fn new(grid: &Grid<2>) -> Self {
        let (p, basis) = (grid.degree(), grid.basis());
        let at = |l: usize| 0.5 * ((l / p) as f64 + basis.line_nodes()[l % p]);
        let weights = |l: usize| {
            let [value, _] = basis.line(at(l));
            // At a node of the coarse cell all others are zero, but for round-off.
            (0..=p).map(|k| (k, value[k])).filter(|(_, v)| v.abs() > 1e-13).collect::<Vec<_>>()
        };
        let from: Vec<Vec<(usize, f64)>> = (0..2 * p).map(weights).collect();
        let mut to = vec![Vec::new(); p];
        for (l, weights) in from.iter().enumerate() {
            for &(k, v) in weights {
                let l = l as isize;
                // The last node of a cell is the first of the next.
                if k == p { to[0].push((l - 2 * p as isize, v)) } else { to[k].push((l, v)) }
            }
        }
        to.iter_mut().for_each(|list| list.sort_by_key(|e| e.0));
        Self { degree: p, from, to }
    }

    /// Coarse nodes and their weights at a fine one.
    pub fn at_fine(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + Clone + '_ {
        let p = self.degree;
        self.from[i % (2 * p)].iter().map(move |&(k, v)| (i / (2 * p) * p + k, v))
    }

    /// Fine nodes, of so many, and their weights at a coarse one.
    pub fn at_coarse(&self, i: usize, fine: usize) -> impl Iterator<Item = (usize, f64)> + Clone + '_ {
        let first = i / self.degree * 2 * self.degree;
        let node = move |&(step, v): &(isize, f64)| Some((first.checked_add_signed(step).filter(|n| *n < fine)?, v));
        self.to[i % self.degree].iter().filter_map(node)
    }
}

/// Halfway between the second and third of four values, of which the outer ones may be missing.
pub(super) fn halfway(v: [Option<f64>; 4]) -> f64 {
    match v {
        [Some(a), Some(b), Some(c), Some(d)] => (9.0 * (b + c) - a - d) / 16.0,
        [_, Some(b), Some(c), _] => 0.5 * (b + c),
        [_, Some(v), None, _] | [_, None, Some(v), _] => v,
        _ => 0.0,
    }
}

/// A row of sums over rows of nodes, kept as long as the same is asked for.
pub(super) struct Line {
    row: Option<usize>,
    values: Vec<f64>,
}

impl Line {
    pub fn new(width: usize) -> Self {
        Self { row: None, values: vec![0.0; width] }
    }

    pub fn of(&mut self, row: usize, sum: impl Fn(usize, &mut [f64])) -> &[f64] {
        if self.row.replace(row) != Some(row) {
            sum(row, &mut self.values);
        }
        &self.values
    }
}

/// The sum of some rows of nodes, by their weights.
pub(super) fn combine(rows: impl Iterator<Item = (usize, f64)>, values: &[f64], out: &mut [f64]) {
    out.fill(0.0);
    for (row, weight) in rows {
        let row = &values[row * out.len()..(row + 1) * out.len()];
        out.iter_mut().zip(row).for_each(|(o, v)| *o += weight * v);
    }
}
