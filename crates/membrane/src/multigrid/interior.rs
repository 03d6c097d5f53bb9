//! Regular nodes, whose equations repeat from cell to cell and are never stored, and how these are relaxed.
//!
//! Relaxation solves patch by patch: the nodes around a vertex of the grid, up to those on the rim of its four cells, are
//! solved for exactly while the rim is held. Degree 1 has a single node in each patch, and is Gauss-Seidel. Patches of one
//! row of vertices touch no node of the next row but one, so that every other row is relaxed at the same time. Where the
//! tension varies the equations do not repeat; patches are then solved as if it were everywhere what it is at their vertex.

use super::runs::Run;
use super::uneven::Uneven;
use crate::field::Field;
use rayon::prelude::*;
use signorini_fem::lagrange::TensorBasis;
use signorini_fem::{Grid, gauss_legendre};
use signorini_solve::{SolveError, dense};

/// The part of a row of nodes that stands for one column or row of the grid in a row of the matrix: offset, entry of the
/// stiffness, entry of the mass.
type Line = Vec<(isize, f64, f64)>;

/// The equations of regular nodes.
pub struct Interior {
    degree: usize,
    /// Nodes in a row of the grid.
    width: usize,
    /// By the place of a node in its cell, along x first: for each neighbour what is added to its number, and the entry.
    rows: Vec<Vec<(isize, f64)>>,
    /// The solution of a patch: for every node of it, by the right-hand side there, row by row, and for every node of its
    /// rim, those below, those above, then left and right of each row, by the displacement there.
    patch: Vec<f64>,
    /// The equations, where the tension is not the same everywhere; `rows` are then those of unit tension.
    uneven: Option<Uneven>,
}

/// Nodes of a grid from which on the rows of patches are shared among threads.
const SHARED: usize = 1 << 15;

impl Interior {
    /// # Errors
    /// A patch that cannot be solved for.
    pub fn new(grid: &Grid<2>, field: &dyn Field<2>) -> Result<Self, SolveError> {
        let p = grid.degree();
        let tension = field.constant().unwrap_or(1.0);
        let width = grid.node_counts()[0];
        let size = grid.cell_size();
        let (along, across) = (tension * size[1] / size[0], tension * size[0] / size[1]);
        let lines: Vec<Line> = (0..p).map(|place| line(p, place)).collect();
        let coupling = |[a, b]: [usize; 2]| {
            let mut entries = Vec::new();
            for &(dy, ky, my) in &lines[b] {
                entries.extend(lines[a].iter().map(|&(dx, kx, mx)| ([dx, dy], along * kx * my + across * mx * ky)));
            }
            entries
        };
        let rows = (0..p * p).map(|place| {
            let entries = coupling([place % p, place / p]);
            entries.into_iter().map(|([dx, dy], v)| (dy * width as isize + dx, v)).collect()
        });
        let rows: Vec<Vec<(isize, f64)>> = rows.collect();

        // The patch around a vertex at the origin.
        let reach = p as isize;
        let inner = |p: isize| (1 - p..p).flat_map(move |dy| (1 - p..p).map(move |dx| [dx, dy]));
        let places: Vec<[isize; 2]> = inner(reach).collect();
        let m = places.len();
        let side = 2 * p - 1;
        let place_of = |[dx, dy]: [isize; 2]| (dy + reach - 1) as usize * side + (dx + reach - 1) as usize;
        let rim_of = |[dx, dy]: [isize; 2]| match (dx, dy) {
            (_, _) if dy == -reach => (dx + reach) as usize,
            (_, _) if dy == reach => 2 * p + 1 + (dx + reach) as usize,
            _ => 2 * (2 * p + 1) + 2 * (dy + reach - 1) as usize + usize::from(dx == reach),
        };
        let mut a = vec![0.0; m * m];
        let mut columns = vec![vec![0.0; m]; m + 8 * p];
        for (i, place) in places.iter().enumerate() {
            columns[i][i] = 1.0;
            for (step, v) in coupling(place.map(|d| d.rem_euclid(reach) as usize)) {
                let to = [place[0] + step[0], place[1] + step[1]];
                if to.iter().all(|d| d.abs() < reach) {
                    a[i * m + place_of(to)] = v;
                } else {
                    columns[m + rim_of(to)][i] = -v;
                }
            }
        }
        let factor = dense::Factor::new(m, &a).ok_or(SolveError::NotFactorised { size: m })?;
        let patch = columns.iter().flat_map(|c| factor.solve(c)).collect();
        let mut interior = Self { degree: p, width, rows, patch, uneven: None };
        if field.constant().is_none() {
            interior.uneven = Some(Uneven::new(grid, field, |node| interior.pattern(node)));
        }
        Ok(interior)
    }

    /// What the row of a node looks like: what is added to its number for each neighbour, and the entry, where it repeats.
    fn pattern(&self, node: usize) -> &[(isize, f64)] {
        let (i, j) = (node % self.width % self.degree, node / self.width % self.degree);
        &self.rows[j * self.degree + i]
    }

    /// Neighbours of a regular node, itself among them, with the entries of its row.
    pub fn row(&self, node: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let stored = self.uneven.as_ref().map(|uneven| uneven.row(node));
        let entry = move |(k, &(step, v)): (usize, &(isize, f64))| {
            (node.wrapping_add_signed(step), stored.map_or(v, |row| row[k]))
        };
        self.pattern(node).iter().enumerate().map(entry)
    }

    /// What the equations of some runs of regular nodes leave of the right-hand side.
    pub fn residual(&self, runs: &[Run], u: &[f64], b: &[f64], r: &mut [f64]) {
        let (w, p) = (self.width, self.degree);
        if p == 1 && self.uneven.is_none() {
            let Stencil { own, x, y, corner } = self.stencil();
            for run in runs {
                let at = run.row * w;
                let (low, mid, high) = (&u[at - w..at], &u[at..at + w], &u[at + w..at + 2 * w]);
                for i in run.begin..run.end {
                    let corners = low[i - 1] + low[i + 1] + high[i - 1] + high[i + 1];
                    r[at + i] = b[at + i]
                        - own * mid[i]
                        - x * (mid[i - 1] + mid[i + 1])
                        - y * (low[i] + high[i])
                        - corner * corners;
                }
            }
            return;
        }
        for run in runs {
            for node in run.row * w + run.begin..run.row * w + run.end {
                r[node] = b[node] - self.row(node).map(|(j, v)| v * u[j]).sum::<f64>();
            }
        }
    }

    fn stencil(&self) -> Stencil {
        let row = &self.rows[0];
        Stencil { corner: row[0].1, y: row[1].1, x: row[3].1, own: row[4].1 }
    }

    /// Solves for the patches around runs of vertices: every other row of them at once, in a row every other one after the
    /// others.
    pub fn relax(&self, vertices: &[Run], u: &mut [f64], b: &[f64]) {
        let (w, p) = (self.width, self.degree);
        if let Some(uneven) = &self.uneven {
            return self.relax_uneven(uneven, vertices, u, b);
        }
        for first in [2, 1] {
            let mut strips = Vec::new();
            let Some((_, rest)) = u.split_at_mut_checked((first - 1) * p * w) else { continue };
            let Some((below, mut rest)) = rest.split_at_mut_checked(w) else { continue };
            let mut below: &[f64] = below;
            let mut runs = vertices;
            for vertex in (first..).step_by(2) {
                let Some((rows, tail)) = rest.split_at_mut_checked((2 * p - 1) * w) else { break };
                let Some((above, tail)) = tail.split_at_mut_checked(w) else { break };
                let above: &[f64] = above;
                runs = &runs[runs.partition_point(|r| r.row < vertex)..];
                let own = &runs[..runs.partition_point(|r| r.row == vertex)];
                let b = &b[((vertex - 1) * p + 1) * w..][..rows.len()];
                if !own.is_empty() {
                    strips.push((own, Strip { below, rows, above, b }));
                }
                (below, rest) = (above, tail);
            }
            if b.len() > SHARED {
                strips.into_par_iter().for_each(|(runs, strip)| self.relax_strip(runs, strip));
            } else {
                strips.into_iter().for_each(|(runs, strip)| self.relax_strip(runs, strip));
            }
        }
    }

    /// The same by what is left of the stored equations.
    fn relax_uneven(&self, uneven: &Uneven, vertices: &[Run], u: &mut [f64], b: &[f64]) {
        let (w, p) = (self.width, self.degree);
        let side = 2 * p - 1;
        let m = side * side;
        let (mut left, mut step) = (vec![0.0; m], vec![0.0; m]);
        let own = self.rows[0].iter().position(|e| e.0 == 0).unwrap_or(0);
        for first in [0, 1] {
            for run in vertices.iter().filter(|run| run.row % 2 == first) {
                for odd in 0..2 {
                    for i in (run.begin + (run.begin + odd) % 2..run.end).step_by(2) {
                        let vertex = run.row * p * w + i * p;
                        let corner = vertex - (p - 1) * (w + 1);
                        let node = |k: usize| corner + k / side * w + k % side;
                        for (k, left) in left.iter_mut().enumerate() {
                            *left = b[node(k)] - self.row(node(k)).map(|(j, v)| v * u[j]).sum::<f64>();
                        }
                        let tension = uneven.row(vertex)[own] / self.rows[0][own].1;
                        step.fill(0.0);
                        for (column, left) in self.patch.chunks_exact(m).zip(&left) {
                            step.iter_mut().zip(column).for_each(|(s, c)| *s += c * left);
                        }
                        step.iter().enumerate().for_each(|(k, s)| u[node(k)] += s / tension);
                    }
                }
            }
        }
    }

    fn relax_strip(&self, runs: &[Run], strip: Strip) {
        match self.degree {
            1 => self.relax_nodes(runs, strip),
            2 => self.relax_patches::<9>(runs, strip),
            3 => self.relax_patches::<25>(runs, strip),
            4 => self.relax_patches::<49>(runs, strip),
            5 => self.relax_patches::<81>(runs, strip),
            6 => self.relax_patches::<121>(runs, strip),
            7 => self.relax_patches::<169>(runs, strip),
            _ => self.relax_patches::<225>(runs, strip),
        }
    }

    /// Patches of a single node.
    fn relax_nodes(&self, runs: &[Run], strip: Strip) {
        let Stencil { own, x, y, corner } = self.stencil();
        let Strip { below, rows: mid, above, b } = strip;
        for run in runs {
            for odd in 0..2 {
                for i in (run.begin + (run.begin + odd) % 2..run.end).step_by(2) {
                    let corners = below[i - 1] + below[i + 1] + above[i - 1] + above[i + 1];
                    let others = x * (mid[i - 1] + mid[i + 1]) + y * (below[i] + above[i]) + corner * corners;
                    mid[i] = (b[i] - others) / own;
                }
            }
        }
    }

    /// Patches of `M = (2p - 1)²` nodes.
    fn relax_patches<const M: usize>(&self, runs: &[Run], strip: Strip) {
        let (w, p) = (self.width, self.degree);
        let Strip { below, rows, above, b } = strip;
        for run in runs {
            for odd in 0..2 {
                for i in (run.begin + (run.begin + odd) % 2..run.end).step_by(2) {
                    let (left, right) = ((i - 1) * p, (i + 1) * p);
                    let mut sum = [0.0; M];
                    let mut columns = self.patch.chunks_exact(M);
                    let mut add = |v: f64| {
                        if let Some(column) = columns.next() {
                            sum.iter_mut().zip(column).for_each(|(s, c)| *s += c * v);
                        }
                    };
                    b.chunks_exact(w).for_each(|b| b[left + 1..right].iter().for_each(|v| add(*v)));
                    below[left..=right].iter().for_each(|v| add(*v));
                    above[left..=right].iter().for_each(|v| add(*v));
                    for row in rows.chunks_exact(w) {
                        add(row[left]);
                        add(row[right]);
                    }
                    for (row, u) in rows.chunks_exact_mut(w).zip(sum.chunks_exact(2 * p - 1)) {
                        row[left + 1..right].copy_from_slice(u);
                    }
                }
            }
        }
    }
}

/// The rows of nodes of the patches around a row of vertices, the rims below and above, and the right-hand side.
struct Strip<'a> {
    below: &'a [f64],
    rows: &'a mut [f64],
    above: &'a [f64],
    b: &'a [f64],
}

/// The equation of a node at degree 1: its own entry, those of its neighbours along x and y, and across the corners.
struct Stencil {
    own: f64,
    x: f64,
    y: f64,
    corner: f64,
}

/// The neighbours along a line of a node at some place in its cell of unit length.
fn line(p: usize, place: usize) -> Line {
    let basis = TensorBasis::<1>::new(p);
    let mut entries: Line = Vec::new();
    let mut add = |own: usize| {
        for other in 0..=p {
            let (mut k, mut m) = (0.0, 0.0);
            for (x, weight) in gauss_legendre(p + 1) {
                let [value, slope] = basis.line(x);
                k += weight * slope[own] * slope[other];
                m += weight * value[own] * value[other];
            }
            let step = other as isize - own as isize;
            match entries.iter_mut().find(|e| e.0 == step) {
                Some(entry) => (entry.1, entry.2) = (entry.1 + k, entry.2 + m),
                None => entries.push((step, k, m)),
            }
        }
    };
    // A vertex belongs to the cell before it as well.
    if place == 0 {
        add(p);
    }
    add(place);
    entries
}
