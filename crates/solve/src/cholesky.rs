//! Sparse factorisation of symmetric positive definite matrices, by `faer`.
//!
//! Factorisation runs on one thread, so that digits do not depend on the number
//! of threads; every solve is checked by its residual, refined, and refused where the residual stays large.

use crate::dissection::nested_dissection;
use crate::sparse::SymmetricMatrix;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError;
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Mat, MatMut, Par, Side};
use std::sync::Arc;

/// A linear system that could not be solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolveError {
    #[error("the matrix of {size} unknowns is not positive definite: the pivot of unknown {pivot} is not positive")]
    NotPositiveDefinite {
        size: usize,
        /// The unknown at which the factorisation ends.
        pivot: usize,
    },
    #[error("the linear system of {size} unknowns was solved only to a relative residual of {residual:.1e}")]
    Inaccurate { size: usize, residual: f64 },
    #[error("the linear system of {size} unknowns was not factorised")]
    NotFactorised { size: usize },
    #[error("the matrix of {size} unknowns is singular")]
    Singular { size: usize },
    #[error("not enough memory to factorise a matrix of {size} unknowns")]
    OutOfMemory { size: usize },
}

/// Columns from which on the kernels that solve for them are the same for any number: from 16 on, as tests tell.
const COLUMNS: usize = 32;

/// Relative residual that a solve must reach.
const RESIDUAL: f64 = 1e-10;

/// The symbolic analysis, kept and reused as long as the pattern stays the same.
#[derive(Clone, Default)]
pub struct Symbolic {
    /// Where the unknowns are, for an order of elimination by nested dissection.
    places: Option<Arc<Vec<[f64; 3]>>>,
    /// Unknowns that are eliminated last, in this sequence, if places are known.
    last: Vec<u32>,
    cached: Option<Analysis>,
}

/// Column starts and rows of a matrix, and the structure of its factor.
type Analysis = Arc<(Vec<usize>, Vec<usize>, SymbolicCholesky<usize>)>;

/// What a factorisation takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Memory of the factor.
    pub bytes: f64,
    /// Multiplications, each with an addition.
    pub operations: f64,
}

impl Symbolic {
    /// An analysis with the order of elimination of [`crate::dissection`], by where the unknowns are. Without it the order is
    /// that of minimum degree.
    pub fn dissected(places: Vec<[f64; 3]>) -> Self {
        Symbolic { places: Some(Arc::new(places)), ..Symbolic::default() }
    }

    /// The same with some unknowns eliminated last, in their sequence.
    pub fn with_last(self, last: Vec<u32>) -> Self {
        Symbolic { last, cached: None, ..self }
    }

    /// What a factorisation would take, from the structure of the factor.
    pub fn cost(&mut self, a: &SymmetricMatrix) -> Result<Cost, SolveError> {
        let analysis = self.analyse(a)?;
        let squares = |rows: usize, columns: usize| (0..columns).map(|k| ((rows - k) as f64).powi(2)).sum::<f64>();
        let operations = match analysis.2.raw() {
            SymbolicCholeskyRaw::Simplicial(factor) => {
                factor.col_ptr().windows(2).map(|w| squares(w[1] - w[0], 1)).sum()
            }
            SymbolicCholeskyRaw::Supernodal(factor) => (factor.supernode_begin().iter())
                .zip(factor.supernode_end())
                .zip(factor.col_ptr_for_row_idx().windows(2))
                .map(|((begin, end), below)| squares(end - begin + below[1] - below[0], end - begin))
                .sum::<f64>(),
        };
        Ok(Cost { bytes: 8.0 * analysis.2.len_val() as f64, operations })
    }

    fn analyse(&mut self, a: &SymmetricMatrix) -> Result<Analysis, SolveError> {
        let size = a.size();
        let pattern = SymbolicSparseColMatRef::new_checked(size, size, &a.column_start, None, &a.row);
        let reusable = self.cached.as_ref().filter(|c| c.0 == a.column_start && c.1 == a.row);
        if let Some(analysis) = reusable {
            return Ok(analysis.clone());
        }
        let order = self.places.as_ref().filter(|p| p.len() == size).map(|places| {
            let mut order = nested_dissection(a, places);
            if !self.last.is_empty() {
                let mut is_last = vec![false; size];
                self.last.iter().for_each(|k| is_last[*k as usize] = true);
                order.retain(|k| !is_last[*k]);
                order.extend(self.last.iter().map(|k| *k as usize));
            }
            let mut place = vec![0; size];
            order.iter().enumerate().for_each(|(new, &old)| place[old] = new);
            (order, place)
        });
        let ordering = match &order {
            Some((order, place)) => SymmetricOrdering::Custom(PermRef::new_checked(order, place, size)),
            None => SymmetricOrdering::Amd,
        };
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Lower, ordering, CholeskySymbolicParams::default())
            .map_err(|_| SolveError::OutOfMemory { size })?;
        let analysis = Arc::new((a.column_start.clone(), a.row.clone(), symbolic));
        self.cached = Some(analysis.clone());
        Ok(analysis)
    }

    /// Factorises a matrix `A = L Lᵀ`, which is kept for the residuals.
    pub fn factor(&mut self, a: SymmetricMatrix) -> Result<Factor, SolveError> {
        let size = a.size();
        let out_of_memory = |_| SolveError::OutOfMemory { size };
        let analysis = self.analyse(&a)?;
        let pattern = SymbolicSparseColMatRef::new_checked(size, size, &a.column_start, None, &a.row);
        let symbolic = &analysis.2;
        let mut values = Vec::new();
        values.try_reserve_exact(symbolic.len_val()).map_err(|_| SolveError::OutOfMemory { size })?;
        values.resize(symbolic.len_val(), 0.0);
        let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(scratch).map_err(out_of_memory)?;
        symbolic
            .factorize_numeric_llt(
                &mut values,
                SparseColMatRef::new(pattern, &a.value),
                Side::Lower,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                Default::default(),
            )
            .map_err(|LltError::NonPositivePivot { index }| SolveError::NotPositiveDefinite {
                size,
                pivot: unknown_at(symbolic, index),
            })?;
        Ok(Factor { matrix: a, analysis, values, places: self.places.clone() })
    }
}

/// The unknown that is eliminated where a factorisation ends; without supernodes such places are counted from one.
fn unknown_at(symbolic: &SymbolicCholesky<usize>, index: usize) -> usize {
    let place = match symbolic.raw() {
        SymbolicCholeskyRaw::Simplicial(_) => index.saturating_sub(1),
        SymbolicCholeskyRaw::Supernodal(_) => index,
    };
    symbolic.perm().map_or(place, |perm| perm.arrays().0[place])
}

/// A factorised matrix, with the matrix itself for residuals.
pub struct Factor {
    matrix: SymmetricMatrix,
    analysis: Analysis,
    values: Vec<f64>,
    places: Option<Arc<Vec<[f64; 3]>>>,
}

impl Factor {
    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.matrix.size()
    }

    /// Entries of the factor.
    pub fn entries(&self) -> f64 {
        self.values.len() as f64
    }

    /// The lower triangle of the factor between the unknowns that were eliminated last.
    pub fn trailing(&self, count: usize) -> Mat<f64> {
        let begin = self.size() - count;
        let mut out = Mat::<f64>::zeros(count, count);
        match self.analysis.2.raw() {
            SymbolicCholeskyRaw::Simplicial(factor) => {
                for j in begin..self.size() {
                    for k in factor.col_ptr()[j]..factor.col_ptr()[j + 1] {
                        out[(factor.row_idx()[k] - begin, j - begin)] = self.values[k];
                    }
                }
            }
            SymbolicCholeskyRaw::Supernodal(factor) => {
                for s in 0..factor.n_supernodes() {
                    let (own, below) = (factor.supernode_begin()[s]..factor.supernode_end()[s], factor.supernode(s));
                    let rows: Vec<usize> = own.clone().chain(below.pattern().iter().copied()).collect();
                    let values = &self.values[factor.col_ptr_for_val()[s]..];
                    for (k, j) in own.enumerate().filter(|(_, j)| *j >= begin) {
                        let column = &values[k * rows.len()..(k + 1) * rows.len()];
                        rows.iter().zip(column).skip(k).for_each(|(i, v)| out[(i - begin, j - begin)] = *v);
                    }
                }
            }
        }
        out
    }

    /// The factor of the sum of the matrix and another one, ordered anew in the same way.
    ///
    /// # Errors
    /// Those of [`Symbolic::factor`].
    pub fn plus(&self, other: &SymmetricMatrix) -> Result<Factor, SolveError> {
        Symbolic { places: self.places.clone(), ..Symbolic::default() }.factor(self.matrix.plus(other))
    }

    /// The entries of the matrix between some unknowns, in ascending order, one row after the other.
    pub fn block(&self, unknowns: &[u32]) -> Vec<f64> {
        self.matrix.block(unknowns)
    }

    /// Solves `A x = b`, with iterative refinement.
    pub fn solve(&self, b: &[f64]) -> Result<Vec<f64>, SolveError> {
        let size = self.matrix.size();
        let mut x = b.to_vec();
        self.substitute(&mut x)?;
        let norm = |v: &[f64]| v.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        let mut previous = f64::INFINITY;
        for _ in 0..4 {
            let ax = self.matrix.multiply(&x);
            let mut r: Vec<f64> = b.iter().zip(&ax).map(|(b, ax)| b - ax).collect();
            let scale = norm(b) + self.matrix.largest() * norm(&x) + f64::MIN_POSITIVE;
            let residual = norm(&r) / scale;
            if residual.is_nan() {
                return Err(SolveError::Inaccurate { size, residual });
            }
            if residual <= 1e-16 || residual > 0.25 * previous {
                return if residual <= RESIDUAL { Ok(x) } else { Err(SolveError::Inaccurate { size, residual }) };
            }
            previous = residual;
            self.substitute(&mut r)?;
            for (x, r) in x.iter_mut().zip(&r) {
                *x += r;
            }
        }
        Ok(x)
    }

    /// Solves `A x = b` and refines the solution with residuals of twice the working precision: sums of its equations,
    /// such as the balance of all forces, then hold to the round-off of the solution itself.
    pub fn solve_accurately(&self, b: &[f64]) -> Result<Vec<f64>, SolveError> {
        let mut x = self.solve(b)?;
        for _ in 0..2 {
            let mut r = self.matrix.residual_in_extended_precision(b, &x);
            self.substitute(&mut r)?;
            for (x, r) in x.iter_mut().zip(&r) {
                *x += r;
            }
        }
        Ok(x)
    }

    /// Solves for several right-hand sides at once, one after the other in `x`, without refinement: several times as
    /// fast as one by one, for what is refined later. The digits of a solution do not depend on which others are
    /// solved for beside it.
    pub fn solve_columns(&self, x: &mut [f64]) -> Result<(), SolveError> {
        let least = self.matrix.size() * COLUMNS;
        if x.len() >= least {
            return self.substitute(x);
        }
        // A few columns would be solved by other kernels, which round in another sequence.
        let mut more = x.to_vec();
        more.resize(least, 0.0);
        self.substitute(&mut more)?;
        x.copy_from_slice(&more[..x.len()]);
        Ok(())
    }

    /// Solves in `x`, without refinement: for corrections that are themselves refined later.
    pub fn solve_once(&self, x: &mut [f64]) -> Result<(), SolveError> {
        self.substitute(x)
    }

    fn substitute(&self, x: &mut [f64]) -> Result<(), SolveError> {
        let symbolic = &self.analysis.2;
        let size = self.matrix.size();
        let columns = x.len() / size.max(1);
        let mut memory = MemBuffer::try_new(symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq))
            .map_err(|_| SolveError::OutOfMemory { size })?;
        LltRef::new(symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, size, columns),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The five-point Laplacian of an n × n grid.
    fn laplacian(n: u32) -> SymmetricMatrix {
        let mut cliques = Vec::new();
        for i in 0..n * n {
            cliques.push(vec![i]);
            if i % n + 1 < n {
                cliques.push(vec![i, i + 1]);
            }
            if i + n < n * n {
                cliques.push(vec![i, i + n]);
            }
        }
        let mut a = SymmetricMatrix::from_cliques((n * n) as usize, &cliques);
        for c in &cliques {
            match c.len() {
                1 => a.add(c, &[1e-3], 1.0),
                _ => a.add(c, &[1.0, -1.0, -1.0, 1.0], 1.0),
            }
        }
        a
    }

    #[test]
    fn solves_to_round_off_and_reuses_its_analysis() {
        let a = laplacian(60);
        let x: Vec<f64> = (0..a.size()).map(|i| (i as f64 * 0.37).sin()).collect();
        let b = a.multiply(&x);
        let mut symbolic = Symbolic::default();
        for _ in 0..2 {
            let y = symbolic.factor(a.clone()).unwrap().solve(&b).unwrap();
            let error = x.iter().zip(&y).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
            assert!(error < 1e-9, "{error}");
            let mut once = b.clone();
            symbolic.factor(a.clone()).unwrap().solve_once(&mut once).unwrap();
            assert!(once.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-8));
        }
    }

    #[test]
    fn the_order_and_many_columns_change_nothing_and_sums_are_factors_too() {
        let places = (0..400).map(|k| [f64::from(k / 20), f64::from(k % 20), 0.0]).collect();
        let [first, second] = [laplacian(20), laplacian(20)];
        let a = first.plus(&second);
        let n = a.size();
        let factor = Symbolic::dissected(places).factor(first).unwrap().plus(&second).unwrap();
        let x: Vec<f64> = (0..3 * n).map(|i| (i as f64 * 0.37).sin()).collect();
        let mut b: Vec<f64> = x.chunks(n).flat_map(|c| a.multiply(c)).collect();
        factor.solve_columns(&mut b).unwrap();
        assert!(x.iter().zip(&b).all(|(x, y)| (x - y).abs() < 1e-8));
    }

    /// Three unknowns a node of a box in space.
    fn solid(cells: [u32; 3]) -> SymmetricMatrix {
        let at = |i: u32, j: u32, k: u32| (i * (cells[1] + 1) + j) * (cells[2] + 1) + k;
        let mut cliques = Vec::new();
        for cell in 0..cells[0] * cells[1] * cells[2] {
            let (i, j, k) = (cell / (cells[1] * cells[2]), cell / cells[2] % cells[1], cell % cells[2]);
            let corners = (0..8u32).map(|c| at(i + c % 2, j + c / 2 % 2, k + c / 4));
            cliques.push(corners.flat_map(|n| (0..3).map(move |a| 3 * n + a)).collect::<Vec<u32>>());
        }
        let n = cells.iter().map(|c| c + 1).product::<u32>() * 3;
        let mut a = SymmetricMatrix::from_cliques(n as usize, &cliques);
        let value = |i: usize, j: usize| if i == j { 30.0 } else { (((i + j) * (i + j + i * j)) as f64 * 0.77).sin() };
        let element: Vec<f64> = (0..576).map(|k| value((k / 24).max(k % 24), (k / 24).min(k % 24))).collect();
        cliques.iter().for_each(|c| a.add(c, &element, 1.0));
        a
    }

    #[test]
    fn columns_do_not_depend_on_their_neighbours() {
        // One dense block, which is solved by the blocked kernels.
        let n = 700;
        let value = |i: usize, j: usize| if i == j { 1e3 } else { ((i * j) as f64 * 0.77).sin() };
        let dense = SymmetricMatrix::from_columns(n, |j, out| out.extend((j..n).map(|i| (i, value(i, j)))));
        for matrix in [dense, laplacian(60), solid([7, 6, 4])] {
            let factor = Symbolic::default().factor(matrix).unwrap();
            let n = factor.size();
            let column = |k: usize| (0..n).map(move |i| ((i * 7 + k * 13) as f64 * 0.37).sin());
            let solved = |from: usize, count: usize| {
                let mut b: Vec<f64> = (from..from + count).flat_map(column).collect();
                factor.solve_columns(&mut b).unwrap();
                b
            };
            let alone: Vec<f64> = (0..40).flat_map(|k| solved(k, 1)).collect();
            for count in [2, 3, 5, 9, 20, 31, 32, 40] {
                assert_eq!(solved(0, count), alone[..n * count], "{count} at once");
                assert_eq!(solved(40 - count, count), alone[n * (40 - count)..], "the last {count}");
            }
        }
    }

    #[test]
    fn the_cost_is_that_of_the_factor() {
        // Full: every column has all entries below it.
        let n = 6;
        let full = SymmetricMatrix::from_columns(n, |j, out| out.extend((j..n).map(|i| (i, f64::from(i == j)))));
        let cost = Symbolic::default().cost(&full).unwrap();
        assert!(cost.bytes >= 8.0 * 21.0 && cost.bytes <= 8.0 * 36.0, "{cost:?}");
        assert_eq!(cost.operations, (1..=6).map(|k| f64::from(k * k)).sum::<f64>());
        // A grid in two dimensions by minimum degree: about n^1.5 operations for n unknowns.
        let [small, large] = [20, 80].map(|n| Symbolic::default().cost(&laplacian(n)).unwrap().operations);
        let order = (large / small).ln() / 16f64.ln();
        assert!((1.2..1.8).contains(&order), "{order}");
    }

    /// Small matrices have factors without supernodes, large ones with.
    #[test]
    fn an_indefinite_matrix_is_refused_by_the_unknown_that_makes_it_so() {
        for n in [10, 60] {
            let mut a = laplacian(n);
            a.add(&[3], &[-100.0], 1.0);
            let Err(SolveError::NotPositiveDefinite { size, pivot }) = Symbolic::default().factor(a) else { panic!() };
            assert_eq!((size, pivot), ((n * n) as usize, 3));
        }
    }
}
