//! Stress laws: energy per reference volume, first Piola stress and tangent from the deformation gradient.
//!
//! The energy is split as `W(F) = V(F) + U(φ(F))` with a measure `φ` of the change of volume, so that a cell may take `φ`
//! from a projection of it:
//!
//! | law | `V` | `φ` | `U` |
//! |---|---|---|---|
//! | neo-Hooke | `μ/2 (I1 - 3 - 2 ln J)` | `J` | `λ/4 (J² - 1 - 2 ln J)` or `λ/2 ln² J` |
//! | Saint-Venant–Kirchhoff | `μ E:E` | `tr E` | `λ/2 φ²` |
//! | linear elasticity | `μ ε:ε` | `tr ε` | `λ/2 φ²` |
//!
//! All laws are that of Hooke at small strain (Ogden, *Non-linear elastic deformations*, 1984; Wriggers, *Nonlinear finite
//! element methods*, 2008). `λ/4 (J² - 1 - 2 ln J)` is convex in `J`, `λ/2 ln² J` only below `J = e`; both resist `J → 0`.
//! Saint-Venant–Kirchhoff softens in compression: the uniaxial stress falls again below a stretch of `1/√3`.

use crate::material::{Elastic, Space};
use nalgebra::{Matrix3, SMatrix, SVector};

/// A second-order tensor, row by row.
pub type Tensor = SVector<f64, 9>;
/// A fourth-order tensor: row and column as [`Tensor`].
pub type Tensor4 = SMatrix<f64, 9, 9>;

/// How stress follows from strain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StressLaw {
    /// Small strain.
    #[default]
    LinearElastic,
    NeoHooke(Volumetric),
    /// For large rotations with small strain.
    SaintVenantKirchhoff,
}

/// The volumetric energy of neo-Hooke.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Volumetric {
    /// `λ/4 (J² - 1 - 2 ln J)`.
    #[default]
    Quadratic,
    /// `λ/2 ln² J`.
    Logarithmic,
}

/// A deformation that a law does not cover.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StrainError {
    #[error("an element is inverted (J = {jacobian:.3e})")]
    Inverted { jacobian: f64 },
    #[error(
        "a principal stretch of {stretch:.3} is below {LEAST_STRETCH}: Saint-Venant-Kirchhoff softens in compression; \
         use neo-Hooke"
    )]
    Compressed { stretch: f64 },
}

/// Energy with its derivatives in `F`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    pub energy: f64,
    /// First Piola stress.
    pub stress: Tensor,
    pub tangent: Tensor4,
}

/// The smallest principal stretch of Saint-Venant–Kirchhoff: just above that of the largest compressive stress, `1/√3`.
pub const LEAST_STRETCH: f64 = 0.6;

fn flat(m: &Matrix3<f64>) -> Tensor {
    Tensor::from_fn(|k, _| m[(k / 3, k % 3)])
}

/// A fourth-order tensor by its components `iJkL`.
fn fourth(f: impl Fn(usize, usize, usize, usize) -> f64) -> Tensor4 {
    Tensor4::from_fn(|r, c| f(r / 3, r % 3, c / 3, c % 3))
}

fn delta(i: usize, j: usize) -> f64 {
    f64::from(u8::from(i == j))
}

impl StressLaw {
    /// As it is called in a summary.
    pub fn name(self) -> &'static str {
        match self {
            StressLaw::LinearElastic => "linear elastic",
            StressLaw::NeoHooke(Volumetric::Quadratic) => "neo-Hooke, U = lambda/4 (J^2 - 1 - 2 ln J)",
            StressLaw::NeoHooke(Volumetric::Logarithmic) => "neo-Hooke, U = lambda/2 ln^2 J",
            StressLaw::SaintVenantKirchhoff => "Saint-Venant-Kirchhoff",
        }
    }

    /// Whether a deformation gradient is one that the law covers.
    ///
    /// # Errors
    /// Inverted material; with Saint-Venant–Kirchhoff also strong compression.
    pub fn check(self, f: &Matrix3<f64>) -> Result<(), StrainError> {
        if self == StressLaw::LinearElastic {
            return Ok(());
        }
        let jacobian = f.determinant();
        if jacobian.is_nan() || jacobian <= 0.0 {
            return Err(StrainError::Inverted { jacobian });
        }
        if self == StressLaw::SaintVenantKirchhoff {
            let stretch = (f.transpose() * f).symmetric_eigenvalues().min().max(0.0).sqrt();
            if stretch < LEAST_STRETCH {
                return Err(StrainError::Compressed { stretch });
            }
        }
        Ok(())
    }

    /// `V` with its derivatives.
    pub fn deviatoric(self, elastic: &Elastic, f: &Matrix3<f64>) -> Response {
        let (_, mu) = elastic.lame(Space::Solid);
        match self {
            StressLaw::LinearElastic => {
                let h = f - Matrix3::identity();
                let strain = (h + h.transpose()) * 0.5;
                Response {
                    energy: mu * strain.norm_squared(),
                    stress: flat(&(strain * (2.0 * mu))),
                    tangent: fourth(|i, j, k, l| mu * (delta(i, k) * delta(j, l) + delta(i, l) * delta(j, k))),
                }
            }
            StressLaw::NeoHooke(_) => {
                let inverse = f.try_inverse().unwrap_or_else(Matrix3::zeros);
                Response {
                    energy: 0.5 * mu * (f.norm_squared() - 3.0 - 2.0 * f.determinant().ln()),
                    stress: flat(&((f - inverse.transpose()) * mu)),
                    tangent: fourth(|i, j, k, l| mu * (delta(i, k) * delta(j, l) + inverse[(j, k)] * inverse[(l, i)])),
                }
            }
            StressLaw::SaintVenantKirchhoff => {
                let strain = (f.transpose() * f - Matrix3::identity()) * 0.5;
                let s = strain * (2.0 * mu);
                let left = f * f.transpose();
                Response {
                    energy: mu * strain.norm_squared(),
                    stress: flat(&(f * s)),
                    tangent: fourth(|i, j, k, l| {
                        delta(i, k) * s[(j, l)] + mu * (left[(i, k)] * delta(j, l) + f[(i, l)] * f[(k, j)])
                    }),
                }
            }
        }
    }

    /// `φ` with its derivatives.
    pub fn dilatation(self, f: &Matrix3<f64>) -> Response {
        match self {
            StressLaw::LinearElastic => {
                Response { energy: f.trace() - 3.0, stress: flat(&Matrix3::identity()), tangent: Tensor4::zeros() }
            }
            StressLaw::NeoHooke(_) => {
                let jacobian = f.determinant();
                let inverse = f.try_inverse().unwrap_or_else(Matrix3::zeros);
                let g = |i: usize, j: usize| inverse[(j, i)];
                Response {
                    energy: jacobian,
                    stress: flat(&(inverse.transpose() * jacobian)),
                    tangent: fourth(|i, j, k, l| jacobian * (g(i, j) * g(k, l) - g(k, j) * g(i, l))),
                }
            }
            StressLaw::SaintVenantKirchhoff => Response {
                energy: 0.5 * (f.norm_squared() - 3.0),
                stress: flat(f),
                tangent: fourth(|i, j, k, l| delta(i, k) * delta(j, l)),
            },
        }
    }

    /// `U`, `U'`, `U''` at a value of `φ`.
    pub fn volumetric(self, elastic: &Elastic, x: f64) -> [f64; 3] {
        let (lambda, _) = elastic.lame(Space::Solid);
        match self {
            StressLaw::NeoHooke(Volumetric::Quadratic) => [
                0.25 * lambda * (x * x - 1.0 - 2.0 * x.ln()),
                0.5 * lambda * (x - 1.0 / x),
                0.5 * lambda * (1.0 + 1.0 / (x * x)),
            ],
            StressLaw::NeoHooke(Volumetric::Logarithmic) => {
                [0.5 * lambda * x.ln().powi(2), lambda * x.ln() / x, lambda * (1.0 - x.ln()) / (x * x)]
            }
            _ => [0.5 * lambda * x * x, lambda * x, lambda],
        }
    }

    /// Energy, stress and tangent at a point, the stretch across the plane given.
    ///
    /// # Errors
    /// Deformations that the law does not cover.
    pub fn response(self, elastic: &Elastic, f: &Matrix3<f64>) -> Result<Response, StrainError> {
        self.check(f)?;
        let (v, phi) = (self.deviatoric(elastic, f), self.dilatation(f));
        let [u, du, ddu] = self.volumetric(elastic, phi.energy);
        Ok(Response {
            energy: v.energy + u,
            stress: v.stress + phi.stress * du,
            tangent: v.tangent + phi.tangent * du + phi.stress * phi.stress.transpose() * ddu,
        })
    }

    /// The same in plane stress: the stretch across the plane leaves no stress there, and is condensed out of the tangent.
    /// `f` is that of the plane, its last row and column are not read.
    ///
    /// # Errors
    /// Deformations that the law does not cover.
    pub fn plane_stress(self, elastic: &Elastic, f: &Matrix3<f64>) -> Result<Response, StrainError> {
        let mut f = *f;
        for k in 0..2 {
            (f[(k, 2)], f[(2, k)]) = (0.0, 0.0);
        }
        let jacobian = f[(0, 0)] * f[(1, 1)] - f[(0, 1)] * f[(1, 0)];
        if self != StressLaw::LinearElastic && (jacobian.is_nan() || jacobian <= 0.0) {
            return Err(StrainError::Inverted { jacobian });
        }
        f[(2, 2)] = self.stretch_across(elastic, &f);
        let mut out = self.response(elastic, &f)?;
        let across = out.tangent[(8, 8)];
        out.tangent -= out.tangent.column(8) * out.tangent.row(8) / across;
        Ok(out)
    }

    /// The stretch across the plane that leaves no stress there.
    pub fn stretch_across(self, elastic: &Elastic, f: &Matrix3<f64>) -> f64 {
        let jacobian = f[(0, 0)] * f[(1, 1)] - f[(0, 1)] * f[(1, 0)];
        let (lambda, mu) = elastic.lame(Space::Solid);
        let ratio = lambda / (lambda + 2.0 * mu);
        match self {
            StressLaw::LinearElastic => 1.0 - ratio * (f[(0, 0)] + f[(1, 1)] - 2.0),
            StressLaw::SaintVenantKirchhoff => {
                let plane: f64 = (0..2).flat_map(|i| (0..2).map(move |j| (i, j))).map(|k| f[k] * f[k]).sum();
                (1.0 - ratio * (plane - 2.0)).max(0.0).sqrt()
            }
            // μ (c - 1) + λ/2 (j² c - 1) = 0 with the square c of the stretch.
            StressLaw::NeoHooke(Volumetric::Quadratic) => {
                ((mu + 0.5 * lambda) / (mu + 0.5 * lambda * jacobian * jacobian)).sqrt()
            }
            // μ (e^y - 1) + λ (ln j + y/2) = 0 with y = ln c: convex and rising, so that Newton's method converges from
            // everywhere, from the right side after its first step.
            StressLaw::NeoHooke(Volumetric::Logarithmic) => {
                let mut y = -2.0 * ratio * jacobian.ln();
                for _ in 0..100 {
                    let value = mu * (y.exp() - 1.0) + lambda * (jacobian.ln() + 0.5 * y);
                    let step = value / (mu * y.exp() + 0.5 * lambda);
                    y -= step;
                    if step.abs() <= 1e-15 * (1.0 + y.abs()) {
                        break;
                    }
                }
                (0.5 * y).exp()
            }
        }
    }
}
