//! Linear elasticity: constants, stress from the displacement gradient.

use nalgebra::Matrix3;

/// How a solid fills space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    PlaneStrain,
    PlaneStress,
    /// The first coordinate is the radius, the second the axis; integrals run over the whole turn.
    Axisymmetric,
    Solid,
}

/// An isotropic linear elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    pub youngs_modulus: f64,
    pub poissons_ratio: f64,
}

impl Elastic {
    /// Lamé's constants, `λ` and `μ`; in plane stress with the `λ` that leaves no stress across the plane.
    pub fn lame(&self, space: Space) -> (f64, f64) {
        let (e, nu) = (self.youngs_modulus, self.poissons_ratio);
        let mu = 0.5 * e / (1.0 + nu);
        let lambda = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
        (if space == Space::PlaneStress { 2.0 * lambda * mu / (lambda + 2.0 * mu) } else { lambda }, mu)
    }

    /// Stress from the displacement gradient in space, hoop strain and strain across the plane included.
    pub fn stress(&self, space: Space, gradient: &Matrix3<f64>) -> Matrix3<f64> {
        let (lambda, mu) = self.lame(space);
        let strain = 0.5 * (gradient + gradient.transpose());
        let mut stress = strain * (2.0 * mu);
        for k in 0..3 {
            stress[(k, k)] += lambda * strain.trace();
        }
        if space == Space::PlaneStress {
            stress[(2, 2)] = 0.0;
        }
        stress
    }
}

/// The equivalent stress of von Mises.
pub fn von_mises(stress: &Matrix3<f64>) -> f64 {
    let deviator = stress - Matrix3::identity() * (stress.trace() / 3.0);
    (1.5 * deviator.norm_squared()).sqrt()
}
