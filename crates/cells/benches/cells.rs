//! Finite cells: `cargo bench -p signorini-cells`.
//!
//! An eighth of a ball on a rigid plane, by degree and by number of cells. A line tells the unknowns, the time to integrate the
//! cut cells with the stiffness of each, to assemble residual and tangent with contact at the recovered boundary (Nitsche's
//! method), and the iterations and the time of the increment. The largest size is given by `SIGNORINI_LADDER` (unknowns; 7000
//! if left out).

use signorini_cells::shapes::ball;
use signorini_cells::{
    CellBody, CellMaterial, CellSolid, CellTree, Discretisation, Domain, Elastic, Place, Region, Space,
};
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::Plane;
use signorini_geometry::{Aabb, Vector};
use signorini_mechanics::system::TimeField;
use signorini_mechanics::*;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

type V = Vector<3>;

fn run(degree: usize, n: usize) {
    let start = Instant::now();
    let region: Arc<dyn Region<3>> = Arc::new(Domain::shape(ball(V::z(), 1.0)));
    let tree = CellTree::new(Aabb::new(V::zeros(), V::new(1.0, 1.0, 1.0)), [n; 3]).expect("cells");
    let elastic = Elastic { youngs_modulus: 1.0, poissons_ratio: 0.3 };
    let material = CellMaterial { solid: elastic.into(), modulus: None, space: Space::Solid };
    let body = CellBody::new(region, tree, Discretisation::of_degree(degree), material).expect("a body");
    let sides = [("left", Place::low(0)), ("front", Place::low(1)), ("top", Place::high(2))];
    let places: BTreeMap<String, Place<3>> = sides.map(|(name, side)| (name.to_string(), side)).into();
    let ball = CellSolid::new("ball", body, &places).expect("a solid");
    let integrated = start.elapsed().as_secs_f64();
    let plane = RigidBody {
        name: "plane".into(),
        shape: Arc::new(Plane { point: V::zeros(), normal: V::z() }),
        motion: Motion::Prescribed(Arc::new(|_| RigidMotion::new(V::zeros(), V::zeros(), V::zeros()))),
        centre: V::zeros(),
        sites: Vec::new(),
        size: 1.0,
        mass: None,
    };
    let mut system = System { bodies: vec![Box::new(ball), Box::new(plane)], ..System::default() };
    let part = |group: &str| Part { body: 0, group: Some(group.into()) };
    for (axis, group) in ["left", "front", "top"].into_iter().enumerate() {
        let mut support = Support { name: group.into(), part: part(group), ..Support::default() };
        let down: TimeField = Arc::new(move |_, t| if axis == 2 { -0.05 * t } else { 0.0 });
        support.displacement[axis] = Some(down);
        system.supports.push(support);
    }
    let touching = [(part("boundary"), 0), (Part::from(1), 1)];
    let [slave, master] = touching.map(|(part, body)| (part, system.bodies[body].as_ref()));
    let contact = Contact::new("touch", slave, master, Sampling::GaussPoints, Enforcement::Nitsche).expect("points");
    system.contacts.push(Box::new(contact));
    system.prepare().expect("a system");
    let start = Instant::now();
    let (state, result) = system.solve(&system.start(), 1.0, &mut |_, _| true).expect("a state");
    let solved = start.elapsed().as_secs_f64();
    let start = Instant::now();
    system.linearise(&state, 1.0).expect("a tangent");
    println!(
        "{degree:>6} {:>6} {:>8} {:>14.1} {:>12.1} {:>11} {:>12.1}",
        format!("{n}³"),
        result.unknowns,
        1e3 * integrated,
        1e3 * start.elapsed().as_secs_f64(),
        result.iterations,
        1e3 * solved,
    );
}

fn main() {
    let largest: f64 = std::env::var("SIGNORINI_LADDER").ok().and_then(|v| v.parse().ok()).unwrap_or(7000.0);
    println!("degree  cells unknowns integration ms  assembly ms  iterations  increment ms");
    for degree in 1..=4 {
        for n in [4, 6, 8, 12] {
            if 3.0 * ((degree * n + 1) as f64).powi(3) <= largest {
                run(degree, n);
            }
        }
    }
}
