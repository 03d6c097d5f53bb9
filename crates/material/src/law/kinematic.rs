//! Kinematic hardening at finite strain.
//!
//! `F = F_e F_p`, and `A = F_p⁻¹`. Energies are quadratic in logarithms: of the elastic stretch, and of the left plastic stretch
//! `V_p`, from which the back stress `X = 2/3 H_k ln V_p` follows. In principal axes that stay this is Prager's rule for
//! Kirchhoff stress and logarithmic strain; as `X` is a function of the state, shear does not make it oscillate. With
//! `C = (F A)ᵀ F A` of the trial and an increment `A ← A exp(-Y)`, `Y` symmetric with `tr Y = 0`,
//!
//! ```text
//! Φ(Y) = μ ‖dev h(C)‖² + H_k/3 ‖h(AᵀA)‖² + ∫ σ_y dα,    h(M) = ln(e^-Y M e^-Y)/2,    Δα = sqrt(2/3) ‖Y‖
//! ```
//!
//! is stationary (Ortiz & Stainier, *Comput. Methods Appl. Mech. Engrg.* 171 (1999) 419–444; the energy of the plastic stretch as
//! Lion, *Int. J. Plasticity* 16 (2000) 469–494, without recovery). The axes of `C`, `AᵀA` and `Y` differ, so that `Y` is found
//! by Newton's method in five coordinates. The stress is the derivative of `Φ` in `F`, the tangent that of the algorithm.

use super::elastic_plastic::deviator;
use super::hardening::Hardening;
use super::spectral::{Scalar, Spectral};
use super::tensor::{Response, Tensor4, flat};
use nalgebra::{Matrix3, SMatrix, SVector};

type Flow = SVector<f64, 5>;
type FlowMatrix = SMatrix<f64, 5, 5>;

/// `sqrt(2/3)`.
const SHARE: f64 = 0.816_496_580_927_726;
/// Iterations for the plastic increment, halvings of a step, and the part of the yield stress that is left in the end.
const MOST_ITERATIONS: usize = 50;
const MOST_HALVINGS: usize = 30;
const TOLERANCE: f64 = 1e-13;
/// The same where rounding allows no less.
const ROUNDING: f64 = 1e-10;

/// Constants, and what the increment starts from.
pub(super) struct Increment<'a> {
    pub mu: f64,
    pub kinematic: f64,
    pub hardening: &'a Hardening,
    pub alpha: f64,
    pub a: Matrix3<f64>,
}

/// A point after the increment.
pub(super) struct Found {
    /// In the trial `F A`.
    pub response: Response,
    pub alpha: f64,
    pub a: Matrix3<f64>,
}

/// Symmetric tensors without trace, of norm 1 and normal to each other.
fn basis() -> [Matrix3<f64>; 5] {
    let (root2, root6) = (0.5f64.sqrt(), (1.0f64 / 6.0).sqrt());
    let pair = |i: usize, j: usize| {
        let mut m = Matrix3::zeros();
        (m[(i, j)], m[(j, i)]) = (root2, root2);
        m
    };
    [
        Matrix3::from_diagonal(&[root2, -root2, 0.0].into()),
        Matrix3::from_diagonal(&[root6, root6, -2.0 * root6].into()),
        pair(0, 1),
        pair(1, 2),
        pair(0, 2),
    ]
}

/// `G = e^-Y` with its derivatives in the coordinates of `Y`.
struct Shrink {
    g: Matrix3<f64>,
    first: [Matrix3<f64>; 5],
    second: [[Matrix3<f64>; 5]; 5],
}

impl Shrink {
    fn new(y: &Flow, basis: &[Matrix3<f64>; 5]) -> Self {
        let whole: Matrix3<f64> = (0..5).map(|i| basis[i] * y[i]).sum();
        let of = Spectral::new(Scalar::FallingExponential, &whole);
        let second = std::array::from_fn(|i| std::array::from_fn(|j| of.second(&basis[i], &basis[j])));
        Shrink { g: of.value, first: std::array::from_fn(|i| of.first(&basis[i])), second }
    }
}

/// The energy `m/2 ‖dev ln(G M G)/2‖²` as a function of `C' = G M G`.
struct Energy {
    modulus: f64,
    logarithm: Spectral,
    /// The stress `m dev h`, and the derivative in `C'`.
    stress: Matrix3<f64>,
    slope: Matrix3<f64>,
}

impl Energy {
    fn new(modulus: f64, at: &Matrix3<f64>) -> Self {
        let logarithm = Spectral::new(Scalar::HalfLogarithm, at);
        let stress = deviator(&logarithm.value) * modulus;
        let slope = logarithm.first(&stress);
        Energy { modulus, logarithm, stress, slope }
    }

    fn value(&self) -> f64 {
        0.5 * self.stress.norm_squared() / self.modulus
    }

    /// The change of the derivative along a change of `C'`.
    fn bend(&self, along: &Matrix3<f64>) -> Matrix3<f64> {
        let stress = deviator(&self.logarithm.first(along)) * self.modulus;
        self.logarithm.first(&stress) + self.logarithm.second(&self.stress, along)
    }
}

/// A part of the energy in the flow: its derivatives there, and what couples it with `M`.
struct Part {
    energy: Energy,
    gradient: Flow,
    hessian: FlowMatrix,
    /// The derivative in `M` of the gradient.
    mixed: [Matrix3<f64>; 5],
}

fn part(modulus: f64, m: &Matrix3<f64>, by: &Shrink) -> Part {
    let g = &by.g;
    let energy = Energy::new(modulus, &symmetric(&(g * m * g)));
    let moved: [Matrix3<f64>; 5] = std::array::from_fn(|i| {
        let half = by.first[i] * m * g;
        half + half.transpose()
    });
    let bent: [Matrix3<f64>; 5] = std::array::from_fn(|i| energy.bend(&moved[i]));
    let s = &energy.slope;
    let gradient = Flow::from_fn(|i, _| s.dot(&moved[i]));
    let hessian = FlowMatrix::from_fn(|i, j| {
        let twice = by.second[i][j] * m * g + by.first[i] * m * by.first[j];
        bent[i].dot(&moved[j]) + 2.0 * s.dot(&twice)
    });
    let mixed = std::array::from_fn(|i| {
        let half = by.first[i] * s * g;
        half + half.transpose() + g * bent[i] * g
    });
    Part { energy, gradient, hessian, mixed }
}

fn symmetric(m: &Matrix3<f64>) -> Matrix3<f64> {
    (m + m.transpose()) * 0.5
}

impl Increment<'_> {
    /// The point at a trial `F A`; not a number where the increment has no solution.
    pub(super) fn solve(&self, trial: &Matrix3<f64>) -> Found {
        let basis = basis();
        let c = trial.transpose() * trial;
        let own = self.a.transpose() * self.a;
        let moduli = [2.0 * self.mu, 2.0 / 3.0 * self.kinematic];
        let parts = |by: &Shrink| [part(moduli[0], &c, by), part(moduli[1], &own, by)];
        let mut y = Flow::zeros();
        let mut by = Shrink::new(&y, &basis);
        let mut at = parts(&by);
        let drive = at[0].gradient + at[1].gradient;
        let over = SHARE.recip() * drive.norm() - self.hardening.stress(self.alpha);
        let mut inverse = None;
        if over.is_nan() || over > 0.0 {
            let stiffness = 3.0 * self.mu + self.kinematic;
            let [start, _] = self.hardening.increment(SHARE.recip() * drive.norm(), stiffness, self.alpha);
            y = drive * (-start / SHARE / drive.norm());
            let scale = self.hardening.stress(self.alpha);
            let lacks = |at: &[Part; 2], y: &Flow| -> (Flow, FlowMatrix) {
                let norm = y.norm();
                let [alpha, n] = [self.alpha + SHARE * norm, 1.0 / norm];
                let (stress, slope) = self.hardening.at(alpha);
                let along = y * n;
                let gradient = at[0].gradient + at[1].gradient + along * (SHARE * stress);
                let across = FlowMatrix::identity() - along * along.transpose();
                let own = across * (SHARE * stress * n) + along * along.transpose() * (SHARE * SHARE * slope);
                (gradient, at[0].hessian + at[1].hessian + own)
            };
            by = Shrink::new(&y, &basis);
            at = parts(&by);
            let (mut gradient, mut hessian) = lacks(&at, &y);
            for _ in 0..MOST_ITERATIONS {
                if gradient.norm() <= TOLERANCE * scale {
                    break;
                }
                let Some(step) = hessian.lu().solve(&gradient) else { break };
                let mut share = 1.0;
                let before = gradient.norm();
                let mut is_better = false;
                for _ in 0..MOST_HALVINGS {
                    let next = y - step * share;
                    let next_by = Shrink::new(&next, &basis);
                    let next_at = parts(&next_by);
                    let (g, h) = lacks(&next_at, &next);
                    if g.norm() < before {
                        (y, by, at, gradient, hessian, is_better) = (next, next_by, next_at, g, h, true);
                        break;
                    }
                    share *= 0.5;
                }
                if !is_better {
                    break;
                }
            }
            if gradient.norm() > ROUNDING * scale || gradient.norm().is_nan() {
                y = Flow::repeat(f64::NAN);
            }
            inverse = hessian.try_inverse();
        }
        let [elastic, plastic] = &at;
        let g = &by.g;
        let slope = g * elastic.energy.slope * g;
        let bend = |along: &Matrix3<f64>| {
            let mut out = g * elastic.energy.bend(&(g * along * g)) * g;
            if let Some(inverse) = &inverse {
                let driven = inverse * Flow::from_fn(|i, _| elastic.mixed[i].dot(along));
                (0..5).for_each(|i| out -= elastic.mixed[i] * driven[i]);
            }
            out
        };
        let mut tangent = Tensor4::zeros();
        for k in 0..9 {
            let mut moved = Matrix3::zeros();
            moved[(k / 3, k % 3)] = 1.0;
            let half = moved.transpose() * trial;
            let change = moved * slope + trial * bend(&(half + half.transpose()));
            tangent.set_column(k, &(flat(&change) * 2.0));
        }
        let lost = y.sum() * 0.0;
        let stress = flat(&(trial * slope * 2.0)).add_scalar(lost);
        let energy = elastic.energy.value() + plastic.energy.value() + lost;
        // The volume is kept but for rounding, which would add up.
        let renewed = if inverse.is_some() { self.a * (g / g.determinant().cbrt()) } else { self.a };
        let alpha = self.alpha + SHARE * y.norm();
        Found { response: Response { energy, stress, tangent }, alpha, a: renewed }
    }
}
