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

#[cfg(test)]
mod tests {
    use super::*;

    const ELASTIC: Elastic = Elastic { youngs_modulus: 3.0, poissons_ratio: 0.25 };

    /// Under uniaxial stress `ε_x = σ/E`, `ε_y = -ν σ/E`, whether the third direction is solved for or left out.
    #[test]
    fn uniaxial_stress_is_that_of_youngs_modulus() {
        let (strain, across) = (0.01, -0.25 * 0.01);
        let solid = ELASTIC.stress(Space::Solid, &Matrix3::from_diagonal(&[strain, across, across].into()));
        let plane = ELASTIC.stress(Space::PlaneStress, &Matrix3::from_diagonal(&[strain, across, 0.0].into()));
        for stress in [solid, plane] {
            assert!((stress[(0, 0)] - 0.03).abs() < 1e-17, "{stress}");
            assert!(stress.iter().skip(1).all(|s| s.abs() < 1e-17), "{stress}");
        }
    }

    /// The shear modulus is half of `E/(1 + ν)`, and a spin has no stress.
    #[test]
    fn shear_has_its_modulus_and_spins_have_none() {
        let mut shear = Matrix3::zeros();
        shear[(0, 1)] = 0.02;
        let stress = ELASTIC.stress(Space::PlaneStrain, &shear);
        assert!((stress[(0, 1)] - 0.02 * 0.5 * 3.0 / 1.25).abs() < 1e-17 && stress[(0, 1)] == stress[(1, 0)]);
        shear[(1, 0)] = -0.02;
        assert_eq!(ELASTIC.stress(Space::PlaneStrain, &shear), Matrix3::zeros());
    }

    #[test]
    fn plane_strain_holds_the_third_direction() {
        let stress = ELASTIC.stress(Space::PlaneStrain, &Matrix3::from_diagonal(&[0.01, 0.02, 0.0].into()));
        let held = ELASTIC.poissons_ratio * (stress[(0, 0)] + stress[(1, 1)]);
        assert!((stress[(2, 2)] - held).abs() < 1e-17);
    }
}
