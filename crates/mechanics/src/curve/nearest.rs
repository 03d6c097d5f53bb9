//! Nearest points of a curve: all local minima of the distance, and the curve as others meet it.
//!
//! The nearest point is the least of all local minima of the distance: elements are boxed by the hulls of their Bezier
//! points, and within an element every change of sign of `(c(ξ) - x)·c'(ξ)` between samples is refined. Samples are so close
//! that the curve turns by less than 15 degrees between them.

use super::{Closure, Continuity, Curve};
use crate::points::{Anchor, Foot, Master, MasterProjection, MaterialPoint, Site};
use signorini_geometry::bvh::Bvh;
use signorini_geometry::shape::CurveJet;
use signorini_geometry::{Aabb, Point, Vector};

/// Boxes of the elements, of the curve itself.
pub fn boxes(curve: &dyn Curve, configuration: &[f64]) -> Vec<Aabb<3>> {
    (0..curve.elements())
        .map(|e| {
            let hull = curve.hull(configuration, e);
            hull[1..].iter().fold(Aabb::new(hull[0], hull[0]), |b, p| Aabb::new(b.min.inf(p), b.max.sup(p)))
        })
        .collect()
}

/// Samples of an element, so close that the curve turns little between them.
pub fn samples(curve: &dyn Curve, configuration: &[f64], element: usize) -> usize {
    if curve.continuity() == Continuity::C0 {
        return 1;
    }
    // The sides of the Bezier polygon turn at least as much as the curve.
    let hull = curve.hull(configuration, element);
    let sides: Vec<Vector<3>> = hull.windows(2).map(|p| p[1] - p[0]).collect();
    let turn: f64 = sides.windows(2).map(|s| s[0].cross(&s[1]).norm().atan2(s[0].dot(&s[1]))).sum();
    ((turn / 15f64.to_radians()).ceil() as usize).clamp(2, 64)
}

/// Whether two points along the same curve may touch: farther apart along it than the half circumference of a loop that
/// just closes, with a tenth to spare, or bent towards each other so that the chord is less than half of the arc.
pub fn are_apart(curve: &dyn Curve, s: f64, sigma: f64, chord: f64) -> bool {
    let (radius, length) = (curve.radius(), curve.length());
    let along = (s - sigma).abs();
    let arc = match curve.closure() {
        Closure::Open => along,
        Closure::Closed => along.min(length - along),
    };
    // Below this the points are one.
    let one = 1e-9 * length;
    arc > (1.1 * std::f64::consts::PI * radius).max(one) || (arc > radius.max(one) && chord < 0.5 * arc)
}

/// A local minimum of the distance to a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Minimum {
    pub element: usize,
    pub xi: f64,
    /// 1 within the curve, 0 at an end or a kink.
    pub coordinates: usize,
    pub distance: f64,
}

/// All local minima, on one element, of the distance from a point to the curve.
pub fn minima(curve: &dyn Curve, configuration: &[f64], element: usize, x: &Point<3>) -> Vec<Minimum> {
    let jet = |xi: f64| curve.jet(configuration, element, xi);
    let slope = |xi: f64| {
        let j = jet(xi);
        (j.x - x).dot(&j.d1)
    };
    let found = |xi: f64, coordinates: usize| Minimum { element, xi, coordinates, distance: (jet(xi).x - x).norm() };
    let count = samples(curve, configuration, element);
    let at: Vec<f64> = (0..=count).map(|k| k as f64 / count as f64).collect();
    let slopes: Vec<f64> = at.iter().map(|xi| slope(*xi)).collect();
    let mut out = Vec::new();
    for k in 0..count {
        if slopes[k] <= 0.0 && slopes[k + 1] >= 0.0 && (slopes[k] < 0.0 || slopes[k + 1] > 0.0) {
            // A root at a sample shared by two intervals is one minimum.
            if k > 0 && slopes[k] == 0.0 {
                continue;
            }
            out.push(found(refine(&jet, x, at[k], at[k + 1]), 1));
        }
    }
    let n = curve.elements();
    let is_first = element == 0 && curve.closure() == Closure::Open;
    let is_last = element + 1 == n && curve.closure() == Closure::Open;
    if slopes[0] > 0.0 && is_first {
        out.push(found(0.0, 0));
    }
    if slopes[count] < 0.0 {
        let is_kink = curve.continuity() == Continuity::C0 && !is_last && {
            let next = curve.jet(configuration, (element + 1) % n, 0.0);
            (next.x - x).dot(&next.d1) > 0.0
        };
        if is_last || is_kink {
            out.push(found(1.0, 0));
        }
    }
    out
}

/// The root of `(c - x)·c'` between two parameters: Newton's method, kept between bounds.
fn refine(jet: &dyn Fn(f64) -> CurveJet, x: &Point<3>, low: f64, high: f64) -> f64 {
    let (mut low, mut high) = (low, high);
    let mut xi = 0.5 * (low + high);
    for _ in 0..60 {
        let j = jet(xi);
        let d = j.x - x;
        let slope = d.dot(&j.d1);
        let second = j.d1.norm_squared() + d.dot(&j.d2);
        if slope > 0.0 {
            high = xi
        } else {
            low = xi
        }
        let next = xi - slope / second;
        let next = if second > 0.0 && next > low && next < high { next } else { 0.5 * (low + high) };
        if (next - xi).abs() <= f64::EPSILON {
            return next;
        }
        xi = next;
    }
    xi
}

/// A curve that is touched.
pub struct CurveMaster<'a> {
    curve: Box<dyn Curve + 'a>,
    configuration: &'a [f64],
    tree: Bvh,
}

impl<'a> CurveMaster<'a> {
    /// A curve in a configuration.
    pub fn new(curve: Box<dyn Curve + 'a>, configuration: &'a [f64]) -> Self {
        let tree = Bvh::new(&boxes(curve.as_ref(), configuration));
        CurveMaster { curve, configuration, tree }
    }
}

impl Master for CurveMaster<'_> {
    fn nearest(&self, x: &Point<3>, reach: f64, except: Option<&Site>) -> Option<MasterProjection> {
        let curve = self.curve.as_ref();
        let mut best: Option<Minimum> = None;
        // Distances of surfaces: the curve lies deeper by the radius of the section.
        let reach = reach + curve.radius();
        let mut limit = reach * reach;
        self.tree.nearest(x, limit, |element| {
            for m in minima(curve, self.configuration, element, x) {
                let is_other = except.is_none_or(|site| {
                    let sigma = curve.arc(site.patch as usize, site.xi[0]);
                    are_apart(curve, curve.arc(element, m.xi), sigma, m.distance)
                });
                let is_nearer = best.as_ref().is_none_or(|b| {
                    (m.distance, m.element).partial_cmp(&(b.distance, b.element)) == Some(std::cmp::Ordering::Less)
                });
                if is_other && is_nearer && m.distance <= reach {
                    limit = limit.min(m.distance * m.distance);
                    best = Some(m);
                }
            }
            limit
        });
        let foot = |m: Minimum| {
            let foot = curve.foot(self.configuration, m.element, m.xi, m.coordinates);
            Foot { spin_bends: curve.spin_bends(self.configuration, m.element, m.xi), ..foot }
        };
        best.map(|m| MasterProjection::Foot(Box::new(foot(m))))
    }

    fn at(&self, point: &MaterialPoint) -> Anchor {
        let foot = self.curve.foot(self.configuration, point.patch as usize, point.xi[0], 1);
        Anchor {
            x: foot.jet.x,
            tangent: foot.jet.u,
            across: None,
            functions: foot.functions,
            spin: foot.spin,
            frame: foot.frame,
            turning: None,
        }
    }
}
