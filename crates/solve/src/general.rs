//! General sparse matrices, assembled from dense blocks of a few unknowns each, and their factors by `faer`.
//!
//! Factorisation is LU with partial pivoting on one thread. Rows and columns are scaled by powers of two beforehand, so
//! that neither the units of an unknown nor those of an equation choose the pivots; every solve is refined and refused
//! where its residual stays large.

use crate::cholesky::SolveError;
use crate::dense::inverse_power;
use crate::sparse::SymmetricMatrix;
use faer::linalg::solvers::SolveCore;
use faer::sparse::linalg::solvers::{Lu as Numeric, SymbolicLu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut};
use std::collections::BTreeMap;

/// A square matrix in compressed columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Matrix {
    column_start: Vec<usize>,
    row: Vec<usize>,
    value: Vec<f64>,
}

/// Entries of a matrix before they are summed up.
#[derive(Clone, Debug, Default)]
pub struct Entries {
    list: Vec<(u32, u32, f64)>,
    /// Dense blocks by their unknowns, where they are kept apart.
    blocks: Option<DenseBlocks>,
}

/// Sums of dense blocks, row by row, by their unknowns.
pub type DenseBlocks = BTreeMap<Vec<u32>, Vec<f64>>;

impl Entries {
    /// No entries; dense blocks are to be kept apart, those of the same unknowns summed.
    pub fn in_blocks() -> Self {
        Entries { list: Vec::new(), blocks: Some(DenseBlocks::new()) }
    }

    /// Single entries as they were added, and the dense blocks that were kept apart.
    pub fn into_parts(self) -> (Vec<(u32, u32, f64)>, DenseBlocks) {
        (self.list, self.blocks.unwrap_or_default())
    }

    /// The largest entry of each row in the first columns, before entries at the same place are summed.
    pub fn row_sizes(&self, n: usize, columns: usize) -> Vec<f64> {
        let mut out = vec![0.0f64; n];
        let mut take = |row: u32, column: u32, value: f64| {
            if (column as usize) < columns {
                out[row as usize] = out[row as usize].max(value.abs());
            }
        };
        self.list.iter().for_each(|e| take(e.0, e.1, e.2));
        for (unknowns, values) in self.blocks.iter().flatten() {
            for (row, values) in unknowns.iter().zip(values.chunks(unknowns.len().max(1))) {
                unknowns.iter().zip(values).for_each(|(column, value)| take(*row, *column, *value));
            }
        }
        out
    }

    /// Row, column and value of the entries that are not kept apart, as they were added.
    pub fn list(&self) -> impl Iterator<Item = (u32, u32, f64)> + '_ {
        self.list.iter().copied()
    }

    /// Adds to one entry.
    pub fn add(&mut self, row: u32, column: u32, value: f64) {
        self.list.push((row, column, value));
    }

    /// Adds a dense block, row by row.
    pub fn add_block(&mut self, unknowns: &[u32], values: &[f64]) {
        if let Some(blocks) = &mut self.blocks {
            match blocks.get_mut(unknowns) {
                Some(sum) => sum.iter_mut().zip(values).for_each(|(s, v)| *s += v),
                None => {
                    blocks.insert(unknowns.to_vec(), values.to_vec());
                }
            }
            return;
        }
        for (values, &row) in values.chunks(unknowns.len().max(1)).zip(unknowns) {
            self.list.extend(unknowns.iter().zip(values).filter(|(_, v)| **v != 0.0).map(|(c, v)| (row, *c, *v)));
        }
    }

    /// Leaves out the rows for which `is_left_out` holds.
    pub fn without_rows(&mut self, is_left_out: impl Fn(u32) -> bool) {
        self.list.retain(|e| !is_left_out(e.0));
    }

    /// Puts rows of the identity in place of those of unknowns that are held.
    pub fn hold(&mut self, is_held: &[bool]) {
        self.without_rows(|row| is_held[row as usize]);
        (0..is_held.len()).filter(|k| is_held[*k]).for_each(|k| self.add(k as u32, k as u32, 1.0));
    }

    /// The matrix of `n` unknowns, without blocks that are kept apart; entries at the same place are summed in the order in
    /// which they were added.
    pub fn matrix(&self, n: usize) -> Matrix {
        let mut start = vec![0usize; n + 1];
        self.list.iter().for_each(|e| start[e.1 as usize + 1] += 1);
        (0..n).for_each(|j| start[j + 1] += start[j]);
        let mut fill = start.clone();
        let mut sorted = vec![(0u32, 0.0); self.list.len()];
        for &(row, column, value) in &self.list {
            sorted[fill[column as usize]] = (row, value);
            fill[column as usize] += 1;
        }
        let mut out = Matrix { column_start: vec![0], row: Vec::new(), value: Vec::new() };
        for j in 0..n {
            let column = &mut sorted[start[j]..start[j + 1]];
            column.sort_by_key(|e| e.0);
            let begin = out.row.len();
            for &(row, value) in column.iter() {
                if out.row.len() > begin && out.row.last() == Some(&(row as usize)) {
                    if let Some(last) = out.value.last_mut() {
                        *last += value;
                    }
                } else {
                    out.row.push(row as usize);
                    out.value.push(value);
                }
            }
            out.column_start.push(out.row.len());
        }
        out
    }
}

impl Matrix {
    pub fn size(&self) -> usize {
        self.column_start.len().saturating_sub(1)
    }

    /// Rows and entries of a column.
    pub fn column(&self, j: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        (self.column_start[j]..self.column_start[j + 1]).map(|k| (self.row[k], self.value[k]))
    }

    /// `A x`.
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.size()];
        for j in 0..self.size() {
            self.column(j).for_each(|(i, v)| out[i] += v * x[j]);
        }
        out
    }

    /// `½ (A + Aᵀ)`.
    pub fn symmetric_part(&self) -> SymmetricMatrix {
        let size = self.size();
        let mut columns: Vec<Vec<(usize, f64)>> = vec![Vec::new(); size];
        for j in 0..size {
            self.column(j).for_each(|(i, v)| columns[i.min(j)].push((i.max(j), if i == j { v } else { 0.5 * v })));
        }
        SymmetricMatrix::from_columns(size, |j, out| {
            let column = &mut columns[j];
            column.sort_by_key(|e| e.0);
            for &(i, v) in column.iter() {
                match out.last_mut() {
                    Some(last) if last.0 == i => last.1 += v,
                    _ => out.push((i, v)),
                }
            }
        })
    }

    /// The largest `|a_ij - a_ji|` relative to the geometric mean of the largest entries of both rows.
    pub fn asymmetry(&self) -> f64 {
        let sizes = self.row_sizes();
        let mut most = 0.0f64;
        for j in 0..self.size() {
            for (i, v) in self.column(j) {
                let mirrored = self.get(j, i);
                most = most.max((v - mirrored).abs() / (sizes[i] * sizes[j]).sqrt().max(f64::MIN_POSITIVE));
            }
        }
        most
    }

    /// The entry of a row and column, by bisection.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let range = self.column_start[j]..self.column_start[j + 1];
        self.row[range.clone()].binary_search(&i).map_or(0.0, |k| self.value[range.start + k])
    }

    /// The largest entry of each row.
    pub fn row_sizes(&self) -> Vec<f64> {
        self.row_sizes_within(self.size())
    }

    /// The same of the first columns.
    pub fn row_sizes_within(&self, columns: usize) -> Vec<f64> {
        let mut out = vec![0.0f64; self.size()];
        (0..columns).flat_map(|j| self.column(j)).for_each(|(i, v)| out[i] = out[i].max(v.abs()));
        out
    }
}

/// The factors of a matrix, with the matrix itself for residuals.
pub struct Lu {
    matrix: Matrix,
    /// Powers of two by which rows and columns were multiplied.
    scales: [Vec<f64>; 2],
    factors: Numeric<usize, f64>,
}

/// The symbolic analysis, kept as long as the pattern stays the same.
#[derive(Clone, Default)]
pub struct Analysis(Option<(Vec<usize>, Vec<usize>, SymbolicLu<usize>)>);

/// Relative residual that a solve must reach.
const RESIDUAL: f64 = 1e-9;

impl Analysis {
    /// Factorises a matrix.
    ///
    /// # Errors
    /// No memory, or a matrix that is singular by its structure.
    pub fn factor(&mut self, matrix: Matrix) -> Result<Lu, SolveError> {
        let size = matrix.size();
        let rows: Vec<f64> = matrix.row_sizes().into_iter().map(inverse_power).collect();
        let mut columns = vec![1.0; size];
        let mut value = matrix.value.clone();
        for j in 0..size {
            let range = matrix.column_start[j]..matrix.column_start[j + 1];
            for k in range.clone() {
                value[k] *= rows[matrix.row[k]];
            }
            columns[j] = inverse_power(value[range.clone()].iter().fold(0.0f64, |m, v| m.max(v.abs())));
            value[range].iter_mut().for_each(|v| *v *= columns[j]);
        }
        let singular = |_| SolveError::Singular { size };
        let pattern = SymbolicSparseColMatRef::new_checked(size, size, &matrix.column_start, None, &matrix.row);
        let kept = self.0.as_ref().filter(|k| k.0 == matrix.column_start && k.1 == matrix.row);
        let symbolic = match kept {
            Some(kept) => kept.2.clone(),
            None => {
                let found = SymbolicLu::try_new(pattern).map_err(|_| SolveError::OutOfMemory { size })?;
                self.0 = Some((matrix.column_start.clone(), matrix.row.clone(), found.clone()));
                found
            }
        };
        let factors =
            Numeric::try_new_with_symbolic(symbolic, SparseColMatRef::new(pattern, &value)).map_err(singular)?;
        Ok(Lu { matrix, scales: [rows, columns], factors })
    }
}

impl Lu {
    fn substitute(&self, x: &mut [f64]) {
        x.iter_mut().zip(&self.scales[0]).for_each(|(x, s)| *x *= s);
        let size = x.len();
        self.factors.solve_in_place_with_conj(Conj::No, MatMut::from_column_major_slice_mut(x, size, 1));
        x.iter_mut().zip(&self.scales[1]).for_each(|(x, s)| *x *= s);
    }

    /// Solves `A x = b`, with iterative refinement.
    ///
    /// # Errors
    /// A residual that stays large: the matrix is singular to working precision.
    pub fn solve(&self, b: &[f64]) -> Result<Vec<f64>, SolveError> {
        let size = self.matrix.size();
        // Residual of each equation against the sum of its terms: independent of units. Where these are nothing but the
        // rounding of other unknowns, against what the largest unknowns would make, in the scales of the columns (Arioli,
        // Demmel & Duff 1989).
        let columns = &self.scales[1];
        let mut reach = vec![0.0; size];
        for j in 0..size {
            self.matrix.column(j).for_each(|(i, v)| reach[i] += v.abs() * columns[j]);
        }
        let rounding = 1e3 * size as f64 * f64::EPSILON;
        let backward_error = |x: &[f64]| {
            let mut r = b.to_vec();
            let mut terms: Vec<f64> = b.iter().map(|b| b.abs()).collect();
            for j in 0..size {
                self.matrix.column(j).for_each(|(i, v)| {
                    r[i] -= v * x[j];
                    terms[i] += (v * x[j]).abs();
                });
            }
            let largest = x.iter().zip(columns).fold(0.0f64, |m, (x, c)| m.max(x.abs() / c));
            terms.iter_mut().zip(&reach).for_each(|(t, reach)| {
                if *t <= rounding * reach * largest {
                    *t += reach * largest;
                }
            });
            let of = |(r, t): (&f64, &f64)| if *r == 0.0 { 0.0 } else { r.abs() / t.max(f64::MIN_POSITIVE) };
            // A NaN must not be lost in a maximum.
            let error = r.iter().zip(&terms).map(of).fold(0.0f64, |m, e| if e > m || e.is_nan() { e } else { m });
            (error, r)
        };
        let mut x = b.to_vec();
        self.substitute(&mut x);
        let (mut error, mut r) = backward_error(&x);
        for _ in 0..3 {
            if error.is_nan() || error <= 4.0 * f64::EPSILON {
                break;
            }
            self.substitute(&mut r);
            let next: Vec<f64> = x.iter().zip(&r).map(|(x, r)| x + r).collect();
            let (next_error, next_r) = backward_error(&next);
            if next_error.is_nan() || next_error > 0.5 * error {
                break;
            }
            (x, error, r) = (next, next_error, next_r);
        }
        if error.is_nan() || x.iter().any(|x| !x.is_finite()) {
            return Err(SolveError::Singular { size });
        }
        if error > RESIDUAL {
            return Err(SolveError::Inaccurate { size, residual: error });
        }
        Ok(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(k: usize) -> f64 {
        ((k as f64 + 1.0) * 12.9898).sin() * 43758.5453 % 1.0
    }

    #[test]
    fn solves_saddle_points_in_any_units() {
        let n = 80;
        for unit in [1.0, 1e-9, 1e9] {
            let mut entries = Entries::default();
            for k in 0..n - 1 {
                let [i, j] = [k as u32, k as u32 + 1];
                entries.add_block(&[i, j], &[3.0 + noise(k), -1.0 + noise(k + 7), -1.0, 3.0]);
            }
            // A multiplier without a diagonal, in units of its own.
            for i in [0u32, 30, 79] {
                entries.add(i, n as u32, unit * noise(i as usize));
                entries.add(n as u32, i, unit);
            }
            let a = entries.matrix(n + 1);
            let mut x: Vec<f64> = (0..=n).map(noise).collect();
            x[n] /= unit;
            let found = Analysis::default().factor(a.clone()).unwrap().solve(&a.multiply(&x)).unwrap();
            assert!(x[..n].iter().zip(&found).all(|(a, b)| (a - b).abs() < 1e-12), "{unit}");
            assert!((x[n] - found[n]).abs() * unit < 1e-12, "{unit}");
        }
    }

    #[test]
    fn a_singular_matrix_is_refused() {
        let mut entries = Entries::default();
        entries.add_block(&[0, 1], &[1.0, -1.0, -1.0, 1.0]);
        entries.add(2, 2, 1.0);
        let a = entries.matrix(3);
        let refused = Analysis::default().factor(a).and_then(|lu| lu.solve(&[1.0, 1.0, 0.0]));
        assert!(matches!(refused, Err(SolveError::Singular { .. } | SolveError::Inaccurate { .. })), "{refused:?}");
    }
}
