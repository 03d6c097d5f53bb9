//! Curves do not pass through each other: how far a way between two states may be followed.
//!
//! Both curves are taken as chords of their samples, which move in proportion along the way. Two chords cross where their
//! four ends are in one plane, `[u, v, w](t) = 0` for the sides `u`, `v` and the connection `w` of two of their ends, a cubic
//! in `t`, at places within both. A step that would bring a crossing about is followed half the way from where the sections
//! touch to there: the contact is closed then, from the side on which the curves were. Sharp edges know their inside, and are
//! followed to a quarter of the depth of a cell beyond.

use super::contact::CurveContact;
use super::search::{SearchScope, Searched};
use signorini_geometry::bvh::Bvh;
use signorini_geometry::{Aabb, Point, Vector};
use signorini_mechanics::curve::{Closure, samples};

/// A point that moves in proportion: at the start, and its whole way.
#[derive(Clone, Copy)]
pub struct Moved {
    pub x: Point<3>,
    pub way: Vector<3>,
}

impl Moved {
    fn at(&self, t: f64) -> Point<3> {
        self.x + self.way * t
    }
}

/// A chord of a curve.
type Chord = [Moved; 2];

/// Halvings of an interval that holds a root.
const HALVINGS: usize = 50;
/// How far beyond the ends of a chord it counts, as part of it: chords meet end to end, and none is to pass between.
const BEYOND: f64 = 1e-6;

impl CurveContact {
    /// The share of a way on which the curves do not pass through each other, for both as they are at its ends.
    pub(super) fn share_of_way(&self, from: [Searched<'_>; 2], to: [Searched<'_>; 2]) -> f64 {
        if (0..2).all(|s| from[s].configuration == to[s].configuration) {
            return 1.0;
        }
        let radii = from[0].curve.radius() + from[1].curve.radius();
        let depths = from.iter().flat_map(|s| (0..s.curve.elements()).map(|e| s.curve.depth(e)));
        let deepest = depths.fold(f64::INFINITY, f64::min);
        let chords = [0, 1].map(|s| chords(from[s], to[s]));
        if chords.iter().flatten().flatten().any(|p| !p.at(1.0).iter().all(|x| x.is_finite())) {
            return 1.0;
        }
        let boxes = chords.each_ref().map(|list| list.iter().map(swept).collect::<Vec<_>>());
        let trees = boxes.each_ref().map(|b| Bvh::new(b));
        let is_self = self.between() == SearchScope::Itself;
        let count = chords[0].len();
        let is_closed = from[0].curve.closure() == Closure::Closed;
        let mut share = 1.0f64;
        for (i, j) in trees[0].pairs_within(&trees[1], (&boxes[0], &boxes[1]), 0.0) {
            // Of one curve each pair once, and none that meets end to end.
            if is_self && (j < i + 2 || (is_closed && i + count < j + 2)) {
                continue;
            }
            let pair = [chords[0][i], chords[1][j]];
            if let Some(crossed) = crossing(&pair) {
                let until = if radii > 0.0 {
                    0.5 * (touching(&pair, radii, crossed) + crossed)
                } else {
                    leaving(&pair, 0.5 * deepest, crossed)
                };
                share = share.min(until);
            }
        }
        share
    }
}

/// The chords of a curve.
fn chords(from: Searched<'_>, to: Searched<'_>) -> Vec<Chord> {
    let mut out = Vec::new();
    for element in 0..from.curve.elements() {
        let count = samples(from.curve, from.configuration, element).max(samples(to.curve, to.configuration, element));
        let at = |k: usize| {
            let xi = k as f64 / count as f64;
            let [x, y] = [from, to].map(|s| s.curve.jet(s.configuration, element, xi).x);
            Moved { x, way: y - x }
        };
        out.extend((0..count).map(|k| [at(k), at(k + 1)]));
    }
    out
}

/// The box of a chord on its way.
fn swept(chord: &Chord) -> Aabb<3> {
    let ends = [chord[0].at(0.0), chord[1].at(0.0), chord[0].at(1.0), chord[1].at(1.0)];
    ends[1..].iter().fold(Aabb::new(ends[0], ends[0]), |b, p| Aabb::new(b.min.inf(p), b.max.sup(p)))
}

/// The first place on the way at which two chords cross.
pub fn crossing([a, b]: &[Chord; 2]) -> Option<f64> {
    let difference = |p: &Moved, q: &Moved| [p.x - q.x, p.way - q.way];
    let sides = [difference(&a[1], &a[0]), difference(&b[1], &b[0]), difference(&b[0], &a[0])];
    let triple = |i: usize, j: usize, k: usize| sides[0][i].cross(&sides[1][j]).dot(&sides[2][k]);
    let c = [
        triple(0, 0, 0),
        triple(1, 0, 0) + triple(0, 1, 0) + triple(0, 0, 1),
        triple(1, 1, 0) + triple(1, 0, 1) + triple(0, 1, 1),
        triple(1, 1, 1),
    ];
    roots(c).into_iter().find(|t| meet(a, b, *t))
}

/// Whether chords whose lines meet do so themselves.
fn meet(a: &Chord, b: &Chord, t: f64) -> bool {
    let [p, q] = [a, b].map(|c| [c[0].at(t), c[1].at(t)]);
    let [u, v, w] = [p[1] - p[0], q[1] - q[0], q[0] - p[0]];
    let normal = u.cross(&v);
    let square = normal.norm_squared();
    if square <= (f64::EPSILON * u.norm() * v.norm()).powi(2) {
        return false;
    }
    let places = [w.cross(&v).dot(&normal) / square, w.cross(&u).dot(&normal) / square];
    places.iter().all(|s| (-BEYOND..=1.0 + BEYOND).contains(s))
}

/// Up to where something holds that holds at the start of an interval and not at its end, by bisection.
fn last([mut low, mut high]: [f64; 2], holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    low
}

/// Changes of sign of a cubic from 0 to 1, in order.
pub fn roots(c: [f64; 4]) -> Vec<f64> {
    let value = |t: f64| c[0] + t * (c[1] + t * (c[2] + t * c[3]));
    // Between zeros of its derivative it is monotone.
    let mut bounds = vec![0.0];
    let (half, leading) = (c[2], 3.0 * c[3]);
    let root = half * half - leading * c[1];
    if root > 0.0 {
        let q = -(half + half.signum() * root.sqrt());
        let mut between = [q / leading, c[1] / q];
        between.sort_by(f64::total_cmp);
        bounds.extend(between.into_iter().filter(|t| *t > 0.0 && *t < 1.0));
    }
    bounds.push(1.0);
    let mut out = Vec::new();
    for pair in bounds.windows(2) {
        let sign = value(pair[0]).signum();
        if sign != value(pair[1]).signum() {
            out.push(last([pair[0], pair[1]], |t| value(t).signum() == sign));
        }
    }
    out
}

/// Where before they cross two chords are as near as the sections about them touch.
pub fn touching(pair: &[Chord; 2], radii: f64, crossed: f64) -> f64 {
    if distance(pair, 0.0) <= radii {
        return 0.0;
    }
    last([0.0, crossed], |t| distance(pair, t) > radii)
}

/// Where after they cross two chords are a distance apart: 1 if they are not on their way.
fn leaving(pair: &[Chord; 2], apart: f64, crossed: f64) -> f64 {
    if distance(pair, 1.0) <= apart {
        return 1.0;
    }
    last([crossed, 1.0], |t| distance(pair, t) <= apart)
}

/// The distance of two chords (Ericson, Real-time collision detection, 2005, section 5.1.9).
pub fn distance([a, b]: &[Chord; 2], t: f64) -> f64 {
    let [p, q] = [a, b].map(|c| [c[0].at(t), c[1].at(t)]);
    let [u, v, w] = [p[1] - p[0], q[1] - q[0], p[0] - q[0]];
    let [uu, vv, uv] = [u.norm_squared(), v.norm_squared(), u.dot(&v)];
    let [uw, vw] = [u.dot(&w), v.dot(&w)];
    let determinant = uu * vv - uv * uv;
    let along = |s: f64| if vv > 0.0 { ((s * uv + vw) / vv).clamp(0.0, 1.0) } else { 0.0 };
    let back = |r: f64| if uu > 0.0 { ((r * uv - uw) / uu).clamp(0.0, 1.0) } else { 0.0 };
    let s = if determinant > 0.0 { ((uv * vw - uw * vv) / determinant).clamp(0.0, 1.0) } else { 0.0 };
    let r = along(s);
    let s = back(r);
    (w + u * s - v * along(s)).norm()
}
