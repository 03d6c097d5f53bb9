//! Arruda-Boyce, the first five terms of its series:
//! `V = μ Σ C_k/λm^(2k-2) (Ī1^k - 3^k)` (Arruda & Boyce, *J. Mech. Phys. Solids* 41 (1993) 389–412).

use super::invariants::{first, of_one};
use super::tensor::Response;
use nalgebra::Matrix3;

/// `C_1` to `C_5`: the series of the inverse Langevin function.
const SERIES: [f64; 5] = [1.0 / 2.0, 1.0 / 20.0, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673_750.0];

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArrudaBoyce {
    pub mu: f64,
    /// `λm`, at which chains are stretched out.
    pub locking_stretch: f64,
}

impl ArrudaBoyce {
    /// `V`, `V'`, `V''` at a value of `Ī1`.
    fn of_invariant(&self, x: f64) -> [f64; 3] {
        let mut out = [0.0; 3];
        for (k, c) in SERIES.iter().enumerate() {
            let n = k as i32 + 1;
            let (c, m) = (self.mu * c / self.locking_stretch.powi(2 * n - 2), f64::from(n));
            out[0] += c * (x.powi(n) - 3f64.powi(n));
            out[1] += c * m * x.powi(n - 1);
            out[2] += if n > 1 { c * m * (m - 1.0) * x.powi(n - 2) } else { 0.0 };
        }
        out
    }

    /// At rest: larger than `mu`.
    pub(super) fn shear_modulus(&self) -> f64 {
        2.0 * self.of_invariant(3.0)[1]
    }

    pub(super) fn energy(&self, f: &Matrix3<f64>) -> Response {
        let of = first(f);
        of_one(self.of_invariant(of.energy), &of)
    }
}
