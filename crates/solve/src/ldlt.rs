//! Factors `L D Lᵀ` of sparse symmetric matrices that need not be positive definite, by `faer`, without pivoting on one
//! thread: by Sylvester's law of inertia as many entries of `D` are negative as eigenvalues of the matrix are.
//!
//! Without pivoting a pivot may be far too small, and its neighbours are lost to rounding: who counts on the signs checks them by
//! a Rayleigh quotient.

use crate::cholesky::SolveError;
use crate::sparse::SymmetricMatrix;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// A factorised matrix.
pub struct Ldlt {
    size: usize,
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
}

impl Ldlt {
    /// Factorises a matrix.
    ///
    /// # Errors
    /// No memory, or a pivot that is zero.
    pub fn factor(a: &SymmetricMatrix) -> Result<Self, SolveError> {
        let size = a.size();
        let out_of_memory = |_| SolveError::OutOfMemory { size };
        let pattern = SymbolicSparseColMatRef::new_checked(size, size, &a.column_start, None, &a.row);
        let order = (SymmetricOrdering::Amd, CholeskySymbolicParams::default());
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Lower, order.0, order.1)
            .map_err(|_| SolveError::OutOfMemory { size })?;
        let mut values = vec![0.0; symbolic.len_val()];
        let scratch = symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(scratch).map_err(out_of_memory)?;
        symbolic
            .factorize_numeric_ldlt(
                &mut values,
                SparseColMatRef::new(pattern, &a.value),
                Side::Lower,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                Default::default(),
            )
            .map_err(|_| SolveError::Singular { size })?;
        Ok(Ldlt { size, symbolic, values })
    }

    /// The entries of `D`, in the order of elimination.
    fn pivots(&self) -> Vec<f64> {
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(factor) => {
                factor.col_ptr()[..self.size].iter().map(|at| self.values[*at]).collect()
            }
            SymbolicCholeskyRaw::Supernodal(factor) => (0..factor.n_supernodes())
                .flat_map(|s| {
                    let columns = factor.supernode_end()[s] - factor.supernode_begin()[s];
                    let rows = columns + factor.supernode(s).pattern().len();
                    let first = factor.col_ptr_for_val()[s];
                    (0..columns).map(move |k| self.values[first + k * (rows + 1)])
                })
                .collect(),
        }
    }

    /// The number of negative eigenvalues.
    pub fn negative_eigenvalues(&self) -> usize {
        self.pivots().iter().filter(|d| **d < 0.0).count()
    }

    /// Solves in `x`, without refinement.
    ///
    /// # Errors
    /// No memory.
    pub fn solve(&self, x: &mut [f64]) -> Result<(), SolveError> {
        let size = self.size;
        let mut memory = MemBuffer::try_new(self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq))
            .map_err(|_| SolveError::OutOfMemory { size })?;
        LdltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, size, 1),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `-u'' - s u` of a chain of springs: as many negative eigenvalues as `4 sin²(kπ/2(n+1)) < s`. With three dense unknowns
    /// a node the factor has supernodes.
    #[test]
    fn negative_eigenvalues_of_a_chain_are_those_of_its_sines() {
        for (n, copies) in [(12, 1), (60, 3)] {
            for shift in [0.01f64, 0.3, 1.7] {
                let mut entries: Vec<(Vec<u32>, Vec<f64>)> = Vec::new();
                for c in 0..copies {
                    for k in 0..n {
                        entries.push((vec![copies * k + c], vec![2.0 - shift]));
                        if k + 1 < n {
                            entries.push((vec![copies * k + c, copies * (k + 1) + c], vec![0.0, -1.0, -1.0, 0.0]));
                        }
                    }
                }
                let size = (copies * n) as usize;
                let matrix = SymmetricMatrix::of_cliques(size, &entries);
                let factor = Ldlt::factor(&matrix).unwrap();
                let angle = |k: u32| f64::from(k) * std::f64::consts::PI / (2.0 * f64::from(n + 1));
                let expected = (1..=n).filter(|k| 4.0 * angle(*k).sin().powi(2) < shift).count();
                assert_eq!(factor.negative_eigenvalues(), copies as usize * expected);
                let x: Vec<f64> = (0..size).map(|k| (k as f64 * 0.7).cos()).collect();
                let mut found = matrix.multiply(&x);
                factor.solve(&mut found).unwrap();
                assert!(x.iter().zip(&found).all(|(a, b)| (a - b).abs() < 1e-10));
            }
        }
    }

    #[test]
    fn a_dense_matrix_counts_in_supernodes() {
        let n = 700;
        // A diagonal with 40 negative entries, and little beside it.
        let value = |i: usize, j: usize| match (i == j, i % 17 == 3 && i < 680) {
            (true, true) => -50.0,
            (true, false) => 50.0,
            _ => 0.01 * ((i * j) as f64 * 0.77).sin(),
        };
        let dense = SymmetricMatrix::from_columns(n, |j, out| out.extend((j..n).map(|i| (i, value(i, j)))));
        assert_eq!(Ldlt::factor(&dense).unwrap().negative_eigenvalues(), 40);
    }
}
