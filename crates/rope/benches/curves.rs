//! Ropes and beams: `cargo bench -p signorini-rope`.
//!
//! A rope three quarters round a drum, pulled with friction, of straight elements and smooth, and a cantilever beam that is bent out of
//! its plane in one increment, by number of elements. A line tells the unknowns, the time to assemble residual and tangent, and
//! the iterations and the time of all increments. The largest number of elements is given by `SIGNORINI_LADDER` (200 if left
//! out).

use signorini_contact::Coulomb;
use signorini_geometry::Vector;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::Cylinder;
use signorini_mechanics::system::TimeField;
use signorini_mechanics::*;
use signorini_rope::beam::Beam;
use signorini_rope::cable::Cable;
use signorini_rope::cable::element::Carries;
use signorini_rope::centreline::Continuity;
use signorini_rope::chain::Chain;
use signorini_rope::chain::body::ReferenceLength;
use signorini_rope::path::Path;
use signorini_rope::section::Stiffness;
use std::f64::consts::{FRAC_PI_4, PI};
use std::sync::Arc;
use std::time::Instant;

type V = Vector<3>;

fn part(group: &str) -> Part {
    Part { body: 0, group: (!group.is_empty()).then(|| group.to_string()) }
}

fn held(group: &str, components: [bool; 3], turns: bool) -> Support {
    let zero = || -> TimeField { Arc::new(|_, _| 0.0) };
    let displacement = components.map(|is_held| is_held.then(zero));
    let rotation = components.map(|_| turns.then(zero));
    Support { name: group.into(), part: part(group), displacement, rotation, ..Support::default() }
}

fn load(group: &str, load: TimedLoad) -> PlacedLoad {
    PlacedLoad { name: group.into(), part: part(group), load }
}

/// Solves the increments and writes the line.
fn run(what: &str, elements: usize, increments: usize, mut system: System) {
    system.prepare().expect("a system");
    let start = Instant::now();
    let (mut state, mut iterations, mut unknowns) = (system.start(), 0, 0);
    for k in 1..=increments {
        let time = k as f64 / increments as f64;
        let (next, result) = system.solve(&state, time, &mut |_, _| true).expect("a state");
        system.accept(&next).expect("a state");
        (state, iterations, unknowns) = (next, iterations + result.iterations, result.unknowns);
    }
    let solved = start.elapsed().as_secs_f64();
    let start = Instant::now();
    system.linearise(&state, 1.0).expect("a tangent");
    let assembled = start.elapsed().as_secs_f64();
    println!(
        "{what:>14} {elements:>8} {unknowns:>8} {:>12.2} {increments:>10} {iterations:>10} {:>9.1}",
        1e3 * assembled,
        1e3 * solved
    );
}

fn wrapped(elements: usize, is_smooth: bool) {
    let path = Path::circle(V::zeros(), V::x(), -V::z(), 1.0, 1.5 * PI).expect("an arc");
    let rope: Box<dyn Body> = if is_smooth {
        let path = path.sample(elements, Continuity::C1).expect("elements");
        Box::new(
            Cable::new("rope", &path, 1e4, 0.0, Carries::TensionOnly, ReferenceLength::Pretension(1.0), 0.0)
                .expect("a rope"),
        )
    } else {
        let path = path.sample(elements, Continuity::C0).expect("elements");
        Box::new(Chain::new("rope", &path, 1e4, ReferenceLength::Pretension(1.0), 0.0).expect("a rope"))
    };
    let drum = RigidBody {
        name: "drum".into(),
        shape: Arc::new(Cylinder { point: V::zeros(), axis: V::y(), radius: 1.0 }),
        motion: Motion::Prescribed(Arc::new(|_| RigidMotion::new(V::zeros(), V::zeros(), V::zeros()))),
        centre: V::zeros(),
        sites: Vec::new(),
        size: 1.0,
        mass: None,
    };
    let mut system = System { bodies: vec![rope, Box::new(drum)], ..System::default() };
    system.supports.push(held("start", [true; 3], false));
    system.supports.push(held("", [false, true, false], false));
    system.loads.push(load("end", TimedLoad::Tension(Arc::new(|_, t| 1.0 + 2.0 * t))));
    let side = |body: usize| (Part::from(body), system.bodies[body].as_ref());
    let (sampling, how) = match is_smooth {
        true => (Sampling::GaussPoints, Enforcement::Penalty { wanted_penetration: None }),
        false => (Sampling::Nodes, Enforcement::Multiplier),
    };
    let mut contact = Contact::new("wrap", side(0), side(1), sampling, how).expect("points");
    contact.law.friction = Some(Box::new(Coulomb::isotropic(0.3).expect("a coefficient")));
    system.contacts.push(Box::new(contact));
    run(if is_smooth { "smooth rope" } else { "rope" }, elements, 4, system);
}

fn bent(elements: usize) {
    let path = Path::circle(V::new(0.0, 100.0, 0.0), -V::y(), V::x(), 100.0, FRAC_PI_4).expect("an arc");
    let inertia = 1.0 / 12.0;
    let stiffness = Stiffness { axial: 1e7, shear: [0.5e7; 2], torsion: 1e7 * inertia, bending: [1e7 * inertia; 2] };
    let path = path.sample(elements, Continuity::C1).expect("elements");
    let beam = Beam::new("beam", &path, Some(V::z()), stiffness, 0.0).expect("a beam");
    let mut system = System { bodies: vec![Box::new(beam)], ..System::default() };
    system.supports.push(held("start", [true; 3], true));
    system.loads.push(load("end", TimedLoad::Force(Arc::new(|_, t| V::z() * 600.0 * t))));
    run("beam", elements, 1, system);
}

fn main() {
    let largest: usize = std::env::var("SIGNORINI_LADDER").ok().and_then(|v| v.parse().ok()).unwrap_or(200);
    println!("          body elements unknowns  assembly ms increments iterations  total ms");
    for elements in [60, 200, 600, 2000, 6000].into_iter().filter(|n| *n <= largest) {
        wrapped(elements, false);
        wrapped(elements, true);
        bent(elements);
    }
}
