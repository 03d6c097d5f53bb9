//! Laws with the change of volume apart: derivatives, indifference, closed forms of stretches.

use nalgebra::{Matrix3, Rotation3, Vector3};
use signorini_material::Elastic;
use signorini_material::law::*;

fn rubber(isochoric: Isochoric, fibre: Option<Fibre>, volumetric: Volumetric) -> (Elastic, StressLaw) {
    let law = Rubber { isochoric, fibre, bulk_modulus: 7.0, volumetric };
    (law.elastic(), StressLaw::Rubber(law))
}

fn ogden(terms: &[[f64; 2]]) -> Isochoric {
    Isochoric::Ogden(Ogden::new(terms).unwrap())
}

const MOONEY: Isochoric = Isochoric::MooneyRivlin(MooneyRivlin { c10: 0.3, c01: 0.1 });
const YEOH: Isochoric = Isochoric::Yeoh(Yeoh([0.4, -0.02, 0.01]));
const ARRUDA: Isochoric = Isochoric::ArrudaBoyce(ArrudaBoyce { mu: 0.5, locking_stretch: 2.0 });

fn fibre() -> Fibre {
    Fibre { direction: Vector3::new(2.0, 1.0, -2.0) / 3.0, c3: 0.2, c4: 3.0, c5: 1.5, stretch: 1.2 }
}

fn laws() -> Vec<(Elastic, StressLaw)> {
    let three = [[0.63, 1.3], [0.0012, 5.0], [-0.01, -2.0]];
    vec![
        rubber(MOONEY, None, Volumetric::Linear),
        rubber(YEOH, None, Volumetric::Quadratic),
        rubber(ARRUDA, None, Volumetric::Logarithmic),
        rubber(ogden(&three), None, Volumetric::Linear),
        rubber(ogden(&[[0.5, -3.0]]), None, Volumetric::Linear),
        rubber(MOONEY, Some(fibre()), Volumetric::Linear),
    ]
}

/// Deformations with stretches apart, nearly equal, and equal: two of them, and all.
fn deformations() -> Vec<Matrix3<f64>> {
    let some = Matrix3::new(1.1, 0.2, -0.1, -0.15, 0.9, 0.12, 0.05, -0.2, 1.05);
    let turned = |a: f64, b: f64, c: f64| {
        let [r, q] = [[0.3, -0.7, 1.1], [1.2, 0.4, -0.5]].map(|w| Rotation3::new(w.into()).into_inner());
        r * Matrix3::from_diagonal(&[a, b, c].into()) * q
    };
    vec![
        some,
        turned(1.4, 1.4, 0.6),
        turned(1.4, 1.4 + 1e-9, 0.6),
        turned(1.4, 1.4 + 1e-6, 1.4 - 1e-7),
        turned(1.3, 1.3, 1.3),
        turned(1.25, 0.8, 1.0),
    ]
}

/// The remainder of the first-order expansion of energy and stress falls with the square of the step, where differences of
/// values that hardly differ leave enough digits.
#[test]
fn stress_and_tangent_are_derivatives_by_taylor_remainders() {
    let direction = Matrix3::new(0.3, -0.5, 0.2, 0.7, 0.1, -0.4, -0.2, 0.6, 0.45);
    let along = Tensor::from_fn(|k, _| direction[(k / 3, k % 3)]);
    for (elastic, law) in laws() {
        for f in deformations() {
            let here = law.response(&elastic, &f).unwrap();
            let remainders: Vec<[f64; 2]> = ([2e-3, 1e-3].into_iter())
                .map(|h| {
                    let there = law.response(&elastic, &(f + direction * h)).unwrap();
                    let energy = there.energy - here.energy - here.stress.dot(&along) * h;
                    [energy.abs(), (there.stress - here.stress - here.tangent * along * h).norm()]
                })
                .collect();
            for k in 0..2 {
                let order = (remainders[0][k] / remainders[1][k]).log2();
                assert!((1.9..2.15).contains(&order), "{} {k}: order {order} at {f}", law.name());
            }
            assert!((here.tangent - here.tangent.transpose()).norm() < 1e-12 * here.tangent.norm());
        }
    }
}

/// `W(Q F) = W(F)`, `P(Q F) = Q P(F)`; without fibres also `P(F Q) = P(F) Q`.
#[test]
fn laws_are_indifferent_to_the_frame() {
    let q = Rotation3::new(Vector3::new(0.4, 2.1, -0.9)).into_inner();
    let matrix = |t: &Tensor| Matrix3::from_fn(|i, j| t[3 * i + j]);
    for (elastic, law) in laws() {
        for f in deformations() {
            let here = law.response(&elastic, &f).unwrap();
            let turned = law.response(&elastic, &(q * f)).unwrap();
            assert!((turned.energy - here.energy).abs() < 1e-12, "{}", law.name());
            assert!((matrix(&turned.stress) - q * matrix(&here.stress)).norm() < 1e-12, "{}", law.name());
            if law.fibre_direction().is_none() {
                let isotropic = law.response(&elastic, &(f * q)).unwrap();
                assert!((matrix(&isotropic.stress) - matrix(&here.stress) * q).norm() < 1e-12, "{}", law.name());
            }
        }
    }
}

/// One exponent of 2 is the first term of Mooney-Rivlin, of -2 the second; a series of one term of Yeoh is that too, and
/// fibres that are not stretched are not there.
#[test]
fn laws_agree_where_they_are_the_same() {
    let c01 = Isochoric::MooneyRivlin(MooneyRivlin { c10: 0.0, c01: 0.25 });
    let c10 = Isochoric::MooneyRivlin(MooneyRivlin { c10: 0.25, c01: 0.0 });
    let short = Fibre { direction: Vector3::z(), ..fibre() };
    let pairs = [
        (rubber(c10, None, Volumetric::Linear), rubber(ogden(&[[0.5, 2.0]]), None, Volumetric::Linear)),
        (rubber(c01, None, Volumetric::Linear), rubber(ogden(&[[0.5, -2.0]]), None, Volumetric::Linear)),
        (
            rubber(c10, None, Volumetric::Logarithmic),
            rubber(Isochoric::Yeoh(Yeoh([0.25, 0.0, 0.0])), None, Volumetric::Logarithmic),
        ),
    ];
    for ((elastic, a), (_, b)) in pairs {
        for f in deformations() {
            let [a, b] = [&a, &b].map(|law| law.response(&elastic, &f).unwrap());
            assert!((a.energy - b.energy).abs() < 1e-13 && (a.stress - b.stress).norm() < 1e-13);
            assert!((a.tangent - b.tangent).norm() < 1e-12);
        }
    }
    let flat = Matrix3::from_diagonal(&[1.2, 1.1, 0.9].into());
    let [with, without] = [Some(short), None].map(|f| rubber(MOONEY, f, Volumetric::Linear));
    assert_eq!(with.1.response(&with.0, &flat).unwrap().stress, without.1.response(&without.0, &flat).unwrap().stress);
}

/// `τ_1 - τ_2` of an incompressible bar from the energies by hand, in the conventions of Abaqus: uniaxial, equibiaxial, planar.
#[test]
fn stresses_of_incompressible_stretches_are_those_of_the_manuals() {
    let l: f64 = 1.7;
    let cases = [[l, 1.0 / l.sqrt(), 1.0 / l.sqrt()], [l, l, 1.0 / (l * l)], [l, 1.0, 1.0 / l]];
    let three = [[0.63, 1.3], [0.0012, 5.0], [-0.01, -2.0]];
    for s in cases {
        let [i1, i2] = [s.map(|v| v * v).iter().sum::<f64>(), s.map(|v| 1.0 / (v * v)).iter().sum::<f64>()];
        // λ ∂W/∂λ between the first and the last direction.
        let [of_first, of_second] = [2.0 * (s[0].powi(2) - s[2].powi(2)), 2.0 * (s[2].powi(-2) - s[0].powi(-2))];
        let lm: f64 = 2.0;
        let arruda: f64 = [1.0 / 2.0, 1.0 / 20.0, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673_750.0]
            .iter()
            .enumerate()
            .map(|(k, c)| 0.5 * c * (k + 1) as f64 * (i1 / (lm * lm)).powi(k as i32))
            .sum();
        let x = i1 - 3.0;
        let expected = [
            (MOONEY, 0.3 * of_first + 0.1 * of_second, 0.3 * x + 0.1 * (i2 - 3.0)),
            (YEOH, (0.4 - 0.04 * x + 0.03 * x * x) * of_first, 0.4 * x - 0.02 * x * x + 0.01 * x.powi(3)),
            (ARRUDA, arruda * of_first, f64::NAN),
            (
                ogden(&three),
                three.iter().map(|[m, a]| 2.0 * m / a * (s[0].powf(*a) - s[2].powf(*a))).sum(),
                three.iter().map(|[m, a]| 2.0 * m / (a * a) * (s.map(|v| v.powf(*a)).iter().sum::<f64>() - 3.0)).sum(),
            ),
        ];
        for (law, difference, energy) in expected {
            let (elastic, law) = rubber(law, None, Volumetric::Linear);
            let at = law.response(&elastic, &Matrix3::from_diagonal(&s.into())).unwrap();
            let found = s[0] * at.stress[0] - s[2] * at.stress[8];
            assert!((found - difference).abs() < 1e-13, "{} {s:?}: {found} {difference}", law.name());
            assert!(energy.is_nan() || (at.energy - energy).abs() < 1e-13, "{}: {} {energy}", law.name(), at.energy);
        }
    }
    // The shear modulus at rest by the series of Abaqus.
    let series = 1.0 + 3.0 / 5.0 / 4.0 + 99.0 / 175.0 / 16.0 + 513.0 / 875.0 / 64.0 + 42039.0 / 67375.0 / 256.0;
    assert!((ARRUDA.shear_modulus() - 0.5 * series).abs() < 1e-14);
}

/// Stretched along fibres at constant volume, in their three ranges; the energy is the work.
#[test]
fn fibres_carry_by_their_stretch() {
    let along = fibre();
    let c6 = along.c3 * ((along.c4 * (along.stretch - 1.0)).exp() - 1.0) - along.c5 * along.stretch;
    let (elastic, law) = rubber(MOONEY, Some(along), Volumetric::Linear);
    let (_, bare) = rubber(MOONEY, None, Volumetric::Linear);
    let at = |l: f64| {
        let a = along.direction * along.direction.transpose();
        let f = a * l + (Matrix3::identity() - a) / l.sqrt();
        let [with, without] = [&law, &bare].map(|law| law.response(&elastic, &f).unwrap());
        let stress = Matrix3::from_fn(|i, j| (with.stress - without.stress)[3 * i + j]) * f.transpose();
        let along_fibre = (along.direction.transpose() * stress * along.direction)[0];
        // Less the part that the volume takes, the Kirchhoff stress along fibres is 2/3 of λ F'.
        (1.5 * along_fibre, with.energy - without.energy)
    };
    assert_eq!(at(0.9), (0.0, 0.0));
    assert!((at(1.1).0 - along.c3 * ((along.c4 * 0.1).exp() - 1.0)).abs() < 1e-14);
    assert!((at(1.5).0 - (along.c5 * 1.5 + c6)).abs() < 1e-13);
    // Simpson's rule for the work of λ F' over ln λ, in the ranges on both sides of straight fibres.
    let work = |from: f64, to: f64| {
        let n = 400;
        let h = (to / from).ln() / n as f64;
        let value = |k: usize| at(from * (h * k as f64).exp()).0;
        let inner: f64 = (1..n).map(|k| value(k) * if k % 2 == 1 { 4.0 } else { 2.0 }).sum();
        h / 3.0 * (value(0) + inner + value(n))
    };
    let whole = work(1.0, along.stretch - 1e-14) + work(along.stretch, 1.5);
    assert!((at(1.5).1 - whole).abs() < 1e-11, "{} {whole}", at(1.5).1);
}

/// Ogden's tangent at coincident stretches is that of distinct ones in the limit: no digits are lost on the way.
#[test]
fn equal_stretches_lose_no_digits() {
    let (elastic, law) = rubber(ogden(&[[0.63, 1.3], [0.0012, 5.0], [-0.01, -2.0]]), None, Volumetric::Linear);
    let at = |gap: f64| {
        let r = Rotation3::new(Vector3::new(0.3, -0.7, 1.1)).into_inner();
        let f = r * Matrix3::from_diagonal(&[1.5, 1.5 * (1.0 + gap), 0.5].into()) * r.transpose();
        law.response(&elastic, &f).unwrap().tangent
    };
    let equal = at(0.0);
    for gap in [1e-15, 1e-13, 1e-11, 1e-9] {
        let error = (at(gap) - equal).norm() / equal.norm();
        assert!(error < 1e-13 + 10.0 * gap, "{gap:e}: {error:e}");
    }
}

/// A negative second constant softens in equibiaxial tension, and the stretch there is that at which the stress is largest:
/// a limit found by hand from `∂τ/∂ln λ`.
#[test]
fn unstable_stretches_are_known() {
    let law = |c01: f64| Rubber {
        isochoric: Isochoric::MooneyRivlin(MooneyRivlin { c10: 0.5, c01 }),
        fibre: None,
        bulk_modulus: 100.0,
        volumetric: Volumetric::Linear,
    };
    // Of an equibiaxial stretch λ, h = ln λ (1, 1, -2): dτ/dh ~ c10 (λ² + 2 λ⁻⁴) + c01 (λ⁻² + 2 λ⁴) along the stretch, and
    // c10 λ² + c01 λ⁻² across it: with c01 = -0.1 the first vanishes where λ⁶ (2 c01) + … = 0.
    let unstable_at = |l: f64| {
        let f = Matrix3::from_diagonal(&[l, l, 1.0 / (l * l)].into());
        law(-0.1).unstable(&f).is_some()
    };
    let slope = |l: f64| 0.5 * (l.powi(2) + 2.0 * l.powi(-4)) - 0.1 * (l.powi(-2) + 2.0 * l.powi(4));
    let (mut low, mut high) = (1.0, 3.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if slope(middle) > 0.0 { low = middle } else { high = middle }
    }
    assert!(!unstable_at(low * 0.999) && unstable_at(low * 1.001), "{low}");
    assert!(law(0.1).unstable(&Matrix3::from_diagonal(&[3.0, 3.0, 1.0 / 9.0].into())).is_none());
}
