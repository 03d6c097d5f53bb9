//! Unit quaternions `q = (w, x, y, z)` as vectors of `R⁴`: rotations of cross-sections.
//!
//! A quaternion turns by the spatial spin `θ` as `q ← exp(θ/2) q`, so that `δq = G(q) θ` with `G = ½ [e_b q]`. Left
//! multiplication is linear in `R⁴`, which makes linear interpolation there, normalised afterwards, objective.

use nalgebra::{SMatrix, SVector};
use signorini_geometry::{Matrix, Vector};

/// A quaternion: the scalar part first.
pub type Quaternion = SVector<f64, 4>;

/// The quaternion of no rotation.
pub fn identity() -> Quaternion {
    Quaternion::new(1.0, 0.0, 0.0, 0.0)
}

/// The product `p q`: first the rotation `q`, then `p`.
pub fn product(p: &Quaternion, q: &Quaternion) -> Quaternion {
    Quaternion::new(
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    )
}

/// The conjugate, the inverse of a unit quaternion.
pub fn conjugate(q: &Quaternion) -> Quaternion {
    Quaternion::new(q[0], -q[1], -q[2], -q[3])
}

/// The vector part.
pub fn vector(q: &Quaternion) -> Vector<3> {
    Vector::<3>::new(q[1], q[2], q[3])
}

/// A vector as a quaternion without scalar part.
pub fn pure(v: &Vector<3>) -> Quaternion {
    Quaternion::new(0.0, v[0], v[1], v[2])
}

/// `exp(θ/2)`: the rotation about `θ` by the angle `|θ|`.
pub fn exponential(theta: &Vector<3>) -> Quaternion {
    let half = 0.5 * theta.norm();
    // sin(x)/x to round-off where the quotient itself loses digits.
    let factor = if half < 1e-4 { 0.5 * (1.0 - half * half / 6.0) } else { 0.5 * half.sin() / half };
    Quaternion::new(half.cos(), factor * theta[0], factor * theta[1], factor * theta[2])
}

/// The rotation vector of a unit quaternion, of length at most `π`.
pub fn logarithm(q: &Quaternion) -> Vector<3> {
    let q = if q[0] < 0.0 { -q } else { *q };
    let v = vector(&q);
    let sine = v.norm();
    let factor = if sine < 1e-8 { 2.0 } else { 2.0 * sine.atan2(q[0]) / sine };
    v * factor
}

/// `R(q)` of a quaternion of any length but zero; its columns are the axes of the section.
pub fn rotation(q: &Quaternion) -> Matrix<3> {
    let scale = 1.0 / q.norm_squared();
    let (w, v) = (q[0], vector(q));
    Matrix::<3>::from_fn(|i, j| {
        let unit = if i == j { w * w - v.norm_squared() } else { 0.0 };
        let cross = match (3 + j - i) % 3 {
            1 => -v[(j + 1) % 3],
            2 => v[(i + 1) % 3],
            _ => 0.0,
        };
        scale * (unit + 2.0 * (v[i] * v[j] + w * cross))
    })
}

/// The quaternion of a rotation matrix.
pub fn of_rotation(r: &Matrix<3>) -> Quaternion {
    // The largest of the four candidates is divided by: no loss of digits at any angle (Spurrier).
    let trace = r.trace();
    let largest = (0..3).max_by(|&i, &j| r[(i, i)].total_cmp(&r[(j, j)])).unwrap_or(0);
    let q = if trace >= r[(largest, largest)] {
        let w = 0.5 * (1.0 + trace).sqrt();
        let f = 0.25 / w;
        Quaternion::new(w, f * (r[(2, 1)] - r[(1, 2)]), f * (r[(0, 2)] - r[(2, 0)]), f * (r[(1, 0)] - r[(0, 1)]))
    } else {
        let (i, j, k) = (largest, (largest + 1) % 3, (largest + 2) % 3);
        let x = (0.5 * r[(i, i)] + 0.25 * (1.0 - trace)).sqrt();
        let f = 0.25 / x;
        let mut q = Quaternion::zeros();
        q[0] = f * (r[(k, j)] - r[(j, k)]);
        q[1 + i] = x;
        q[1 + j] = f * (r[(j, i)] + r[(i, j)]);
        q[1 + k] = f * (r[(k, i)] + r[(i, k)]);
        q
    };
    q / q.norm()
}

/// `G(q)`: the variation of a quaternion per spin.
pub fn spin_map(q: &Quaternion) -> SMatrix<f64, 4, 3> {
    let columns: [Quaternion; 3] = std::array::from_fn(|b| product(&pure(&axis(b)), q) * 0.5);
    SMatrix::from_columns(&columns)
}

/// `T⁻¹(φ)`: the variation of the rotation vector `φ` per spatial spin, for `|φ| < 2π`.
pub fn inverse_tangent_map(phi: &Vector<3>) -> Matrix<3> {
    let angle = phi.norm();
    let half = 0.5 * angle;
    // (1 - x cot x)/(4 x²) of the half angle x, by its series where digits are lost.
    let factor =
        if half < 1e-3 { (1.0 + half * half / 15.0) / 12.0 } else { (1.0 - half / half.tan()) / (angle * angle) };
    let skew = phi.cross_matrix();
    Matrix::<3>::identity() - skew * 0.5 + skew * skew * factor
}

/// Unit vector along a coordinate axis.
pub fn axis(k: usize) -> Vector<3> {
    Vector::<3>::from_fn(|i, _| if i == k { 1.0 } else { 0.0 })
}
