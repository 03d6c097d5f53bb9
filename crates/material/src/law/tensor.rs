//! Tensors of laws, and energies with their derivatives in the deformation gradient.

use nalgebra::{Matrix3, SMatrix, SVector};

/// A second-order tensor, row by row.
pub type Tensor = SVector<f64, 9>;
/// A fourth-order tensor: row and column as [`Tensor`].
pub type Tensor4 = SMatrix<f64, 9, 9>;

/// A scalar with its derivatives in `F`: an energy with first Piola stress and tangent, or an invariant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    pub energy: f64,
    /// First Piola stress.
    pub stress: Tensor,
    pub tangent: Tensor4,
}

impl Response {
    pub(super) fn zero() -> Self {
        Response { energy: 0.0, stress: Tensor::zeros(), tangent: Tensor4::zeros() }
    }

    /// That of a material whose moduli are so many times larger.
    pub fn times(self, factor: f64) -> Self {
        Response { energy: self.energy * factor, stress: self.stress * factor, tangent: self.tangent * factor }
    }

    pub(super) fn plus(self, other: &Response) -> Self {
        Response {
            energy: self.energy + other.energy,
            stress: self.stress + other.stress,
            tangent: self.tangent + other.tangent,
        }
    }
}

pub(super) fn flat(m: &Matrix3<f64>) -> Tensor {
    Tensor::from_fn(|k, _| m[(k / 3, k % 3)])
}

/// A fourth-order tensor by its components `iJkL`.
pub(super) fn fourth(f: impl Fn(usize, usize, usize, usize) -> f64) -> Tensor4 {
    Tensor4::from_fn(|r, c| f(r / 3, r % 3, c / 3, c % 3))
}

pub(super) fn delta(i: usize, j: usize) -> f64 {
    f64::from(u8::from(i == j))
}
