//! Yeoh: `V = Σ c_k (Ī1 - 3)^k`, `k = 1..3` (Yeoh, *Rubber Chem. Technol.* 66 (1993) 754–771).

use super::invariants::{first, of_one};
use super::tensor::Response;
use nalgebra::Matrix3;

/// `c10`, `c20`, `c30`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Yeoh(pub [f64; 3]);

impl Yeoh {
    pub(super) fn shear_modulus(&self) -> f64 {
        2.0 * self.0[0]
    }

    pub(super) fn energy(&self, f: &Matrix3<f64>) -> Response {
        let [c1, c2, c3] = self.0;
        let of = first(f);
        let x = of.energy - 3.0;
        of_one([x * (c1 + x * (c2 + x * c3)), c1 + x * (2.0 * c2 + 3.0 * c3 * x), 2.0 * c2 + 6.0 * c3 * x], &of)
    }
}
