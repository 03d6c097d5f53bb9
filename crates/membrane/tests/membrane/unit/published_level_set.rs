//! Of `published::level_set`.

use signorini_fem::Grid;
use signorini_geometry::{Aabb, Point, polygon};
use signorini_membrane::testing::NodalLevelSet;

/// Error in the area of a circle of radius 0.4 that grows by 0.15.
fn error(cells: usize) -> f64 {
    let bounds = Aabb::new(Point::<2>::new(-1.0, -1.0), Point::<2>::new(1.0, 1.0));
    let grid = Grid::new(bounds, [cells, cells], 1);
    let level_set = NodalLevelSet::of(&grid, |x| x.norm() - 0.4).carried(|_| 0.15);
    let outlines = level_set.outlines();
    assert_eq!(outlines.len(), 1);
    (polygon::signed_area(&outlines[0]) - std::f64::consts::PI * 0.55f64.powi(2)).abs()
}

#[test]
fn a_front_is_carried_along_its_normals_to_first_order() {
    let errors = [error(40), error(80), error(160)];
    let order = (errors[0] / errors[2]).log2() / 2.0;
    assert!(errors[0] < 0.02 && order > 0.8, "{errors:?}");
}
