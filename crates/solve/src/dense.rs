//! Dense systems: the Newton step on a contact front has a few dozen unknowns, that on tractions of contact some
//! thousands.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt;
use faer::linalg::lu::partial_pivoting::{factor, solve as substitution};
use faer::perm::PermRef;
use faer::{Mat, MatMut, MatRef, Par};
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

/// `P A = L U` of an unsymmetric matrix of any size, by one thread: the digits are the same on every machine.
pub struct Lu {
    /// `L` below the diagonal, `U` on it and above.
    factors: Mat<f64>,
    rows: Vec<usize>,
    inverse: Vec<usize>,
    sign: f64,
}

impl Lu {
    /// Factorises a matrix of so many rows given by its columns, one after the other, with partial pivoting.
    pub fn new(n: usize, columns: &[f64]) -> Self {
        let mut factors = MatRef::from_column_major_slice(columns, n, n).to_owned();
        let (mut rows, mut inverse) = (vec![0usize; n], vec![0usize; n]);
        let scratch = factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Default::default());
        let (info, _) = factor::lu_in_place(
            factors.as_mut(),
            &mut rows,
            &mut inverse,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
            Default::default(),
        );
        let sign = if info.transposition_count.is_multiple_of(2) { 1.0 } else { -1.0 };
        Lu { factors, rows, inverse, sign }
    }

    fn pivots(&self) -> impl Iterator<Item = f64> {
        (0..self.factors.nrows()).map(|k| self.factors[(k, k)])
    }

    /// The smallest pivot relative to the largest: of the size of round-off where the matrix is singular. 1 without
    /// unknowns.
    pub fn smallest_pivot(&self) -> f64 {
        let largest = self.pivots().fold(0.0f64, |m, p| m.max(p.abs()));
        self.pivots().fold(1.0f64, |m, p| if p.is_nan() { 0.0 } else { m.min(p.abs() / largest) })
    }

    /// The sign of the determinant.
    pub fn determinant_sign(&self) -> f64 {
        self.pivots().fold(self.sign, |sign, p| sign * p.signum())
    }

    /// Solves `A x = b` in `x`.
    pub fn solve_in_place(&self, x: &mut [f64]) {
        let n = x.len();
        let scratch = substitution::solve_in_place_scratch::<usize, f64>(n, 1, Par::Seq);
        substitution::solve_in_place(
            self.factors.as_ref(),
            self.factors.as_ref(),
            PermRef::new_checked(&self.rows, &self.inverse, n),
            MatMut::from_column_major_slice_mut(x, n, 1),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
    }
}

/// [`Lu`] of a matrix whose rows and columns are scaled by powers of two first, so that units do not choose the pivots.
pub struct Equilibrated {
    rows: Vec<f64>,
    columns: Vec<f64>,
    lu: Lu,
}

/// The power of two nearest to an inverse.
pub(crate) fn inverse_power(size: f64) -> f64 {
    if size > 0.0 && size.is_finite() { (-size.log2().round()).exp2() } else { 1.0 }
}

impl Equilibrated {
    /// Factorises a matrix of so many rows given by its columns, one after the other.
    pub fn new(n: usize, mut a: Vec<f64>) -> Self {
        let mut largest = vec![0.0f64; n];
        for column in a.chunks(n.max(1)) {
            largest.iter_mut().zip(column).for_each(|(l, v)| *l = l.max(v.abs()));
        }
        let rows: Vec<f64> = largest.into_iter().map(inverse_power).collect();
        let mut columns = Vec::with_capacity(n);
        for column in a.chunks_mut(n.max(1)) {
            column.iter_mut().zip(&rows).for_each(|(v, s)| *v *= s);
            let scale = inverse_power(column.iter().fold(0.0f64, |m, v| m.max(v.abs())));
            column.iter_mut().for_each(|v| *v *= scale);
            columns.push(scale);
        }
        Equilibrated { rows, columns, lu: Lu::new(n, &a) }
    }

    /// See [`Lu::smallest_pivot`].
    pub fn smallest_pivot(&self) -> f64 {
        self.lu.smallest_pivot()
    }

    /// Solves `A x = b` in `x`.
    pub fn solve_in_place(&self, x: &mut [f64]) {
        x.iter_mut().zip(&self.rows).for_each(|(x, s)| *x *= s);
        self.lu.solve_in_place(x);
        x.iter_mut().zip(&self.columns).for_each(|(x, s)| *x *= s);
    }
}

/// The lower triangle of the inverse of a symmetric matrix, row by row, by Cholesky's factor of its lower triangle and one
/// thread; none where a pivot, a square, is not above `least`.
pub fn positive_inverse(mut a: DMatrix<f64>, least: f64) -> Option<Vec<f64>> {
    let n = a.nrows();
    let scratch = llt::factor::cholesky_in_place_scratch::<f64>(n, Par::Seq, Default::default())
        .or(llt::inverse::inverse_scratch::<f64>(n, Par::Seq));
    let mut memory = MemBuffer::new(scratch);
    let mut factor = MatMut::from_column_major_slice_mut(a.as_mut_slice(), n, n);
    let (default, stack) = (Default::default(), MemStack::new(&mut memory));
    llt::factor::cholesky_in_place(factor.as_mut(), default, Par::Seq, stack, Default::default()).ok()?;
    if (0..n).any(|i| factor[(i, i)].powi(2) <= least) {
        return None;
    }
    let mut inverse = Mat::<f64>::zeros(n, n);
    llt::inverse::inverse(inverse.as_mut(), factor.as_ref(), Par::Seq, MemStack::new(&mut memory));
    Some((0..n).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| inverse[(i, j)]).collect())
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
    fn inverses_of_positive_matrices() {
        use nalgebra::DMatrix;
        for n in [1, 2, 7, 150] {
            let half = DMatrix::from_fn(n, n, |i, j| ((i * 31 + j * 17 + i * j) as f64 * 0.77).sin());
            let a = &half * half.transpose() + DMatrix::identity(n, n);
            let inverse = super::positive_inverse(a.clone(), 1e-12).unwrap();
            let full = DMatrix::from_fn(n, n, |i, j| inverse[i.max(j) * (i.max(j) + 1) / 2 + i.min(j)]);
            assert!((a.clone() * full - DMatrix::identity(n, n)).amax() < 1e-11, "{n}");
            assert!(super::positive_inverse(a.clone(), 1e9).is_none());
            assert!(super::positive_inverse(-a, 1e-12).is_none());
        }
    }

    #[test]
    fn lu_solves_and_knows_the_sign_of_the_determinant() {
        use nalgebra::DMatrix;
        for n in [0, 1, 2, 7, 150] {
            let entry = |i: usize, j: usize| ((i * 31 + j * 17 + i * j) as f64 * 0.77).sin();
            let mut a = DMatrix::from_fn(n, n, |i, j| entry(i, j) + f64::from(u8::from(i == j)));
            let x: Vec<f64> = (0..n).map(|k| (k as f64).cos()).collect();
            let factor = super::Lu::new(n, a.as_slice());
            let mut y: Vec<f64> = (0..n).map(|i| (0..n).map(|j| a[(i, j)] * x[j]).sum()).collect();
            factor.solve_in_place(&mut y);
            assert!(x.iter().zip(&y).all(|(x, y)| (x - y).abs() < 1e-10), "{n}");
            assert!(factor.smallest_pivot() > 1e-4);
            let sign = factor.determinant_sign();
            assert_eq!(sign, a.determinant().signum());
            if n > 1 {
                a.swap_rows(0, 1);
                assert_eq!(super::Lu::new(n, a.as_slice()).determinant_sign(), -sign);
                let row = a.row(1).into_owned();
                a.set_row(0, &row);
                assert!(super::Lu::new(n, a.as_slice()).smallest_pivot() < 1e-14);
            }
        }
    }

    #[test]
    fn solves_and_refuses() {
        let x = super::solve(&[0.0, 2.0, 1.0, 1.0], &[4.0, 3.0]).unwrap();
        assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15);
        assert!(super::solve(&[1.0, 1.0, 1.0, 1.0], &[1.0, 2.0]).is_none());
    }
}
