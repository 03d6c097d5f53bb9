//! Linear elasticity in each space.

use nalgebra::Matrix3;
use signorini_material::{Elastic, Space};

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
