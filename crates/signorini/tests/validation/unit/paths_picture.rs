//! Of `paths::picture`.

use signorini::testing::{Camera, Cover, Line, LinePoint, Surface};
use signorini_geometry::Vector;

/// A square of side 2 at height 1, seen from above: of a line below from -3 to 3 the middle third is hidden, of one above it
/// nothing.
#[test]
fn what_lies_behind_a_body_is_told() {
    let at = |x: f64, y: f64, z: f64| Vector::<3>::new(x, y, z);
    let points = vec![at(-1.0, -1.0, 1.0), at(1.0, -1.0, 1.0), at(1.0, 1.0, 1.0), at(-1.0, 1.0, 1.0)];
    let surface = Surface { normals: vec![Vector::<3>::z(); 4], points, triangles: vec![[0, 1, 2], [0, 2, 3]] };
    let line = |z: f64| {
        let point = |x: f64| LinePoint { x: at(x, 0.1, z), ..LinePoint::default() };
        Line { points: vec![point(-3.0), point(3.0)], ..Line::default() }
    };
    let seen = [at(-3.0, -3.0, 0.0), at(3.0, 3.0, 0.0)];
    let camera = Camera::new(&Vector::<3>::z(), &Vector::<3>::y(), seen.iter(), [0.0, 0.0, 300.0, 300.0]);
    let cover = Cover::new(std::slice::from_ref(&surface), &camera);
    let hidden = cover.hidden(&line(0.0), 0.01);
    assert_eq!(hidden.len(), 1);
    let (first, last) = (hidden[0][0].x, hidden[0][hidden[0].len() - 1].x);
    assert!((first + 1.0).abs() < 0.02 && (last - 1.0).abs() < 0.02, "{first} {last}");
    assert!(cover.hidden(&line(2.0), 0.01).is_empty());
}
