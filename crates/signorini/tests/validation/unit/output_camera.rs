//! Of `output::camera`.

use signorini::testing::Camera;
use signorini_geometry::Vector;

#[test]
fn a_long_flat_thing_fills_the_width() {
    let points = [Vector::<3>::zeros(), Vector::<3>::new(1.0, 20.0, 0.5)];
    let camera = Camera::new(&Vector::<3>::x(), &Vector::<3>::z(), points.iter(), [10.0, 0.0, 410.0, 300.0]);
    let x: Vec<f64> = points.iter().map(|p| camera.at(p).0).collect();
    assert!((x[0] - 10.0).abs() < 1e-9 && (x[1] - 410.0).abs() < 1e-9, "{x:?}");
}
