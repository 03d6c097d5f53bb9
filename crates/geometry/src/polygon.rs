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
    let range = |i: usize, k: usize| {
        let (a, b) = edge(i);
        (a[k].min(b[k]), a[k].max(b[k]))
    };
    // From left to right only edges that begin before another one ends can cross it.
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_unstable_by(|&i, &j| range(i, 0).0.total_cmp(&range(j, 0).0).then(i.cmp(&j)));
    order.iter().enumerate().find_map(|(at, &i)| {
        let (end, (low, high)) = (range(i, 0).1, range(i, 1));
        let mut beside = order[at + 1..].iter().copied().take_while(|&j| range(j, 0).0 <= end);
        let crossed = |&j: &usize| {
            let neighbours = (i + 1) % n == j || (j + 1) % n == i;
            let (from, to) = range(j, 1);
            let ((a, b), (c, d)) = (edge(i), edge(j));
            !neighbours && from <= high && low <= to && segments_cross(a, b, c, d)
        };
        beside.find(crossed).map(|j| (i.min(j), i.max(j)))
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
        // A long curve, and the same with one corner pulled across to the other side.
        let mut round: Vec<Point<2>> = (0..500)
            .map(|k| f64::from(k) * 0.004 * std::f64::consts::PI)
            .map(|a| Point::<2>::new(a.cos(), a.sin()))
            .collect();
        assert_eq!(self_crossing(&round), None);
        round[100] = Point::<2>::new(-1.1, -0.3);
        assert!(self_crossing(&round).is_some_and(|(i, j)| i == 99 || i == 100 || j == 100));
    }
}
