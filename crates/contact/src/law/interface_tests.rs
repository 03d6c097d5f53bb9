//! Laws that give way, hold each other or wear, as implicit functions of their trials.

use super::*;

fn coulomb(mu: f64) -> Box<dyn Law> {
    Box::new(Coulomb::isotropic(mu).unwrap())
}

fn keys(softening: Softening, opening: f64, shear: f64) -> CohesionKeys {
    CohesionKeys { strength: 0.8, energy: 0.5, softening, opening, shear, heals: false }
}

fn cohesion(softening: Softening, opening: f64, shear: f64) -> Cohesion {
    Cohesion::new(keys(softening, opening, shear), coulomb(0.3)).unwrap()
}

const BOTH: [Softening; 2] = [Softening::Linear, Softening::Exponential];

/// Derivatives in every branch: bonded, opening, damaged, unloaded, pressed and slipping with a bond that is whole, damaged,
/// broken; rough surfaces near and far; wear in stick and in slip.
#[test]
fn derivatives_are_of_second_order() {
    let mut laws: Vec<Box<dyn Law>> = vec![
        Box::new(Rough::new(Compliance::Exponential { pressure: 0.5, length: 0.1 }, Some(coulomb(0.4))).unwrap()),
        Box::new(Rough::new(Compliance::Power { coefficient: 3.0, exponent: 1.5 }, Some(coulomb(0.4))).unwrap()),
        Box::new(Worn::new(0.3, coulomb(0.4)).unwrap()),
        Box::new(Worn::new(0.3, Box::new(Coulomb::orthotropic([0.5, 0.2]).unwrap())).unwrap()),
        Box::new(Worn::new(0.3, Box::new(Viscous::new(0.4, 0.3).unwrap())).unwrap()),
    ];
    for softening in BOTH {
        for (opening, shear) in [(0.0, 1.0), (0.2, 0.7), (0.0, 0.0), (0.2, 0.0)] {
            laws.push(Box::new(cohesion(softening, opening, shear)));
        }
    }
    let trials =
        [[1.3, 0.3, -0.2], [1.3, 0.9, 0.7], [0.2, 0.1, 2.5], [-0.3, 0.2, 0.1], [-1.4, 0.3, 0.2], [-1.1, 1.4, -0.3]];
    let directions = [[0.7, 0.0, 0.0], [0.0, 0.8, -0.1], [0.2, 0.3, 0.5]];
    for law in &laws {
        for (opened, slipped) in [(0.0, [0.0; 2]), (0.4, [0.2, 0.1]), (9e9, [0.5, 0.2])] {
            let point = LawPoint { per_gap: 4.0, duration: 0.5, opened, slipped, ..LawPoint::default() };
            for trial in trials {
                let at = law.traction(trial, &point);
                for direction in directions {
                    let [coarse, fine] = [1e-3, 5e-4].map(|h| {
                        let moved = law.traction(std::array::from_fn(|k| trial[k] + h * direction[k]), &point);
                        let off = |r: usize| {
                            let by: f64 = (0..3).map(|c| at.derivative[r][c] * direction[c]).sum();
                            (moved.traction[r] - at.traction[r] - h * by).powi(2)
                        };
                        (0..3).map(off).sum::<f64>().sqrt()
                    });
                    let second = coarse < 1e-12 || (3.5..4.5).contains(&(coarse / fine));
                    assert!(second, "{law:?} at {trial:?}, {opened}, along {direction:?}: {coarse:e} {fine:e}");
                }
            }
        }
    }
}

/// A bond that is opened along a straight line carries its envelope, on the ellipse of its two strengths; closing it goes to the
/// origin. The work of opening it whole is its energy, in any direction.
#[test]
fn a_bond_follows_its_envelope() {
    for softening in BOTH {
        for (first, shear) in [(0.0, 1.0), (0.2, 0.7)] {
            let law = cohesion(softening, first, shear);
            for angle in [0.0f64, 0.6, 1.2, std::f64::consts::FRAC_PI_2] {
                let (cos, sin) = (angle.cos(), angle.sin());
                let carried = |opening: f64, opened: f64| {
                    let [g, e] = [opening * cos, opening * sin / shear];
                    let c = law.least_scale();
                    // The traction that is its own trial, by bisection along its direction.
                    let point = LawPoint { per_gap: c, opened, ..LawPoint::default() };
                    let of = |t: f64| law.traction([-t * cos - c * g, shear * t * sin + c * e, 0.0], &point);
                    let size = |t: [f64; 3]| (t[0] / 1.0).hypot(t[1] / shear);
                    let [mut low, mut high] = [0.0, 1.0];
                    for _ in 0..60 {
                        let t = 0.5 * (low + high);
                        if size(of(t).traction) > t { low = t } else { high = t }
                    }
                    (size(of(low).traction), law.opening([-low * cos - c * g, shear * low * sin + c * e, 0.0], &point))
                };
                let whole = 2.0 * 0.5 / 0.8;
                let expected = |d: f64| match softening {
                    _ if d < first => 0.8 * d / first,
                    Softening::Linear => (0.8 * (whole - d) / (whole - first)).max(0.0),
                    Softening::Exponential => 0.8 * (-(d - first) / (0.5 / 0.8 - 0.5 * first)).exp(),
                };
                for opening in [0.1, 0.3, 0.7, 1.1] {
                    let (t, opened) = carried(opening, 0.0);
                    assert!((t - expected(opening)).abs() < 1e-9, "{softening:?} {angle} {opening}: {t}");
                    assert!((opened - opening).abs() < 1e-9, "{opened}");
                    let (closing, _) = carried(0.5 * opening, opening.max(first));
                    let secant = 0.5 * expected(opening.max(first)) * opening / opening.max(first);
                    assert!((closing - secant).abs() < 1e-9, "{closing} {secant}");
                }
                let count = 1000;
                let step = if softening == Softening::Linear { whole } else { 20.0 } / f64::from(count);
                let work: f64 = (0..count).map(|k| step * carried((f64::from(k) + 0.5) * step, 0.0).0).sum();
                assert!((work - 0.5).abs() < 1e-4, "{softening:?} {angle}: {work}");
            }
        }
    }
}

/// What rubs is the part that is damaged, and wear opens the gap by Archard's law.
#[test]
fn pressed_bonds_rub_as_far_as_they_are_damaged() {
    let law = cohesion(Softening::Linear, 0.0, 1.0);
    let (p, c) = (1.5, 4.0);
    for (slip, damage) in [(0.5, 0.4), (1.0, 0.8), (2.0, 1.0)] {
        let expected = 0.8 * (1.0 - damage) + 0.3 * p * damage;
        let point = LawPoint { per_gap: c, ..LawPoint::default() };
        let found = law.traction([p, expected + c * slip, 0.0], &point);
        assert!((found.traction[1] - expected).abs() < 1e-12 && found.traction[0] == p, "{found:?}");
    }
    let worn = Worn::new(0.2, coulomb(0.4)).unwrap();
    let point = LawPoint { per_gap: c, ..LawPoint::default() };
    // A depth of 0.2 times pressure 0.5 and slip 0.3, as the gap of the trial.
    let found = worn.traction([0.5 + c * 0.2 * 0.5 * 0.3, 0.4 * 0.5 + c * 0.3, 0.0], &point);
    assert!((found.traction[0] - 0.5).abs() < 1e-14 && (found.traction[1] - 0.2).abs() < 1e-14, "{found:?}");
}

#[test]
fn values_that_no_law_can_have_are_refused() {
    let cohesion = |keys| Cohesion::new(keys, coulomb(0.0)).map(|_| ());
    let good = keys(Softening::Linear, 0.0, 1.0);
    assert!(cohesion(good).is_ok());
    for bad in [
        CohesionKeys { strength: 0.0, ..good },
        CohesionKeys { energy: -1.0, ..good },
        CohesionKeys { energy: f64::NAN, ..good },
        CohesionKeys { opening: 1.3, ..good },
    ] {
        assert!(cohesion(bad).is_err(), "{bad:?}");
    }
    let rough = |compliance| Rough::new(compliance, None).map(|_| ());
    assert!(rough(Compliance::Exponential { pressure: 0.0, length: 1.0 }).is_err());
    assert!(rough(Compliance::Power { coefficient: 1.0, exponent: 0.5 }).is_err());
    assert!(Worn::new(-1.0, coulomb(0.0)).is_err());
}
