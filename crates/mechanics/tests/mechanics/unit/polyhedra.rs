//! Rigid polyhedra in motion: they meet by facets, edges and corners.

use super::rigid_dynamics::{FREE, centre, run, system, touch};
use crate::common::{at_rest, v};
use nalgebra::Rotation3;
use signorini_geometry::mass_properties::MassProperties;
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::rigid_shape::{Polyhedron, RigidShape};
use signorini_geometry::{Point, Vector};
use signorini_mechanics::Part;
use signorini_mechanics::rigid_body::{Motion, RigidBody, RigidMass, RigidSite};
use signorini_mechanics::system::{PlacedLoad, System, TimedLoad};
use std::sync::Arc;

/// A box of density one about a point, turned.
fn block(half: [f64; 3], at: Vector<3>, turn: Vector<3>, motion: Motion) -> RigidBody {
    let turned = Rotation3::from_scaled_axis(turn);
    let corner = |k: usize| -> Point<3> {
        at + turned * Point::<3>::from_fn(|i, _| if k >> i & 1 == 1 { half[i] } else { -half[i] })
    };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> = faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect();
    let mesh = TriangleMesh::new((0..8).map(corner).collect(), &triangles).unwrap();
    let sites = mesh.vertices().iter().map(|x| RigidSite { x: *x, outward: Some(x - at), radius: 0.0, weight: 1.0 });
    let (sites, size) = (sites.collect(), mesh.size());
    let shape = Polyhedron::new(mesh).unwrap();
    let MassProperties { volume, centre, inertia } = shape.mass_properties().unwrap();
    let zero = Vector::<3>::zeros();
    let mass = Some(RigidMass { mass: volume, inertia, velocity: zero, angular_velocity: zero });
    RigidBody { name: "block".into(), shape: Arc::new(shape), motion, centre, sites, size, mass }
}

/// Gravity of ten on every free body.
fn fall(system: &mut System) {
    for k in 0..system.bodies.len() {
        let Some(mass) = system.bodies[k].mass(&[]).unwrap().filter(|_| system.bodies[k].unknowns() > 0) else {
            continue;
        };
        let weight = v(0.0, 0.0, -10.0 * mass.blocks[0].1[0]);
        let load = TimedLoad::Force(Arc::new(move |_, _| weight));
        system.loads.push(PlacedLoad { name: "gravity".into(), part: Part::from(k), load });
    }
}

/// A bar falls on another one across it, edge on edge, and on its flat side: it rebounds to where it came from.
#[test]
fn bars_strike_edge_on_edge_and_side_on_side() {
    let quarter = std::f64::consts::FRAC_PI_4;
    for (turn, low) in [(quarter, 0.2 * 2f64.sqrt()), (0.0, 0.2)] {
        for steps in [3, 20] {
            let upper = block([1.0, 0.1, 0.1], v(0.0, 0.0, low + 0.2), v(turn, 0.0, 0.0), FREE);
            let lower = block([0.1, 1.0, 0.1], v(0.0, 0.0, 0.0), v(0.0, turn, 0.0), at_rest());
            let mut both = system(vec![upper, lower]);
            fall(&mut both);
            touch(&mut both, [0, 1], 0.0, 1.0);
            let end = run(&mut both, 0.4, steps, |_, _| {});
            assert!((centre(&end, 0)[2] - low - 0.2).abs() < 1e-9, "{turn} {steps}: {}", centre(&end, 0));
            assert!(end.velocities[2].abs() < 1e-8, "{turn} {steps}: {:?}", end.velocities);
        }
    }
}

/// Boxes of one size on each other, whose corners lie on each other, rest; so does a larger one on a smaller one. One that
/// overhangs by more than half falls.
#[test]
fn stacks_rest_and_overhangs_fall() {
    let half = [0.5, 0.5, 0.5];
    let stack = |over: f64, wide: f64| {
        let base = block(half, v(0.0, 0.0, 0.0), v(0.0, 0.0, 0.0), at_rest());
        let middle = block(half, v(0.0, 0.0, 1.0), v(0.0, 0.0, 0.0), FREE);
        let top = block([wide, 0.5, 0.5], v(over, 0.0, 2.0), v(0.0, 0.0, 0.0), FREE);
        let mut all = system(vec![base, middle, top]);
        fall(&mut all);
        touch(&mut all, [1, 0], 0.5, 0.0);
        touch(&mut all, [2, 1], 0.5, 0.0);
        let end = run(&mut all, 0.3, 6, |_, _| {});
        end.velocities.iter().map(|v| v.abs()).fold(0.0, f64::max)
    };
    assert_eq!(stack(0.0, 0.5), 0.0);
    assert_eq!(stack(0.0, 1.0), 0.0);
    assert_eq!(stack(0.49, 0.5), 0.0);
    assert!(stack(0.51, 0.5) > 0.01);
}
