//! Points nearest to a place on segments, triangles and facets.

use signorini_geometry::{Point, Vector};

/// The middle of some points.
pub fn centre(points: &[Point<3>], list: &[u32]) -> Point<3> {
    list.iter().map(|k| points[*k as usize]).sum::<Point<3>>() / list.len().max(1) as f64
}

/// The mean of points; the origin of none.
pub fn mean(points: &[Point<3>]) -> Point<3> {
    points.iter().sum::<Point<3>>() / points.len().max(1) as f64
}

/// The outward normal of a facet by its area; in the plane by its length, of cells that go round counter-clockwise.
pub fn area_normal(points: &[Point<3>], facet: &[u32]) -> Vector<3> {
    let x = |k: usize| points[facet[k] as usize];
    match facet.len() {
        2 => (x(1) - x(0)).cross(&Vector::<3>::z()),
        3 => (x(1) - x(0)).cross(&(x(2) - x(0))) * 0.5,
        _ => (x(2) - x(0)).cross(&(x(3) - x(1))) * 0.5,
    }
}

/// The largest distance between points of a facet.
pub fn extent(points: &[Point<3>], facet: &[u32]) -> f64 {
    let x = |k: &u32| points[*k as usize];
    let far = |a: &u32| facet.iter().map(|b| (x(a) - x(b)).norm()).fold(0.0, f64::max);
    facet.iter().map(far).fold(0.0, f64::max)
}

/// The point of a segment nearest to `p`.
pub fn on_segment(p: &Point<3>, [a, b]: [&Point<3>; 2]) -> Point<3> {
    let d = b - a;
    let square = d.norm_squared();
    if square == 0.0 { *a } else { a + d * ((p - a).dot(&d) / square).clamp(0.0, 1.0) }
}

/// The point of a triangle nearest to `p`.
pub fn on_triangle(p: &Point<3>, [a, b, c]: [&Point<3>; 3]) -> Point<3> {
    let (u, v) = (b - a, c - a);
    let normal = u.cross(&v);
    let square = normal.norm_squared();
    if square > 0.0 {
        let w = p - a;
        let (s, t) = (w.cross(&v).dot(&normal) / square, u.cross(&w).dot(&normal) / square);
        if s >= 0.0 && t >= 0.0 && s + t <= 1.0 {
            return a + u * s + v * t;
        }
    }
    let sides = [on_segment(p, [a, b]), on_segment(p, [b, c]), on_segment(p, [c, a])];
    sides.into_iter().min_by(|x, y| (x - p).norm_squared().total_cmp(&(y - p).norm_squared())).unwrap_or(*a)
}

/// The point of a facet nearest to `p`; one of four points is two triangles.
pub fn on_facet(p: &Point<3>, points: &[Point<3>], facet: &[u32]) -> Point<3> {
    let x = |k: usize| &points[facet[k] as usize];
    match facet.len() {
        2 => on_segment(p, [x(0), x(1)]),
        3 => on_triangle(p, [x(0), x(1), x(2)]),
        _ => {
            let halves = [on_triangle(p, [x(0), x(1), x(2)]), on_triangle(p, [x(0), x(2), x(3)])];
            let [a, b] = halves;
            if (a - p).norm_squared() <= (b - p).norm_squared() { a } else { b }
        }
    }
}

/// The points of two segments nearest to each other, by their shares of the segments.
pub fn of_segments([p, q]: [&Point<3>; 2], [r, s]: [&Point<3>; 2]) -> [f64; 2] {
    let (d, e, w) = (q - p, s - r, p - r);
    let (a, b, c) = (d.norm_squared(), d.dot(&e), e.norm_squared());
    let (f, g) = (d.dot(&w), e.dot(&w));
    let det = a * c - b * b;
    let share = |top: f64, bottom: f64| if bottom > 0.0 { (top / bottom).clamp(0.0, 1.0) } else { 0.0 };
    let mut u = if det > 1e-12 * a * c { ((b * g - c * f) / det).clamp(0.0, 1.0) } else { 0.5 };
    let v = share(b * u + g, c);
    u = share(b * v - f, a);
    [u, v]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_points_are_no_farther_than_any_other() {
        let corners =
            [Point::<3>::new(0.0, 0.1, 0.2), Point::<3>::new(1.0, -0.3, 0.4), Point::<3>::new(0.3, 0.9, -0.2)];
        let [a, b, c] = corners;
        for p in [[0.4, 0.2, 1.0], [-1.0, 0.0, 0.3], [0.9, 0.8, 0.1], [0.5, -2.0, 0.0]].map(Point::<3>::from) {
            let found = (on_triangle(&p, [&a, &b, &c]) - p).norm();
            let mut least = f64::INFINITY;
            for i in 0..=100 {
                for j in 0..=100 - i {
                    let (s, t) = (f64::from(i) / 100.0, f64::from(j) / 100.0);
                    least = least.min((a + (b - a) * s + (c - a) * t - p).norm());
                }
            }
            assert!(found <= least + 1e-12 && found > least - 0.02, "{found} {least}");
        }
        let [u, v] = of_segments([&a, &b], [&c, &Point::<3>::new(0.6, -1.0, 0.9)]);
        assert!((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v));
    }
}
