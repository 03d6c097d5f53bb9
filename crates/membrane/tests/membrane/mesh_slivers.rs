//! Fronts that cut the cells of a mesh anywhere: the system stays positive definite.

use crate::common::{cells, on_mesh};
use signorini_geometry::{ClosedCurve, Point};
use signorini_membrane::equilibrium::{Elements, Equilibrium};
use signorini_membrane::obstacle::Side;
use signorini_membrane::plane_zone::PlaneZone;

/// Solves round many circles, some of them holes; the number of those that could not be solved.
fn failures(name: &str, degree: usize, circles: usize) -> usize {
    let membrane = on_mesh(cells(name, degree, 0));
    let mut elements = Elements::new(&membrane);
    (0..circles)
        .filter(|&i| {
            let t = i as f64;
            let radius = 0.12 + 0.5 * (0.37 * t).fract();
            let centre = 0.3 * Point::<2>::new((1.3 * t).sin(), (2.1 * t).cos());
            let circle = |r: f64, sense: f64| {
                let points: Vec<Point<2>> = (0..16)
                    .map(|k| {
                        let (sin, cos) = (sense * std::f64::consts::TAU * f64::from(k) / 16.0).sin_cos();
                        centre + r * Point::<2>::new(cos, sin)
                    })
                    .collect();
                (Side::Below, ClosedCurve::through(&points, 7))
            };
            let mut curves = vec![circle(radius, 1.0)];
            if i % 2 == 0 {
                curves.push(circle(0.6 * radius, -1.0));
            }
            let zone = PlaneZone::new(&membrane.grid, curves);
            Equilibrium::solve(&membrane, &zone, &mut elements).is_err()
        })
        .count()
}

#[test]
fn circles_anywhere_on_meshes_of_all_kinds() {
    for (name, degree) in [
        ("triangles_1_6", 1),
        ("triangles_2_6", 2),
        ("mixed_1_6", 1),
        ("mixed_2_6", 2),
        ("triangles_1_6", 2),
        ("annulus", 2),
    ] {
        let failed = failures(name, degree, 120);
        assert_eq!(failed, 0, "{name}, degree {degree}");
    }
}
