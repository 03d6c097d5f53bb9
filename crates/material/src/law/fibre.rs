//! Fibres along one direction: `V = F(λ̄)` of the stretch `λ̄ = sqrt(Ī4)` along them (Weiss, Maker & Govindjee,
//! *Comput. Methods Appl. Mech. Engrg.* 135 (1996) 107–128; FEBio's transversely isotropic Mooney-Rivlin).
//!
//! ```text
//! λ̄ F'(λ̄) = 0                              λ̄ ≤ 1
//!          = c3 (exp(c4 (λ̄ - 1)) - 1)      1 < λ̄ < λm
//!          = c5 λ̄ + c6                     λ̄ ≥ λm,   c6 = c3 (exp(c4 (λm - 1)) - 1) - c5 λm
//! ```
//!
//! Compressed fibres carry nothing; the stress is continuous at `λm`, its derivative is not.

use super::invariants::{along, of_one};
use super::tensor::Response;
use nalgebra::{Matrix3, Vector3};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fibre {
    /// Unit vector before the body deforms.
    pub direction: Vector3<f64>,
    /// A stress.
    pub c3: f64,
    pub c4: f64,
    /// A stress: the modulus of straightened fibres.
    pub c5: f64,
    /// `λm`, at which fibres are straight.
    pub stretch: f64,
}

impl Fibre {
    pub(super) fn energy(&self, f: &Matrix3<f64>) -> Response {
        let of = along(f, &self.direction);
        if of.energy <= 1.0 {
            return Response::zero();
        }
        let stretch = of.energy.sqrt();
        let [force, change] = self.force(stretch);
        // dλ̄/dĪ4 = 1/(2 λ̄).
        let slope = force / (2.0 * of.energy);
        let second = (change / (2.0 * stretch) - 2.0 * slope) / (2.0 * of.energy);
        of_one([self.stored(stretch), slope, second], &of)
    }

    /// `λ̄ F'` and its derivative, above 1.
    fn force(&self, stretch: f64) -> [f64; 2] {
        let curled = |s: f64| self.c3 * (self.c4 * (s - 1.0)).exp_m1();
        if stretch < self.stretch {
            return [curled(stretch), self.c3 * self.c4 * (self.c4 * (stretch - 1.0)).exp()];
        }
        [curled(self.stretch) + self.c5 * (stretch - self.stretch), self.c5]
    }

    /// `F(λ̄) = ∫ (λ F')/λ dλ`: no elementary function of curled fibres, and integrated by Gauss's rule.
    fn stored(&self, stretch: f64) -> f64 {
        let end = stretch.min(self.stretch);
        // Pieces over which the exponential grows by no more than e.
        let pieces = (self.c4.abs() * (end - 1.0)).ceil().clamp(1.0, 200.0) as usize;
        let half = 0.5 * (end - 1.0) / pieces as f64;
        let mut out = 0.0;
        for piece in 0..pieces {
            let middle = 1.0 + half * (2 * piece + 1) as f64;
            for [x, w] in GAUSS {
                for s in [middle - half * x, middle + half * x] {
                    out += w * half * self.c3 * (self.c4 * (s - 1.0)).exp_m1() / s;
                }
            }
        }
        if stretch > self.stretch {
            let straight = self.force(self.stretch)[0] - self.c5 * self.stretch;
            out += self.c5 * (stretch - self.stretch) + straight * (stretch / self.stretch).ln();
        }
        out
    }
}

/// Gauss's rule with eight points on (-1, 1): the positive points and their weights.
const GAUSS: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_48],
    [0.960_289_856_497_536_3, 0.101_228_536_290_376_26],
];
