//! The volumetric ghost penalty (Preuss; Lehrenfeld & Olshanskii): two polynomials that meet at a face of a cut cell are
//! held together by the difference of their extensions over both cells.

use crate::lagrange::{Tabulation, TensorBasis};
use signorini_geometry::Point;
use signorini_geometry::rule::gauss_legendre;

/// The matrices of `h_k^-2 ∫_{K1 ∪ K2} (E u1 - E u2)(E v1 - E v2)` for a face normal to direction `k`, on one cell size.
///
/// The unknowns are those of the lower cell followed by those of the upper one, the shared ones in both: because both
/// polynomials agree there, assembling them twice is right.
#[derive(Clone, Debug)]
pub struct GhostPenalty<const D: usize> {
    matrices: [Vec<f64>; D],
}

impl<const D: usize> GhostPenalty<D> {
    pub fn new(basis: &TensorBasis<D>, size: &Point<D>) -> Self {
        Self { matrices: std::array::from_fn(|k| face_matrix(basis, size, k)) }
    }

    /// Row-major matrix of size `2 (p + 1)^D` for faces normal to direction `k`.
    pub fn matrix(&self, k: usize) -> &[f64] {
        &self.matrices[k]
    }
}

fn face_matrix<const D: usize>(basis: &TensorBasis<D>, size: &Point<D>, k: usize) -> Vec<f64> {
    let n = basis.len();
    let rule = gauss_legendre(basis.degree() + 1);
    let q = rule.len();
    let scale = size.iter().product::<f64>() / (size[k] * size[k]);
    let mut matrix = vec![0.0; 4 * n * n];
    let (mut lower, mut upper) = (Tabulation::default(), Tabulation::default());
    let mut jump = vec![0.0; 2 * n];
    for half in 0..2 {
        for i in 0..q.pow(D as u32) {
            let mut index = i;
            let mut weight = scale;
            let mut xi = Point::<D>::zeros();
            for d in 0..D {
                let (x, w) = rule[index % q];
                index /= q;
                xi[d] = x;
                weight *= w;
            }
            xi[k] += half as f64;
            basis.tabulate(&xi, size, &mut lower);
            xi[k] -= 1.0;
            basis.tabulate(&xi, size, &mut upper);
            for a in 0..n {
                jump[a] = lower.value[a];
                jump[n + a] = -upper.value[a];
            }
            for a in 0..2 * n {
                for b in 0..2 * n {
                    matrix[a * 2 * n + b] += weight * jump[a] * jump[b];
                }
            }
        }
    }
    // Constants are free, and their rows sum to zero; what round-off makes of it goes to the diagonal, or it would show
    // up as a force without a cause: at degree 6 the extensions reach far, and the entries are large.
    for a in 0..2 * n {
        let row = &mut matrix[a * 2 * n..(a + 1) * 2 * n];
        row[a] = -(0..2 * n).filter(|b| *b != a).map(|b| row[b]).sum::<f64>();
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_global_polynomial_is_free_and_a_kink_is_not() {
        let basis = TensorBasis::<2>::new(3);
        let size = Point::<2>::new(0.5, 0.25);
        let ghost = GhostPenalty::new(&basis, &size);
        let nodes = basis.line_nodes();
        let energy = |f: &dyn Fn(f64, f64) -> f64| {
            let u: Vec<f64> = (0..2 * basis.len())
                .map(|i| {
                    let (cell, j) = (i / basis.len(), i % basis.len());
                    f((nodes[j % 4] + cell as f64) * size[0], nodes[j / 4] * size[1])
                })
                .collect();
            let m = ghost.matrix(0);
            (0..u.len()).map(|a| (0..u.len()).map(|b| u[a] * m[a * u.len() + b] * u[b]).sum::<f64>()).sum::<f64>()
        };
        assert!(energy(&|x, y| x.powi(3) * y - y.powi(2) + 1.0).abs() < 1e-12);
        // A kink of slope 1 differs by |x - 0.5| on both cells: ∫ 2 t² over both, divided by h².
        assert!((energy(&|x, _| (x - 0.5).max(0.0)) - 2.0 / 3.0 * 0.125 * 0.25 / 0.25).abs() < 1e-12);
    }
}
