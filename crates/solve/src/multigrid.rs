//! A V-cycle for symmetric positive definite matrices: levels whose unknowns are made of those of the next finer one.
//!
//! Coarse matrices are `P^T A P`. Every level is scaled to a unit diagonal and smoothed by a Chebyshev polynomial of degree
//! four on the upper part of its spectrum, before and after: the same on any number of threads, and symmetric, so that the
//! cycle preconditions conjugate gradients (Adams, Brezina, Hu & Tuminaro, J. Comput. Phys. 188, 2003). The coarsest
//! level is factorised.

use crate::cholesky::{Factor, SolveError, Symbolic};
use crate::sparse::SymmetricMatrix;
use rayon::prelude::*;

/// How the unknowns of a level are made of coarser ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Transfer {
    /// Number of coarser unknowns.
    pub columns: usize,
    /// For each unknown the coarser ones in it.
    pub rows: Vec<Vec<(u32, f64)>>,
}

/// Degree of the smoother.
const STEPS: usize = 4;
/// The part of the spectrum that is smoothed reaches down to this share of its largest eigenvalue: coarser levels, with
/// cells twice as large in space, see what lies below.
const LOWEST: f64 = 1.0 / 8.0;
/// Steps of the power method, and what is added to the largest eigenvalue that they find from below.
const POWER_STEPS: usize = 12;
const MARGIN: f64 = 1.15;
/// Added to the unit diagonal of the coarsest level: coarse functions that are alike on what is free cost nothing.
const GRAIN: f64 = 1e-10;

/// The levels of a matrix.
pub struct Multigrid {
    scale: Vec<f64>,
    levels: Vec<Level>,
    coarsest: Factor,
}

struct Level {
    matrix: Rows,
    largest: f64,
    down: Rows,
    up: Rows,
}

/// A sparse matrix by rows.
struct Rows {
    start: Vec<usize>,
    column: Vec<u32>,
    value: Vec<f64>,
}

impl Rows {
    fn of_lists<'a>(lists: impl Iterator<Item = &'a [(u32, f64)]>) -> Self {
        let mut out = Rows { start: vec![0], column: Vec::new(), value: Vec::new() };
        for list in lists {
            out.column.extend(list.iter().map(|e| e.0));
            out.value.extend(list.iter().map(|e| e.1));
            out.start.push(out.column.len());
        }
        out
    }

    /// Both triangles of a symmetric matrix.
    fn whole(a: &SymmetricMatrix) -> Self {
        let n = a.size();
        let mut start = vec![0usize; n + 1];
        for (i, j, _) in a.entries() {
            start[i + 1] += 1;
            if i != j {
                start[j + 1] += 1;
            }
        }
        (0..n).for_each(|i| start[i + 1] += start[i]);
        let mut fill = start.clone();
        let (mut column, mut value) = (vec![0; start[n]], vec![0.0; start[n]]);
        let mut put = |i: usize, j: usize, v: f64| {
            (column[fill[i]], value[fill[i]]) = (j as u32, v);
            fill[i] += 1;
        };
        for (i, j, v) in a.entries() {
            put(i, j, v);
            if i != j {
                put(j, i, v);
            }
        }
        Rows { start, column, value }
    }

    fn row(&self, i: usize) -> impl Iterator<Item = (u32, f64)> + '_ {
        let own = self.start[i]..self.start[i + 1];
        self.column[own.clone()].iter().copied().zip(self.value[own].iter().copied())
    }

    /// Rows of the other side.
    fn transposed(&self, columns: usize) -> Self {
        let mut lists: Vec<Vec<(u32, f64)>> = vec![Vec::new(); columns];
        for i in 0..self.start.len() - 1 {
            for k in self.start[i]..self.start[i + 1] {
                lists[self.column[k] as usize].push((i as u32, self.value[k]));
            }
        }
        Rows::of_lists(lists.iter().map(Vec::as_slice))
    }

    fn multiply(&self, x: &[f64]) -> Vec<f64> {
        (0..self.start.len() - 1)
            .into_par_iter()
            .with_min_len(1024)
            .map(|i| {
                let own = self.start[i]..self.start[i + 1];
                self.column[own.clone()].iter().zip(&self.value[own]).map(|(j, v)| v * x[*j as usize]).sum()
            })
            .collect()
    }
}

/// `P^T A P`.
fn galerkin(a: &Rows, up: &Rows, down: &Rows) -> SymmetricMatrix {
    let n = down.start.len() - 1;
    let row = |sum: &mut Vec<f64>, i: usize| -> Vec<(usize, f64)> {
        let mut found = vec![i];
        sum.resize(n, 0.0);
        for (f, w) in down.row(i) {
            for (g, v) in a.row(f as usize) {
                for (j, u) in up.row(g as usize) {
                    let j = j as usize;
                    if j >= i {
                        if sum[j] == 0.0 && j != i {
                            found.push(j);
                        }
                        sum[j] += w * v * u;
                    }
                }
            }
        }
        found.sort_unstable();
        found.dedup();
        found.into_iter().map(|j| (j, std::mem::take(&mut sum[j]))).collect()
    };
    let columns: Vec<Vec<(usize, f64)>> = (0..n).into_par_iter().map_init(Vec::new, row).collect();
    SymmetricMatrix::from_columns(n, |j, out| out.extend(&columns[j]))
}

/// `1/√a_ii`, and one where that is no number.
fn unit_scale(a: &SymmetricMatrix) -> Vec<f64> {
    a.diagonal().iter().map(|d| if *d > 0.0 { 1.0 / d.sqrt() } else { 1.0 }).collect()
}

impl Multigrid {
    /// The levels of a matrix, from its unknowns to the coarsest.
    ///
    /// # Errors
    /// A coarsest level that is not positive definite.
    pub fn new(a: SymmetricMatrix, transfers: Vec<Transfer>) -> Result<Self, SolveError> {
        let scale = unit_scale(&a);
        let mut a = a.scaled(&scale);
        let mut of_level = scale.clone();
        let mut levels = Vec::new();
        for mut transfer in transfers {
            for (row, s) in transfer.rows.iter_mut().zip(&of_level) {
                row.iter_mut().for_each(|(_, v)| *v /= s);
            }
            let matrix = Rows::whole(&a);
            let mut up = Rows::of_lists(transfer.rows.iter().map(Vec::as_slice));
            let mut down = up.transposed(transfer.columns);
            let coarser = galerkin(&matrix, &up, &down);
            let next = unit_scale(&coarser);
            up.column.iter().zip(&mut up.value).for_each(|(j, v)| *v *= next[*j as usize]);
            for (i, s) in next.iter().enumerate() {
                down.value[down.start[i]..down.start[i + 1]].iter_mut().for_each(|v| *v *= s);
            }
            let largest = largest_eigenvalue(&matrix, a.size());
            levels.push(Level { matrix, largest, down, up });
            a = coarser.scaled(&next);
            of_level = next;
        }
        for (k, own) in a.diagonal().into_iter().enumerate() {
            // Functions of nothing that is free have no row.
            a.add(&[k as u32], &[if own == 0.0 { 1.0 } else { GRAIN }], 1.0);
        }
        let coarsest = Symbolic::default().factor(a)?;
        Ok(Multigrid { scale, levels, coarsest })
    }

    /// What is about `A⁻¹ r`.
    ///
    /// # Errors
    /// Numbers that are not finite.
    pub fn apply(&self, r: &[f64]) -> Result<Vec<f64>, SolveError> {
        let r: Vec<f64> = r.iter().zip(&self.scale).map(|(r, s)| r * s).collect();
        let mut x = self.cycle(0, r)?;
        x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x *= s);
        Ok(x)
    }

    fn cycle(&self, number: usize, mut r: Vec<f64>) -> Result<Vec<f64>, SolveError> {
        let Some(level) = self.levels.get(number) else {
            self.coarsest.solve_once(&mut r)?;
            return Ok(r);
        };
        let mut x = vec![0.0; r.len()];
        level.smooth(&mut x, &mut r);
        let coarse = level.up.multiply(&self.cycle(number + 1, level.down.multiply(&r))?);
        let image = level.matrix.multiply(&coarse);
        r.iter_mut().zip(&image).for_each(|(r, a)| *r -= a);
        x.iter_mut().zip(&coarse).for_each(|(x, c)| *x += c);
        level.smooth(&mut x, &mut r);
        Ok(x)
    }
}

impl Level {
    /// Adds a polynomial of the matrix times the residual to `x`, and takes its image from the residual.
    fn smooth(&self, x: &mut [f64], r: &mut [f64]) {
        let (high, low) = (self.largest, LOWEST * self.largest);
        let (middle, half) = (0.5 * (high + low), 0.5 * (high - low));
        let sigma = middle / half;
        let mut rho = 1.0 / sigma;
        let mut d: Vec<f64> = r.iter().map(|r| r / middle).collect();
        for step in 1..=STEPS {
            let image = self.matrix.multiply(&d);
            x.iter_mut().zip(&d).for_each(|(x, d)| *x += d);
            r.iter_mut().zip(&image).for_each(|(r, a)| *r -= a);
            if step < STEPS {
                let next = 1.0 / (2.0 * sigma - rho);
                d.iter_mut().zip(r.iter()).for_each(|(d, r)| *d = next * rho * *d + 2.0 * next / half * r);
                rho = next;
            }
        }
    }
}

/// A bound of the largest eigenvalue, by the power method from a start in which every eigenvector has a part.
fn largest_eigenvalue(a: &Rows, n: usize) -> f64 {
    let mut seed = 1u64;
    let mut x: Vec<f64> = (0..n)
        .map(|_| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        })
        .collect();
    let mut found = 1.0;
    for _ in 0..POWER_STEPS {
        let size = x.iter().map(|v| v * v).sum::<f64>().sqrt();
        x.iter_mut().for_each(|v| *v /= size.max(f64::MIN_POSITIVE));
        let image = a.multiply(&x);
        found = image.iter().map(|v| v * v).sum::<f64>().sqrt();
        x = image;
    }
    MARGIN * found.max(f64::MIN_POSITIVE)
}
