//! Closest points of segments and triangles.

use super::Query;
use super::result::{ClosestPair, Entity, Feature, Foot, Projection, Uniqueness};
use crate::Point;
use crate::patch::Border;
use crate::scale::length;
use crate::shape::{Curve, CurveKind};

pub(super) fn segment_parameter(p: &Point<3>, p0: &Point<3>, p1: &Point<3>) -> f64 {
    let d = p1 - p0;
    let squared = d.norm_squared();
    if squared > 0.0 { ((p - p0).dot(&d) / squared).clamp(0.0, 1.0) } else { 0.0 }
}

/// A position on a segment, exact at both ends.
pub(super) fn along(p0: &Point<3>, p1: &Point<3>, t: f64) -> Point<3> {
    if t == 1.0 { *p1 } else { p0 + (p1 - p0) * t }
}

/// The feature of a curve at a parameter.
pub(super) fn end_feature(t: f64, range: [f64; 2], closed: bool) -> Feature {
    match t {
        _ if closed => Feature::INTERIOR,
        t if t <= range[0] => Feature::vertex(Entity::Border(Border::Start)),
        t if t >= range[1] => Feature::vertex(Entity::Border(Border::End)),
        _ => Feature::INTERIOR,
    }
}

/// The closest point of a triangle by the region in which the point lies (Ericson 2005, §5.1.5), with the parameters
/// along the sides from the first corner.
pub(crate) fn triangle(p: &Point<3>, [a, b, c]: &[Point<3>; 3]) -> ([f64; 2], Feature) {
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
    let t = segment_parameter(p, sides[longest].0, sides[longest].1);
    match longest {
        0 => ([t, 0.0], Feature::edge(Border::V0)),
        1 => ([0.0, t], Feature::edge(Border::U0)),
        _ => ([1.0 - t, t], Feature::edge(Border::Diagonal)),
    }
}

/// Two segments: crossing, end to segment or parallel.
pub fn segment_segment(c: &Curve, d: &Curve, query: &Query) -> Option<Projection> {
    let (CurveKind::Segment { p0, p1 }, CurveKind::Segment { p0: q0, p1: q1 }) = (&c.kind, &d.kind) else {
        return None;
    };
    if query.local_minima {
        return None;
    }
    Some(segments(&[*p0, *p1], &[*q0, *q1], c.size().max(d.size())))
}

/// Parameters of the closest points of two segments.
pub(crate) fn segment_parameters(p: &[Point<3>; 2], q: &[Point<3>; 2]) -> [f64; 2] {
    let found = segments(p, q, 0.0).closest;
    [found.a.parameters()[0], found.b.parameters()[0]]
}

fn segments([p0, p1]: &[Point<3>; 2], [q0, q1]: &[Point<3>; 2], size: f64) -> Projection {
    let (e, f) = (p1 - p0, q1 - q0);
    let pair = |s: f64, t: f64, lambda_min: f64| {
        let (x, y) = (along(p0, p1, s), along(q0, q1, t));
        ClosestPair {
            distance: length(&(x - y)),
            a: Foot::new(x, end_feature(s, [0.0, 1.0], false), &[s]),
            b: Foot::new(y, end_feature(t, [0.0, 1.0], false), &[t]),
            lambda_min,
        }
    };
    let lambda = |s: f64, t: f64| if [s, t].iter().all(|z| *z == 0.0 || *z == 1.0) { f64::INFINITY } else { 1.0 };
    let project = |s: f64| segment_parameter(&along(p0, p1, s), q0, q1);
    let back = |t: f64| segment_parameter(&along(q0, q1, t), p0, p1);
    // F is convex: the minimum is a crossing inside both, or at an end of one of them.
    let mut best = pair(0.0, project(0.0), f64::INFINITY);
    best.lambda_min = lambda(0.0, best.b.parameters()[0]);
    let offer = |best: &mut ClosestPair, s: f64, t: f64, lambda: f64| {
        let other = pair(s, t, lambda);
        if other.distance < best.distance {
            *best = other;
        }
    };
    for (s, t) in [(1.0, project(1.0)), (back(0.0), 0.0), (back(1.0), 1.0)] {
        offer(&mut best, s, t, lambda(s, t));
    }
    let (ee, ff) = (e.norm_squared(), f.norm_squared());
    let cross = e.cross(&f);
    let sine_squared = cross.norm_squared() / (ee * ff);
    let parallel = sine_squared.is_nan() || sine_squared <= 16.0 * f64::EPSILON;
    if !parallel {
        let r = q0 - p0;
        let s = r.cross(&f).dot(&cross) / cross.norm_squared();
        let t = r.cross(&e).dot(&cross) / cross.norm_squared();
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            let lambda = sine_squared / (1.0 + (1.0 - sine_squared).max(0.0).sqrt());
            // One more projection removes what the cross products of nearly parallel segments lose.
            let t = project(s);
            offer(&mut best, back(t), t, lambda);
        }
    }
    let mut uniqueness = Uniqueness::Unique;
    let mut closest = best;
    let mut others = Vec::new();
    if parallel && ee > 0.0 && ff > 0.0 {
        // The overlap, in the parameter of the first.
        let unclamped = |q: &Point<3>| (q - p0).dot(&e) / ee;
        let (t0, t1) = (unclamped(q0), unclamped(q1));
        let (low, high) = (t0.min(t1).max(0.0), t0.max(t1).min(1.0));
        let ends = [low, high].map(|s| pair(s, project(s), 0.0));
        let level = best.distance + 8.0 * f64::EPSILON * (size + best.distance);
        // A tilt that rounding can see leaves one end closer than the other.
        if (high - low) * e.norm() > 1e-12 * size && ends.iter().all(|p| p.distance <= level) {
            uniqueness = Uniqueness::Continuum { dimension: 1 };
            let s = 0.5 * (low + high);
            closest = pair(s, project(s), 0.0);
            others.extend(ends);
        }
    } else if !parallel && closest.lambda_min < 1e-6 {
        uniqueness = Uniqueness::NearContinuum { lambda: closest.lambda_min };
    }
    Projection::known(closest, uniqueness, others)
}
