//! From one level to the next: interpolation by the functions of the coarser grid, and its transpose.

use super::band::Band;
use super::level::Level;
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
    fn at_fine(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + Clone + '_ {
        let p = self.degree;
        self.from[i % (2 * p)].iter().map(move |&(k, v)| (i / (2 * p) * p + k, v))
    }

    /// Fine nodes, of so many, and their weights at a coarse one.
    fn at_coarse(&self, i: usize, fine: usize) -> impl Iterator<Item = (usize, f64)> + Clone + '_ {
        let first = i / self.degree * 2 * self.degree;
        let node = move |&(step, v): &(isize, f64)| Some((first.checked_add_signed(step).filter(|n| *n < fine)?, v));
        self.to[i % self.degree].iter().filter_map(node)
    }
}

/// Halfway between the second and third of four values, of which the outer ones may be missing.
fn halfway(v: [Option<f64>; 4]) -> f64 {
    match v {
        [Some(a), Some(b), Some(c), Some(d)] => (9.0 * (b + c) - a - d) / 16.0,
        [_, Some(b), Some(c), _] => 0.5 * (b + c),
        [_, Some(v), None, _] | [_, None, Some(v), _] => v,
        _ => 0.0,
    }
}

impl Level {
    /// The displacement at a node of the next finer grid, by the nodes where it is known.
    pub(super) fn interpolated(&self, known: &[bool], i: usize, j: usize) -> f64 {
        if self.grid.degree() == 1 { self.by_cubics(known, i, j) } else { self.by_functions(known, i, j) }
    }

    /// That at degree 1, cubic where four neighbours in a line are known.
    fn by_cubics(&self, known: &[bool], i: usize, j: usize) -> f64 {
        let [w, rows] = self.grid.node_counts();
        let at = |ic: isize, jc: isize| -> Option<f64> {
            let inside = (0..w as isize).contains(&ic) && (0..rows as isize).contains(&jc);
            let node = if inside { jc as usize * w + ic as usize } else { return None };
            known[node].then(|| self.u[node])
        };
        let (ic, jc) = ((i / 2) as isize, (j / 2) as isize);
        let along = |jc: isize| -> Option<f64> {
            if i.is_multiple_of(2) {
                return at(ic, jc);
            }
            let four = [-1, 0, 1, 2].map(|k| at(ic + k, jc));
            (four[1].is_some() || four[2].is_some()).then(|| halfway(four))
        };
        if j.is_multiple_of(2) { along(jc).unwrap_or(0.0) } else { halfway([-1, 0, 1, 2].map(|k| along(jc + k))) }
    }

    /// The displacement of a coarser level at a node, by the functions there; where some are unknown by those that are known.
    fn by_functions(&self, known: &[bool], i: usize, j: usize) -> f64 {
        let w = self.width();
        let (mut sum, mut weight) = (0.0, 0.0);
        for (jc, y) in self.interpolation.at_fine(j) {
            for (ic, x) in self.interpolation.at_fine(i) {
                if known[jc * w + ic] {
                    sum += x * y * self.u[jc * w + ic];
                    weight += x * y;
                }
            }
        }
        if weight > 0.5 { sum / weight } else { 0.0 }
    }

    /// Adds the displacement of a coarser level, interpolated, to the nodes that take part.
    pub(super) fn add_correction(&mut self, coarse: &Level) {
        let (w, wc) = (self.width(), coarse.width());
        let table = &self.interpolation;
        let across = |j: usize, line: &mut [f64]| combine(table.at_fine(j), &coarse.u, line);
        let mut line = Line::new(wc);
        for run in &self.runs {
            let line = line.of(run.row, across);
            for i in run.begin..run.end {
                self.u[run.row * w + i] += table.at_fine(i).map(|(ic, x)| x * line[ic]).sum::<f64>();
            }
        }
        let nodes = self.grid.node_count();
        for (unknown, node) in self.bands.iter().flat_map(Band::irregular) {
            // Unknowns behind the nodes belong to the band alone.
            if unknown < nodes {
                let (i, j) = (node % w, node / w);
                let along = |jc: usize| table.at_fine(i).map(|(ic, x)| x * coarse.u[jc * wc + ic]).sum::<f64>();
                self.u[unknown] += table.at_fine(j).map(|(jc, y)| y * along(jc)).sum::<f64>();
            }
        }
    }

    /// Makes the residual the right-hand side of a coarser level, by the transpose of the interpolation.
    pub(super) fn restrict_residual(&self, coarse: &mut Level) {
        let r = self.residual();
        let (w, wc) = (self.width(), coarse.width());
        let (table, rows) = (&self.interpolation, self.grid.node_counts()[1]);
        let across = |j: usize, line: &mut [f64]| combine(table.at_coarse(j, rows), &r, line);
        let mut line = Line::new(w);
        coarse.b.fill(0.0);
        for run in &coarse.runs {
            let line = line.of(run.row, across);
            for i in run.begin..run.end {
                coarse.b[run.row * wc + i] = table.at_coarse(i, w).map(|(i, x)| x * line[i]).sum();
            }
        }
        let nodes = coarse.grid.node_count();
        for (unknown, node) in coarse.bands.iter().flat_map(Band::irregular) {
            if unknown < nodes {
                let (i, j) = (node % wc, node / wc);
                let along = |jf: usize| table.at_coarse(i, w).map(|(i, x)| x * r[jf * w + i]).sum::<f64>();
                coarse.b[unknown] = table.at_coarse(j, rows).map(|(jf, y)| y * along(jf)).sum();
            }
        }
    }
}

/// A row of sums over rows of nodes, kept as long as the same is asked for.
struct Line {
    row: Option<usize>,
    values: Vec<f64>,
}

impl Line {
    fn new(width: usize) -> Self {
        Self { row: None, values: vec![0.0; width] }
    }

    fn of(&mut self, row: usize, sum: impl Fn(usize, &mut [f64])) -> &[f64] {
        if self.row.replace(row) != Some(row) {
            sum(row, &mut self.values);
        }
        &self.values
    }
}

/// The sum of some rows of nodes, by their weights.
fn combine(rows: impl Iterator<Item = (usize, f64)>, values: &[f64], out: &mut [f64]) {
    out.fill(0.0);
    for (row, weight) in rows {
        let row = &values[row * out.len()..(row + 1) * out.len()];
        out.iter_mut().zip(row).for_each(|(o, v)| *o += weight * v);
    }
}
