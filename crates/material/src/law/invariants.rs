//! Invariants without the change of volume, and energies of them.
//!
//! With `C = FᵀF`, `J = det F` and a unit vector `a` of the undeformed body
//!
//! | symbol | is |
//! |---|---|
//! | `Ī1` | `J^(-2/3) tr C` |
//! | `Ī2` | `J^(-4/3) (tr² C - C:C)/2` |
//! | `Ī4` | `J^(-2/3) a·C a`, the square of the stretch along `a` |

use super::tensor::{Response, Tensor4, delta, flat, fourth};
use nalgebra::{Matrix3, Vector3};

/// `J^n I` of an invariant `I`, by the product rule; `∂J^n/∂F = n J^n G` with `G = F^(-T)`.
fn scaled(f: &Matrix3<f64>, n: f64, of: &Response) -> Response {
    let inverse = f.try_inverse().unwrap_or_else(Matrix3::zeros);
    let g = flat(&inverse.transpose());
    let factor = f.determinant().powf(n);
    let value = of.energy;
    let mixed = of.stress * g.transpose();
    let turned = fourth(|i, j, k, l| inverse[(j, k)] * inverse[(l, i)]);
    Response {
        energy: factor * value,
        stress: (of.stress + g * (n * value)) * factor,
        tangent: (of.tangent + (mixed + mixed.transpose()) * n + g * g.transpose() * (n * n * value)
            - turned * (n * value))
            * factor,
    }
}

/// `Ī1` and its derivatives.
pub(super) fn first(f: &Matrix3<f64>) -> Response {
    let plain = Response { energy: f.norm_squared(), stress: flat(&(f * 2.0)), tangent: Tensor4::identity() * 2.0 };
    scaled(f, -2.0 / 3.0, &plain)
}

/// `Ī2` and its derivatives.
pub(super) fn second(f: &Matrix3<f64>) -> Response {
    let (right, left) = (f.transpose() * f, f * f.transpose());
    let trace = right.trace();
    let plain = Response {
        energy: 0.5 * (trace * trace - right.norm_squared()),
        stress: flat(&((f * trace - f * right) * 2.0)),
        tangent: fourth(|i, j, k, l| {
            2.0 * (2.0 * f[(i, j)] * f[(k, l)] + delta(i, k) * (trace * delta(j, l) - right[(l, j)])
                - f[(i, l)] * f[(k, j)]
                - left[(i, k)] * delta(j, l))
        }),
    };
    scaled(f, -4.0 / 3.0, &plain)
}

/// `Ī4` along a unit vector, and its derivatives.
pub(super) fn along(f: &Matrix3<f64>, a: &Vector3<f64>) -> Response {
    let moved = f * a;
    let plain = Response {
        energy: moved.norm_squared(),
        stress: flat(&(moved * a.transpose() * 2.0)),
        tangent: fourth(|i, j, k, l| 2.0 * delta(i, k) * a[j] * a[l]),
    };
    scaled(f, -2.0 / 3.0, &plain)
}

/// An energy of one invariant: its value, first and second derivative in the invariant.
pub(super) fn of_one([value, slope, second]: [f64; 3], of: &Response) -> Response {
    Response {
        energy: value,
        stress: of.stress * slope,
        tangent: of.tangent * slope + of.stress * of.stress.transpose() * second,
    }
}
