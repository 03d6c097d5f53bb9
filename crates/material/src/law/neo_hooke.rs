//! Neo-Hooke: `V = μ/2 (I1 - 3 - 2 ln J)`.

use super::tensor::{Response, delta, flat, fourth};
use nalgebra::Matrix3;

/// `V` with its derivatives.
pub(super) fn energy(mu: f64, f: &Matrix3<f64>) -> Response {
    let inverse = f.try_inverse().unwrap_or_else(Matrix3::zeros);
    Response {
        energy: 0.5 * mu * (f.norm_squared() - 3.0 - 2.0 * f.determinant().ln()),
        stress: flat(&((f - inverse.transpose()) * mu)),
        tangent: fourth(|i, j, k, l| mu * (delta(i, k) * delta(j, l) + inverse[(j, k)] * inverse[(l, i)])),
    }
}
