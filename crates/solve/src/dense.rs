//! Small dense systems: the Newton step on a contact front has a few dozen unknowns.

use nalgebra::{DMatrix, DVector};

/// Solves `A x = b` for a row-major matrix by LU with partial pivoting; none if the matrix is singular.
pub fn solve(a: &[f64], b: &[f64]) -> Option<Vec<f64>> {
    let n = b.len();
    let x = DMatrix::from_row_slice(n, n, a).lu().solve(&DVector::from_column_slice(b))?;
    x.iter().all(|v| v.is_finite()).then(|| x.as_slice().to_vec())
}

#[cfg(test)]
mod tests {
    #[test]
    fn solves_and_refuses() {
        let x = super::solve(&[0.0, 2.0, 1.0, 1.0], &[4.0, 3.0]).unwrap();
        assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15);
        assert!(super::solve(&[1.0, 1.0, 1.0, 1.0], &[1.0, 2.0]).is_none());
    }
}
