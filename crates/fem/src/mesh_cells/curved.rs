//! What is kept of cells whose map is not linear, and the measures of straight ones.

use signorini_geometry::{Aabb, Matrix, Point};

/// What is to know about a cell whose map is not linear.
pub(super) struct CurvedCell {
    pub(super) bounds: Aabb<2>,
    pub(super) size: f64,
    pub(super) volume: f64,
    /// Centre and inverse Jacobian there.
    pub(super) centre: Point<2>,
    pub(super) inverse: Matrix<2>,
    /// Whether the Jacobian is nowhere much smaller than on average.
    pub(super) regular: bool,
}

/// The edges of a triangle from its first corner, the derivatives of its linear map.
pub(super) fn edges(corners: &[Point<2>]) -> Matrix<2> {
    Matrix::<2>::from_columns(&[corners[1] - corners[0], corners[2] - corners[0]])
}

/// The longest side of a polygon.
pub(super) fn longest(vertices: &[Point<2>]) -> f64 {
    let side = |i: usize| (vertices[i] - vertices[(i + 1) % vertices.len()]).norm();
    (0..vertices.len()).map(side).fold(0.0, f64::max)
}

/// The smallest box round points.
pub(super) fn box_round(points: impl Iterator<Item = Point<2>>) -> Aabb<2> {
    Aabb::around(points).expect("a cell has nodes")
}
