//! Isotropic energies by the logarithms of the principal stretches.
//!
//! | symbol | is |
//! |---|---|
//! | `c_a`, `N_a` | eigenvalues and eigenvectors of `C = FᵀF` |
//! | `h_a` | `ln λ_a = ln c_a / 2` |
//! | `τ_a` | `∂W/∂h_a`, principal Kirchhoff stress |
//! | `D_ab` | `∂τ_a/∂h_b` |
//! | `s_ab` | `(τ_a - τ_b)/(h_a - h_b)` |
//! | `S_a` | `τ_a/c_a`, principal second Piola stress |
//! | `f_a` | `F N_a` |
//!
//! `δS_ab = Q_ab δC_ab` for `a ≠ b` with `Q_ab = (S_a - S_b)/(c_a - c_b)`, which for equal stretches is 0/0 (Ogden,
//! *Non-linear elastic deformations*, 1984, sect. 6.1). No difference of stresses is formed:
//!
//! ```text
//! Q_ab = s_ab l_ab (1/c_a + 1/c_b)/2 - (τ_a + τ_b)/(2 c_a c_b),    l_ab = (h_a - h_b)/(c_a - c_b)
//! ```
//!
//! with `l_ab = ln(1 + x)/(2 c_b x)`, `x = (c_a - c_b)/c_b`, which loses no digits however small `x` is; a law gives `s_ab` in
//! such a form too. Eigenvectors of nearly equal stretches are arbitrary, the result is not: the coefficients of all of them
//! agree.

use super::tensor::{Response, Tensor, Tensor4, delta, flat};
use nalgebra::{Matrix3, Vector3};

/// An energy at three logarithms of stretches, with its derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Principal {
    pub energy: f64,
    /// `τ_a`.
    pub stress: [f64; 3],
    /// `D_ab`.
    pub tangent: [[f64; 3]; 3],
    /// `s_ab`; that of `a = b` is not read.
    pub secant: [[f64; 3]; 3],
}

/// Principal stretches: their logarithms, squares and directions (as columns).
pub(super) struct Stretches {
    pub logarithms: [f64; 3],
    squares: [f64; 3],
    pub directions: Matrix3<f64>,
}

/// The principal stretches of a deformation gradient.
pub(super) fn stretches(f: &Matrix3<f64>) -> Stretches {
    let found = (f.transpose() * f).symmetric_eigen();
    let squares: [f64; 3] = std::array::from_fn(|a| found.eigenvalues[a]);
    Stretches { logarithms: squares.map(|c| 0.5 * c.ln()), squares, directions: found.eigenvectors }
}

/// `(e^(αa) - e^(αb))/(a - b)`.
pub(super) fn secant_of_exponentials(alpha: f64, a: f64, b: f64) -> f64 {
    let between = a - b;
    let quotient = if between == 0.0 { alpha } else { (alpha * between).exp_m1() / between };
    (alpha * b).exp() * quotient
}

/// The energy as a function of `F`.
pub(super) fn response(f: &Matrix3<f64>, law: impl FnOnce([f64; 3]) -> Principal) -> Response {
    let at = stretches(f);
    let of = law(at.logarithms);
    let (c, n) = (&at.squares, &at.directions);
    let second: Matrix3<f64> = (0..3).map(|a| n.column(a) * n.column(a).transpose() * (of.stress[a] / c[a])).sum();
    let moved: [Vector3<f64>; 3] = std::array::from_fn(|a| f * n.column(a));
    // `f_a N_b`.
    let m: [[Tensor; 3]; 3] =
        std::array::from_fn(|a| std::array::from_fn(|b| flat(&(moved[a] * n.column(b).transpose()))));
    let mut tangent = Tensor4::from_fn(|r, s| delta(r / 3, s / 3) * second[(r % 3, s % 3)]);
    for a in 0..3 {
        for b in 0..3 {
            let diagonal = (0.5 * of.tangent[a][b] - delta(a, b) * of.stress[a]) / (c[a] * c[b]);
            tangent += m[a][a] * m[b][b].transpose() * (2.0 * diagonal);
            if a != b {
                let x = (c[a] - c[b]) / c[b];
                let logarithm = if x == 0.0 { 0.5 / c[b] } else { 0.5 * x.ln_1p() / (x * c[b]) };
                let q = 0.5 * of.secant[a][b] * logarithm * (1.0 / c[a] + 1.0 / c[b])
                    - 0.5 * (of.stress[a] + of.stress[b]) / (c[a] * c[b]);
                tangent += m[a][b] * (m[b][a] + m[a][b]).transpose() * q;
            }
        }
    }
    Response { energy: of.energy, stress: flat(&(f * second)), tangent }
}
