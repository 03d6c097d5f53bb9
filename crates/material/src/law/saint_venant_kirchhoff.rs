//! Saint-Venant–Kirchhoff: quadratic in the Green-Lagrange strain.

use super::tensor::{Response, delta, flat, fourth};
use nalgebra::Matrix3;

/// `V = μ E:E` with its derivatives.
pub(super) fn energy(mu: f64, f: &Matrix3<f64>) -> Response {
    let strain = (f.transpose() * f - Matrix3::identity()) * 0.5;
    let s = strain * (2.0 * mu);
    let left = f * f.transpose();
    Response {
        energy: mu * strain.norm_squared(),
        stress: flat(&(f * s)),
        tangent: fourth(|i, j, k, l| {
            delta(i, k) * s[(j, l)] + mu * (left[(i, k)] * delta(j, l) + f[(i, l)] * f[(k, j)])
        }),
    }
}

/// `φ = tr E`.
pub(super) fn dilatation(f: &Matrix3<f64>) -> Response {
    Response {
        energy: 0.5 * (f.norm_squared() - 3.0),
        stress: flat(f),
        tangent: fourth(|i, j, k, l| delta(i, k) * delta(j, l)),
    }
}
