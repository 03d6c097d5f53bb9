//! Laws of contact that give way, hold surfaces together or wear, against closed forms.

use super::*;
use signorini_contact::law::{Cohesion, CohesionKeys, Compliance, Coulomb, Law, Rough, Softening, Worn};
use signorini_geometry::rigid_shape::Plane;

#[test]
fn the_gap_of_a_rough_surface_is_that_of_its_pressure() {
    let (scale, length) = (0.05, 0.01);
    // A penalty would give way besides the law.
    let enforcements = [Enforcement::Multiplier, Enforcement::AugmentedLagrangian];
    let sites = [Test::Sites(Sampling::GaussPoints), Test::Mortar(0)];
    for (test, enforcement) in sites.into_iter().flat_map(|t| enforcements.map(|e| (t, e))) {
        // Below and above the scale of the law; the block starts apart and ends apart, or inside by a little.
        for p in [0.01, 0.1] {
            let mut system = System::default();
            let block = rectangle([0.0, 0.0], [2.0, 1.0], [4, 2], 1, |x| x);
            system.bodies.push(Box::new(solid("block", block, 1, ELASTIC, StressLaw::LinearElastic)));
            let floor = Plane { point: v(0.0, -0.02, 0.0), normal: v(0.0, 1.0, 0.0) };
            system.bodies.push(Box::new(rigid(floor, |_| Vector::<3>::zeros())));
            for side in ["left", "right"] {
                system.supports.push(hold(0, side, [Some(0.0), None, None]));
            }
            let pressure: TimeField = Arc::new(move |_, t| p * t);
            system.loads.push(load(0, "top", TimedLoad::Pressure(pressure)));
            touch(&mut system, [(0, "bottom"), (1, "")], test, enforcement, None);
            system.contacts[0].law_mut().friction =
                Some(Box::new(Rough::new(Compliance::Exponential { pressure: scale, length }, None).unwrap()));
            let (_, results) = run(&mut system, &[0.5, 1.0]);
            let gap = -length * (p / scale).ln();
            for site in results[1].sites[0].iter().filter(|s| s.weight > 0.0) {
                let error = (site.gap.unwrap() - gap).abs();
                assert!(error < 2e-6 && (site.pressure / p - 1.0).abs() < 1e-6, "{test:?} {enforcement:?}: {error:e}");
            }
            assert!(results.iter().all(|r| r.iterations < 40), "{}", told(&results));
        }
    }
}

fn coulomb(mu: f64) -> Box<dyn Law> {
    Box::new(Coulomb::isotropic(mu).unwrap())
}

/// A bar of two parts that is pulled and let go, and along the joint: springs in series with the law of the joint. What the joint
/// remembers is saved on the way.
#[test]
fn a_joint_opens_by_its_law_and_remembers_how_far() {
    let (strength, energy) = (0.02, 4e-3);
    let last = 2.0 * energy / strength;
    // Of both halves, by moduli of unit height; E 1, ν 0.3 held sideways, in tension and shear.
    let (young, nu) = (ELASTIC.youngs_modulus, ELASTIC.poissons_ratio);
    let shear = young / (2.0 * (1.0 + nu));
    let stretch = 2.0 * shear * (1.0 - nu) / (1.0 - 2.0 * nu);
    for (along, modulus) in [(1, stretch), (0, shear)] {
        for test in [Test::Sites(Sampling::GaussPoints), Test::Sites(Sampling::Nodes), Test::Mortar(0)] {
            // Points pass the patch test on rigid bodies; a solid is left by what slides on it.
            let on_solid = along == 1 && matches!(test, Test::Mortar(_));
            let stiffness = if on_solid { 0.5 * modulus } else { modulus };
            // Up to damage, back, on, and far beyond.
            let way = [0.0, 1.5, 0.5, 2.0, 10.0].map(|share| share * strength / stiffness);
            let build = || {
                let mut system = System::default();
                let mut add = |name: &str, low: f64, cells: usize| {
                    let block = rectangle([0.0, low], [1.0, low + 1.0], [cells, 1], 1, |x| x);
                    system.bodies.push(Box::new(solid(name, block, 1, ELASTIC, StressLaw::LinearElastic)));
                };
                add("upper", 0.0, 3);
                if on_solid {
                    add("lower", -1.0, 2);
                    system.supports.push(hold(1, "bottom", [Some(0.0), Some(0.0), None]));
                } else {
                    let floor = Plane { point: v(0.0, 0.0, 0.0), normal: v(0.0, 1.0, 0.0) };
                    system.bodies.push(Box::new(rigid(floor, |_| Vector::<3>::zeros())));
                }
                let moved: TimeField = Arc::new(move |_, t| way[t as usize]);
                let mut pulled = hold(0, "top", [Some(0.0), Some(0.0), None]);
                pulled.displacement[along] = Some(moved);
                system.supports.push(pulled);
                for (body, side) in (0..=usize::from(on_solid)).flat_map(|body| [(body, "left"), (body, "right")]) {
                    // Shear and stretch are uniform across the bar.
                    let mut side = hold(body, side, [None, None, None]);
                    side.displacement[1 - along] = Some(Arc::new(|_, _| 0.0));
                    system.supports.push(side);
                }
                let master = if on_solid { "top" } else { "" };
                touch(&mut system, [(0, "bottom"), (1, master)], test, Enforcement::Multiplier, None);
                let keys = CohesionKeys {
                    strength,
                    energy,
                    softening: Softening::Linear,
                    opening: 0.0,
                    shear: 1.0,
                    heals: false,
                };
                system.contacts[0].law_mut().friction = Some(Box::new(Cohesion::new(keys, coulomb(0.2)).unwrap()));
                system
            };
            let mut system = build();
            system.prepare().unwrap();
            let mut state = system.start();
            let mut damaged = 0.0f64;
            for (k, moved) in way.into_iter().enumerate().skip(1) {
                let (next, result) = system.solve(&state, k as f64, &mut |_, _| true).unwrap();
                // `m (u - δ)/2` by the halves, and by the joint: on its envelope, or on the way to its largest opening.
                let secant = strength * (1.0 - damaged / last) / damaged;
                let opening = if damaged > 0.0 && stiffness * moved / (stiffness + secant) <= damaged {
                    stiffness * moved / (stiffness + secant)
                } else {
                    ((stiffness * moved - strength) / (stiffness - strength / last)).clamp(0.0, moved)
                };
                damaged = damaged.max(opening);
                let expected = if damaged >= last { 0.0 } else { stiffness * (moved - opening) };
                let force: Vector<3> = result.sites[0].iter().map(|s| s.force()).sum();
                let found = -force[along];
                assert!(
                    (found - expected).abs() < 1e-9 && force[1 - along].abs() < 1e-9,
                    "{test:?} {along} at {moved}: {found} for {expected}"
                );
                assert!(result.iterations < 30, "{} iterations", result.iterations);
                system.accept(&next).unwrap();
                state = next;
                // Another run goes on from what was saved.
                let saved = system.contacts[0].history();
                system = build();
                system.prepare().unwrap();
                system.contacts[0].restore(&saved).unwrap();
            }
        }
    }
}

/// A block under a pressure that is drawn over a plane, in one increment or in several: what is worn off is the coefficient times
/// pressure and slip, and the block sinks by it.
#[test]
fn wear_is_that_of_archard() {
    let (k, p, mu) = (0.3, 0.02, 0.25);
    for (test, increments) in [(Test::Sites(Sampling::GaussPoints), 1), (Test::Mortar(0), 1), (Test::Mortar(0), 4)] {
        let mut system = System::default();
        let block = rectangle([0.0, 0.0], [2.0, 1.0], [4, 2], 1, |x| x);
        let soft = Elastic { poissons_ratio: 0.0, ..ELASTIC };
        system.bodies.push(Box::new(solid("block", block, 1, soft, StressLaw::LinearElastic)));
        let floor = Plane { point: v(0.0, 0.0, 0.0), normal: v(0.0, 1.0, 0.0) };
        system.bodies.push(Box::new(rigid(floor, |t| v(-(t - 1.0).max(0.0), 0.0, 0.0))));
        // No part of it shears or tilts.
        for side in ["left", "right", "top", "bottom"] {
            system.supports.push(hold(0, side, [Some(0.0), None, None]));
        }
        let pressure: TimeField = Arc::new(move |_, t| p * t.min(1.0));
        system.loads.push(load(0, "top", TimedLoad::Pressure(pressure)));
        touch(&mut system, [(0, "bottom"), (1, "")], test, Enforcement::Multiplier, None);
        system.contacts[0].law_mut().friction = Some(Box::new(Worn::new(k, coulomb(mu)).unwrap()));
        let times: Vec<f64> = (0..=increments).map(|i| 1.0 + i as f64 / increments as f64).collect();
        let (_, results) = run(&mut system, &times);
        for (time, result) in times.iter().zip(&results) {
            let depth = k * p * (time - 1.0);
            for site in result.sites[0].iter().filter(|s| s.weight > 0.0) {
                assert!((site.worn - depth).abs() < 1e-12, "{test:?}: {} for {depth}", site.worn);
                assert!((site.pressure - p).abs() < 1e-10 && site.gap.unwrap().abs() < 1e-12, "{test:?}");
            }
        }
        let taken = results.last().unwrap().dissipated[0] * increments as f64;
        assert!((taken - 2.0 * mu * p).abs() < 1e-9, "{taken}");
    }
}
