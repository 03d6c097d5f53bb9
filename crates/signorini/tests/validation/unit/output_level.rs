//! Of `output::level`.

use signorini::testing::{CUBES, region, surface};
use signorini_contact::GapJet;
use signorini_geometry::Vector;

#[test]
fn the_surface_of_a_ball_lies_on_it_and_has_its_area() {
    let gap = |x: &Vector<3>| GapJet::ball(x, &Vector::<3>::zeros(), 0.8);
    let (points, normals, triangles) = surface(&gap, [Vector::<3>::repeat(-1.0), Vector::<3>::repeat(1.0)], CUBES);
    assert!(points.iter().zip(&normals).all(|(x, n)| (x - n * 0.8).norm() < 1e-12));
    let x = |k: u32| points[k as usize];
    let area: f64 = triangles.iter().map(|t| 0.5 * (x(t[1]) - x(t[0])).cross(&(x(t[2]) - x(t[0]))).norm()).sum();
    assert!((area / (4.0 * std::f64::consts::PI * 0.64) - 1.0).abs() < 2e-3, "{area}");
}

#[test]
fn a_body_in_the_plane_has_its_area_and_its_edge() {
    let gap = |x: &Vector<3>| GapJet::ball(x, &Vector::<3>::zeros(), 0.8);
    let corner = Vector::<3>::new(1.0, 1.0, 0.0);
    let (triangles, edge) = region(&gap, [-corner, corner]);
    let area: f64 = triangles.iter().map(|[a, b, c]| 0.5 * (b - a).cross(&(c - a)).norm()).sum();
    let length: f64 = edge.iter().map(|[a, b]| (b - a).norm()).sum();
    let pi = std::f64::consts::PI;
    assert!((area / (pi * 0.64) - 1.0).abs() < 1e-4 && (length / (pi * 1.6) - 1.0).abs() < 1e-4, "{area} {length}");
}

#[test]
fn an_open_surface_ends_at_its_rim() {
    // A disc of radius 0.5 at z = 0 whose sides are told apart everywhere by the sign of z.
    let gap = |x: &Vector<3>| {
        let r = x.xy().norm();
        let foot = if r > 0.5 { Vector::<3>::new(x.x, x.y, 0.0) * (0.5 / r) } else { Vector::<3>::new(x.x, x.y, 0.0) };
        let d = (x - foot).norm();
        GapJet::flat(if x.z < 0.0 { -d } else { d }, Vector::<3>::z())
    };
    let (points, _, triangles) =
        surface(&gap, [Vector::<3>::new(-1.0, -1.0, -0.9), Vector::<3>::new(1.0, 1.0, 1.0)], CUBES);
    assert!(!triangles.is_empty());
    assert!(triangles.iter().flatten().all(|&k| points[k as usize].xy().norm() < 0.5 + 2.0 / CUBES as f64));
}
