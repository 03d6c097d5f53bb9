//! Small dense systems: the Newton step on a contact front has a few dozen unknowns.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Solves `A x = b` for a row-major matrix by LU with partial pivoting; none if the matrix is singular.
pub fn solve(a: &[f64], b: &[f64]) -> Option<Vec<f64>> {
    let n = b.len();
    let x = DMatrix::from_row_slice(n, n, a).lu().solve(&DVector::from_column_slice(b))?;
    x.iter().all(|v| v.is_finite()).then(|| x.as_slice().to_vec())
}

/// A factorised matrix.
pub struct Factor(nalgebra::LU<f64, nalgebra::Dyn, nalgebra::Dyn>);

impl Factor {
    /// Factorises a row-major matrix by LU with partial pivoting; none if it is singular.
    pub fn new(n: usize, a: &[f64]) -> Option<Self> {
        let lu = DMatrix::from_row_slice(n, n, a).lu();
        lu.is_invertible().then_some(Self(lu))
    }

    /// Solves `A x = b`.
    pub fn solve(&self, b: &[f64]) -> Vec<f64> {
        let mut x = DVector::from_column_slice(b);
        self.0.solve_mut(&mut x);
        x.as_slice().to_vec()
    }
}

/// The eigenvalues of `A x = λ B x`, ascending, and their eigenvectors, of unit length in `B`; of symmetric row-major
/// matrices, of which `B` must be positive definite. None where it is not.
pub fn symmetric_eigen(a: &[f64], b: &[f64]) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
    let n = a.len().isqrt();
    let factor = DMatrix::from_row_slice(n, n, b).cholesky()?.unpack();
    let a = DMatrix::from_row_slice(n, n, a);
    let half = factor.solve_lower_triangular(&((&a + a.transpose()) * 0.5))?;
    let reduced = factor.solve_lower_triangular(&half.transpose())?;
    let eigen = SymmetricEigen::try_new((&reduced + reduced.transpose()) * 0.5, f64::EPSILON, 100 * n.max(10))?;
    let vectors = factor.tr_solve_lower_triangular(&eigen.eigenvectors)?;
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    let values = order.iter().map(|&i| eigen.eigenvalues[i]).collect();
    Some((values, order.iter().map(|&i| vectors.column(i).iter().copied().collect()).collect()))
}

#[cfg(test)]
mod tests {
    #[test]
    fn eigenvectors_satisfy_their_equation() {
        let (a, b) = ([2.0, 1.0, 0.0, 1.0, -3.0, 0.5, 0.0, 0.5, 1.0], [2.0, 0.3, 0.0, 0.3, 1.0, 0.1, 0.0, 0.1, 0.5]);
        let times = |m: &[f64; 9], x: &[f64]| -> Vec<f64> {
            (0..3).map(|i| (0..3).map(|j| m[3 * i + j] * x[j]).sum()).collect()
        };
        let (values, vectors) = super::symmetric_eigen(&a, &b).unwrap();
        assert!(values.is_sorted());
        for (value, x) in values.iter().zip(&vectors) {
            let (ax, bx) = (times(&a, x), times(&b, x));
            assert!(ax.iter().zip(&bx).all(|(l, r)| (l - value * r).abs() < 1e-14));
            assert!((x.iter().zip(&bx).map(|(x, y)| x * y).sum::<f64>() - 1.0).abs() < 1e-14);
        }
        assert!(super::symmetric_eigen(&a, &[0.0; 9]).is_none());
    }

    #[test]
    fn solves_and_refuses() {
        let x = super::solve(&[0.0, 2.0, 1.0, 1.0], &[4.0, 3.0]).unwrap();
        assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15);
        assert!(super::solve(&[1.0, 1.0, 1.0, 1.0], &[1.0, 2.0]).is_none());
    }
}
