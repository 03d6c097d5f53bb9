//! Stress laws against differences and homogeneous stretches.

use nalgebra::Matrix3;
use signorini_material::Elastic;
use signorini_material::law::{StrainError, StressLaw, Volumetric};

const LAWS: [StressLaw; 4] = [
    StressLaw::LinearElastic,
    StressLaw::NeoHooke(Volumetric::Quadratic),
    StressLaw::NeoHooke(Volumetric::Logarithmic),
    StressLaw::SaintVenantKirchhoff,
];

fn elastic() -> Elastic {
    Elastic { youngs_modulus: 1.0, poissons_ratio: 0.3 }
}

fn some() -> Matrix3<f64> {
    Matrix3::new(1.1, 0.2, -0.1, -0.15, 0.9, 0.12, 0.05, -0.2, 1.05)
}

#[test]
fn stress_and_tangent_are_derivatives_of_the_energy() {
    let h = 1e-5;
    for law in LAWS {
        for plane in [false, true] {
            let at = |f: &Matrix3<f64>| {
                if plane { law.plane_stress(&elastic(), f, &[]) } else { law.response(&elastic(), f) }.unwrap()
            };
            let here = at(&some());
            for k in (0..9).filter(|k| !plane || (k % 3 < 2 && k / 3 < 2)) {
                let moved = |h: f64| {
                    let mut f = some();
                    f[(k / 3, k % 3)] += h;
                    at(&f)
                };
                let (plus, minus) = (moved(h), moved(-h));
                let slope = (plus.energy - minus.energy) / (2.0 * h);
                assert!((slope - here.stress[k]).abs() < 1e-9, "{} {plane}: {slope} {}", law.name(), here.stress[k]);
                let column = (plus.stress - minus.stress) / (2.0 * h);
                assert!((column - here.tangent.column(k)).norm() < 1e-8, "{} {plane}", law.name());
            }
            if plane {
                assert!(here.stress[8].abs() < 1e-14);
            }
        }
    }
}

#[test]
fn laws_are_that_of_hooke_at_small_strain() {
    let here = |law: StressLaw| law.response(&elastic(), &Matrix3::identity()).unwrap();
    for law in LAWS {
        assert!(here(law.clone()).stress.norm() < 1e-15);
        assert!((here(law.clone()).tangent - here(StressLaw::LinearElastic).tangent).norm() < 1e-14, "{}", law.name());
    }
}

/// Stretch; lateral stretch and stress of a bar; the same with one side held.
type Row = [f64; 5];

/// Roots of the lateral stress, E = 1, ν = 0.3.
const STRETCHES: [(StressLaw, [Row; 4]); 3] = [
    (
        StressLaw::NeoHooke(Volumetric::Logarithmic),
        [
            [0.7, 1.1079347328484763, -0.40523042431429934, 1.1507960463303386, -0.4584239232140321],
            [0.9, 1.0317024344349306, -0.10872218513630874, 1.044997289776318, -0.12052108360677372],
            [1.2, 0.945632624291129, 0.17492914739624107, 0.9214954383794538, 0.18937376828392893],
            [1.5, 0.8801745918067377, 0.37828017639431855, 0.8249236422395783, 0.4024361498651765],
        ],
    ),
    (
        StressLaw::NeoHooke(Volumetric::Quadratic),
        [
            [0.7, 1.1004673201164705, -0.39616940804633327, 1.1312415725341851, -0.43390521726901987],
            [0.9, 1.0311339905161059, -0.10822107111011522, 1.0433824645548682, -0.11907990057290219],
            [1.2, 0.94421919724064, 0.1757852908853336, 0.9172492321316785, 0.19187623274161728],
            [1.5, 0.8742328303856898, 0.38095306622457065, 0.8069465847859288, 0.409958258795468],
        ],
    ),
    (
        StressLaw::SaintVenantKirchhoff,
        [
            [0.7, 1.0737783756436894, -0.1785, 1.1038892283972286, -0.19615384615384615],
            [0.9, 1.02810505299799, -0.0855, 1.0399175791516226, -0.09395604395604393],
            [1.2, 0.9316651759081692, 0.264, 0.9007933011676826, 0.29010989010989],
            [1.5, 0.7905694150420948, 0.9375, 0.6813851438692469, 1.0302197802197801],
        ],
    ),
];

#[test]
fn homogeneous_stretches_are_the_roots_of_the_lateral_stress() {
    for (law, rows) in STRETCHES {
        for [stretch, lateral, stress, held_lateral, held_stress] in rows {
            let bar = law.response(&elastic(), &Matrix3::from_diagonal(&[stretch, lateral, lateral].into())).unwrap();
            assert!((bar.stress[0] - stress).abs() < 1e-12 && bar.stress[4].abs() < 1e-12, "{}", law.name());
            let held = Matrix3::from_diagonal(&[stretch, held_lateral, 1.0].into());
            let held = law.response(&elastic(), &held).unwrap();
            assert!((held.stress[0] - held_stress).abs() < 1e-12 && held.stress[4].abs() < 1e-12, "{}", law.name());
            // In plane stress the bar is free across the plane.
            let plane = Matrix3::from_diagonal(&[stretch, lateral, 0.0].into());
            let plane = law.plane_stress(&elastic(), &plane, &[]).unwrap();
            assert!((plane.stress - bar.stress).norm() < 1e-12, "{}", law.name());
        }
    }
}

#[test]
fn what_a_law_does_not_cover_is_refused() {
    let squeezed = Matrix3::from_diagonal(&[0.59, 1.0, 1.0].into());
    let refused = StressLaw::SaintVenantKirchhoff.response(&elastic(), &squeezed);
    assert!(matches!(refused, Err(StrainError::Compressed { stretch }) if (stretch - 0.59).abs() < 1e-12));
    let turned = Matrix3::from_diagonal(&[-0.5, 1.0, 1.0].into());
    for law in &LAWS[1..] {
        assert!(matches!(law.response(&elastic(), &turned), Err(StrainError::Inverted { .. })));
        assert!(matches!(law.plane_stress(&elastic(), &turned, &[]), Err(StrainError::Inverted { .. })));
    }
}
