//! Ogden: `V = Σ 2 μ_i/α_i² (λ̄1^α_i + λ̄2^α_i + λ̄3^α_i - 3)` with `λ̄ = J^(-1/3) λ`
//! (Ogden, *Proc. R. Soc. Lond. A* 326 (1972) 565–584; the factors are those of Abaqus. In FEBio `c_i = 2 μ_i`, `m_i = α_i`).

use super::principal::{Principal, response, secant_of_exponentials};
use super::tensor::{Response, delta};
use nalgebra::Matrix3;

/// The most terms.
pub const MOST_TERMS: usize = 6;

/// Terms of an energy: `μ_i` and `α_i`, which is not zero; `μ_i = 0` of those that are not there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ogden {
    terms: [[f64; 2]; MOST_TERMS],
}

impl Ogden {
    /// A sum of terms `[μ_i, α_i]`; none where there are none or too many of them, or an exponent is zero.
    pub fn new(terms: &[[f64; 2]]) -> Option<Self> {
        let fits = (1..=MOST_TERMS).contains(&terms.len()) && terms.iter().all(|[_, alpha]| *alpha != 0.0);
        fits.then(|| Ogden { terms: std::array::from_fn(|k| terms.get(k).copied().unwrap_or([0.0, 1.0])) })
    }

    fn terms(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.terms.iter().copied().filter(|[mu, _]| *mu != 0.0)
    }

    pub(super) fn shear_modulus(&self) -> f64 {
        self.terms().map(|[mu, _]| mu).sum()
    }

    pub(super) fn energy(&self, f: &Matrix3<f64>) -> Response {
        response(f, |h| self.principal(h))
    }

    fn principal(&self, h: [f64; 3]) -> Principal {
        let mean = (h[0] + h[1] + h[2]) / 3.0;
        let h = h.map(|h| h - mean);
        let mut out = Principal { energy: 0.0, stress: [0.0; 3], tangent: [[0.0; 3]; 3], secant: [[0.0; 3]; 3] };
        for [mu, alpha] in self.terms() {
            // Powers less one, which keep their digits at small strain.
            let more = h.map(|h| (alpha * h).exp_m1());
            let mean = (more[0] + more[1] + more[2]) / 3.0;
            out.energy += 2.0 * mu / (alpha * alpha) * 3.0 * mean;
            for a in 0..3 {
                out.stress[a] += 2.0 * mu / alpha * (more[a] - mean);
                for b in 0..3 {
                    let power = delta(a, b) * (1.0 + more[a]);
                    out.tangent[a][b] += 2.0 * mu * (power - (1.0 + more[a] + more[b]) / 3.0 + mean / 3.0);
                    out.secant[a][b] += 2.0 * mu / alpha * secant_of_exponentials(alpha, h[a], h[b]);
                }
            }
        }
        out
    }
}
