//! Plane polygons in space: their parts within a box, and points that integrate over them.

use signorini_geometry::rule::gauss_legendre;
use signorini_geometry::{Point, Vector};

/// The part of a polygon with `sign (x_axis - at) ≥ 0` (Sutherland & Hodgman).
pub fn clip(polygon: Vec<Point<3>>, axis: usize, at: f64, sign: f64) -> Vec<Point<3>> {
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
pub fn clip_line(line: &[Point<3>], axis: usize, at: f64, sign: f64) -> Vec<Point<3>> {
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

pub fn fan(polygon: &[Point<3>]) -> impl Iterator<Item = [Point<3>; 3]> + '_ {
    (2..polygon.len()).map(|i| [polygon[0], polygon[i - 1], polygon[i]])
}

pub fn area_vector(polygon: &[Point<3>]) -> Vector<3> {
    fan(polygon).map(|[a, b, c]| 0.5 * (b - a).cross(&(c - a))).sum()
}

/// Points that integrate over a convex polygon, with their weights: as dense as `n` Gauss points along the length `h` of a
/// cell, whatever the number of polygons in it.
///
/// Where the polygon is so small that each of three points stands for no more than one of those `n²`, they are
/// `x_k = c + √2 (cos θ_k, sin θ_k)ᵀ L` with `θ_k` a third of a turn apart, `c` the centroid and `L Lᵀ` the covariance of
/// the polygon: `Σ_k v_k v_kᵀ / 3 = I` for `v_k = √2 (cos θ_k, sin θ_k)`, so that quadratic functions are integrated exactly.
pub fn polygon_points(polygon: &[Point<3>], n: usize, h: f64) -> Vec<(Point<3>, f64)> {
    let of = |[a, b, c]: &[Point<3>; 3]| 0.5 * (b - a).cross(&(c - a)).norm();
    // Of slivers that rounding folds, more than the length of the area vector.
    let area: f64 = fan(polygon).map(|t| of(&t)).sum();
    let spacing = h / n as f64;
    if area > 3.0 * spacing * spacing {
        return fan(polygon).flat_map(|part| triangle_points(&part, n)).collect();
    }
    if area == 0.0 {
        return Vec::new();
    }
    let centroid = fan(polygon).map(|t| (t[0] + t[1] + t[2]) * (of(&t) / (3.0 * area))).sum::<Point<3>>();
    let normal = area_vector(polygon).try_normalize(0.0).unwrap_or_default();
    let edge = |i: usize| polygon[(i + 1) % polygon.len()] - polygon[i];
    let longest =
        (0..polygon.len()).map(edge).fold(Vector::<3>::zeros(), |l, e| if e.norm() > l.norm() { e } else { l });
    let along = longest.normalize();
    let axes = [along, normal.cross(&along)];
    // ∫ y yᵀ over a triangle is A/12 (Σ y_i y_iᵀ + (Σ y_i)(Σ y_i)ᵀ).
    let mut covariance = [0.0; 3];
    for t in fan(polygon) {
        let y = t.map(|x| axes.map(|a| a.dot(&(x - centroid))));
        let sum = [0, 1].map(|k| y.iter().map(|y| y[k]).sum::<f64>());
        for (c, [i, j]) in covariance.iter_mut().zip([[0, 0], [0, 1], [1, 1]]) {
            *c += of(&t) / (12.0 * area) * (y.iter().map(|y| y[i] * y[j]).sum::<f64>() + sum[i] * sum[j]);
        }
    }
    let first = covariance[0].sqrt();
    let mixed = if first > 0.0 { covariance[1] / first } else { 0.0 };
    let second = (covariance[2] - mixed * mixed).max(0.0).sqrt();
    let point = |k: usize| {
        let (sin, cos) = (k as f64 * std::f64::consts::TAU / 3.0).sin_cos();
        let v = [cos, sin].map(|c| std::f64::consts::SQRT_2 * c);
        centroid + axes[0] * (first * v[0]) + axes[1] * (mixed * v[0] + second * v[1])
    };
    (0..3).map(|k| (point(k), area / 3.0)).collect()
}

/// Gauss points of a triangle, collapsed from the square.
pub fn triangle_points([a, b, c]: &[Point<3>; 3], n: usize) -> Vec<(Point<3>, f64)> {
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
