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
//! | orthotropic | `ε:C:ε/2` or `E:C:E/2` | | 0 |
//! | elastic-plastic | `μ (dev ε_e)²` | `tr ε` or `J` | `K/2 φ²` or `K/2 ln² J` |
//! | Mooney-Rivlin, Yeoh, Ogden, Arruda-Boyce, fibres | of `J^(-1/3) F` | `J` | `K/2 (J - 1)²` and others of [`Volumetric`] |
//!
//! All laws are that of Hooke at small strain (Ogden, *Non-linear elastic deformations*, 1984; Wriggers, *Nonlinear finite
//! element methods*, 2008). `λ/4 (J² - 1 - 2 ln J)` is convex in `J`, `λ/2 ln² J` only below `J = e`; both resist `J → 0`.
//! Saint-Venant–Kirchhoff softens in compression: the uniaxial stress falls again below a stretch of `1/√3`.

mod arruda_boyce;
mod elastic_plastic;
mod fibre;
mod hardening;
mod invariants;
mod kinematic;
mod linear_elastic;
mod mooney_rivlin;
mod neo_hooke;
mod ogden;
mod orthotropic;
mod principal;
mod rubber;
mod saint_venant_kirchhoff;
mod spectral;
mod tensor;
mod volumetric;
mod yeoh;

pub use arruda_boyce::ArrudaBoyce;
pub use elastic_plastic::{ElasticPlastic, Plastic};
pub use fibre::Fibre;
pub use hardening::{Hardening, HardeningError};
pub use mooney_rivlin::MooneyRivlin;
pub use ogden::{MOST_TERMS, Ogden};
pub use orthotropic::{Orthotropic, OrthotropicError};
pub use rubber::{Isochoric, Rubber};
pub use tensor::{Response, Tensor, Tensor4};
pub use volumetric::Volumetric;
pub use yeoh::Yeoh;

use crate::elastic::{Elastic, Space};
use nalgebra::{Matrix3, Vector3};
use tensor::{flat, fourth};

/// How stress follows from strain.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum StressLaw {
    /// Small strain.
    #[default]
    LinearElastic,
    NeoHooke(Volumetric),
    /// For large rotations with small strain.
    SaintVenantKirchhoff,
    Rubber(Rubber),
    Orthotropic(Orthotropic),
    /// With a history: the stress depends on the plastic strain of the last state.
    ElasticPlastic(ElasticPlastic),
}

/// A deformation that a law does not cover.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StrainError {
    #[error("an element is inverted (J = {jacobian:.3e})")]
    Inverted { jacobian: f64 },
    #[error(
        "a principal stretch of {stretch:.3} is below {LEAST_STRETCH}: Saint-Venant-Kirchhoff softens in compression; \
         use neo-Hooke or another hyperelastic law"
    )]
    Compressed { stretch: f64 },
}

/// The smallest principal stretch of Saint-Venant–Kirchhoff: just above that of the largest compressive stress, `1/√3`.
pub const LEAST_STRETCH: f64 = 0.6;

/// Iterations for the stretch across a plane, and the most that its logarithm changes in one.
const MOST_ITERATIONS: usize = 100;
const MOST_STEP: f64 = 0.5;

impl StressLaw {
    /// As it is called in a summary.
    pub fn name(&self) -> String {
        match self {
            StressLaw::LinearElastic => "linear elastic".into(),
            StressLaw::NeoHooke(volumetric) => format!("neo-Hooke, {}", volumetric.formula("lambda")),
            StressLaw::SaintVenantKirchhoff => "Saint-Venant-Kirchhoff".into(),
            StressLaw::Rubber(law) => law.name(),
            StressLaw::Orthotropic(law) if law.is_finite => "orthotropic, Saint-Venant-Kirchhoff".into(),
            StressLaw::Orthotropic(_) => "orthotropic".into(),
            StressLaw::ElasticPlastic(law) if law.is_finite => "elastic-plastic, logarithmic strain".into(),
            StressLaw::ElasticPlastic(_) => "elastic-plastic".into(),
        }
    }

    /// Whether strains and rotations are small: stress, loads and areas are those of the undeformed body.
    pub fn is_small_strain(&self) -> bool {
        match self {
            StressLaw::LinearElastic => true,
            StressLaw::Orthotropic(law) => !law.is_finite,
            StressLaw::ElasticPlastic(law) => !law.is_finite,
            _ => false,
        }
    }

    /// Whether stress is linear in the displacement gradient.
    pub fn is_linear(&self) -> bool {
        self.is_small_strain() && !self.has_history()
    }

    /// Whether stress depends on what was before.
    pub fn has_history(&self) -> bool {
        matches!(self, StressLaw::ElasticPlastic(_))
    }

    /// The history variables of a point at the start: none of elastic laws.
    pub fn start(&self) -> Vec<f64> {
        match self {
            StressLaw::ElasticPlastic(law) => law.start(),
            _ => Vec::new(),
        }
    }

    /// A point of a law with history after an increment; none of elastic laws.
    pub fn plastic(&self, elastic: &Elastic, space: Space, f: &Matrix3<f64>, history: &[f64]) -> Option<Plastic> {
        let StressLaw::ElasticPlastic(law) = self else { return None };
        let mut f = *f;
        if space == Space::PlaneStress {
            f[(2, 2)] = self.stretch_across(elastic, &f, history);
        }
        Some(law.point(elastic.lame(Space::Solid).1, &f, history))
    }

    /// The direction of fibres, where there are any.
    pub fn fibre_direction(&self) -> Option<&Vector3<f64>> {
        match self {
            StressLaw::Rubber(law) => law.fibre.as_ref().map(|fibre| &fibre.direction),
            _ => None,
        }
    }

    /// Principal stretches of a deformation in which the material is not stable; none where it is, or nothing is known.
    pub fn unstable(&self, elastic: &Elastic, space: Space, f: &Matrix3<f64>) -> Option<[f64; 3]> {
        let StressLaw::Rubber(law) = self else { return None };
        let mut f = *f;
        if space == Space::PlaneStress {
            f[(2, 2)] = self.stretch_across(elastic, &f, &[]);
        }
        law.unstable(&f)
    }

    /// Whether a deformation gradient is one that the law covers.
    ///
    /// # Errors
    /// Inverted material; with Saint-Venant–Kirchhoff also strong compression.
    pub fn check(&self, f: &Matrix3<f64>) -> Result<(), StrainError> {
        if self.is_small_strain() {
            return Ok(());
        }
        let jacobian = f.determinant();
        if jacobian.is_nan() || jacobian <= 0.0 {
            return Err(StrainError::Inverted { jacobian });
        }
        let is_quadratic = matches!(self, StressLaw::SaintVenantKirchhoff | StressLaw::Orthotropic(_));
        if is_quadratic {
            let stretch = (f.transpose() * f).symmetric_eigenvalues().min().max(0.0).sqrt();
            if stretch < LEAST_STRETCH {
                return Err(StrainError::Compressed { stretch });
            }
        }
        Ok(())
    }

    /// `V` with its derivatives, from a history.
    pub fn deviatoric(&self, elastic: &Elastic, f: &Matrix3<f64>, history: &[f64]) -> Response {
        let (_, mu) = elastic.lame(Space::Solid);
        match self {
            StressLaw::LinearElastic => linear_elastic::energy(mu, f),
            StressLaw::NeoHooke(_) => neo_hooke::energy(mu, f),
            StressLaw::SaintVenantKirchhoff => saint_venant_kirchhoff::energy(mu, f),
            StressLaw::Rubber(law) => law.deviatoric(f),
            StressLaw::Orthotropic(law) => law.energy(f),
            StressLaw::ElasticPlastic(law) => law.point(mu, f, history).response,
        }
    }

    /// `φ` with its derivatives.
    pub fn dilatation(&self, f: &Matrix3<f64>) -> Response {
        match self {
            StressLaw::LinearElastic => linear_elastic::dilatation(f),
            StressLaw::Orthotropic(_) => Response::zero(),
            StressLaw::ElasticPlastic(law) if !law.is_finite => linear_elastic::dilatation(f),
            StressLaw::SaintVenantKirchhoff => saint_venant_kirchhoff::dilatation(f),
            StressLaw::NeoHooke(_) | StressLaw::Rubber(_) | StressLaw::ElasticPlastic(_) => {
                let jacobian = f.determinant();
                let inverse = f.try_inverse().unwrap_or_else(Matrix3::zeros);
                let g = |i: usize, j: usize| inverse[(j, i)];
                Response {
                    energy: jacobian,
                    stress: flat(&(inverse.transpose() * jacobian)),
                    tangent: fourth(|i, j, k, l| jacobian * (g(i, j) * g(k, l) - g(k, j) * g(i, l))),
                }
            }
        }
    }

    /// `U`, `U'`, `U''` at a value of `φ`.
    ///
    /// # Errors
    /// A volume that is not positive.
    pub fn volumetric(&self, elastic: &Elastic, x: f64) -> Result<[f64; 3], StrainError> {
        let (lambda, mu) = elastic.lame(Space::Solid);
        let bulk = lambda + 2.0 / 3.0 * mu;
        let of_volume = |volumetric: Volumetric, modulus: f64| match x > 0.0 {
            true => Ok(volumetric.energy(modulus, x)),
            false => Err(StrainError::Inverted { jacobian: x }),
        };
        match self {
            StressLaw::NeoHooke(volumetric) => of_volume(*volumetric, lambda),
            StressLaw::Rubber(law) => of_volume(law.volumetric, law.bulk_modulus),
            StressLaw::ElasticPlastic(law) if law.is_finite => of_volume(Volumetric::Logarithmic, bulk),
            StressLaw::ElasticPlastic(_) => Ok([0.5 * bulk * x * x, bulk * x, bulk]),
            StressLaw::LinearElastic | StressLaw::SaintVenantKirchhoff => {
                Ok([0.5 * lambda * x * x, lambda * x, lambda])
            }
            StressLaw::Orthotropic(_) => Ok([0.0; 3]),
        }
    }

    /// Energy, stress and tangent at a point, the stretch across the plane given; of a law with history from its start.
    ///
    /// # Errors
    /// Deformations that the law does not cover.
    pub fn response(&self, elastic: &Elastic, f: &Matrix3<f64>) -> Result<Response, StrainError> {
        self.response_from(elastic, f, &self.start())
    }

    /// The same from a history.
    ///
    /// # Errors
    /// Deformations that the law does not cover.
    pub fn response_from(&self, elastic: &Elastic, f: &Matrix3<f64>, history: &[f64]) -> Result<Response, StrainError> {
        self.check(f)?;
        let (v, phi) = (self.deviatoric(elastic, f, history), self.dilatation(f));
        let [u, du, ddu] = self.volumetric(elastic, phi.energy)?;
        Ok(Response {
            energy: v.energy + u,
            stress: v.stress + phi.stress * du,
            tangent: v.tangent + phi.tangent * du + phi.stress * phi.stress.transpose() * ddu,
        })
    }

    /// The same in a space: in plane stress by [`plane_stress`](StressLaw::plane_stress).
    ///
    /// # Errors
    /// Deformations that the law does not cover.
    pub fn response_in(
        &self,
        elastic: &Elastic,
        space: Space,
        f: &Matrix3<f64>,
        history: &[f64],
    ) -> Result<Response, StrainError> {
        if space == Space::PlaneStress {
            self.plane_stress(elastic, f, history)
        } else {
            self.response_from(elastic, f, history)
        }
    }

    /// Cauchy stress from a first Piola stress.
    pub fn cauchy(
        &self,
        elastic: &Elastic,
        space: Space,
        f: &Matrix3<f64>,
        piola: &Tensor,
        history: &[f64],
    ) -> Matrix3<f64> {
        let piola = Matrix3::from_fn(|i, j| piola[3 * i + j]);
        if self.is_small_strain() {
            return piola;
        }
        let mut whole = *f;
        // The thickness changes as well, with no stress across.
        if space == Space::PlaneStress {
            whole[(2, 2)] = self.stretch_across(elastic, f, history);
        }
        piola * f.transpose() / whole.determinant()
    }

    /// The same in plane stress: the stretch across the plane leaves no stress there, and is condensed out of the tangent.
    /// `f` is that of the plane, its last row and column are not read.
    ///
    /// # Errors
    /// Deformations that the law does not cover.
    pub fn plane_stress(&self, elastic: &Elastic, f: &Matrix3<f64>, history: &[f64]) -> Result<Response, StrainError> {
        let mut f = *f;
        for k in 0..2 {
            (f[(k, 2)], f[(2, k)]) = (0.0, 0.0);
        }
        let jacobian = f[(0, 0)] * f[(1, 1)] - f[(0, 1)] * f[(1, 0)];
        if !self.is_small_strain() && (jacobian.is_nan() || jacobian <= 0.0) {
            return Err(StrainError::Inverted { jacobian });
        }
        f[(2, 2)] = self.stretch_across(elastic, &f, history);
        let mut out = self.response_from(elastic, &f, history)?;
        let across = out.tangent[(8, 8)];
        out.tangent -= out.tangent.column(8) * out.tangent.row(8) / across;
        Ok(out)
    }

    /// The stretch across the plane that leaves no stress there, from a history.
    pub fn stretch_across(&self, elastic: &Elastic, f: &Matrix3<f64>, history: &[f64]) -> f64 {
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
                for _ in 0..MOST_ITERATIONS {
                    let value = mu * (y.exp() - 1.0) + lambda * (jacobian.ln() + 0.5 * y);
                    let step = value / (mu * y.exp() + 0.5 * lambda);
                    y -= step;
                    if step.abs() <= 1e-15 * (1.0 + y.abs()) {
                        break;
                    }
                }
                (0.5 * y).exp()
            }
            StressLaw::Orthotropic(law) if !law.is_finite => {
                let mut f = *f;
                f[(2, 2)] = 1.0;
                let at = law.energy(&f);
                1.0 - at.stress[8] / at.tangent[(8, 8)]
            }
            StressLaw::ElasticPlastic(law) if !law.is_finite => self.free_strain(elastic, f, history),
            _ => self.free_stretch(elastic, f, history, -ratio * jacobian.ln()),
        }
    }

    /// One plus the strain across the plane without stress there, at small strain. The stress across rises with the strain
    /// across, the derivative of a convex energy: Newton's method, in an interval that shrinks around the root.
    fn free_strain(&self, elastic: &Elastic, f: &Matrix3<f64>, history: &[f64]) -> f64 {
        let mut f = *f;
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut x = 1.0;
        for _ in 0..MOST_ITERATIONS {
            f[(2, 2)] = x;
            let Ok(at) = self.response_from(elastic, &f, history) else { return f64::NAN };
            let value = at.stress[8];
            if value > 0.0 {
                high = x
            } else {
                low = x
            }
            let step = value / at.tangent[(8, 8)];
            let next = x - step;
            // Outside of the interval the middle of it is taken.
            x = if next >= low && next <= high { next } else { 0.5 * (low + high) };
            if step.abs() <= 1e-15 {
                break;
            }
        }
        x
    }

    /// The stretch across the plane without stress there, by Newton's method for its logarithm from a start.
    fn free_stretch(&self, elastic: &Elastic, f: &Matrix3<f64>, history: &[f64], start: f64) -> f64 {
        let mut f = *f;
        let mut y = start;
        for _ in 0..MOST_ITERATIONS {
            let stretch = y.exp();
            f[(2, 2)] = stretch;
            let Ok(at) = self.response_from(elastic, &f, history) else { return f64::NAN };
            // Kirchhoff stress across, and its change with y.
            let (value, slope) = (stretch * at.stress[8], stretch * (at.stress[8] + stretch * at.tangent[(8, 8)]));
            let step = (value / slope).clamp(-MOST_STEP, MOST_STEP);
            // A stress that falls with the stretch leads away from the root.
            let step = if slope > 0.0 { step } else { MOST_STEP * value.signum() };
            y -= step;
            if step.abs() <= 1e-15 * (1.0 + y.abs()) {
                break;
            }
        }
        y.exp()
    }
}
