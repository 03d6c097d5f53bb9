//! Orthotropic elasticity against compliance, rotations, isotropy and differences.

use nalgebra::{Matrix3, Rotation3, Vector3};
use signorini_material::law::*;
use signorini_material::{Elastic, StressLaw};

const E: [f64; 3] = [10.0, 4.0, 2.0];
const NU: [f64; 3] = [0.3, 0.2, 0.35];
const G: [f64; 3] = [2.0, 1.5, 0.8];
const ANY: Elastic = Elastic { youngs_modulus: 1.0, poissons_ratio: 0.0 };

fn law(axes: [[f64; 3]; 2], is_finite: bool) -> StressLaw {
    let small = Orthotropic::new(E, NU, G, axes).unwrap();
    StressLaw::Orthotropic(if is_finite { small.at_finite_strain() } else { small })
}

/// Strains by the compliance along turned axes leave one stress only, normal or of shear.
#[test]
fn strains_by_the_compliance_have_one_stress() {
    let r = Rotation3::new(Vector3::new(0.3, -0.8, 1.2)).into_inner();
    let axes = [r.column(0).into_owned().into(), (r.column(1) * 2.0).into()];
    let law = law(axes, false);
    let stress = |strain: Matrix3<f64>| {
        let at = law.response(&ANY, &(Matrix3::identity() + r * strain * r.transpose())).unwrap();
        r.transpose() * Matrix3::from_fn(|i, j| at.stress[3 * i + j]) * r
    };
    let near = |found: Matrix3<f64>, i: usize, j: usize| {
        let mut exact = Matrix3::zeros();
        (exact[(i, j)], exact[(j, i)]) = (1.0, 1.0);
        assert!((found - exact).norm() < 1e-13, "{i} {j}: {found}");
    };
    near(stress(Matrix3::from_diagonal(&[1.0 / E[0], -NU[0] / E[0], -NU[1] / E[0]].into())), 0, 0);
    near(stress(Matrix3::from_diagonal(&[-NU[0] / E[0], 1.0 / E[1], -NU[2] / E[1]].into())), 1, 1);
    near(stress(Matrix3::from_diagonal(&[-NU[1] / E[0], -NU[2] / E[1], 1.0 / E[2]].into())), 2, 2);
    for ((i, j), g) in [(0, 1), (0, 2), (1, 2)].into_iter().zip(G) {
        let mut strain = Matrix3::zeros();
        (strain[(i, j)], strain[(j, i)]) = (0.5 / g, 0.5 / g);
        near(stress(strain), i, j);
    }
}

#[test]
fn equal_constants_are_isotropic_also_in_plane_stress() {
    let g = 3.0 / (2.0 * 1.25);
    let axes = [[1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let same = Orthotropic::new([3.0; 3], [0.25; 3], [g; 3], axes).unwrap();
    let elastic = Elastic { youngs_modulus: 3.0, poissons_ratio: 0.25 };
    let f = Matrix3::new(1.1, 0.2, 0.0, -0.15, 0.9, 0.0, 0.0, 0.0, 1.0);
    for (is_finite, isotropic) in [(false, StressLaw::LinearElastic), (true, StressLaw::SaintVenantKirchhoff)] {
        let law = StressLaw::Orthotropic(if is_finite { same.at_finite_strain() } else { same });
        for plane in [false, true] {
            let at = |law: &StressLaw| match plane {
                true => law.plane_stress(&elastic, &f, &[]).unwrap(),
                false => law.response(&elastic, &f).unwrap(),
            };
            let (a, b) = (at(&law), at(&isotropic));
            assert!((a.stress - b.stress).norm() < 1e-13 && (a.tangent - b.tangent).norm() < 1e-13, "{is_finite}");
            assert!((a.energy - b.energy).abs() < 1e-14);
        }
    }
}

#[test]
fn stress_and_tangent_are_derivatives() {
    let law = law([[1.0, 2.0, 0.5], [-2.0, 1.0, 0.0]], true);
    let some = Matrix3::new(1.1, 0.2, -0.1, -0.15, 0.9, 0.12, 0.05, -0.2, 1.05);
    let here = law.response(&ANY, &some).unwrap();
    let h = 1e-5;
    for k in 0..9 {
        let moved = |h: f64| {
            let mut f = some;
            f[(k / 3, k % 3)] += h;
            law.response(&ANY, &f).unwrap()
        };
        let (plus, minus) = (moved(h), moved(-h));
        assert!(((plus.energy - minus.energy) / (2.0 * h) - here.stress[k]).abs() < 1e-8);
        assert!(((plus.stress - minus.stress) / (2.0 * h) - here.tangent.column(k)).norm() < 1e-7);
    }
}

#[test]
fn constants_without_a_positive_energy_are_refused() {
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let refused = |e: [f64; 3], nu: [f64; 3], g: [f64; 3]| Orthotropic::new(e, nu, g, axes).unwrap_err();
    assert!(matches!(refused([1.0, -1.0, 1.0], NU, G), OrthotropicError::Modulus { name: "E2", .. }));
    assert!(matches!(refused(E, NU, [1.0, 1.0, 0.0]), OrthotropicError::Modulus { name: "G23", .. }));
    // sqrt(10/4) = 1.58.
    assert!(matches!(refused(E, [1.6, 0.0, 0.0], G), OrthotropicError::Ratio { name: "v12", .. }));
    assert!(Orthotropic::new(E, [1.57, 0.0, 0.0], G, axes).is_ok());
    assert!(matches!(refused([1.0; 3], [0.5; 3], G), OrthotropicError::Determinant { .. }));
    assert!(Orthotropic::new([1.0; 3], [0.4999; 3], G, axes).is_ok());
    let skew = Orthotropic::new(E, NU, G, [[1.0, 0.0, 0.0], [0.1, 1.0, 0.0]]).unwrap_err();
    assert!(matches!(skew, OrthotropicError::Axes { .. }));
}
