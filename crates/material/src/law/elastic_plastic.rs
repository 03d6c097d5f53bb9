//! Plasticity of von Mises with associated flow, isotropic and kinematic hardening.
//!
//! | symbol | is |
//! |---|---|
//! | `ε`, `ε_p` | strain and plastic strain, `tr ε_p = 0` |
//! | `s = 2 μ (dev ε - ε_p)` | deviator of the stress |
//! | `X = 2/3 H_k ε_p` | back stress (Prager) |
//! | `ξ = s - X`, `n = ξ/‖ξ‖`, `q = sqrt(3/2) ‖ξ‖` | |
//! | `α` | equivalent plastic strain, `δα = sqrt(2/3) ‖δε_p‖` |
//! | `q ≤ σ_y(α)` | condition of yield |
//!
//! Backward Euler is the radial return (Simo & Hughes, *Computational inelasticity*, 1998, ch. 3): `n` is that of the trial with
//! `ε_p` of the last state, and `q_trial - (3 μ + H_k) Δα = σ_y(α + Δα)` is solved exactly for a polygon `σ_y`. The tangent is
//! that of the algorithm,
//!
//! ```text
//! ∂s/∂ε = 2 μ (P - 3 μ Δα/q (P - n⊗n) - 3 μ/(3 μ + H_k + σ_y') n⊗n),    P = dev
//! ```
//!
//! **At finite strain** `F = F_e F_p`, and the same law holds for the logarithms of the principal elastic stretches and the
//! Kirchhoff stress (Simo, *Comput. Methods Appl. Mech. Engrg.* 99 (1992) 61–112). With `A = F_p⁻¹` the trial is `F A`, and
//! `A ← A exp(-sqrt(3/2) Δα n)`, which keeps the volume. Any rotation of the intermediate configuration gives the same stress.
//!
//! Kinematic hardening at finite strain needs a return of tensors: see `kinematic`.
//!
//! Stored is `μ ‖s/2μ‖² + H_k/3 ‖ε_p‖²`; dissipated is `∫ σ_y dα`, that is `(s - X):δε_p`.

use super::hardening::Hardening;
use super::kinematic::Increment;
use super::principal::{Principal, response, stretches};
use super::tensor::{Response, Tensor4, delta, flat, fourth};
use nalgebra::{Matrix3, Vector3};

/// The constants of plasticity; those of elasticity stand aside.
#[derive(Clone, Debug, PartialEq)]
pub struct ElasticPlastic {
    pub hardening: Hardening,
    /// `H_k`.
    pub kinematic: f64,
    pub is_finite: bool,
}

/// A point after an increment.
#[derive(Clone, Debug, PartialEq)]
pub struct Plastic {
    pub response: Response,
    /// What the next increment starts from, as that of [`ElasticPlastic::start`].
    pub history: Vec<f64>,
    /// Energy per volume that the increment dissipated.
    pub dissipated: f64,
}

/// `sqrt(3/2)`.
const ROOT: f64 = 1.224_744_871_391_589;

/// The increment at a trial.
struct Return {
    increment: f64,
    /// `1 - 3 μ Δα/q`, by which elastic deviators shrink.
    factor: f64,
    /// What stands before `n⊗n` in `∂s/∂ε`, over `2 μ`.
    along: f64,
}

impl ElasticPlastic {
    /// The history at the start: `α`, then the six components of `ε_p` (xx, yy, zz, xy, yz, xz), or the nine of `A`.
    pub fn start(&self) -> Vec<f64> {
        match self.is_finite {
            true => [vec![0.0], flat(&Matrix3::identity()).as_slice().to_vec()].concat(),
            false => vec![0.0; 7],
        }
    }

    /// The point after an increment from a history to a deformation gradient.
    pub fn point(&self, mu: f64, f: &Matrix3<f64>, history: &[f64]) -> Plastic {
        if self.is_finite { self.finite(mu, f, history) } else { self.small(mu, f, history) }
    }

    fn small(&self, mu: f64, f: &Matrix3<f64>, history: &[f64]) -> Plastic {
        let h = f - Matrix3::identity();
        let strain = deviator(&((h + h.transpose()) * 0.5));
        let alpha = history[0];
        let mut plastic = symmetric(&history[1..7]);
        let back = 2.0 / 3.0 * self.kinematic;
        let trial = (strain - plastic) * (2.0 * mu) - plastic * back;
        let q = ROOT * trial.norm();
        let found = self.solve(mu, q, alpha);
        let mut tangent = fourth(|i, j, k, l| {
            let symmetric = 0.5 * (delta(i, k) * delta(j, l) + delta(i, l) * delta(j, k));
            2.0 * mu * found.factor * (symmetric - delta(i, j) * delta(k, l) / 3.0)
        });
        if found.increment > 0.0 {
            let n = trial / trial.norm();
            plastic += n * (ROOT * found.increment);
            tangent += flat(&n) * flat(&n).transpose() * (2.0 * mu * found.along);
        }
        let elastic = strain - plastic;
        let energy = mu * elastic.norm_squared() + 0.5 * back * plastic.norm_squared();
        let mut history = vec![alpha + found.increment];
        history.extend(components(&plastic));
        let response = Response { energy, stress: flat(&(elastic * (2.0 * mu))), tangent };
        Plastic { response, dissipated: self.hardening.dissipated(alpha, history[0]), history }
    }

    fn finite(&self, mu: f64, f: &Matrix3<f64>, history: &[f64]) -> Plastic {
        let alpha = history[0];
        let a = Matrix3::from_fn(|i, j| history[1 + 3 * i + j]);
        let trial = f * a;
        if self.kinematic > 0.0 {
            let start = Increment { mu, kinematic: self.kinematic, hardening: &self.hardening, alpha, a };
            let found = start.solve(&trial);
            let history = [&[found.alpha], flat(&found.a).as_slice()].concat();
            let dissipated = self.hardening.dissipated(alpha, found.alpha);
            return Plastic { response: of_trial(&found.response, &a), history, dissipated };
        }
        let mut flow = [0.0; 3];
        let mut increment = 0.0;
        let found = response(&trial, |h| {
            let mean = (h[0] + h[1] + h[2]) / 3.0;
            let s = h.map(|h| 2.0 * mu * (h - mean));
            let norm = s.iter().map(|s| s * s).sum::<f64>().sqrt();
            let found = self.solve(mu, ROOT * norm, alpha);
            increment = found.increment;
            let n = if increment > 0.0 { s.map(|s| s / norm) } else { [0.0; 3] };
            flow = n.map(|n| ROOT * increment * n);
            let tangent = std::array::from_fn(|a| {
                std::array::from_fn(|b| {
                    2.0 * mu * (found.factor * (delta(a, b) - 1.0 / 3.0) + found.along * n[a] * n[b])
                })
            });
            let stress = s.map(|s| found.factor * s);
            let energy = stress.iter().map(|t| t * t).sum::<f64>() / (4.0 * mu);
            Principal { energy, stress, tangent, secant: [[2.0 * mu * found.factor; 3]; 3] }
        });
        let response = of_trial(&found, &a);
        let mut renewed = a;
        if increment > 0.0 {
            let directions = stretches(&trial).directions;
            let shrink = Matrix3::from_diagonal(&Vector3::from(flow.map(|f| (-f).exp())));
            renewed = a * directions * shrink * directions.transpose();
        }
        let mut history = vec![alpha + increment];
        history.extend_from_slice(flat(&renewed).as_slice());
        Plastic { response, dissipated: self.hardening.dissipated(alpha, history[0]), history }
    }

    /// The increment of equivalent plastic strain at a trial.
    fn solve(&self, mu: f64, q: f64, alpha: f64) -> Return {
        if q <= self.hardening.stress(alpha) {
            return Return { increment: 0.0, factor: 1.0, along: 0.0 };
        }
        let stiffness = 3.0 * mu + self.kinematic;
        let [increment, slope] = self.hardening.increment(q, stiffness, alpha);
        let shrunk = 3.0 * mu * increment / q;
        Return { increment, factor: 1.0 - shrunk, along: shrunk - 3.0 * mu / (stiffness + slope) }
    }
}

/// From a response in `F A` to that in `F`: `δ(F A) = δF A`.
fn of_trial(found: &Response, a: &Matrix3<f64>) -> Response {
    let turn: Tensor4 = Matrix3::identity().kronecker(&a.transpose());
    let (stress, tangent) = (turn.transpose() * found.stress, turn.transpose() * found.tangent * turn);
    Response { energy: found.energy, stress, tangent }
}

pub(super) fn deviator(m: &Matrix3<f64>) -> Matrix3<f64> {
    m - Matrix3::identity() * (m.trace() / 3.0)
}

fn symmetric(v: &[f64]) -> Matrix3<f64> {
    Matrix3::new(v[0], v[3], v[5], v[3], v[1], v[4], v[5], v[4], v[2])
}

fn components(m: &Matrix3<f64>) -> [f64; 6] {
    [m[(0, 0)], m[(1, 1)], m[(2, 2)], m[(0, 1)], m[(1, 2)], m[(0, 2)]]
}
