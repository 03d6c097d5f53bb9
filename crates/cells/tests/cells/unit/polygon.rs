//! Of `polygon`.

use signorini_cells::polygon::polygon_points;
use signorini_geometry::Point;

/// A quadrilateral in an inclined plane, against Gauss points of its triangles.
#[test]
fn three_points_integrate_quadratic_functions() {
    let plane = |s: f64, t: f64| Point::<3>::new(1.0 + s - 0.3 * t, 2.0 * s + 0.5 * t, 0.4 * s + t);
    let polygon = [plane(0.0, 0.0), plane(1.0, 0.1), plane(0.9, 0.8), plane(-0.2, 0.5)];
    let few = polygon_points(&polygon, 3, 20.0);
    let many = polygon_points(&polygon, 3, 0.1);
    assert_eq!([few.len(), many.len()], [3, 18]);
    let monomials = |x: &Point<3>| [1.0, x[0], x[1], x[2], x[0] * x[0], x[0] * x[1], x[1] * x[2], x[2] * x[2]];
    for k in 0..8 {
        let [a, b] = [&few, &many].map(|list| list.iter().map(|(x, w)| w * monomials(x)[k]).sum::<f64>());
        assert!((a - b).abs() < 1e-14 * b.abs().max(1.0), "{k}: {a} {b}");
    }
}
