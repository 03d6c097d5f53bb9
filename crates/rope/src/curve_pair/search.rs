//! Local minima of the distance of two curves, and of a curve to itself.
//!
//! Boxes of elements that are near each other make candidates. Within a pair of elements the samples whose distance is a
//! local minimum start a search with Newton's method on `½ |x_A - x_B|²`, with the metric in place of the Hessian where that
//! is not positive definite, damped, and with ends as bounds. It may run on into neighbouring elements. Curves that run
//! along each other have no isolated minimum and give none: line contact is for them. Ends are minima of their own where
//! the distance falls towards them: each is projected onto the other curve.

use crate::centreline::{Centreline, Closure};
use crate::curve_body::{CurveBody, are_apart, boxes, minima, samples};
use signorini_geometry::Vector;
use signorini_geometry::bvh::Bvh;
use signorini_geometry::shape::CurveJet;
use signorini_mechanics::body::BodyState;

/// A point of a curve: free to move along it, or held at an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    pub element: usize,
    pub xi: f64,
    /// 1 along the curve, 0 at an end.
    pub coordinates: usize,
}

/// A local minimum of the distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearby {
    pub points: [CurvePoint; 2],
    pub distance: f64,
}

/// A curve with positions: what is searched.
#[derive(Clone, Copy)]
pub struct Searched<'a> {
    pub body: &'a dyn CurveBody,
    pub state: &'a BodyState,
}

/// Whether two curves are searched, or one against itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Between {
    Two,
    Itself,
}

/// Newton steps of one search: it is quadratic where it is not nearly singular.
const MOST: usize = 60;
/// Share by which the metric is enlarged where it takes the place of the Hessian.
const DAMPING: f64 = 1e-3;
/// Curves closer to parallel than this sine make no crossing: foot points would move a thousand times as far as curves.
const PARALLEL: f64 = 1e-3;

/// A position along a whole curve: number of the element plus the parameter in it.
fn jet(searched: &Searched<'_>, u: f64) -> CurveJet {
    let line = searched.body.centreline();
    let (element, xi) = split(line, u);
    line.jet(&searched.state.configuration, element, xi)
}

fn split(line: &Centreline, u: f64) -> (usize, f64) {
    let n = line.elements();
    let u = if line.closure == Closure::Closed { u.rem_euclid(n as f64) } else { u };
    let element = (u.floor().max(0.0) as usize).min(n - 1);
    (element, u - element as f64)
}

/// A minimum with its positions along both curves.
type Place = ([f64; 2], Nearby);

/// Minima so far.
struct Found<'a> {
    sides: [Searched<'a>; 2],
    between: Between,
    limit: f64,
    places: Vec<Place>,
}

impl Found<'_> {
    /// Adds a minimum, unless it is too far, known, or one of a curve with itself next to itself.
    fn add(&mut self, u: [f64; 2], points: [CurvePoint; 2]) {
        let lines = self.sides.map(|s| s.body.centreline());
        let distance = (jet(&self.sides[0], u[0]).x - jet(&self.sides[1], u[1]).x).norm();
        if distance > self.limit {
            return;
        }
        if self.between == Between::Itself {
            let arc = |side: usize| lines[side].arc(points[side].element, points[side].xi);
            // Each pair of points once, the first one along the curve first.
            if u[0] >= u[1] || !are_apart(lines[0], self.sides[0].body.radius(), arc(0), arc(1), distance) {
                return;
            }
        }
        // The same minimum from several starts, or from both sides of a seam.
        let same = |v: &[f64; 2]| {
            (0..2).all(|s| {
                let n = lines[s].elements() as f64;
                let apart = (v[s] - u[s]).abs();
                let apart = if lines[s].closure == Closure::Closed { apart.min(n - apart) } else { apart };
                apart < SAME
            })
        };
        if !self.places.iter().any(|p| same(&p.0)) {
            self.places.push((u, Nearby { points, distance }));
        }
    }
}

/// Minima whose parameters, in elements, agree to this are one: searches end closer than that.
const SAME: f64 = 1e-5;

/// All local minima closer than `reach`, surface to surface, in the order of their places.
pub fn crossings(a: Searched<'_>, b: Searched<'_>, between: Between, reach: f64) -> Vec<Nearby> {
    let sides = [a, b];
    let limit = reach + a.body.radius() + b.body.radius();
    let boxes = sides.map(|s| boxes(s.body, s.state));
    let trees = [Bvh::new(&boxes[0]), Bvh::new(&boxes[1])];
    let mut found = Found { sides, between, limit, places: Vec::new() };
    for (i, j) in trees[0].pairs_within(&trees[1], (&boxes[0], &boxes[1]), limit) {
        if between == Between::Itself && j < i {
            continue;
        }
        for start in starts([&a, &b], [i, j]) {
            if let Some(u) = descend([&a, &b], start) {
                let points = [0, 1].map(|side| {
                    let (element, xi) = split(sides[side].body.centreline(), u[side]);
                    CurvePoint { element, xi, coordinates: 1 }
                });
                found.add(u, points);
            }
        }
    }
    let own_ends = sides.map(|s| ends(&s));
    for side in 0..2 {
        let other = 1 - side;
        for end in &own_ends[side] {
            let x = jet(&sides[side], end.u).x;
            let line = sides[other].body.centreline();
            trees[other].nearest(&x, limit * limit, |element| {
                for m in minima(line, &sides[other].state.configuration, element, &x) {
                    let u = m.element as f64 + m.xi;
                    let d = x - jet(&sides[other], u).x;
                    // The distance falls towards the end, and at the other's end towards that.
                    let beyond = |outward: Vector<3>, d: Vector<3>| d.dot(&outward) <= 0.0;
                    let is_least = beyond(end.outward, d)
                        && (m.coordinates == 1
                            || own_ends[other].iter().any(|o| (o.u - u).abs() < SAME && beyond(o.outward, -d)));
                    if is_least {
                        let own = CurvePoint { coordinates: 0, ..point(&sides[side], end.u) };
                        let met = CurvePoint { element: m.element, xi: m.xi, coordinates: m.coordinates };
                        let ordered = side == 0;
                        let pair = if ordered { ([end.u, u], [own, met]) } else { ([u, end.u], [met, own]) };
                        let swap = between == Between::Itself && pair.0[0] > pair.0[1];
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

fn point(searched: &Searched<'_>, u: f64) -> CurvePoint {
    let (element, xi) = split(searched.body.centreline(), u);
    CurvePoint { element, xi, coordinates: 1 }
}

/// An end of a curve, and the direction in which it would go on.
struct End {
    u: f64,
    outward: Vector<3>,
}

fn ends(searched: &Searched<'_>) -> Vec<End> {
    let line = searched.body.centreline();
    if line.closure == Closure::Closed {
        return Vec::new();
    }
    let last = line.elements() as f64;
    [(0.0, -1.0), (last, 1.0)].map(|(u, sign)| End { u, outward: jet(searched, u).d1 * sign }).into()
}

/// Samples of a pair of elements whose distance is not larger than that of their neighbours.
fn starts(sides: [&Searched<'_>; 2], elements: [usize; 2]) -> Vec<[f64; 2]> {
    let grids: [Vec<f64>; 2] = [0, 1].map(|s| {
        let count = samples(sides[s].body.centreline(), &sides[s].state.configuration, elements[s]);
        (0..=count).map(|k| elements[s] as f64 + k as f64 / count as f64).collect()
    });
    // A parameter at the end of an element is that of the same element.
    let at = |s: usize, u: f64| {
        let xi = u - elements[s] as f64;
        sides[s].body.centreline().jet(&sides[s].state.configuration, elements[s], xi).x
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
    let lines = sides.map(|s| s.body.centreline());
    let clamp = |s: usize, u: f64| match lines[s].closure {
        Closure::Open => u.clamp(0.0, lines[s].elements() as f64),
        Closure::Closed => u,
    };
    let mut u = start;
    for _ in 0..MOST {
        let [p, q] = [jet(sides[0], u[0]), jet(sides[1], u[1])];
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
            let after = (jet(sides[0], next[0]).x - jet(sides[1], next[1]).x).norm_squared();
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
            // Halted at an end, or where rounding hides any descent.
            return (is_minimum && largest < SAME).then_some(u);
        }
    }
    None
}
