//! Of `multigrid::mesh`.

use signorini_fem::Grid;
use signorini_geometry::{Aabb, ClosedCurve, Point};
use signorini_membrane::obstacle::Side;
use signorini_membrane::plane_zone::PlaneZone;
use signorini_membrane::testing::{Near, cells_near_fronts};
use std::collections::HashSet;

#[test]
fn sums_tell_which_boxes_fronts_are_near_to() {
    let bounds = Aabb::new(Point::<2>::zeros(), Point::<2>::new(1.3, 0.9));
    let grid = Grid::new(bounds, [13, 9], 1);
    let circle: Vec<Point<2>> = (0..24)
        .map(|k| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 24.0).sin_cos();
            Point::<2>::new(0.75 + 0.25 * cos, 0.4 + 0.2 * sin)
        })
        .collect();
    let zone = PlaneZone::new(&grid, vec![(Side::Below, ClosedCurve::through(&circle, 3))]);
    let near: HashSet<usize> = cells_near_fronts(&zone).collect();
    let sums = Near::new(&zone);
    let mut seen = [0, 0];
    for cell in 0..grid.cell_count() {
        let low = grid.cell_index(cell);
        for [columns, rows] in [[1, 1], [2, 1], [1, 3], [3, 2]] {
            let high = [(low[0] + columns).min(13), (low[1] + rows).min(9)];
            let last = grid.cell_at([high[0] - 1, high[1] - 1]);
            let b = Aabb::new(grid.cell_box(cell).min, grid.cell_box(last).max).scaled(0.9);
            let mut within = (low[1]..high[1]).flat_map(|j| (low[0]..high[0]).map(move |i| [i, j]));
            let expected = within.any(|at| near.contains(&grid.cell_at(at)));
            assert_eq!(sums.touches(&b), expected, "{b:?}");
            seen[usize::from(expected)] += 1;
        }
    }
    assert!(seen.iter().all(|n| *n > 50), "{seen:?}");
}
