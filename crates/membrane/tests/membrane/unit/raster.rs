//! Of `raster`.

use signorini_fem::Grid;
use signorini_geometry::{Aabb, ClosedCurve, Point, polygon};
use signorini_membrane::testing::Raster;

fn circle(x: f64, r: f64, turn: f64) -> ClosedCurve {
    let points: Vec<Point<2>> = (0..32)
        .map(|i| {
            let (s, c) = (turn * std::f64::consts::TAU * i as f64 / 32.0).sin_cos();
            Point::<2>::new(x + r * c, r * s)
        })
        .collect();
    ClosedCurve::through(&points, 5)
}

fn areas(curves: &[ClosedCurve]) -> Vec<f64> {
    let bounds = Aabb::new(Point::<2>::new(-1.0, -1.0), Point::<2>::new(1.0, 1.0));
    let grid = Grid::<2>::new(bounds, [40, 40], 2);
    Raster::of_curves(&grid, curves).outlines().iter().map(|o| polygon::signed_area(o)).collect()
}

#[test]
fn overlapping_zones_unite_and_inverted_ones_vanish() {
    let pi = std::f64::consts::PI;
    let united = areas(&[circle(-0.2, 0.3, 1.0), circle(0.2, 0.3, 1.0)]);
    assert_eq!(united.len(), 1);
    assert!(united[0] > 1.5 * pi * 0.09 && united[0] < 2.0 * pi * 0.09);
    assert!(areas(&[circle(0.0, 0.3, -1.0)]).is_empty());
    let ring = areas(&[circle(0.0, 0.6, 1.0), circle(0.0, 0.3, -1.0)]);
    assert!((ring.iter().sum::<f64>() - 0.27 * pi).abs() < 0.01);
}
