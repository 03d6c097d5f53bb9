//! Determinant and inverse of matrices of one to three rows, for any dimension known at compile time.

use signorini_geometry::Matrix;

/// # Panics
/// If there are more than three rows.
pub fn determinant<const D: usize>(m: &Matrix<D>) -> f64 {
    let at = |i: usize, j: usize| m[(i, j)];
    match D {
        0 => 1.0,
        1 => at(0, 0),
        2 => at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0),
        3 => {
            at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1))
                - at(0, 1) * (at(1, 0) * at(2, 2) - at(1, 2) * at(2, 0))
                + at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0))
        }
        _ => panic!("{D} dimensions"),
    }
}

/// The inverse, by cofactors; not finite where there is none.
///
/// # Panics
/// If there are more than three rows.
pub fn inverse<const D: usize>(m: &Matrix<D>) -> Matrix<D> {
    let d = determinant(m);
    let at = |i: usize, j: usize| m[(i, j)];
    Matrix::<D>::from_fn(|i, j| {
        let cofactor = match D {
            1 => 1.0,
            2 => {
                let sign = if i == j { 1.0 } else { -1.0 };
                sign * at(1 - j, 1 - i)
            }
            _ => {
                let (p, q, r, s) = ((j + 1) % 3, (j + 2) % 3, (i + 1) % 3, (i + 2) % 3);
                at(p, r) * at(q, s) - at(p, s) * at(q, r)
            }
        };
        cofactor / d
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_and_determinant() {
        let a = Matrix::<3>::new(2.0, -1.0, 0.5, 0.3, 1.7, 0.2, -0.4, 0.1, 1.1);
        assert!((a * inverse(&a) - Matrix::<3>::identity()).norm() < 1e-14);
        assert!((determinant(&a) - nalgebra_determinant(&a)).abs() < 1e-14);
        let b = Matrix::<2>::new(2.0, -1.0, 0.3, 1.7);
        assert!((b * inverse(&b) - Matrix::<2>::identity()).norm() < 1e-15);
    }

    fn nalgebra_determinant(a: &Matrix<3>) -> f64 {
        a.determinant()
    }
}
