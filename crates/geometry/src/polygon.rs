//! Polygons given by their corners, the last joined to the first.

use crate::Point;

/// Signed area: positive where the corners run counter-clockwise.
pub fn signed_area(corners: &[Point<2>]) -> f64 {
    edges(corners).map(|(a, b)| 0.5 * (a[0] * b[1] - b[0] * a[1])).sum()
}

/// Length of the closed outline.
pub fn perimeter(corners: &[Point<2>]) -> f64 {
    edges(corners).map(|(a, b)| (b - a).norm()).sum()
}

/// The edges as pairs of corners.
pub fn edges(corners: &[Point<2>]) -> impl Iterator<Item = (&Point<2>, &Point<2>)> {
    corners.iter().zip(corners.iter().cycle().skip(1))
}

/// How often the outline runs counter-clockwise round `x`; zero is outside.
pub fn winding_number(corners: &[Point<2>], x: &Point<2>) -> i32 {
    edges(corners)
        .map(|(a, b)| {
            let side = (b[0] - a[0]) * (x[1] - a[1]) - (x[0] - a[0]) * (b[1] - a[1]);
            match (a[1] <= x[1], b[1] <= x[1]) {
                (true, false) if side > 0.0 => 1,
                (false, true) if side < 0.0 => -1,
                _ => 0,
            }
        })
        .sum()
}

/// Distance from `x` to the segment from `a` to `b`.
pub fn segment_distance(a: &Point<2>, b: &Point<2>, x: &Point<2>) -> f64 {
    let d = b - a;
    let t = ((x - a).dot(&d) / d.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (x - a - t * d).norm()
}

/// Whether two segments cross or touch.
pub fn segments_cross(a: &Point<2>, b: &Point<2>, c: &Point<2>, d: &Point<2>) -> bool {
    let side = |p: &Point<2>, q: &Point<2>, x: &Point<2>| (q[0] - p[0]) * (x[1] - p[1]) - (x[0] - p[0]) * (q[1] - p[1]);
    side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0
}

/// Two edges that cross each other without being neighbours, by their indices; none if the polygon is simple.
pub fn self_crossing(corners: &[Point<2>]) -> Option<(usize, usize)> {
    let n = corners.len();
    let edge = |i: usize| (&corners[i], &corners[(i + 1) % n]);
    (0..n).find_map(|i| {
        let (a, b) = edge(i);
        (i + 2..n).filter(|&j| (j + 1) % n != i).find_map(|j| {
            let (c, d) = edge(j);
            let apart = (0..2).any(|k| a[k].max(b[k]) < c[k].min(d[k]) || c[k].max(d[k]) < a[k].min(b[k]));
            (!apart && segments_cross(a, b, c, d)).then_some((i, j))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Vec<Point<2>> {
        [[0., 0.], [1., 0.], [1., 1.], [0., 1.]].map(Point::<2>::from).to_vec()
    }

    #[test]
    fn area_winding_and_crossings() {
        let square = square();
        assert_eq!(signed_area(&square), 1.0);
        assert_eq!(perimeter(&square), 4.0);
        assert_eq!(winding_number(&square, &Point::<2>::new(0.5, 0.5)), 1);
        assert_eq!(winding_number(&square, &Point::<2>::new(1.5, 0.5)), 0);
        let reversed: Vec<_> = square.iter().rev().copied().collect();
        assert_eq!(winding_number(&reversed, &Point::<2>::new(0.5, 0.5)), -1);
        assert_eq!(self_crossing(&square), None);
        let bow: Vec<_> = [0, 2, 1, 3].map(|i| square[i]).to_vec();
        assert!(self_crossing(&bow).is_some());
    }
}
