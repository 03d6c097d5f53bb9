//! Of `history::bridge`.

use signorini_geometry::Point;
use signorini_membrane::testing::nearest;

#[test]
fn the_nearest_points_of_outlines_lie_within_their_pieces() {
    let p = |x: f64, y: f64| Point::<2>::new(x, y);
    let a = [vec![p(0.0, 0.0), p(1.0, 0.0)]];
    let b = [vec![p(0.25, 3.0), p(0.4, 0.5), p(0.5, 3.0)]];
    for bridge in [nearest(&a, &b).unwrap(), nearest(&b, &a).unwrap()] {
        assert!((bridge.length() - 0.5).abs() < 1e-15 && (bridge.middle() - p(0.4, 0.25)).norm() < 1e-15);
    }
    assert!(nearest(&a, &[]).is_none());
}
