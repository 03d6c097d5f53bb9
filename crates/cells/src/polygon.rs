//! Plane polygons in space: their parts within a box, and points that integrate over triangles.

use signorini_geometry::rule::gauss_legendre;
use signorini_geometry::{Point, Vector};

/// The part of a polygon with `sign (x_axis - at) ≥ 0` (Sutherland & Hodgman).
pub(crate) fn clip(polygon: Vec<Point<3>>, axis: usize, at: f64, sign: f64) -> Vec<Point<3>> {
    let height = |x: &Point<3>| sign * (x[axis] - at);
    if polygon.iter().all(|x| height(x) >= 0.0) {
        return polygon;
    }
    let mut out = Vec::with_capacity(polygon.len() + 1);
    for (i, a) in polygon.iter().enumerate() {
        let b = &polygon[(i + 1) % polygon.len()];
        let (ha, hb) = (height(a), height(b));
        if ha >= 0.0 {
            out.push(*a);
        }
        if (ha >= 0.0) != (hb >= 0.0) {
            let mut x = a + (b - a) * (ha / (ha - hb));
            x[axis] = at;
            out.push(x);
        }
    }
    out
}

/// The part of a line with `sign (x_axis - at) ≥ 0`; nothing of one that has none.
pub(crate) fn clip_line(line: &[Point<3>], axis: usize, at: f64, sign: f64) -> Vec<Point<3>> {
    let [p, q] = line[..] else { return Vec::new() };
    let [a, b] = [p, q].map(|x| sign * (x[axis] - at));
    let cut = || p + (q - p) * (a / (a - b));
    match (a >= 0.0, b >= 0.0) {
        (true, true) => vec![p, q],
        (true, false) => vec![p, cut()],
        (false, true) => vec![cut(), q],
        (false, false) => Vec::new(),
    }
}

pub(crate) fn fan(polygon: &[Point<3>]) -> impl Iterator<Item = [Point<3>; 3]> + '_ {
    (2..polygon.len()).map(|i| [polygon[0], polygon[i - 1], polygon[i]])
}

pub(crate) fn area_vector(polygon: &[Point<3>]) -> Vector<3> {
    fan(polygon).map(|[a, b, c]| 0.5 * (b - a).cross(&(c - a))).sum()
}

/// Gauss points of a triangle, collapsed from the square.
pub(crate) fn triangle_points([a, b, c]: &[Point<3>; 3], n: usize) -> Vec<(Point<3>, f64)> {
    let (u, v) = (b - a, c - a);
    let area = u.cross(&v).norm();
    if area == 0.0 {
        return Vec::new();
    }
    let line = gauss_legendre(n);
    let mut out = Vec::with_capacity(n * n);
    for (s, ws) in &line {
        for (t, wt) in &line {
            out.push((a + u * (s * (1.0 - t)) + v * *t, area * ws * wt * (1.0 - t)));
        }
    }
    out
}
