//! Time of a warm shortest path per body: `cargo bench -p signorini-paths`.

use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::{Cylinder, Ellipsoid, RigidShape, Sphere, Torus};
use signorini_geometry::{Point, Vector};
use signorini_paths::wrapping::{Anchor, Body, Route, Station, Wrapping};
use std::time::Instant;

fn main() {
    let (origin, axis) = (Point::<3>::zeros(), Vector::<3>::z());
    let sphere = Sphere { center: origin, radius: 1.2 };
    let cylinder = Cylinder { point: origin, axis: Vector::<3>::new(0.1, 0.2, 1.0).normalize(), radius: 1.0 };
    let ellipsoid = Ellipsoid::new(origin, [2.0, 1.5, 1.0]).unwrap_or_else(|e| panic!("{e}"));
    let torus = Torus { center: origin, axis, major: 1.5, minor: 0.6 };
    let kinds: [(&str, Vec<&dyn RigidShape>); 5] = [
        ("sphere", vec![&sphere]),
        ("cylinder", vec![&cylinder]),
        ("ellipsoid", vec![&ellipsoid]),
        ("torus", vec![&torus]),
        ("all, four times", [&sphere as &dyn RigidShape, &cylinder, &ellipsoid, &torus].repeat(4)),
    ];
    println!("{:<18} {:>7} {:>11} {:>12} {:>10}", "bodies", "number", "steps/call", "us per call", "us/body");
    for (name, shapes) in kinds {
        let n = shapes.len();
        // In a row, the path over one and under the next.
        let place = |k: usize, t: f64| {
            let side = if k.is_multiple_of(2) { -0.6 } else { 0.6 };
            let turn = Vector::<3>::new(0.1, 0.05, 0.2 * (7.0 * t).sin());
            RigidMotion::new(
                turn,
                origin,
                Vector::<3>::new(6.0 * k as f64, side + 0.1 * (9.0 * t + k as f64).sin(), 0.1),
            )
        };
        let route = Route {
            start: Anchor::fixed(Point::<3>::new(-5.0, 0.0, 0.3)),
            stations: (0..n).map(|body| Station::Around { body, turns: 0 }).collect(),
            end: Anchor::fixed(Point::<3>::new(6.0 * n as f64 - 1.0, 0.0, -0.4)),
        };
        let mut wrapping = Wrapping::new(route);
        let calls = 4000 / n;
        let (mut steps, mut length, mut seconds) = (0, 0.0, 0.0);
        for call in 0..=calls {
            let t = call as f64 / calls as f64;
            let bodies: Vec<Body<'_>> =
                shapes.iter().enumerate().map(|(k, shape)| Body { shape: *shape, motion: place(k, t) }).collect();
            let start = Instant::now();
            let path = wrapping.solve(&bodies).unwrap_or_else(|e| panic!("{name}, call {call}: {e}"));
            if call > 0 {
                seconds += start.elapsed().as_secs_f64();
                steps += path.iterations;
                length += path.length;
            }
        }
        let per_call = 1e6 * seconds / calls as f64;
        let steps = steps as f64 / calls as f64;
        println!("{name:<18} {n:>7} {steps:>11.2} {per_call:>12.2} {:>10.2}", per_call / n as f64);
        assert!(length.is_finite());
    }
}
