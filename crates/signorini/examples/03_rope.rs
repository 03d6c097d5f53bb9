//! A rope over a drum with friction, drawn over it: the ratio of its tensions is that of Euler and Eytelwein.
//!
//! `cargo run --release --example 03_rope`

use signorini::problem::{
    Body, Contact, CoulombFriction, Cylinder, Friction, List, Load, Path, Problem, Rigid, Rope, Shape, Space, Step,
    Support, Value,
};
use signorini::run::{Silent, solve};
use std::f64::consts::PI;

const MU: f64 = 0.3;
/// Straight elements of the rope on the drum, and of each part that hangs down.
const ROUND: usize = 40;
const STRAIGHT: usize = 4;

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut problem = Problem::new(Space::ThreeD);

    // 1. A rope half round a drum of radius 1, with parts that hang down on both sides, under a tension of 1.
    let edge = 2.0 * (0.5 * PI / ROUND as f64).sin();
    let hanging = |x: f64, k: usize| [x, 0.0, -edge * k as f64];
    let round = (0..=ROUND).map(|k| PI * k as f64 / ROUND as f64).map(|a| [-a.cos(), 0.0, a.sin()]);
    let points = (1..=STRAIGHT).rev().map(|k| hanging(-1.0, k)).chain(round);
    let points: Vec<List<Value>> = points.chain((1..=STRAIGHT).map(|k| hanging(1.0, k))).map(|p| p.into()).collect();
    let rope = Rope {
        cells: Some((ROUND + 2 * STRAIGHT) as i64),
        path: Path::Points(points.into()),
        stiffness: 1000.0.into(),
        radius: None,
        pretension: Some(1.0.into()),
        unstrained_length: None,
        continuity: None,
        bending_stiffness: None,
        contact_points: None,
        pulleys: None,
        winch: None,
        mass_per_length: None,
        velocity: None,
    };
    problem.bodies.insert("rope".into(), Body::Rope(rope));
    let drum = Cylinder { point: [0.0, 0.0, 0.0].into(), axis: Some([0.0, 1.0, 0.0].into()), radius: 1.0.into() };
    problem.bodies.insert("drum".into(), Body::Rigid(Rigid::new(Shape::Cylinder(drum))));

    // 2. A weight of 1 at its start; its end is drawn down. It stays in the plane.
    let weight = Load { on: "rope:start".into(), force: Some([0.0, 0.0, -1.0].into()), ..Load::default() };
    problem.loads.insert("weight".into(), weight);
    let held = |on: &str, displacement: [Value; 3]| Support {
        on: on.into(),
        displacement: Some(displacement.into()),
        ..Support::default()
    };
    problem.supports.insert("plane".into(), held("rope", ["free".into(), 0.0.into(), "free".into()]));
    problem.supports.insert("end".into(), held("rope:end", [0.0.into(), 0.0.into(), "-0.2*t".into()]));

    // 3. Friction of Coulomb.
    let friction = Friction::Coulomb(CoulombFriction { mu: MU.into(), axis: None, on: None });
    let touch = Contact { between: Some(["rope", "drum"].into()), friction: Some(friction), ..Contact::default() };
    problem.contacts.insert("touch".into(), touch);
    problem.steps.push(Step { to: 1.0.into(), increments: Some(4), ..Step::default() });

    // 4. The tension of the end over that of the start.
    let outcome = solve(&problem, &mut Silent)?;
    println!("{}", outcome.summary.verdict);
    let step = outcome.summary.steps.last().ok_or("no step")?;
    let rope = &step.curves["rope"];
    let (ratio, exact) = (rope.end_tension / rope.start_tension, (MU * PI).exp());
    println!("tensions {:.6} and {:.6}: ratio {ratio:.6}, exp(μπ) = {exact:.6}", rope.start_tension, rope.end_tension);
    assert!((ratio / exact - 1.0).abs() < 1e-4, "{ratio}");
    Ok(())
}
