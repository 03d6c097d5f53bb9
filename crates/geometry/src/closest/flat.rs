//! Closest points of two segments, with the overlap of those that are parallel.

use super::query::Query;
use super::result::{ClosestPair, Foot, Projection, Uniqueness};
use crate::Point;
use crate::feature::{Entity, Feature};
use crate::patch::Border;
use crate::scale::length;
use crate::shape::{Curve, CurveKind};
use crate::straight::{along, closest_on_segment, segments};

/// The feature of a curve at a parameter.
pub(super) fn end_feature(t: f64, range: [f64; 2], closed: bool) -> Feature {
    match t {
        _ if closed => Feature::INTERIOR,
        t if t <= range[0] => Feature::vertex(Entity::Border(Border::Start)),
        t if t >= range[1] => Feature::vertex(Entity::Border(Border::End)),
        _ => Feature::INTERIOR,
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
    Some(named(&[*p0, *p1], &[*q0, *q1], c.size().max(d.size())))
}

fn named(p @ [p0, p1]: &[Point<3>; 2], q @ [q0, q1]: &[Point<3>; 2], size: f64) -> Projection {
    let best = segments(p, q);
    let pair = |s: f64, t: f64, lambda_min: f64| {
        let (x, y) = (along(p0, p1, s), along(q0, q1, t));
        ClosestPair {
            distance: length(&(x - y)),
            a: Foot::new(x, end_feature(s, [0.0, 1.0], false), &[s]),
            b: Foot::new(y, end_feature(t, [0.0, 1.0], false), &[t]),
            lambda_min,
        }
    };
    let project = |s: f64| closest_on_segment(&along(p0, p1, s), q0, q1);
    let [s, t] = best.parameters;
    let mut closest = pair(s, t, best.lambda_min);
    let mut uniqueness = Uniqueness::Unique;
    let mut others = Vec::new();
    let e = p1 - p0;
    let ee = e.norm_squared();
    if best.parallel && ee > 0.0 && q0 != q1 {
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
    } else if !best.parallel && closest.lambda_min < 1e-6 {
        uniqueness = Uniqueness::NearContinuum { lambda: closest.lambda_min };
    }
    Projection::known(closest, uniqueness, others)
}
