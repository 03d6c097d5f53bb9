//! Two flat blocks pressed on each other, over a ladder of sizes: `cargo bench -p signorini-solid`. The largest size is given by
//! `SIGNORINI_LADDER` (unknowns; 50 000 if left out).

use signorini_fem::block::block;
use signorini_geometry::Vector;
use signorini_mechanics::system::TimeField;
use signorini_mechanics::*;
use signorini_solid::{Elastic, SolidBody, Space, StressLaw};
use std::sync::Arc;
use std::time::Instant;

fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| from + (to - from) * k as f64 / n as f64).collect()
}

fn solid(name: &str, low: f64, n: usize) -> Box<dyn Body> {
    let mesh = block::<3>(&[even(0.0, 10.0, n), even(0.0, 10.0, n), even(low, low + 1.0, 3)], 1, |x| x);
    let groups = mesh.groups().clone();
    let law = (Elastic { youngs_modulus: 1000.0, poissons_ratio: 0.3 }, StressLaw::LinearElastic);
    Box::new(SolidBody::<3>::new(name, Arc::new(mesh), 1, law, Space::Solid, groups).expect("a solid"))
}

fn part(body: usize, group: &str) -> Part {
    Part { body, group: Some(group.into()) }
}

fn hold(body: usize, group: &str, which: [bool; 3]) -> Support {
    let zero = || -> TimeField { Arc::new(|_, _| 0.0) };
    let displacement = which.map(|is_held| is_held.then(zero));
    Support { name: group.into(), part: part(body, group), displacement, ..Support::default() }
}

/// Seconds and iterations with small or finite sliding.
fn run(n: usize, slides_little: bool) {
    let mut system = System { bodies: vec![solid("lower", 0.0, n), solid("upper", 1.0, n)], ..System::default() };
    system.supports.push(hold(0, "bottom", [true; 3]));
    system.supports.push(hold(1, "left", [true, false, false]));
    system.supports.push(hold(1, "front", [false, true, false]));
    let pressure = TimedLoad::Traction(Arc::new(|x, _| Vector::<3>::new(0.0, 0.0, -1.0 - 0.1 * x[0])));
    system.loads.push(PlacedLoad { name: "p".into(), part: part(1, "top"), load: pressure });
    let side = |body: usize, group: &str| (part(body, group), system.bodies[body].as_ref());
    let mut contact = Mortar::new("touch", side(1, "bottom"), side(0, "top"), Enforcement::Multiplier).expect("faces");
    if slides_little {
        contact.slides_little();
    }
    system.contacts.push(Box::new(contact));
    system.prepare().expect("a system");
    let start = Instant::now();
    let (_, result) = system.solve(&system.start(), 0.0, &mut |_, _| true).expect("a state");
    println!(
        "{:>7} unknowns, {} sliding: {} iterations, {:.2} s",
        result.unknowns,
        if slides_little { "small" } else { "finite" },
        result.iterations,
        start.elapsed().as_secs_f64()
    );
}

fn main() {
    let largest: f64 = std::env::var("SIGNORINI_LADDER").ok().and_then(|v| v.parse().ok()).unwrap_or(50_000.0);
    for n in [10usize, 20, 30, 45, 60, 100] {
        if 24.0 * ((n + 1) as f64).powi(2) <= largest {
            [true, false].into_iter().for_each(|slides_little| run(n, slides_little));
        }
    }
}
