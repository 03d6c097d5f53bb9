//! A round membrane is pressed onto a curved floor: the problem is stated in plain types, solved in memory and read out.
//!
//! `cargo run --release --example 01_membrane`

use signorini::problem::{
    Body, Contact, Disc, Domain, GridMesh, Load, Membrane, Mesh, Problem, Rigid, Shape, Space, Step, Support, Value,
};
use signorini::run::{Silent, solve};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // 1. The space: a membrane is seen from above.
    let mut problem = Problem::new(Space::Plane);

    // 2. The membrane: a disc of radius one on a grid of 24 x 24 cells of degree 2, under a tension of one.
    let disc = Disc { radius: 1.0.into(), center: None };
    let grid = GridMesh { cells: Some([24, 24].into()), ..GridMesh::default() };
    let film =
        Membrane { domain: Some(Domain::Disc(disc)), mesh: Mesh::Grid(grid), degree: Some(2), tension: 1.0.into() };
    problem.bodies.insert("film".into(), Body::Membrane(film));

    // 3. The floor: a height as a function of the place. Evaluated on jets, it knows its derivatives.
    let height = Value::field(|[x, y, _]| (x * x + y * y * 2.0) * 0.05 - 0.1);
    problem.bodies.insert("floor".into(), Body::Rigid(Rigid::new(Shape::Height(height))));

    // 4. It is held at its rim, and pressed downwards by a load that grows with the time, an expression.
    let rim = Support { on: "film:boundary".into(), displacement: Some(0.0.into()), ..Support::default() };
    problem.supports.insert("rim".into(), rim);
    problem.loads.insert("press".into(), Load { on: "film".into(), normal: Some("-t".into()), ..Load::default() });

    // 5. The two may touch.
    let touch = Contact { between: Some(["film", "floor"].into()), ..Contact::default() };
    problem.contacts.insert("touch".into(), touch);

    // 6. The history: up to t = 1 in four increments.
    problem.steps.push(Step { to: 1.0.into(), increments: Some(4), ..Step::default() });

    // 7. Solve. What is wrong with a problem is told by its key: try a radius of -1.
    let outcome = solve(&problem, &mut Silent)?;
    println!("{}", outcome.summary.verdict);

    // 8. Figures of every step, as in summary.json ...
    println!("   time    area   force");
    for step in &outcome.summary.steps {
        let contact = &step.contacts["touch"];
        println!("{:7.3} {:7.4} {:7.4}", step.time, contact.area, contact.force[2]);
    }

    // 9. ... and the fields of the last state: points, cells, arrays.
    let last = outcome.states.last().ok_or("no state")?;
    let film = &last.bodies[0];
    let gap = film.array("gap").ok_or("no gap")?;
    let touching = gap.iter().filter(|g| **g < 1e-9).count();
    println!(
        "{touching} of {} points touch, the largest pressure is {:.4}",
        film.points.len(),
        film.largest("contact_pressure").unwrap_or(0.0)
    );
    Ok(())
}
