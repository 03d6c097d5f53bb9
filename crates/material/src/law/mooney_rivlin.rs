//! Mooney-Rivlin: `V = c10 (Ī1 - 3) + c01 (Ī2 - 3)` (Mooney 1940, Rivlin 1948).

use super::invariants::{first, of_one, second};
use super::tensor::Response;
use nalgebra::Matrix3;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MooneyRivlin {
    pub c10: f64,
    pub c01: f64,
}

impl MooneyRivlin {
    pub(super) fn shear_modulus(&self) -> f64 {
        2.0 * (self.c10 + self.c01)
    }

    pub(super) fn energy(&self, f: &Matrix3<f64>) -> Response {
        let of_first = first(f);
        let mut out = of_one([self.c10 * (of_first.energy - 3.0), self.c10, 0.0], &of_first);
        if self.c01 != 0.0 {
            let of_second = second(f);
            out = out.plus(&of_one([self.c01 * (of_second.energy - 3.0), self.c01, 0.0], &of_second));
        }
        out
    }
}
