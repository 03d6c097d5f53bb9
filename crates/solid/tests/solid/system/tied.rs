//! Ties: the patch test, finite rotations with a gap that stays, rigid bodies, supports that meet them, tangents.

use super::*;
use signorini_geometry::rigid_shape::Sphere;
use signorini_mechanics::points::Order;
use signorini_mechanics::testing::{assembled, numbering, state as state_of};
use signorini_solid::Volumetric;

const FINITE: StressLaw = StressLaw::NeoHooke(Volumetric::Quadratic);

fn tie(system: &System, slave: (usize, &str), master: (usize, &str), test: Test, within: Option<f64>) -> Tie {
    let of = |(body, group): (usize, &str)| (part(body, group), system.bodies[body].as_ref());
    let how = match test {
        Test::Sites(sampling) => (Some(sampling), Enforcement::AugmentedLagrangian),
        Test::Mortar(_) => (None, Enforcement::Multiplier),
    };
    Tie::new("tie", of(slave), of(master), how, within).unwrap()
}

/// A block on one with another mesh, with a gap between them.
fn stack(law: &StressLaw, gap: f64, counts: [usize; 2]) -> System {
    let [low, high] = counts;
    let lower = solid("lower", cuboid([0.0; 3], [1.0; 3], [low; 3], |x| x), 1, ELASTIC, law.clone());
    let at = [0.3 * gap, 0.0, 1.0 + gap];
    let upper = solid("upper", cuboid(at, [1.0 + at[0], 1.0, 2.0 + gap], [high; 3], |x| x), 1, ELASTIC, law.clone());
    System { bodies: vec![Box::new(lower), Box::new(upper)], ..System::default() }
}

/// Uniaxial tension of a stack, of which supports hold sides that end at the tie: exact, pulled and not pressed.
#[test]
fn a_tied_stack_passes_the_patch_test() {
    for (test, tolerance) in [(Test::Mortar(0), 1e-10), (Test::Sites(Sampling::GaussPoints), 1e-8)] {
        let mut system = stack(&StressLaw::LinearElastic, 0.0, [2, 3]);
        system.contacts.push(Box::new(tie(&system, (1, "bottom"), (0, "top"), test, None)));
        system.supports.push(hold(0, "bottom", [None, None, Some(0.0)]));
        for body in [0, 1] {
            system.supports.push(hold(body, "left", [Some(0.0), None, None]));
            system.supports.push(hold(body, "front", [None, Some(0.0), None]));
        }
        system.loads.push(load(1, "top", TimedLoad::Traction(Arc::new(|_, _| v(0.0, 0.0, 0.01)))));
        let (state, results) = run(&mut system, &[1.0]);
        for (body, own) in system.bodies.iter().zip(&state.bodies) {
            let fields = body.fields(own);
            for (x, u) in fields.points.iter().zip(&fields.displacement) {
                let exact = v(-0.003 * x[0], -0.003 * x[1], 0.01 * x[2]);
                assert!((u - exact).norm() < tolerance * 0.01, "{test:?}: {u} instead of {exact}");
            }
        }
        let pull = force(&results[0], 0);
        assert!((pull - v(0.0, 0.0, -0.01)).norm() < tolerance, "{test:?}: {pull}");
        // A stack that is held by its tie is no free body: it is found at once.
        assert!(results[0].iterations <= 4 || test != Test::Mortar(0), "{}", results[0].iterations);
    }
}

/// A quarter turn of the lower block with a gap between both: the upper one follows without strain, and its gap with it.
#[test]
fn a_tie_turns_without_strain() {
    for test in [Test::Mortar(0), Test::Sites(Sampling::Nodes)] {
        let mut system = stack(&FINITE, 0.05, [1, 2]);
        system.contacts.push(Box::new(tie(&system, (1, "bottom"), (0, "top"), test, Some(0.1))));
        let angle = |t: f64| 0.5 * std::f64::consts::PI * t;
        let (x, z): (TimeField, TimeField) = (
            Arc::new(move |x, t| (angle(t).cos() - 1.0) * x[0] + angle(t).sin() * x[2]),
            Arc::new(move |x, t| -angle(t).sin() * x[0] + (angle(t).cos() - 1.0) * x[2]),
        );
        let zero: TimeField = Arc::new(|_, _| 0.0);
        let displacement = [Some(x), Some(zero), Some(z)];
        system.supports.push(Support { displacement, ..hold(0, "bottom", [None; 3]) });
        let (state, results) = run(&mut system, &[0.5, 1.0]);
        for (body, own) in system.bodies.iter().zip(&state.bodies) {
            let fields = body.fields(own);
            for (x, u) in fields.points.iter().zip(&fields.displacement) {
                assert!((x + u - v(x[2], x[1], -x[0])).norm() < 1e-8, "{test:?}: {x} moved by {u}");
            }
        }
        assert!(force(&results[1], 0).norm() < 1e-8, "{test:?}");
    }
}

/// A ball that is glued to a block and pulled: forces and moments balance, with the arm of the ball as it turns.
#[test]
fn a_rigid_body_hangs_on_its_tie() {
    let mesh = cuboid([0.0; 3], [1.0; 3], [2; 3], |x| x);
    let mut system = System::default();
    system.bodies.push(Box::new(solid("block", mesh, 1, ELASTIC, FINITE)));
    let centre = Point::<3>::new(0.5, 0.5, 1.4);
    let shape = Sphere { center: centre, radius: 0.4 };
    let motion = Motion::Free { plane: false };
    let ball = RigidBody {
        name: "ball".into(),
        shape: Arc::new(shape),
        motion,
        centre,
        sites: Vec::new(),
        size: 0.8,
        mass: None,
    };
    system.bodies.push(Box::new(ball));
    system.contacts.push(Box::new(tie(&system, (0, "top"), (1, ""), Test::Mortar(0), Some(0.3))));
    system.supports.push(hold(0, "bottom", [Some(0.0); 3]));
    let pull = v(4e-3, 0.0, 6e-3);
    system.loads.push(load(1, "", TimedLoad::Force(Arc::new(move |_, _| pull))));
    let (state, results) = run(&mut system, &[1.0]);
    let sites = &results[0].sites[0];
    let [force, moment] =
        sites.iter().fold([Vector::<3>::zeros(); 2], |[f, m], s| [f + s.force(), m + s.x.cross(&s.force())]);
    let now = &state.bodies[1].configuration;
    let arm = v(now[0], now[1], now[2]);
    assert!((arm - centre).norm() > 0.01, "the ball moved to {arm}");
    assert!((force - pull).norm() < 1e-10 && (moment - arm.cross(&pull)).norm() < 1e-9, "{force} {moment}");
}

/// Residual and tangent against differences, away from equilibrium: faces with a gap, and a rigid body that turns.
#[test]
fn tangents_of_ties_are_exact() {
    let seed = &mut 11u64;
    for rigid in [false, true] {
        let mut system = stack(&StressLaw::LinearElastic, 0.05, [1, 1]);
        system.bodies[1] =
            Box::new(solid("upper", cuboid([0.01, 0.0, 1.05], [0.8, 1.0, 2.0], [1; 3], |x| x), 1, ELASTIC, FINITE));
        if rigid {
            let centre = Point::<3>::new(0.5, 0.5, 0.5);
            let shape = Sphere { center: centre, radius: 0.5 };
            let motion = Motion::Free { plane: false };
            let ball = RigidBody {
                name: "ball".into(),
                shape: Arc::new(shape),
                motion,
                centre,
                sites: Vec::new(),
                size: 1.0,
                mass: None,
            };
            system.bodies[0] = Box::new(ball);
        }
        let group = if rigid { "" } else { "top" };
        system.contacts.push(Box::new(tie(&system, (1, "bottom"), (0, group), Test::Mortar(0), Some(0.4))));
        system.prepare().unwrap();
        let (first, count) = numbering(&system);
        let start = system.start();
        let all = count + start.multipliers.len();
        let moved = |at: &SystemState, step: &[f64]| {
            let bodies = (system.bodies.iter().zip(&at.bodies).zip(&first))
                .map(|((b, s), f)| b.advance(s, &step[*f as usize..*f as usize + b.unknowns()], 1.0))
                .collect();
            state_of(bodies, at.multipliers.iter().zip(&step[count..]).map(|(m, s)| m + s).collect(), count)
        };
        let step: Vec<f64> = (0..all).map(|k| if k < count { 0.05 } else { 0.5 } * noise(seed)).collect();
        let at = moved(&start, &step);
        let (residual, tangent) = assembled(&system, &at, Order::Second).unwrap();
        let matrix = tangent.matrix(all);
        let mut dense = nalgebra::DMatrix::from_fn(all, all, |i, j| matrix.get(i, j));
        for (body, first) in system.bodies.iter().zip(&first) {
            for spin in body.spins() {
                let spin = spin.map(|s| (s + first) as usize);
                let moment = v(residual[spin[0]], residual[spin[1]], residual[spin[2]]).cross_matrix() * 0.5;
                (0..9).for_each(|k| dense[(spin[k / 3], spin[k % 3])] -= moment[(k / 3, k % 3)]);
            }
        }
        for j in 0..all {
            let of = |h: f64| {
                let mut step = vec![0.0; all];
                step[j] = h;
                assembled(&system, &moved(&at, &step), Order::First).unwrap().0
            };
            let h = 1e-6;
            let (plus, minus) = (of(h), of(-h));
            for i in 0..all {
                let difference = (plus[i] - minus[i]) / (2.0 * h);
                let error = (dense[(i, j)] - difference).abs();
                // Tractions that nothing determines are kept by a part of 1e-6.
                assert!(error < 2e-6 * dense.amax(), "rigid {rigid}, ({i}, {j}): {} {difference}", dense[(i, j)]);
            }
        }
    }
}

/// A place that is held until a time is free afterwards: the stress that it held goes, and comes back where it is held again.
#[test]
fn supports_begin_and_end() {
    let mesh = cuboid([0.0; 3], [1.0; 3], [1; 3], |x| x);
    let mut system = System::default();
    system.bodies.push(Box::new(solid("cube", mesh, 1, ELASTIC, StressLaw::LinearElastic)));
    system.supports.push(hold(0, "bottom", [Some(0.0); 3]));
    system.supports.push(Support { until: Some(1.0), ..hold(0, "top", [None, None, Some(0.1)]) });
    system.supports.push(Support { name: "again".into(), from: Some(2.0), ..hold(0, "top", [None, None, Some(0.1)]) });
    let (_, results) = run(&mut system, &[1.0, 2.0, 3.0]);
    let force = |k: usize, support: usize| results[k].support_forces[support][0].z;
    assert!(force(0, 1) > 0.05 && force(0, 2) == 0.0, "{} {}", force(0, 1), force(0, 2));
    assert!(force(1, 0).abs() < 1e-10 && force(1, 1) == 0.0 && force(1, 2) == 0.0, "free between");
    assert!((force(2, 2) - 3.0 * force(0, 1)).abs() < 1e-10, "{} {}", force(2, 2), force(0, 1));
}
