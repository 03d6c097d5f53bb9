//! Two elastic blocks of different cells pressed on each other, without a case file: the system is built from its parts.
//!
//! `cargo run --release -p signorini-solid --example 05_system`

use signorini_fem::block::block;
use signorini_geometry::Vector;
use signorini_mechanics::{Body, Enforcement, Mortar, Part, PlacedLoad, Support, System, TimedLoad};
use signorini_solid::{Elastic, SolidBody, Space, StressLaw};
use std::sync::Arc;

const YOUNG: f64 = 1000.0;
const PRESSURE: f64 = 2.0;

/// A unit cube that stands at a height, of `n × n × n` cells of degree 1.
fn cube(name: &str, height: f64, n: usize) -> Box<dyn Body> {
    let even = |from: f64| -> Vec<f64> { (0..=n).map(|k| from + k as f64 / n as f64).collect() };
    let mesh = block::<3>(&[even(0.0), even(0.0), even(height)], 1, |x| x);
    let groups = mesh.groups().clone();
    let law = (Elastic { youngs_modulus: YOUNG, poissons_ratio: 0.3 }, StressLaw::LinearElastic);
    Box::new(SolidBody::<3>::new(name, Arc::new(mesh), 1, law, Space::Solid, groups).expect("a solid"))
}

fn part(body: usize, group: &str) -> Part {
    Part { body, group: Some(group.into()) }
}

/// Holds a side of a body along one axis.
fn hold(body: usize, group: &str, axis: usize) -> Support {
    let mut support = Support { name: group.into(), part: part(body, group), ..Support::default() };
    support.displacement[axis] = Some(Arc::new(|_, _| 0.0));
    support
}

pub fn main() {
    // 1. Bodies are named by their number: meshes of 3 and 4 cells along each edge do not match.
    let mut system = System { bodies: vec![cube("lower", 0.0, 3), cube("upper", 1.0, 4)], ..System::default() };

    // 2. Symmetry on two sides, a floor, and a pressure that grows with time.
    system.supports.push(hold(0, "bottom", 2));
    for body in 0..2 {
        system.supports.push(hold(body, "left", 0));
        system.supports.push(hold(body, "front", 1));
    }
    let load = TimedLoad::Traction(Arc::new(|_, time| Vector::<3>::new(0.0, 0.0, -PRESSURE * time)));
    system.loads.push(PlacedLoad { name: "press".into(), part: part(1, "top"), load });

    // 3. Contact: the first side is the slave, whose nodes carry the multipliers.
    let side = |body: usize, group: &str| (part(body, group), system.bodies[body].as_ref());
    let touch = Mortar::new("touch", side(1, "bottom"), side(0, "top"), Enforcement::Multiplier).expect("faces");
    system.contacts.push(Box::new(touch));

    // 4. One increment, from the start to time 1.
    system.prepare().expect("a system");
    let (state, result) = system.solve(&system.start(), 1.0, &mut |_, _| true).expect("an equilibrium");
    system.accept(&state).expect("a state");

    // 5. A column of height 2 under uniaxial stress becomes shorter by 2 p / E.
    let fields = system.bodies[1].fields(&state.bodies[1]);
    let lowest = fields.displacement.iter().map(|u| u[2]).fold(0.0, f64::min);
    let force: Vector<3> = result.sites[0].iter().map(|site| site.force()).sum();
    println!("{} unknowns, {} iterations", result.unknowns, result.iterations);
    println!("the top moves by {lowest:.10}, exact {:.10}; contact force {:.10}", -2.0 * PRESSURE / YOUNG, force[2]);
    assert!((lowest + 2.0 * PRESSURE / YOUNG).abs() < 1e-9 * PRESSURE / YOUNG);
    assert!((force - Vector::<3>::z() * PRESSURE).norm() < 1e-8 * PRESSURE);
}
