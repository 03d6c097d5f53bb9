//! Orthotropic elasticity: Hooke's law with three planes of symmetry, at small strain in `ε`, at finite strain in the
//! Green-Lagrange strain (Lekhnitskii, *Theory of elasticity of an anisotropic body*, 1981).
//!
//! Along the axes of the material, with `ν_ji = ν_ij E_j/E_i`,
//!
//! ```text
//! ε_i = σ_i/E_i - Σ ν_ji σ_j/E_j,    ε_ij = σ_ij/(2 G_ij)
//! ```

use super::tensor::{Response, Tensor4, delta, flat, fourth};
use nalgebra::Matrix3;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthotropic {
    /// Axes of the material as columns.
    axes: Matrix3<f64>,
    /// Stress per strain along the axes.
    normal: Matrix3<f64>,
    /// `G12`, `G13`, `G23`.
    shear: [f64; 3],
    pub(super) is_finite: bool,
}

/// Constants with which some strain would have a negative energy, or axes that are none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OrthotropicError {
    #[error("{name} is {value}: moduli are positive")]
    Modulus { name: &'static str, value: f64 },
    #[error("|{name}| is {}, not below sqrt({first}/{second}) = {most:.6}", value.abs())]
    Ratio { name: &'static str, first: &'static str, second: &'static str, value: f64, most: f64 },
    #[error(
        "1 - v12 v21 - v13 v31 - v23 v32 - 2 v21 v32 v13 is {value:.6}, not positive, with vji = vij Ej/Ei: some strain \
         would have a negative energy"
    )]
    Determinant { value: f64 },
    #[error("the axes have a cosine of {cosine:.6} with each other: they are to be perpendicular")]
    Axes { cosine: f64 },
}

/// Cosine of the angle between axes that are perpendicular but for rounding.
const PERPENDICULAR: f64 = 1e-6;

impl Orthotropic {
    /// A law from `E1, E2, E3`, `ν12, ν13, ν23`, `G12, G13, G23` and the first two axes, of any length.
    ///
    /// # Errors
    /// The first condition of a positive energy that fails, and axes that are not perpendicular.
    pub fn new(
        moduli: [f64; 3],
        ratios: [f64; 3],
        shear: [f64; 3],
        axes: [[f64; 3]; 2],
    ) -> Result<Self, OrthotropicError> {
        const E: [&str; 3] = ["E1", "E2", "E3"];
        for (name, value) in E.into_iter().chain(["G12", "G13", "G23"]).zip(moduli.into_iter().chain(shear)) {
            if !(value > 0.0 && value.is_finite()) {
                return Err(OrthotropicError::Modulus { name, value });
            }
        }
        let pairs = [("v12", 0, 1), ("v13", 0, 2), ("v23", 1, 2)];
        for ((name, i, j), value) in pairs.into_iter().zip(ratios) {
            let most = (moduli[i] / moduli[j]).sqrt();
            if value.is_nan() || value.abs() >= most {
                return Err(OrthotropicError::Ratio { name, first: E[i], second: E[j], value, most });
            }
        }
        let [v12, v13, v23] = ratios;
        let [v21, v31, v32] = [v12 * moduli[1] / moduli[0], v13 * moduli[2] / moduli[0], v23 * moduli[2] / moduli[1]];
        let value = 1.0 - v12 * v21 - v13 * v31 - v23 * v32 - 2.0 * v21 * v32 * v13;
        let mut compliance = Matrix3::from_diagonal(&moduli.map(|e| 1.0 / e).into());
        for ((_, i, j), ratio) in pairs.into_iter().zip(ratios) {
            (compliance[(i, j)], compliance[(j, i)]) = (-ratio / moduli[i], -ratio / moduli[i]);
        }
        let normal = compliance.try_inverse().filter(|_| value > 0.0);
        let normal = normal.ok_or(OrthotropicError::Determinant { value })?;
        let [first, second] = axes.map(|a| nalgebra::Vector3::from(a).normalize());
        let cosine = first.dot(&second);
        if cosine.is_nan() || cosine.abs() > PERPENDICULAR {
            return Err(OrthotropicError::Axes { cosine });
        }
        let second = (second - first * cosine).normalize();
        let axes = Matrix3::from_columns(&[first, second, first.cross(&second)]);
        Ok(Orthotropic { axes, normal, shear, is_finite: false })
    }

    /// The same in the Green-Lagrange strain.
    pub fn at_finite_strain(self) -> Self {
        Orthotropic { is_finite: true, ..self }
    }

    /// Stress of a symmetric strain.
    fn stress(&self, strain: &Matrix3<f64>) -> Matrix3<f64> {
        let e = self.axes.transpose() * strain * self.axes;
        let mut s = Matrix3::from_diagonal(&(self.normal * e.diagonal()));
        for ((i, j), g) in [(0, 1), (0, 2), (1, 2)].into_iter().zip(self.shear) {
            (s[(i, j)], s[(j, i)]) = (2.0 * g * e[(i, j)], 2.0 * g * e[(i, j)]);
        }
        self.axes * s * self.axes.transpose()
    }

    /// `C_ijkl`.
    fn stiffness(&self) -> Tensor4 {
        let mut out = Tensor4::zeros();
        for c in 0..9 {
            let mut unit = Matrix3::zeros();
            unit[(c / 3, c % 3)] = 1.0;
            out.set_column(c, &flat(&self.stress(&((unit + unit.transpose()) * 0.5))));
        }
        out
    }

    pub(super) fn energy(&self, f: &Matrix3<f64>) -> Response {
        if !self.is_finite {
            let h = f - Matrix3::identity();
            let strain = (h + h.transpose()) * 0.5;
            let stress = self.stress(&strain);
            return Response { energy: 0.5 * stress.dot(&strain), stress: flat(&stress), tangent: self.stiffness() };
        }
        let strain = (f.transpose() * f - Matrix3::identity()) * 0.5;
        let s = self.stress(&strain);
        // `F_ia`, that turns the first index.
        let turn: Tensor4 = f.kronecker(&Matrix3::identity());
        let geometric = fourth(|i, j, k, l| delta(i, k) * s[(j, l)]);
        Response {
            energy: 0.5 * s.dot(&strain),
            stress: turn * flat(&s),
            tangent: geometric + turn * self.stiffness() * turn.transpose(),
        }
    }

    /// The largest modulus: a scale.
    pub fn largest_modulus(&self) -> f64 {
        self.normal.diagonal().max()
    }

    /// Whether no stress acts out of the plane `z` but across it: one of the axes is along `z`.
    pub fn is_of_plane(&self) -> bool {
        (0..3).any(|k| self.axes[(2, k)].abs() > 1.0 - PERPENDICULAR)
    }
}
