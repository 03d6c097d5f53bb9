//! Closest points of straight segments and flat triangles, given by their corners.

use crate::Point;
use crate::feature::{Entity, Feature};
use crate::patch::Border;
use crate::scale::length;

/// The parameter in `[0, 1]` of the closest point of a segment.
pub(crate) fn closest_on_segment(p: &Point<3>, p0: &Point<3>, p1: &Point<3>) -> f64 {
    let d = p1 - p0;
    let squared = d.norm_squared();
    if squared > 0.0 { ((p - p0).dot(&d) / squared).clamp(0.0, 1.0) } else { 0.0 }
}

/// A position on a segment, exact at both ends.
pub(crate) fn along(p0: &Point<3>, p1: &Point<3>, t: f64) -> Point<3> {
    if t == 1.0 { *p1 } else { p0 + (p1 - p0) * t }
}

/// The closest point of a triangle by the region in which the point lies (Ericson 2005, §5.1.5), with the parameters
/// along the sides from the first corner.
pub(crate) fn closest_on_triangle(p: &Point<3>, [a, b, c]: &[Point<3>; 3]) -> ([f64; 2], Feature) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let corner = |k: usize| {
        let entity = match k {
            0 => Entity::Corner(Border::U0, Border::V0),
            1 => Entity::Corner(Border::V0, Border::Diagonal),
            _ => Entity::Corner(Border::U0, Border::Diagonal),
        };
        ([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]][k], Feature::vertex(entity))
    };
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return corner(0);
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return corner(1);
    }
    let vc = d1 * d4 - d3 * d2;
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return corner(2);
    }
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return ([d1 / (d1 - d3), 0.0], Feature::edge(Border::V0));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return ([0.0, d2 / (d2 - d6)], Feature::edge(Border::U0));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return ([1.0 - w, w], Feature::edge(Border::Diagonal));
    }
    let sum = va + vb + vc;
    if sum > 0.0 {
        return ([vb / sum, vc / sum], Feature::INTERIOR);
    }
    // A triangle without area is its longest side.
    let sides = [(a, b), (a, c), (b, c)];
    let lengths = sides.map(|(p, q)| (q - p).norm_squared());
    let longest = (1..3).fold(0, |l, k| if lengths[k] > lengths[l] { k } else { l });
    let t = closest_on_segment(p, sides[longest].0, sides[longest].1);
    match longest {
        0 => ([t, 0.0], Feature::edge(Border::V0)),
        1 => ([0.0, t], Feature::edge(Border::U0)),
        _ => ([1.0 - t, t], Feature::edge(Border::Diagonal)),
    }
}

/// The closest points of two segments.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SegmentPair {
    /// Those of both segments, in `[0, 1]`.
    pub parameters: [f64; 2],
    pub distance: f64,
    /// Smallest eigenvalue of the Hessian over the parameters that are free; see [`crate::closest::ClosestPair`].
    pub lambda_min: f64,
    /// To rounding, or one of them has no length.
    pub parallel: bool,
}

/// The closest points of two segments: a crossing inside both, or at an end of one of them, as the distance is convex.
pub(crate) fn segments([p0, p1]: &[Point<3>; 2], [q0, q1]: &[Point<3>; 2]) -> SegmentPair {
    let (e, f) = (p1 - p0, q1 - q0);
    let cross = e.cross(&f);
    let sine_squared = cross.norm_squared() / (e.norm_squared() * f.norm_squared());
    let parallel = sine_squared.is_nan() || sine_squared <= 16.0 * f64::EPSILON;
    let pair = |s: f64, t: f64, lambda_min: f64| SegmentPair {
        parameters: [s, t],
        distance: length(&(along(p0, p1, s) - along(q0, q1, t))),
        lambda_min,
        parallel,
    };
    let lambda = |s: f64, t: f64| if [s, t].iter().all(|z| *z == 0.0 || *z == 1.0) { f64::INFINITY } else { 1.0 };
    let project = |s: f64| closest_on_segment(&along(p0, p1, s), q0, q1);
    let back = |t: f64| closest_on_segment(&along(q0, q1, t), p0, p1);
    let mut best = pair(0.0, project(0.0), lambda(0.0, project(0.0)));
    let mut offer = |s: f64, t: f64, lambda: f64| {
        let other = pair(s, t, lambda);
        if other.distance < best.distance {
            best = other;
        }
    };
    for (s, t) in [(1.0, project(1.0)), (back(0.0), 0.0), (back(1.0), 1.0)] {
        offer(s, t, lambda(s, t));
    }
    if !parallel {
        let r = q0 - p0;
        let s = r.cross(&f).dot(&cross) / cross.norm_squared();
        let t = r.cross(&e).dot(&cross) / cross.norm_squared();
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            let lambda = sine_squared / (1.0 + (1.0 - sine_squared).max(0.0).sqrt());
            // One more projection removes what the cross products of nearly parallel segments lose.
            let t = project(s);
            offer(back(t), t, lambda);
        }
    }
    best
}
