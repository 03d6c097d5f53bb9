//! Contact of solids: the patch test, and statics.

use super::*;
use signorini_geometry::rigid_shape::Plane;

/// Two blocks pressed together: deviation of the stress across the interface, relative to the pressure.
fn patch(cells: [usize; 2], degree: usize, sampling: Sampling, enforcement: Enforcement) -> f64 {
    let mut system = System::default();
    let block = |low: f64, high: f64, n: usize| rectangle([0.0, low], [1.0, high], [n, 2], 1, |x| x);
    system.bodies.push(Box::new(solid("upper", block(0.5, 1.0, cells[0]), degree, ELASTIC, StressLaw::LinearElastic)));
    system.bodies.push(Box::new(solid("lower", block(0.0, 0.5, cells[1]), degree, ELASTIC, StressLaw::LinearElastic)));
    system.supports.push(hold(1, "bottom", [None, Some(0.0), None]));
    for body in 0..2 {
        system.supports.push(hold(body, "left", [Some(0.0), None, None]));
    }
    let pressure = 1e-3;
    system.loads.push(load(0, "top", TimedLoad::Pressure(Arc::new(move |_, t| pressure * t))));
    touch(&mut system, [(0, "bottom"), (1, "top")], sampling, enforcement, None);
    let (state, results) = run(&mut system, &[1.0]);
    assert!((force(&results[0], 0)[1] - pressure).abs() < 1e-8 * pressure);
    let mut worst = 0.0f64;
    for (body, state) in system.bodies.iter().zip(&state.bodies) {
        let fields = body.fields(state);
        worst = fields.point_data[0].2.chunks(6).fold(worst, |m, s| m.max((s[1] + pressure).abs()));
    }
    worst / pressure
}

#[test]
fn blocks_on_blocks_carry_a_constant_pressure() {
    // With matching meshes exactly; else as well as the points of the slave sample the functions of the master.
    let kinds = [Enforcement::AugmentedLagrangian, Enforcement::Penalty { wanted_penetration: None }];
    for degree in 1..=2 {
        for kind in kinds {
            let error = patch([3, 3], degree, Sampling::GaussPoints, kind);
            assert!(error < 1e-7, "matching, degree {degree} {kind:?}: {error:e}");
        }
        let unlike = patch([3, 4], degree, Sampling::GaussPoints, kinds[1]);
        println!("unlike meshes, degree {degree}: {unlike:.2e}");
        assert!(unlike < 0.3, "{unlike}");
    }
}

fn tilted(mu: f64, tangent: f64, sampling: Test, enforcement: Enforcement) -> Result<IncrementResult, IncrementError> {
    let mut system = System::default();
    let mesh = rectangle([0.0, 0.0], [1.0, 0.5], [4, 2], 1, |x| x);
    system.bodies.push(Box::new(solid("block", mesh, 1, ELASTIC, StressLaw::LinearElastic)));
    let plane = Plane { point: v(0.0, 0.0, 0.0), normal: v(0.0, 1.0, 0.0) };
    system.bodies.push(Box::new(rigid(plane, |_| v(0.0, 0.0, 0.0))));
    let weight = v(tangent, -1.0, 0.0) * 1e-3;
    system.loads.push(load(0, "", TimedLoad::BodyForce(Arc::new(move |_, _| weight))));
    touch(&mut system, [(0, "bottom"), (1, "")], sampling, enforcement, Some(mu));
    system.prepare()?;
    system.solve(&system.start(), 1.0, &mut |_, _| true).map(|found| found.1)
}

#[test]
fn a_block_on_an_incline_holds_up_to_the_angle_of_friction() {
    let mu = 0.3;
    let kinds = [
        (Test::from(Sampling::GaussPoints), Enforcement::Penalty { wanted_penetration: None }),
        (Test::from(Sampling::GaussPoints), Enforcement::AugmentedLagrangian),
        (Test::from(Sampling::Nodes), Enforcement::Multiplier),
        (Test::Mortar(0), Enforcement::Multiplier),
    ];
    for (sampling, enforcement) in kinds {
        let held = tilted(mu, mu * 0.995, sampling, enforcement).unwrap_or_else(|e| panic!("{enforcement:?}: {e:?}"));
        let total = force(&held, 0);
        let weight = v(-mu * 0.995, 1.0, 0.0) * 0.5e-3;
        assert!((total - weight).norm() < 1e-8 * weight.norm(), "{total}");
        let slides = tilted(mu, mu * 1.005, sampling, enforcement);
        let free = matches!(&slides, Err(IncrementError::Free { .. } | IncrementError::NotConverged { .. }));
        assert!(free, "{enforcement:?}: {slides:?}");
    }
}

#[test]
fn a_wedge_needs_the_force_of_statics() {
    for (tangent, mu) in [(0.1, 0.0), (0.1, 0.3), (0.25, 0.35)] {
        for (sampling, enforcement) in [
            (Test::from(Sampling::GaussPoints), Enforcement::AugmentedLagrangian),
            (Test::from(Sampling::Nodes), Enforcement::Multiplier),
            (Test::Mortar(0), Enforcement::Multiplier),
            (Test::Mortar(0), Enforcement::AugmentedLagrangian),
        ] {
            let mut system = System::default();
            let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [4, 4], 1, |mut x| {
                x[1] += tangent * x[0] * (1.0 - x[1]);
                x
            });
            system.bodies.push(Box::new(solid("wedge", mesh, 2, ELASTIC, StressLaw::LinearElastic)));
            let normal = v(-tangent, 1.0, 0.0).normalize();
            system.bodies.push(Box::new(rigid(Plane { point: v(0.0, 0.0, 0.0), normal }, |_| v(0.0, 0.0, 0.0))));
            system.supports.push(hold(0, "left", [Some(0.05), None, None]));
            system.loads.push(load(0, "", TimedLoad::Force(Arc::new(|_, _| v(0.0, -1e-3, 0.0)))));
            touch(&mut system, [(0, "bottom"), (1, "")], sampling, enforcement, (mu > 0.0).then_some(mu));
            let (_, results) = run(&mut system, &[1.0]);
            let pushed = results[0].support_forces[0][0][0];
            let ratio = (tangent + mu) / (1.0 - mu * tangent);
            assert!((pushed / 1e-3 - ratio).abs() < 1e-7, "{tangent} {mu} {enforcement:?}: {} {ratio}", pushed / 1e-3);
        }
    }
}
