//! Supports and forces on single nodes, also in the middle of edges and faces.

use crate::system::{hold, load, part, run};
use signorini_fem::block::block;
use signorini_fem::{Group, Mesh, NodeBetween};
use signorini_geometry::{Point, Vector};
use signorini_mechanics::*;
use signorini_solid::{Elastic, SolidBody, Space, StressLaw};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Bent cells of order 2, `1 × 1 × 2`.
fn mesh() -> Mesh<3> {
    let even = |to: f64, n: usize| (0..=n).map(|k| to * k as f64 / n as f64).collect::<Vec<f64>>();
    block::<3>(&[even(1.0, 2), even(1.0, 1), even(2.0, 2)], 2, |x| x)
}

/// The nodes of a mesh that lie somewhere, without the sides and edges that they make.
fn nodes(mesh: &Mesh<3>, lie: impl Fn(&Point<3>) -> bool) -> Group {
    let vertices: BTreeSet<u32> = (0..mesh.cell_count()).flat_map(|c| mesh.vertices(c)).collect();
    let mut between: BTreeMap<u32, NodeBetween> = BTreeMap::new();
    for cell in 0..mesh.cell_count() {
        for (place, node) in mesh.cell_nodes(cell).iter().enumerate() {
            if !vertices.contains(node) && lie(&mesh.nodes()[*node as usize]) {
                between.entry(*node).or_insert(NodeBetween { node: *node, cell: cell as u32, place: place as u8 });
            }
        }
    }
    Group {
        vertices: vertices.into_iter().filter(|n| lie(&mesh.nodes()[*n as usize])).collect(),
        between: between.into_values().collect(),
        ..Group::default()
    }
}

fn body(mesh: Mesh<3>, groups: BTreeMap<String, Group>, degree: usize) -> System {
    let law = (Elastic { youngs_modulus: 7.0, poissons_ratio: 0.3 }, StressLaw::LinearElastic);
    let body = SolidBody::new("body", Arc::new(mesh), degree, law, Space::Solid, groups).unwrap();
    System { bodies: vec![Box::new(body)], ..System::default() }
}

/// A displacement of degree 2 without forces inside, held at all nodes of the boundary, is found everywhere.
#[test]
fn held_nodes_hold_what_their_sides_would() {
    let exact = |x: &Point<3>| Point::<3>::new(x[1] * x[2], x[0] * x[2], x[0] * x[1]);
    let mesh = mesh();
    let on_boundary = |x: &Point<3>| (0..3).any(|k| x[k] == 0.0 || x[k] == [1.0, 1.0, 2.0][k]);
    let groups = BTreeMap::from([("nodes".to_string(), nodes(&mesh, on_boundary))]);
    let mut system = body(mesh, groups, 2);
    let along = |i: usize| -> Option<system::TimeField> { Some(Arc::new(move |x: &Point<3>, _| exact(x)[i])) };
    system.supports.push(Support {
        name: "nodes".into(),
        part: part(0, "nodes"),
        displacement: std::array::from_fn(along),
        ..Support::default()
    });
    let (state, _) = run(&mut system, &[1.0]);
    let fields = system.bodies[0].fields(&state.bodies[0]);
    for (x, u) in fields.points.iter().zip(&fields.displacement) {
        assert!((u - exact(x)).norm() < 1e-12, "{u:?} at {x:?}");
    }
}

/// A node whose neighbours are free: its displacement is that of several functions.
#[test]
fn a_held_node_in_the_middle_of_an_edge_is_where_it_should_be() {
    let mesh = mesh();
    let at = Point::<3>::new(0.25, 0.0, 2.0);
    let middle = nodes(&mesh, |x| (x - at).norm() < 1e-12);
    assert_eq!((middle.vertices.len(), middle.between.len()), (0, 1));
    let groups =
        BTreeMap::from([("bottom".to_string(), nodes(&mesh, |x| x[2] == 0.0)), ("middle".to_string(), middle)]);
    let mut system = body(mesh, groups, 2);
    system.supports.push(hold(0, "bottom", [Some(0.0); 3]));
    system.supports.push(hold(0, "middle", [None, Some(0.125), None]));
    let (state, results) = run(&mut system, &[1.0]);
    let fields = system.bodies[0].fields(&state.bodies[0]);
    let k = fields.points.iter().position(|x| (x - at).norm() < 1e-12).expect("a point");
    assert!((fields.displacement[k][1] - 0.125).abs() < 1e-12, "{:?}", fields.displacement[k]);
    let [bottom, node] = [0, 1].map(|s| results[0].support_forces[s][0]);
    assert!(node[1] > 1e-3 && (bottom + node).norm() < 1e-12, "{bottom:?} {node:?}");
}

/// The resultant of forces on nodes is their sum, and their work that of the displacements of the nodes (Betti).
#[test]
fn forces_on_nodes_act_there() {
    let mesh = mesh();
    let at = Point::<3>::new(0.25, 0.0, 2.0);
    let groups = BTreeMap::from([
        ("bottom".to_string(), nodes(&mesh, |x| x[2] == 0.0)),
        ("top".to_string(), nodes(&mesh, |x| x[2] == 2.0)),
        ("middle".to_string(), nodes(&mesh, |x| (x - at).norm() < 1e-12)),
    ]);
    let mut system = body(mesh, groups, 2);
    let of = |state: &SystemState, system: &System, lie: &dyn Fn(&Point<3>) -> bool| -> Vector<3> {
        let fields = system.bodies[0].fields(&state.bodies[0]);
        let mut seen: Vec<Point<3>> = Vec::new();
        let mut sum = Vector::<3>::zeros();
        for (x, u) in fields.points.iter().zip(&fields.displacement).filter(|(x, _)| lie(x)) {
            if seen.iter().all(|y| (x - y).norm() > 1e-9) {
                seen.push(*x);
                sum += u;
            }
        }
        sum
    };
    system.supports.push(hold(0, "bottom", [Some(0.0); 3]));
    let force = |v: Vector<3>| TimedLoad::NodalForce(Arc::new(move |_, _| v));
    system.loads.push(load(0, "top", force(Vector::<3>::new(0.0, 0.0, 0.01))));
    let (pulled, results) = run(&mut system, &[1.0]);
    assert!((results[0].support_forces[0][0][2] + 15.0 * 0.01).abs() < 1e-12, "{:?}", results[0].support_forces);
    let moved = of(&pulled, &system, &|x| (x - at).norm() < 1e-12);
    system.loads[0] = load(0, "middle", force(Vector::<3>::new(0.02, 0.0, 0.0)));
    let (pushed, _) = run(&mut system, &[1.0]);
    let there = of(&pushed, &system, &|x| x[2] == 2.0);
    assert!((0.02 * moved[0] - 0.01 * there[2]).abs() < 1e-12 * moved.norm(), "{moved:?} {there:?}");
}
