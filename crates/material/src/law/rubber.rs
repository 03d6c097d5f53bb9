//! Hyperelastic laws without change of volume and with it apart: `W = V(F) + F(λ̄) + U(J)`, where `V` depends on
//! `J^(-1/3) F` only.

use super::arruda_boyce::ArrudaBoyce;
use super::fibre::Fibre;
use super::mooney_rivlin::MooneyRivlin;
use super::ogden::Ogden;
use super::tensor::{Response, delta};
use super::volumetric::Volumetric;
use super::yeoh::Yeoh;
use crate::elastic::Elastic;
use nalgebra::{Matrix2, Matrix3};

/// The energy of changes of shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Isochoric {
    MooneyRivlin(MooneyRivlin),
    Yeoh(Yeoh),
    Ogden(Ogden),
    ArrudaBoyce(ArrudaBoyce),
}

/// A law with the change of volume apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rubber {
    pub isochoric: Isochoric,
    pub fibre: Option<Fibre>,
    pub bulk_modulus: f64,
    pub volumetric: Volumetric,
}

impl Isochoric {
    pub(super) fn name(&self) -> &'static str {
        match self {
            Isochoric::MooneyRivlin(_) => "Mooney-Rivlin",
            Isochoric::Yeoh(_) => "Yeoh",
            Isochoric::Ogden(_) => "Ogden",
            Isochoric::ArrudaBoyce(_) => "Arruda-Boyce",
        }
    }

    /// At rest.
    pub fn shear_modulus(&self) -> f64 {
        match self {
            Isochoric::MooneyRivlin(law) => law.shear_modulus(),
            Isochoric::Yeoh(law) => law.shear_modulus(),
            Isochoric::Ogden(law) => law.shear_modulus(),
            Isochoric::ArrudaBoyce(law) => law.shear_modulus(),
        }
    }

    fn energy(&self, f: &Matrix3<f64>) -> Response {
        match self {
            Isochoric::MooneyRivlin(law) => law.energy(f),
            Isochoric::Yeoh(law) => law.energy(f),
            Isochoric::Ogden(law) => law.energy(f),
            Isochoric::ArrudaBoyce(law) => law.energy(f),
        }
    }

    /// The least change of the principal Kirchhoff stresses with the logarithms of the stretches, over all changes that keep
    /// the volume: the least eigenvalue of `∂τ_a/∂h_b` on `δh_1 + δh_2 + δh_3 = 0`. Where it is not positive the material
    /// is not stable (Drucker's condition of incompressible materials, as in Abaqus).
    pub fn least_stiffness(&self, stretches: [f64; 3]) -> f64 {
        let at = self.energy(&Matrix3::from_diagonal(&stretches.into()));
        let tangent = |a: usize, b: usize| {
            let stress = delta(a, b) * at.stress[4 * a] / stretches[a];
            stretches[a] * stretches[b] * (at.tangent[(4 * a, 4 * b)] + stress)
        };
        // An orthonormal basis of what keeps the volume.
        let basis = [[1.0, -1.0, 0.0].map(|v| v / 2f64.sqrt()), [1.0, 1.0, -2.0].map(|v| v / 6f64.sqrt())];
        let within = Matrix2::from_fn(|i, j| {
            (0..3)
                .flat_map(|a| (0..3).map(move |b| (a, b)))
                .map(|(a, b)| basis[i][a] * tangent(a, b) * basis[j][b])
                .sum::<f64>()
        });
        within.symmetric_eigenvalues().min()
    }
}

impl Rubber {
    /// Constants of small strain, fibres aside.
    pub fn elastic(&self) -> Elastic {
        let (k, mu) = (self.bulk_modulus, self.isochoric.shear_modulus());
        Elastic {
            youngs_modulus: 9.0 * k * mu / (3.0 * k + mu),
            poissons_ratio: (3.0 * k - 2.0 * mu) / (2.0 * (3.0 * k + mu)),
        }
    }

    pub(super) fn name(&self) -> String {
        let fibres = if self.fibre.is_some() { " with fibres" } else { "" };
        format!("{}{fibres}, {}", self.isochoric.name(), self.volumetric.formula("K"))
    }

    pub(super) fn deviatoric(&self, f: &Matrix3<f64>) -> Response {
        let out = self.isochoric.energy(f);
        match &self.fibre {
            Some(fibre) => out.plus(&fibre.energy(f)),
            None => out,
        }
    }

    /// Where the material is not stable in a homogeneous deformation: none where it is.
    pub fn unstable(&self, f: &Matrix3<f64>) -> Option<[f64; 3]> {
        let squares = (f.transpose() * f).symmetric_eigenvalues();
        let mut stretches: [f64; 3] = std::array::from_fn(|a| squares[a].max(0.0).sqrt());
        stretches.sort_by(|a, b| b.total_cmp(a));
        (self.isochoric.least_stiffness(stretches) <= 0.0).then_some(stretches)
    }
}
