//! Of `curve_pair::side`.

use signorini_geometry::Vector;
use signorini_rope::testing::in_cone;

#[test]
fn normals_of_an_edge_are_between_those_of_its_faces() {
    let faces = [Vector::<3>::x(), Vector::<3>::z()];
    assert!(in_cone(&Vector::<3>::x(), &faces) && in_cone(&Vector::<3>::new(0.6, 0.0, 0.8), &faces));
    assert!(!in_cone(&Vector::<3>::new(-0.1, 0.0, 0.9), &faces));
    // Faces at 60 degrees: a wedge of 120.
    let flat = [Vector::<3>::x(), Vector::<3>::new(0.5, 0.0, 0.75f64.sqrt())];
    assert!(in_cone(&Vector::<3>::new(0.75f64.sqrt(), 0.0, 0.5), &flat) && !in_cone(&Vector::<3>::z(), &flat));
}
