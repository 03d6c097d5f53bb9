//! An elastic block, a mesh of arrays, is pressed onto a rigid sphere: stated in plain types, solved in memory, read out.
//!
//! `cargo run --release --example 02_solid`

use signorini::problem::{
    Body, CellArrays, Contact, LinearElastic, Material, MeshArrays, Named, Problem, Rigid, Shape, Solid, SolidMesh,
    Space, Sphere, Support,
};
use signorini::run::{Silent, solve};

/// Cells along each edge of the block.
const CELLS: usize = 8;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut problem = Problem::new(Space::ThreeD);

    // 1. A mesh as arrays: points, hexahedra with eight points each in the order of Gmsh, and the points of the upper side.
    let n = CELLS + 1;
    let place = |k: usize| vec![k % n, k / n % n, k / (n * n)];
    let points: Vec<Vec<f64>> =
        (0..n * n * n).map(|k| place(k).iter().map(|i| *i as f64 / CELLS as f64).collect()).collect();
    let corner = |cell: usize| cell % CELLS + n * (cell / CELLS % CELLS) + n * n * (cell / (CELLS * CELLS));
    let hexahedron = |cell: usize| {
        let of = [0, 1, n + 1, n, n * n, n * n + 1, n * n + n + 1, n * n + n];
        of.iter().map(|step| (corner(cell) + step) as u32).collect::<Vec<u32>>()
    };
    let cells: Vec<Vec<u32>> = (0..CELLS * CELLS * CELLS).map(hexahedron).collect();
    let top: Vec<u32> = (n * n * CELLS..n * n * n).map(|k| k as u32).collect();
    let mesh = MeshArrays {
        points: points.into(),
        cells: vec![CellArrays { shape: "hexahedron".into(), nodes: cells.into() }].into(),
        groups: Named([("top".to_string(), top.into())].into()),
    };

    // 2. What it is made of.
    let steel = LinearElastic { youngs_modulus: 210e3.into(), poissons_ratio: 0.3.into() };
    let block = Solid {
        mesh: SolidMesh::Arrays(mesh),
        degree: Some(2),
        material: Material::LinearElastic(steel),
        strain: None,
        density: None,
        thermal: None,
        velocity: None,
        edges: Named::default(),
    };
    problem.bodies.insert("block".into(), Body::Solid(block));

    // 3. A rigid ball below it, and the upper side moved down by a hundredth.
    let ball = Sphere { center: [0.5, 0.5, -2.0].into(), radius: 2.0.into() };
    problem.bodies.insert("ball".into(), Body::Rigid(Rigid::new(Shape::Sphere(ball))));
    let top = Support { on: "block:top".into(), displacement: Some([0.0, 0.0, -0.01].into()), ..Support::default() };
    problem.supports.insert("press".into(), top);

    // 4. Contact by mortar multipliers, the default.
    let touch = Contact { between: Some(["block", "ball"].into()), ..Contact::default() };
    problem.contacts.insert("touch".into(), touch);

    // 5. Solve and read out.
    let outcome = solve(&problem, &mut Silent)?;
    println!("{}", outcome.summary.verdict);
    let last = outcome.states.last().ok_or("no state")?;
    let (block, zone) = (&last.bodies[0], last.contact("touch").ok_or("no contact")?);
    println!("von Mises at most {:.0} MPa", block.largest("von_mises").unwrap_or(0.0));
    println!("pressure at most {:.0} MPa", zone.largest("contact_pressure").unwrap_or(0.0));
    Ok(())
}
