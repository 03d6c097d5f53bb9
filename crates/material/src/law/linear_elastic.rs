//! Linear elasticity in the linear strain `ε`.

use super::tensor::{Response, Tensor4, delta, flat, fourth};
use nalgebra::Matrix3;

/// `V = μ ε:ε` with its derivatives.
pub(super) fn energy(mu: f64, f: &Matrix3<f64>) -> Response {
    let h = f - Matrix3::identity();
    let strain = (h + h.transpose()) * 0.5;
    Response {
        energy: mu * strain.norm_squared(),
        stress: flat(&(strain * (2.0 * mu))),
        tangent: fourth(|i, j, k, l| mu * (delta(i, k) * delta(j, l) + delta(i, l) * delta(j, k))),
    }
}

/// `φ = tr ε`.
pub(super) fn dilatation(f: &Matrix3<f64>) -> Response {
    Response { energy: f.trace() - 3.0, stress: flat(&Matrix3::identity()), tangent: Tensor4::zeros() }
}
