//! Local minima of the distance of two curves, and of a curve to itself.
//!
//! Boxes of elements that are near each other make candidates. Within a pair of elements the samples whose distance is a
//! local minimum start a search with Newton's method on `½ |x_A - x_B|²`, with the metric in place of the Hessian where that
//! is not positive definite, damped, and with ends as bounds. It may run on into neighbouring elements. Curves that run
//! along each other have no isolated minimum and give none: line contact is for them. Ends, and the kinks of straight
//! elements, are minima of their own where the distance falls towards them: each is projected onto the other curve.

use signorini_geometry::Vector;
use signorini_geometry::bvh::Bvh;
use signorini_geometry::shape::CurveJet;
use signorini_mechanics::Curve;
pub use signorini_mechanics::curve::CurvePoint;
use signorini_mechanics::curve::{Closure, Continuity, are_apart, boxes, minima, samples};

/// A local minimum of the distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearby {
    pub points: [CurvePoint; 2],
    pub distance: f64,
}

/// A curve with its configuration: what is searched.
#[derive(Clone, Copy)]
pub struct Searched<'a> {
    pub curve: &'a dyn Curve,
    pub configuration: &'a [f64],
}

/// Whether two curves are searched, or one against itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchScope {
    Two,
    Itself,
}

/// Newton steps of one search: it is quadratic where it is not nearly singular.
const MOST: usize = 60;
/// Share by which the metric is enlarged where it takes the place of the Hessian.
const DAMPING: f64 = 1e-3;
/// Curves closer to parallel than this sine make no crossing: foot points would move a thousand times as far as curves.
const PARALLEL: f64 = 1e-3;

impl Searched<'_> {
    /// At a position along the whole curve: number of the element plus the parameter in it.
    pub fn jet(&self, u: f64) -> CurveJet {
        let (element, xi) = self.split(u);
        self.curve.jet(self.configuration, element, xi)
    }

    fn split(&self, u: f64) -> (usize, f64) {
        let n = self.curve.elements();
        let u = if self.curve.closure() == Closure::Closed { u.rem_euclid(n as f64) } else { u };
        let element = (u.floor().max(0.0) as usize).min(n - 1);
        (element, u - element as f64)
    }

    fn point(&self, u: f64) -> CurvePoint {
        let (element, xi) = self.split(u);
        CurvePoint { element, xi, coordinates: 1 }
    }

    /// How far apart two positions are, in elements.
    pub fn apart(&self, u: f64, v: f64) -> f64 {
        let (n, apart) = (self.curve.elements() as f64, (u - v).abs());
        if self.curve.closure() == Closure::Closed { apart.min((n - apart).abs()) } else { apart }
    }

    /// Ends and kinks.
    fn corners(&self) -> Vec<Corner> {
        let n = self.curve.elements();
        let is_closed = self.curve.closure() == Closure::Closed;
        let tangent = |element: usize, xi: f64| self.curve.jet(self.configuration, element, xi).d1;
        let mut out = Vec::new();
        if !is_closed {
            out.push(Corner { u: 0.0, outward: vec![-tangent(0, 0.0)] });
        }
        if self.curve.continuity() == Continuity::C0 {
            let kinks = if is_closed { 0..n } else { 1..n };
            out.extend(kinks.map(|e| {
                let outward = vec![tangent((e + n - 1) % n, 1.0), -tangent(e, 0.0)];
                Corner { u: e as f64, outward }
            }));
        }
        if !is_closed {
            out.push(Corner { u: n as f64, outward: vec![tangent(n - 1, 1.0)] });
        }
        out
    }
}

/// A point at which a curve ends or has a kink, and the directions in which its sides would go on.
struct Corner {
    u: f64,
    outward: Vec<Vector<3>>,
}

impl Corner {
    /// Whether the distance `d`, from the other curve to this point, falls towards the corner along all sides.
    fn is_nearest(&self, d: &Vector<3>) -> bool {
        self.outward.iter().all(|t| d.dot(t) <= 0.0)
    }
}

/// A minimum with its positions along both curves.
type Place = ([f64; 2], Nearby);

/// Minima so far.
struct Found<'a> {
    sides: [Searched<'a>; 2],
    between: SearchScope,
    limit: f64,
    places: Vec<Place>,
}

impl Found<'_> {
    /// Adds a minimum, unless it is too far, known, or one of a curve with itself next to itself.
    fn add(&mut self, u: [f64; 2], points: [CurvePoint; 2]) {
        let distance = (self.sides[0].jet(u[0]).x - self.sides[1].jet(u[1]).x).norm();
        if distance > self.limit {
            return;
        }
        if self.between == SearchScope::Itself {
            let curve = self.sides[0].curve;
            let arc = |side: usize| curve.arc(points[side].element, points[side].xi);
            // Each pair of points once, the first one along the curve first.
            if u[0] >= u[1] || !are_apart(curve, arc(0), arc(1), distance) {
                return;
            }
        }
        // The same minimum from several starts, or from both sides of a seam.
        let same = |v: &[f64; 2]| (0..2).all(|s| self.sides[s].apart(v[s], u[s]) < SAME);
        if !self.places.iter().any(|p| same(&p.0)) {
            self.places.push((u, Nearby { points, distance }));
        }
    }
}

/// Minima whose parameters, in elements, agree to this are one: searches end closer than that.
const SAME: f64 = 1e-5;

/// How far beyond an end, in elements, a minimum may be and still be one of the curve: rounding of what search and ends find.
const STATIONARY: f64 = 1e-12;

/// All local minima closer than `reach`, surface to surface, in the order of their places.
pub fn crossings(a: Searched<'_>, b: Searched<'_>, between: SearchScope, reach: f64) -> Vec<Nearby> {
    let sides = [a, b];
    let limit = reach + a.curve.radius() + b.curve.radius();
    let boxes = sides.map(|s| boxes(s.curve, s.configuration));
    let trees = [Bvh::new(&boxes[0]), Bvh::new(&boxes[1])];
    let mut found = Found { sides, between, limit, places: Vec::new() };
    for (i, j) in trees[0].pairs_within(&trees[1], (&boxes[0], &boxes[1]), limit) {
        if between == SearchScope::Itself && j < i {
            continue;
        }
        for start in starts([&a, &b], [i, j]) {
            if let Some(u) = descend([&a, &b], start) {
                found.add(u, [a.point(u[0]), b.point(u[1])]);
            }
        }
    }
    let corners = sides.map(|s| s.corners());
    for side in 0..2 {
        let other = 1 - side;
        for corner in &corners[side] {
            let x = sides[side].jet(corner.u).x;
            trees[other].nearest(&x, limit * limit, |element| {
                for m in minima(sides[other].curve, sides[other].configuration, element, &x) {
                    let u = m.element as f64 + m.xi;
                    let d = x - sides[other].jet(u).x;
                    let is_least = corner.is_nearest(&d)
                        && (m.coordinates == 1
                            || corners[other].iter().any(|o| sides[other].apart(o.u, u) < SAME && o.is_nearest(&-d)));
                    if is_least {
                        let own = CurvePoint { coordinates: 0, ..sides[side].point(corner.u) };
                        let met = CurvePoint { element: m.element, xi: m.xi, coordinates: m.coordinates };
                        let pair = if side == 0 { ([corner.u, u], [own, met]) } else { ([u, corner.u], [met, own]) };
                        let swap = between == SearchScope::Itself && pair.0[0] > pair.0[1];
                        let turned = |(u, p): ([f64; 2], [CurvePoint; 2])| ([u[1], u[0]], [p[1], p[0]]);
                        let (u, points) = if swap { turned(pair) } else { pair };
                        found.add(u, points);
                    }
                }
                limit * limit
            });
        }
    }
    found.places.sort_by(|p, q| p.0[0].total_cmp(&q.0[0]).then(p.0[1].total_cmp(&q.0[1])));
    found.places.into_iter().map(|f| f.1).collect()
}

/// Samples of a pair of elements whose distance is not larger than that of their neighbours.
fn starts(sides: [&Searched<'_>; 2], elements: [usize; 2]) -> Vec<[f64; 2]> {
    let grids: [Vec<f64>; 2] = [0, 1].map(|s| {
        let count = samples(sides[s].curve, sides[s].configuration, elements[s]);
        (0..=count).map(|k| elements[s] as f64 + k as f64 / count as f64).collect()
    });
    // A parameter at the end of an element is that of the same element.
    let at = |s: usize, u: f64| {
        let xi = u - elements[s] as f64;
        sides[s].curve.jet(sides[s].configuration, elements[s], xi).x
    };
    let x: [Vec<_>; 2] = [0, 1].map(|s| grids[s].iter().map(|u| at(s, *u)).collect());
    let d = |i: usize, j: usize| (x[0][i] - x[1][j]).norm_squared();
    let (m, n) = (grids[0].len(), grids[1].len());
    let mut out = Vec::new();
    for i in 0..m {
        for j in 0..n {
            let own = d(i, j);
            let is_least = (i.saturating_sub(1)..=(i + 1).min(m - 1))
                .all(|p| (j.saturating_sub(1)..=(j + 1).min(n - 1)).all(|q| own <= d(p, q)));
            if is_least {
                out.push([grids[0][i], grids[1][j]]);
            }
        }
    }
    out
}

/// The local minimum below a start; none along parallel curves, or where the search runs to an end.
fn descend(sides: [&Searched<'_>; 2], start: [f64; 2]) -> Option<[f64; 2]> {
    let clamp = |s: usize, u: f64| match sides[s].curve.closure() {
        Closure::Open => u.clamp(0.0, sides[s].curve.elements() as f64),
        Closure::Closed => u,
    };
    let mut u = start;
    for _ in 0..MOST {
        let [p, q] = [sides[0].jet(u[0]), sides[1].jet(u[1])];
        let d = p.x - q.x;
        let gradient = [d.dot(&p.d1), -d.dot(&q.d1)];
        let metric = [p.d1.norm_squared(), q.d1.norm_squared(), -p.d1.dot(&q.d1)];
        let full = [metric[0] + d.dot(&p.d2), metric[1] - d.dot(&q.d2), metric[2]];
        let determinant = |m: &[f64; 3]| m[0] * m[1] - m[2] * m[2];
        let is_minimum = full[0] > 0.0 && determinant(&full) > PARALLEL * PARALLEL * metric[0] * metric[1];
        let used =
            if is_minimum { full } else { [metric[0] * (1.0 + DAMPING), metric[1] * (1.0 + DAMPING), metric[2]] };
        let det = determinant(&used);
        let step = [
            (-gradient[0] * used[1] + gradient[1] * used[2]) / det,
            (-gradient[1] * used[0] + gradient[0] * used[2]) / det,
        ];
        // Steps of more than an element are cut: the Hessian is not known that far.
        let largest = step[0].abs().max(step[1].abs());
        let mut share = (1.0 / largest).min(1.0);
        let before = d.norm_squared();
        let mut next = u;
        for _ in 0..40 {
            next = [0, 1].map(|s| clamp(s, u[s] + share * step[s]));
            let after = (sides[0].jet(next[0]).x - sides[1].jet(next[1]).x).norm_squared();
            if after <= before * (1.0 + 1e-15) {
                break;
            }
            share *= 0.5;
        }
        let moved = (next[0] - u[0]).abs().max((next[1] - u[1]).abs());
        u = next;
        let size = f64::EPSILON * (u[0].abs() + u[1].abs() + 1.0);
        if largest <= 8.0 * size {
            return is_minimum.then_some(u);
        }
        if moved <= size {
            // Halted where rounding hides any descent, or at an end: beyond that the distance is not stationary.
            let ends = [0, 1].map(|s| (sides[s].curve.closure() == Closure::Open, sides[s].curve.elements() as f64));
            let is_beyond =
                |s: usize| ends[s].0 && ((u[s] == 0.0 && step[s] < 0.0) || (u[s] == ends[s].1 && step[s] > 0.0));
            let most = if (0..2).any(is_beyond) { STATIONARY } else { SAME };
            return (is_minimum && largest < most).then_some(u);
        }
    }
    None
}
