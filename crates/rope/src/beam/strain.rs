//! Strains of a beam whose rotation is an interpolated quaternion, with exact first and second derivatives.
//!
//! With `Q = Σ L_a q_a`, `P = dQ/ds`, `S = Q·Q`, `r' = dr/ds`, and constant matrices `Qᵀ D_ak Q = (Q e_a Q*)_k` (symmetric)
//! and `Qᵀ A_a P = vec(Q* P)_a`:
//!
//! - `Γ_a = r'_k Qᵀ D_ak Q / S` (axial and shear strains, less those of the reference),
//! - `κ_a = 2 Qᵀ A_a P / S` (twist and curvatures, in the axes of the section).
//!
//! Both are rational functions. The interpolation is linear in `R⁴`, hence objective and independent of the path
//! (compare Crisfield & Jelenić 1999; Simo 1985, Reissner 1981 for the strains).

use crate::quaternion::{self, Quaternion};
use nalgebra::{SMatrix, SVector};
use signorini_geometry::Vector;
use std::sync::LazyLock;

type Matrix4 = SMatrix<f64, 4, 4>;

struct Constants {
    d: [[Matrix4; 3]; 3],
    a: [Matrix4; 3],
}

static CONSTANTS: LazyLock<Constants> = LazyLock::new(|| {
    let unit = |i: usize| Quaternion::from_fn(|k, _| if k == i { 1.0 } else { 0.0 });
    let sandwich = |i: usize, a: usize, j: usize| {
        let left = quaternion::product(&unit(i), &quaternion::pure(&quaternion::axis(a)));
        quaternion::vector(&quaternion::product(&left, &quaternion::conjugate(&unit(j))))
    };
    Constants {
        d: std::array::from_fn(|a| {
            std::array::from_fn(|k| Matrix4::from_fn(|i, j| 0.5 * (sandwich(i, a, j)[k] + sandwich(j, a, i)[k])))
        }),
        a: std::array::from_fn(|a| {
            Matrix4::from_fn(|i, j| {
                quaternion::vector(&quaternion::product(&quaternion::conjugate(&unit(i)), &unit(j)))[a]
            })
        }),
    }
});

/// `Γ + e_1` at a point and its gradient in `(r', Q)`.
#[derive(Clone, Copy, Debug)]
pub struct ForceStrain {
    pub value: Vector<3>,
    pub gradient: [SVector<f64, 7>; 3],
}

/// Axial and shear strains, `e_1` included.
pub fn force_strain(r1: &Vector<3>, q: &Quaternion) -> ForceStrain {
    let s = q.norm_squared();
    let mut value = Vector::<3>::zeros();
    let gradient = std::array::from_fn(|a| {
        let d = &CONSTANTS.d[a];
        let mut g = SVector::<f64, 7>::zeros();
        let mut mq = Quaternion::zeros();
        for k in 0..3 {
            let dq = d[k] * q;
            g[k] = q.dot(&dq) / s;
            value[a] += r1[k] * g[k];
            mq += dq * r1[k];
        }
        g.fixed_rows_mut::<4>(3).copy_from(&((mq - q * value[a]) * (2.0 / s)));
        g
    });
    ForceStrain { value, gradient }
}

/// `Σ_a n_a ∂²Γ_a` in `(r', Q)`.
pub fn force_strain_hessian(r1: &Vector<3>, q: &Quaternion, n: &Vector<3>) -> SMatrix<f64, 7, 7> {
    let s = q.norm_squared();
    // The sum over the components is one quadratic form again.
    let mut m = Matrix4::zeros();
    let mut mixed: [Matrix4; 3] = [Matrix4::zeros(); 3];
    for a in 0..3 {
        for k in 0..3 {
            mixed[k] += CONSTANTS.d[a][k] * n[a];
        }
    }
    for k in 0..3 {
        m += mixed[k] * r1[k];
    }
    let mq = m * q;
    let f = q.dot(&mq);
    let cross = mq * q.transpose();
    let rotation =
        m * (2.0 / s) - (cross + cross.transpose()) * (4.0 / (s * s)) - Matrix4::identity() * (2.0 * f / (s * s))
            + q * q.transpose() * (8.0 * f / (s * s * s));
    let mut out = SMatrix::<f64, 7, 7>::zeros();
    out.fixed_view_mut::<4, 4>(3, 3).copy_from(&rotation);
    for k in 0..3 {
        let dq = mixed[k] * q;
        let column = (dq - q * (q.dot(&dq) / s)) * (2.0 / s);
        out.fixed_view_mut::<4, 1>(3, k).copy_from(&column);
        out.fixed_view_mut::<1, 4>(k, 3).copy_from(&column.transpose());
    }
    out
}

/// `κ` at a point and its gradient in `(Q, P)`.
#[derive(Clone, Copy, Debug)]
pub struct Curvature {
    pub value: Vector<3>,
    pub gradient: [SVector<f64, 8>; 3],
}

/// Twist and curvatures.
pub fn curvature(q: &Quaternion, p: &Quaternion) -> Curvature {
    let s = q.norm_squared();
    let mut value = Vector::<3>::zeros();
    let gradient = std::array::from_fn(|a| {
        let matrix = &CONSTANTS.a[a];
        let ap = matrix * p;
        value[a] = 2.0 * q.dot(&ap) / s;
        let mut g = SVector::<f64, 8>::zeros();
        g.fixed_rows_mut::<4>(0).copy_from(&((ap - q * value[a]) * (2.0 / s)));
        g.fixed_rows_mut::<4>(4).copy_from(&(matrix.transpose() * q * (2.0 / s)));
        g
    });
    Curvature { value, gradient }
}

/// `Σ_a m_a ∂²κ_a` in `(Q, P)`.
pub fn curvature_hessian(q: &Quaternion, p: &Quaternion, m: &Vector<3>) -> SMatrix<f64, 8, 8> {
    let s = q.norm_squared();
    let a = CONSTANTS.a[0] * m[0] + CONSTANTS.a[1] * m[1] + CONSTANTS.a[2] * m[2];
    let ap = a * p;
    let aq = a.transpose() * q;
    let h = q.dot(&ap);
    let cross = ap * q.transpose();
    let qq = (cross + cross.transpose()) * (-4.0 / (s * s)) - Matrix4::identity() * (4.0 * h / (s * s))
        + q * q.transpose() * (16.0 * h / (s * s * s));
    let qp = a * (2.0 / s) - q * aq.transpose() * (4.0 / (s * s));
    let mut out = SMatrix::<f64, 8, 8>::zeros();
    out.fixed_view_mut::<4, 4>(0, 0).copy_from(&qq);
    out.fixed_view_mut::<4, 4>(0, 4).copy_from(&qp);
    out.fixed_view_mut::<4, 4>(4, 0).copy_from(&qp.transpose());
    out
}
