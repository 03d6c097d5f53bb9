//! Beams, cables and chains in systems of bodies: large rotations in one step, falls from afar, capstans.

use signorini_contact::Coulomb;
use signorini_geometry::Vector;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::{Cylinder, RigidShape};
use signorini_mechanics::*;
use signorini_rope::beam::Beam;
use signorini_rope::cable::Cable;
use signorini_rope::cable::element::Carries;
use signorini_rope::centreline::{Closure, Continuity};
use signorini_rope::chain::Chain;
use signorini_rope::chain::body::ReferenceLength;
use signorini_rope::path::Path;
use signorini_rope::section::Stiffness;
use std::sync::Arc;

type V = Vector<3>;
type TimeField = signorini_mechanics::system::TimeField;

fn part(body: usize, group: &str) -> Part {
    Part { body, group: (!group.is_empty()).then(|| group.to_string()) }
}

fn hold(group: &str, displacement: [Option<TimeField>; 3], rotation: [Option<TimeField>; 3]) -> Support {
    Support { name: group.into(), part: part(0, group), displacement, rotation, ..Support::default() }
}

fn zero() -> Option<TimeField> {
    Some(Arc::new(|_, _| 0.0))
}

fn load(group: &str, load: TimedLoad) -> PlacedLoad {
    PlacedLoad { name: group.into(), part: part(0, group), load }
}

fn rigid(shape: impl RigidShape + 'static) -> RigidBody {
    let zero = V::zeros();
    let centre = shape.centre();
    let motion = Motion::Prescribed(Arc::new(move |_| RigidMotion::new(zero, zero, zero)));
    RigidBody { name: "drum".into(), shape: Arc::new(shape), motion, centre, sites: Vec::new(), size: 1.0, mass: None }
}

fn touch(system: &mut System, sampling: Sampling, enforcement: Enforcement, mu: Option<f64>) {
    let of = |body: usize| (part(body, ""), system.bodies[body].as_ref());
    let mut contact = Contact::new("touch", of(0), of(1), sampling, enforcement).unwrap();
    contact.law.friction = mu.map(|mu| Box::new(Coulomb::isotropic(mu).unwrap()) as _);
    system.contacts.push(Box::new(contact));
}

fn run(system: &mut System, times: &[f64]) -> (SystemState, Vec<IncrementResult>) {
    system.prepare().unwrap();
    let mut state = system.start();
    let mut results = Vec::new();
    for &time in times {
        let mut history = Vec::new();
        let found = system.solve(&state, time, &mut |_, r| {
            history.push(r);
            true
        });
        let (next, result) =
            found.unwrap_or_else(|e| panic!("at {time} after {}: {e}\n{e:?}\n{}", told(&results), short(&history)));
        system.accept(&next).unwrap();
        state = next;
        results.push(result);
    }
    (state, results)
}

fn short(history: &[f64]) -> String {
    history.iter().map(|r| format!("{r:.0e} ")).collect()
}

fn told(results: &[IncrementResult]) -> String {
    results.iter().map(|r| format!("{} ", r.iterations)).collect()
}

#[test]
fn the_bend_of_45_degrees_in_one_step() {
    let angle = std::f64::consts::FRAC_PI_4;
    let path = Path::circle(V::new(0.0, 100.0, 0.0), -V::y(), V::x(), 100.0, angle).unwrap();
    let i = 1.0 / 12.0;
    let stiffness = Stiffness { axial: 1e7, shear: [0.5e7; 2], torsion: 1e7 * i, bending: [1e7 * i; 2] };
    let beam = Beam::new("bend", &path.sample(32, Continuity::C1).unwrap(), Some(V::z()), stiffness, 0.0).unwrap();
    let mut system = System::default();
    system.bodies.push(Box::new(beam.clone()));
    system.supports.push(hold("start", std::array::from_fn(|_| zero()), std::array::from_fn(|_| zero())));
    system.loads.push(load("end", TimedLoad::Force(Arc::new(|_, t| V::new(0.0, 0.0, 600.0 * t)))));
    let (state, results) = run(&mut system, &[1.0]);
    let x = beam.position(&state.bodies[0], beam.elements());
    println!("{x:?} {:?}", results[0].history);
    assert!((x - V::new(47.1504, 15.6848, 53.4748)).norm() < 1e-3, "{x:?}");
    assert!(results[0].iterations <= 12, "{:?}", results[0].history);
}

/// A cable that hangs far above a cylinder and falls onto it.
fn fall(cells: usize, height: f64, enforcement: Enforcement) -> (V, Vec<IncrementResult>) {
    let path = Path::points(&[V::new(-2.0, 0.0, height), V::new(2.0, 0.0, height)], Closure::Open).unwrap();
    let path = path.sample(cells, Continuity::C1).unwrap();
    let cable = Cable::new("cable", &path, 1e4, 0.0, Carries::TensionOnly, ReferenceLength::Length(6.0), 0.02).unwrap();
    let mut system = System::default();
    system.bodies.push(Box::new(cable));
    system.bodies.push(Box::new(rigid(Cylinder { point: V::zeros(), axis: V::y(), radius: 0.5 })));
    system.supports.push(hold("boundary", std::array::from_fn(|_| zero()), [None, None, None]));
    system.loads.push(load("", TimedLoad::BodyForce(Arc::new(|_, _| V::new(0.0, 0.0, -1.0)))));
    touch(&mut system, Sampling::GaussPoints, enforcement, None);
    let (_, results) = run(&mut system, &[1.0]);
    let force: V = results[0].sites[0].iter().map(SiteResult::force).sum();
    (force, results)
}

#[test]
fn a_slack_cable_falls_onto_a_cylinder() {
    let mut forces = Vec::new();
    for enforcement in [Enforcement::Penalty { wanted_penetration: None }, Enforcement::Multiplier] {
        let (force, results) = fall(12, 0.8, enforcement);
        println!("{enforcement:?}: {force:?} {}", told(&results));
        // Upright, and no more than the weight.
        assert!(force[0].abs() < 1e-6 && force[1] == 0.0 && force[2] > 2.0 && force[2] < 6.0, "{force:?}");
        forces.push(force[2]);
    }
    assert!((forces[0] / forces[1] - 1.0).abs() < 1e-4, "{forces:?}");
}

#[test]
fn a_slack_cable_falls_from_afar() {
    // From higher above than the cylinder is thick, to where it hangs over it; never round the other side. The higher the
    // ends, the more of the weight they bear.
    let mut before = fall(12, 0.8, Enforcement::Multiplier).0[2];
    for height in [1.5, 1.9] {
        let (force, results) = fall(12, height, Enforcement::Multiplier);
        println!("from {height}: {force:?} {}", told(&results));
        assert!(results[0].iterations <= 250, "{}", told(&results));
        assert!(force[0].abs() < 1e-6 && force[1] == 0.0 && force[2] > 1.0 && force[2] < before, "{force:?}");
        let gaps = || results[0].sites[0].iter().filter_map(|s| s.gap);
        let middle: Vec<f64> = results[0].sites[0].iter().filter(|s| s.x[0].abs() < 0.3).map(|s| s.x[2]).collect();
        assert!(middle.len() >= 4 && middle.iter().all(|z| *z > 0.4) && gaps().all(|g| g > -1e-6));
        before = force[2];
    }
}

/// A bar that is moved through a rope in one increment, and a rope that is taken through a bar.
#[test]
fn nothing_passes_through_in_one_increment() {
    let path = Path::points(&[V::new(-1.0, 0.0, 0.1), V::new(1.0, 0.0, 0.1)], Closure::Open).unwrap();
    let rope = || {
        Chain::new("rope", &path.sample(10, Continuity::C0).unwrap(), 10.0, ReferenceLength::Pretension(1.0), 0.01)
            .unwrap()
    };
    let bar = |motion: fn(f64) -> V| {
        let shape = Cylinder { point: V::zeros(), axis: V::y(), radius: 0.03 };
        let motion = Motion::Prescribed(Arc::new(move |t| RigidMotion::new(V::zeros(), V::zeros(), motion(t))));
        RigidBody {
            name: "bar".into(),
            shape: Arc::new(shape),
            motion,
            centre: V::zeros(),
            sites: Vec::new(),
            size: 0.06,
            mass: None,
        }
    };
    let system = |bar: RigidBody, ends: fn(f64) -> f64| {
        let mut system = System::default();
        system.bodies.push(Box::new(rope()));
        system.bodies.push(Box::new(bar));
        system.supports.push(hold(
            "boundary",
            [zero(), zero(), Some(Arc::new(move |_, t| ends(t)))],
            [None, None, None],
        ));
        touch(&mut system, Sampling::Nodes, Enforcement::Multiplier, None);
        system.prepare().unwrap();
        system
    };
    // The bar goes up by twice its thickness and more: told, and solved in increments of half of it.
    let mut pushed = system(bar(|t| V::z() * (0.3 * t)), |_| 0.0);
    let start = pushed.start();
    let found = pushed.solve(&start, 1.0, &mut |_, _| true);
    assert!(matches!(found, Err(IncrementError::PassesThrough { .. })), "{found:?}");
    let mut state = start;
    for k in 1..=10 {
        let (next, result) = pushed.solve(&state, 0.1 * f64::from(k), &mut |_, _| true).unwrap();
        pushed.accept(&next).unwrap();
        if k == 10 {
            let force: V = result.sites[0].iter().map(SiteResult::force).sum();
            // The node over the bar is pushed up to 0.3 + 0.04, of ends at 0.1.
            let (l, h) = (1f64.hypot(0.24), 0.24);
            let tension = 10.0 * (l * (1.0 + 0.1) - 1.0);
            println!("force {force:?}, of a rope that is bent once {}", 2.0 * tension * h / l);
            assert!((force[2] / (2.0 * tension * h / l) - 1.0).abs() < 1e-6 && force[2] > 0.0, "{force:?}");
        }
        state = next;
    }
    // The ends go down by as much in one step: the rope stays above.
    let mut pulled = system(bar(|_| V::zeros()), |t| -0.3 * t);
    let start = pulled.start();
    let (state, result) = pulled.solve(&start, 1.0, &mut |_, _| true).unwrap();
    let middle = state.bodies[0].configuration[3 * 5 + 2];
    let force: V = result.sites[0].iter().map(SiteResult::force).sum();
    println!("middle at {middle}, force {force:?}, {} iterations", result.iterations);
    assert!((middle - 0.04).abs() < 1e-9 && force[2] > 0.0);
}

fn capstan(cells: usize, sampling: Sampling, enforcement: Enforcement) -> Vec<IncrementResult> {
    let turn = std::f64::consts::PI * 1.5;
    let path = Path::circle(V::zeros(), V::x(), V::z(), 1.02, turn).unwrap().sample(cells, Continuity::C0).unwrap();
    let mut system = System::default();
    let chain = Chain::new("rope", &path, 1e3, ReferenceLength::Pretension(1.0), 0.02).unwrap();
    system.bodies.push(Box::new(chain));
    system.bodies.push(Box::new(rigid(Cylinder { point: V::zeros(), axis: V::y(), radius: 1.0 })));
    system.supports.push(hold("start", std::array::from_fn(|_| zero()), [None, None, None]));
    system.supports.push(hold("", [None, zero(), None], [None, None, None]));
    system.loads.push(load("end", TimedLoad::Force(Arc::new(|_, t| V::x() * 1.05f64.powf(t)))));
    touch(&mut system, sampling, enforcement, Some(0.3));
    let times: Vec<f64> = (0..=16).map(f64::from).collect();
    run(&mut system, &times).1
}

#[test]
fn a_capstan_takes_few_iterations() {
    for cells in [40, 100] {
        for (sampling, enforcement) in [
            (Sampling::Nodes, Enforcement::Penalty { wanted_penetration: None }),
            (Sampling::Nodes, Enforcement::Multiplier),
        ] {
            let results = capstan(cells, sampling, enforcement);
            println!("{cells} {enforcement:?}: {}", told(&results));
            // However far the slip zone grows; the first increment starts from no friction at all.
            let most = |k: usize| if k == 0 { 5 } else { 4 };
            assert!(results[1..].iter().enumerate().all(|(k, r)| r.iterations <= most(k)), "{}", told(&results));
            // Tension falls by exp(-μ φ) from the end to where it sticks.
            let last = &results[16].sites[0];
            let slips: f64 =
                last.iter().filter(|s| s.status == signorini_contact::Status::Slip).map(|s| s.weight).sum();
            let known = 16.0 * 1.05f64.ln() / 0.3 * 1.02;
            let cell = 1.5 * std::f64::consts::PI * 1.02 / cells as f64;
            assert!((slips - known).abs() < 2.0 * cell, "{slips} {known}");
        }
    }
}

/// A rope between a held end and a spring, pulled where the spring is: both resist by what they are stretched.
#[test]
fn a_sprung_end_gives_way() {
    let path = Path::points(&[V::zeros(), V::x()], Closure::Open).unwrap().sample(8, Continuity::C0).unwrap();
    let (stiffness, spring) = (100.0, 10.0);
    let rope = Chain::new("rope", &path, stiffness, ReferenceLength::Pretension(1.0), 0.0).unwrap();
    let mut system = System::default();
    system.bodies.push(Box::new(rope.clone()));
    system.supports.push(hold("start", std::array::from_fn(|_| zero()), [None, None, None]));
    system.loads.push(load("end", TimedLoad::Springs(V::new(spring, spring, spring))));
    system.loads.push(load("end", TimedLoad::Force(Arc::new(|_, t| V::x() * (1.0 + t)))));
    let (state, _) = run(&mut system, &[0.5, 1.0]);
    // The rope is stretched from its length without tension, the spring from the start.
    let axial = stiffness * (1.0 + 1.0 / stiffness);
    let moved = 1.0 / (axial + spring);
    let tension = rope.tensions(&state.bodies[0])[0];
    assert!((tension - (1.0 + axial * moved)).abs() < 1e-9 && tension < 2.0 - 0.05, "{tension}");
}
