//! Static condensation: a symmetric matrix reduced to a few of its unknowns (Guyan 1965), factorised once for many systems
//! that differ in these unknowns only.
//!
//! With the unknowns `k` that remain eliminated last, and springs `D` on their diagonal, the last block of the factor of
//! `K + D` is that of the Schur complement,
//!
//! ```text
//! L_kk L_kkᵀ = S + D,    S = K_kk - K_ki K_ii⁻¹ K_ik:
//! ```
//!
//! it costs no solves. The springs make the matrix positive where nothing but what is added to `S` later holds the body.

use crate::cholesky::{Factor, SolveError, Symbolic};
use crate::sparse::SymmetricMatrix;
use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::{Accum, Mat, Par};

/// A symmetric matrix, reduced to some of its unknowns.
pub struct Condensation {
    factor: Factor,
    kept: Vec<u32>,
    /// The springs `D`.
    springs: Vec<f64>,
    /// `S + D`.
    stiffened: Mat<f64>,
}

impl Condensation {
    /// Reduces a matrix to the unknowns that are `kept`; `places` tells where each unknown is, for the order of elimination.
    ///
    /// # Errors
    /// A matrix that is not positive definite on the other unknowns, or no memory.
    pub fn new(mut matrix: SymmetricMatrix, kept: Vec<u32>, places: Vec<[f64; 3]>) -> Result<Self, SolveError> {
        let diagonal = matrix.diagonal();
        let springs: Vec<f64> = kept.iter().map(|k| diagonal[*k as usize]).collect();
        kept.iter().zip(&springs).for_each(|(k, d)| matrix.add(&[*k], &[*d], 1.0));
        let factor = Symbolic::dissected(places).with_last(kept.clone()).factor(matrix)?;
        let lower = factor.trailing(kept.len());
        let mut stiffened = Mat::<f64>::zeros(kept.len(), kept.len());
        let (down, up) = (BlockStructure::TriangularLower, BlockStructure::TriangularUpper);
        matmul(stiffened.as_mut(), down, Accum::Replace, lower.as_ref(), down, lower.transpose(), up, 1.0, Par::Seq);
        for j in 0..kept.len() {
            (0..j).for_each(|i| stiffened[(i, j)] = stiffened[(j, i)]);
        }
        Ok(Condensation { factor, kept, springs, stiffened })
    }

    /// The unknowns that remain.
    pub fn kept(&self) -> &[u32] {
        &self.kept
    }

    /// Adds the Schur complement to the upper left of a matrix of so many rows, column by column.
    pub fn add_to(&self, matrix: &mut [f64], rows: usize) {
        for j in 0..self.kept.len() {
            for i in 0..self.kept.len() {
                matrix[j * rows + i] += self.stiffened[(i, j)];
            }
            matrix[j * rows + j] -= self.springs[j];
        }
    }

    /// Solves with the matrix and with what is added on the unknowns that remain: `of_kept` is given the right-hand side
    /// reduced to them, and gives them.
    ///
    /// # Errors
    /// Those of `of_kept`, and no memory.
    pub fn solve<E: From<SolveError>>(
        &self,
        right: &[f64],
        of_kept: impl FnOnce(&[f64]) -> Result<Vec<f64>, E>,
    ) -> Result<Vec<f64>, E> {
        // With x = (K + D)⁻¹ (b_i, 0): S x_k + D x_k = -K_ki K_ii⁻¹ b_i.
        let mut x = right.to_vec();
        self.kept.iter().for_each(|k| x[*k as usize] = 0.0);
        self.factor.solve_once(&mut x)?;
        let at_rest: Vec<f64> = self.kept.iter().map(|k| x[*k as usize]).collect();
        let reduced: Vec<f64> =
            self.kept.iter().zip(self.times(&at_rest)).map(|(k, moved)| right[*k as usize] + moved).collect();
        let found = of_kept(&reduced)?;
        let further: Vec<f64> = found.iter().zip(&at_rest).map(|(v, x)| v - x).collect();
        let mut y = vec![0.0; x.len()];
        self.kept.iter().zip(self.times(&further)).for_each(|(k, f)| y[*k as usize] = f);
        self.factor.solve_once(&mut y)?;
        x.iter_mut().zip(&y).for_each(|(x, y)| *x += y);
        self.kept.iter().zip(&found).for_each(|(k, v)| x[*k as usize] = *v);
        Ok(x)
    }

    /// `(S + D) v`.
    fn times(&self, v: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; v.len()];
        for (j, v) in v.iter().enumerate() {
            out.iter_mut().zip(self.stiffened.col(j).iter()).for_each(|(o, s)| *o += s * v);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Springs between neighbours of a box of nodes, in no order, nothing held: only what is added holds it.
    #[test]
    fn a_free_grid_with_springs_on_what_remains_is_solved_as_a_whole() {
        for n in [3u32, 9, 14] {
            let at = |i: u32, j: u32, k: u32| (i * n + j) * n + k;
            let (mut cliques, mut places) = (Vec::new(), Vec::new());
            for (i, j, k) in (0..n * n * n).map(|c| (c / (n * n), c / n % n, c % n)) {
                places.push([i, j, k].map(f64::from));
                let next = [(i + 1, j, k), (i, j + 1, k), (i, j, k + 1)];
                for (a, b, c) in next.into_iter().filter(|(a, b, c)| *a < n && *b < n && *c < n) {
                    let s = 1.0 + f64::from(a + 2 * b + 3 * c).sin().abs();
                    cliques.push((vec![at(i, j, k), at(a, b, c)], vec![s, -s, -s, s]));
                }
            }
            let size = (n * n * n) as usize;
            let matrix = SymmetricMatrix::of_cliques(size, &cliques);
            let kept: Vec<u32> = (0..n * n).map(|c| at(0, c / n, c % n)).collect();
            let condensed = Condensation::new(matrix.clone(), kept.clone(), places).unwrap();
            let m = kept.len();
            // Unsymmetric, as friction is.
            let extra = |i: usize, j: usize| if i == j { 2.0 } else { 0.1 * ((i + 3 * j) as f64).sin() / m as f64 };
            let right: Vec<f64> = (0..size).map(|k| (k as f64 * 0.3).cos()).collect();
            let x = condensed
                .solve(&right, |reduced| {
                    let mut a: Vec<f64> = (0..m * m).map(|k| extra(k % m, k / m)).collect();
                    condensed.add_to(&mut a, m);
                    let mut v = reduced.to_vec();
                    crate::dense::Lu::new(m, &a).solve_in_place(&mut v);
                    Ok::<_, SolveError>(v)
                })
                .unwrap();
            let mut residual: Vec<f64> = matrix.multiply(&x).iter().zip(&right).map(|(a, b)| a - b).collect();
            for i in 0..m {
                residual[kept[i] as usize] += (0..m).map(|j| extra(i, j) * x[kept[j] as usize]).sum::<f64>();
            }
            let largest = residual.iter().fold(0.0f64, |l, r| l.max(r.abs()));
            assert!(largest < 1e-10, "{n}: {largest}");
        }
    }
}
