//! A round column of finite cells under a plate: its boundary runs through the cells, and its stiffness is E π r²/h.
//!
//! `cargo run --release --example 04_cells`

use signorini::problem::{
    Body, CellsBody, CellsGrid, CellsMesh, Contact, Cylinder, Geometry, LinearElastic, Material, Motion, Named, Plane,
    Prescribed, Problem, Rigid, Shape, Space, Support, Value,
};
use signorini::run::{Silent, solve};
use std::f64::consts::PI;

const YOUNG: f64 = 200.0;
const RADIUS: f64 = 0.8;
const HEIGHT: f64 = 1.0;
const DOWN: f64 = 0.01;

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut problem = Problem::new(Space::ThreeD);

    // 1. A quarter of the column, in a box of cells that know nothing of its boundary.
    let column = Cylinder { point: [0.0, 0.0, 0.0].into(), axis: Some([0.0, 0.0, 1.0].into()), radius: RADIUS.into() };
    let grid = CellsGrid {
        cells: Some([3, 3, 2].into()),
        min: Some([0.0, 0.0, 0.0].into()),
        max: Some([0.9, 0.9, HEIGHT].into()),
        ..CellsGrid::default()
    };
    let body = CellsBody {
        geometry: Geometry::Shape(Shape::Cylinder(column)),
        mesh: CellsMesh { grid },
        degree: Some(2),
        functions: None,
        integration: None,
        alpha: None,
        islands: None,
        material: Material::LinearElastic(LinearElastic { youngs_modulus: YOUNG.into(), poissons_ratio: 0.3.into() }),
        strain: None,
        density: None,
        velocity: None,
        groups: Named::default(),
    };
    problem.bodies.insert("column".into(), Body::Cells(Box::new(body)));

    // 2. Two planes of symmetry and a floor: sides of the box.
    for (side, axis) in [("left", 0), ("front", 1), ("bottom", 2)] {
        let mut displacement: [Value; 3] = ["free".into(), "free".into(), "free".into()];
        displacement[axis] = 0.0.into();
        let support =
            Support { on: format!("column:{side}"), displacement: Some(displacement.into()), ..Support::default() };
        problem.supports.insert(side.into(), support);
    }

    // 3. A plate above it, which goes down.
    let plane = Plane { point: [0.0, 0.0, HEIGHT].into(), normal: [0.0, 0.0, -1.0].into() };
    let motion = Prescribed { displacement: Some([0.0, 0.0, -DOWN].into()), rotation: None };
    let plate = Rigid { motion: Some(Motion::Prescribed(motion)), ..Rigid::new(Shape::Plane(plane)) };
    problem.bodies.insert("plate".into(), Body::Rigid(plate));
    let touch = Contact { between: Some(["column:top", "plate"].into()), ..Contact::default() };
    problem.contacts.insert("touch".into(), touch);

    // 4. The force, of a quarter.
    let outcome = solve(&problem, &mut Silent)?;
    println!("{}", outcome.summary.verdict);
    let step = outcome.summary.steps.last().ok_or("no step")?;
    let (force, exact) = (4.0 * -step.contacts["touch"].force[2], YOUNG * PI * RADIUS * RADIUS / HEIGHT * DOWN);
    println!("force {force:.8}, exact {exact:.8}");
    assert!((force / exact - 1.0).abs() < 1e-5, "{force}");
    Ok(())
}
