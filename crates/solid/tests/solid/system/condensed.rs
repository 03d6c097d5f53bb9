//! Linear bodies factorised once: the states are those of factors of the whole tangent.

use super::*;
use signorini_geometry::rigid_shape::Cylinder;

fn block_of(name: &str, low: [f64; 3], high: [f64; 3], cells: [usize; 3]) -> SolidBody<3> {
    solid(name, cuboid(low, high, cells, |x| x), 1, ELASTIC, StressLaw::LinearElastic)
}

/// Solves the same with and without condensation; displacements and forces must agree.
fn agrees(name: &str, times: &[f64], of: impl Fn() -> System) {
    let solve = |solver: LinearSolver| {
        let mut system = of();
        system.solver = solver;
        run(&mut system, times)
    };
    let (direct, expected) = solve(LinearSolver::Direct);
    let (state, results) = solve(LinearSolver::Automatic);
    assert_eq!(expected.last().unwrap().solved, Solved::Direct);
    for (found, expected) in results.iter().zip(&expected) {
        assert_eq!(found.solved, Solved::Condensed, "{name}");
        let sites = found.sites.iter().zip(&expected.sites).flat_map(|(a, b)| a.iter().zip(b));
        assert!(sites.clone().any(|(a, _)| a.pressure > 0.0), "{name}: nothing touches");
        let most = sites.clone().map(|(_, b)| b.pressure).fold(0.0f64, f64::max);
        for (a, b) in sites {
            assert!(
                (a.force() - b.force()).norm() <= 1e-9 * most * b.weight && a.status == b.status,
                "{name}: {a:?} {b:?}"
            );
        }
        assert!(found.iterations <= expected.iterations + 1, "{name}: {} {}", found.iterations, expected.iterations);
    }
    for (a, b) in state.bodies.iter().zip(&direct.bodies) {
        let size = b.configuration.iter().fold(0.0f64, |m, u| m.max(u.abs()));
        let off = a.configuration.iter().zip(&b.configuration).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(off <= 1e-9 * size, "{name}: {off} of {size}");
    }
}

#[test]
fn blocks_that_slide_on_each_other_with_friction() {
    for (test, enforcement) in [
        (Test::Mortar(0), Enforcement::Multiplier),
        (Test::Sites(Sampling::GaussPoints), Enforcement::Penalty { wanted_penetration: None }),
        (Test::Sites(Sampling::Nodes), Enforcement::Multiplier),
    ] {
        agrees(&format!("{test:?}"), &[1.0, 2.0], || {
            let mut system = System::default();
            system.bodies.push(Box::new(block_of("upper", [0.2, 0.1, 0.0], [0.8, 0.6, 0.5], [5, 5, 4])));
            system.bodies.push(Box::new(block_of("lower", [0.0, 0.0, -0.5], [1.0, 1.0, 0.0], [6, 6, 4])));
            system.supports.push(hold(1, "bottom", [Some(0.0); 3]));
            // First pressed, then drawn, all by time: what is held stays the same.
            let drawn: TimeField = Arc::new(|_, t| 0.02 * (t - 1.0).max(0.0));
            let pressed: TimeField = Arc::new(|_, t| -0.02 * t.min(1.0));
            let displacement = [Some(drawn.clone()), Some(drawn), Some(pressed)];
            system.supports.push(Support { displacement, ..hold(0, "top", [None; 3]) });
            touch(&mut system, [(0, "bottom"), (1, "top")], test, enforcement, Some(0.3));
            system
        });
    }
}

#[test]
fn a_block_on_springs_beside_a_body_at_finite_strain() {
    agrees("springs", &[0.5, 1.0], || {
        let mut system = System::default();
        system.bodies.push(Box::new(block_of("block", [0.0; 3], [1.0, 1.0, 0.5], [9, 9, 3])));
        let rubber = StressLaw::NeoHooke(signorini_solid::Volumetric::Quadratic);
        let mesh = cuboid([0.3, 0.3, 0.5], [0.7, 0.7, 0.9], [3, 3, 2], |x| x);
        system.bodies.push(Box::new(solid("rubber", mesh, 1, ELASTIC, rubber)));
        system.loads.push(load(0, "left", TimedLoad::Springs(v(0.02, 0.01, 0.03))));
        system.supports.push(hold(0, "bottom", [None, None, Some(0.0)]));
        system.supports.push(hold(1, "top", [Some(0.01), Some(0.0), Some(-0.02)]));
        touch(&mut system, [(1, "bottom"), (0, "top")], Test::Mortar(0), Enforcement::Multiplier, Some(0.4));
        system
    });
}

#[test]
fn a_zone_that_wanders_over_more_unknowns_than_remain() {
    // A cylinder rolls over a wide block: the surface that may touch has more unknowns than are kept at once.
    agrees("roller", &[1.0, 4.0], || {
        let mut system = System::default();
        let mesh = cuboid([0.0, 0.0, -0.3], [4.0, 2.0, 0.0], [34, 19, 1], |x| x);
        system.bodies.push(Box::new(solid("bed", mesh, 1, ELASTIC, StressLaw::LinearElastic)));
        let cylinder = Cylinder { point: v(0.6, 0.0, 0.5), axis: v(0.0, 1.0, 0.0), radius: 0.5 };
        system.bodies.push(Box::new(rigid(cylinder, |t| v(0.9 * (t - 1.0), 0.0, -0.01 * t.min(1.0)))));
        system.supports.push(hold(0, "bottom", [Some(0.0); 3]));
        touch(&mut system, [(0, "top"), (1, "")], Test::Mortar(0), Enforcement::Multiplier, None);
        system
    });
}

/// Two rubber blocks of so many unknowns that multipliers are eliminated: the state is that of a factorisation of the whole
/// tangent, in the same iterations, without friction and with it.
#[test]
fn eliminated_multipliers_give_the_same_state() {
    let law = StressLaw::NeoHooke(signorini_solid::Volumetric::default());
    let solve = |mu: Option<f64>, solver: LinearSolver| {
        let mut system = System { solver, ..System::default() };
        for (name, low, high, cells) in [
            ("lower", [0.0, 0.0, 0.0], [10.0, 10.0, 2.0], [24, 24, 5]),
            ("upper", [4.1, 4.2, 2.0], [6.1, 5.9, 3.0], [4, 4, 2]),
        ] {
            system.bodies.push(Box::new(solid(name, cuboid(low, high, cells, |x| x), 1, ELASTIC, law.clone())));
        }
        let zero = Some(0.0);
        system.supports.push(hold(0, "bottom", [zero; 3]));
        system.supports.push(hold(1, "top", [Some(0.02), zero, Some(-0.05)]));
        touch(&mut system, [(1, "bottom"), (0, "top")], Test::Mortar(0), Enforcement::Multiplier, mu);
        let (state, results) = run(&mut system, &[1.0]);
        (state, results[0].clone())
    };
    for mu in [None, Some(0.3)] {
        let [(a, by_krylov), (b, direct)] = [LinearSolver::Automatic, LinearSolver::Direct].map(|s| solve(mu, s));
        assert_eq!((by_krylov.solved, direct.solved), (Solved::Eliminated, Solved::Direct), "{mu:?}");
        assert_eq!(by_krylov.iterations, direct.iterations, "{mu:?}");
        for (a, b) in a.bodies.iter().zip(&b.bodies) {
            let most = b.configuration.iter().fold(0.0f64, |m, u| m.max(u.abs()));
            let off = a.configuration.iter().zip(&b.configuration).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
            assert!(off < 1e-9 * most, "{mu:?}: {off:e}");
        }
    }
}
