//! Local minima of the distance of two curves, and of a curve to itself.
//!
//! Boxes of elements that are near each other make candidates. Within a pair of elements the samples whose distance is a
//! local minimum start a search with Newton's method on `½ |x_A - x_B|²`, with the metric in place of the Hessian where that
//! is not positive definite, damped, and with ends as bounds. It may run on into neighbouring elements. Curves that run
//! along each other have no isolated minimum and give none: line contact is for them.

use super::super::curve_body::{CurveBody, are_apart, boxes, samples};
use crate::centreline::{Centreline, Closure};
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

/// All local minima closer than `reach`, surface to surface, in the order of their places.
pub fn crossings(a: Searched<'_>, b: Searched<'_>, between: Between, reach: f64) -> Vec<Nearby> {
    let lines = [a.body.centreline(), b.body.centreline()];
    let limit = reach + a.body.radius() + b.body.radius();
    let boxes = [boxes(a.body, a.state), boxes(b.body, b.state)];
    let trees = [Bvh::new(&boxes[0]), Bvh::new(&boxes[1])];
    let mut found: Vec<([f64; 2], Nearby)> = Vec::new();
    for (i, j) in trees[0].pairs_within(&trees[1], (&boxes[0], &boxes[1]), limit) {
        if between == Between::Itself && j < i {
            continue;
        }
        for start in starts([&a, &b], [i, j]) {
            let Some(u) = descend([&a, &b], start) else { continue };
            let points: [CurvePoint; 2] = [0, 1].map(|side| {
                let (element, xi) = split(lines[side], u.0[side]);
                CurvePoint { element, xi, coordinates: usize::from(!u.1[side]) }
            });
            let x = [jet(&a, u.0[0]), jet(&b, u.0[1])];
            let distance = (x[0].x - x[1].x).norm();
            if distance > limit {
                continue;
            }
            if between == Between::Itself {
                let arc = |side: usize| lines[side].arc(points[side].element, points[side].xi);
                if u.0[0] >= u.0[1] || !are_apart(lines[0], a.body.radius(), arc(0), arc(1), distance) {
                    continue;
                }
            }
            // The same minimum from several starts, or from both sides of a seam.
            let same = |v: &[f64; 2]| {
                (0..2).all(|s| {
                    let n = lines[s].elements() as f64;
                    let apart = (v[s] - u.0[s]).abs();
                    let apart = if lines[s].closure == Closure::Closed { apart.min(n - apart) } else { apart };
                    apart < 1e-5
                })
            };
            if !found.iter().any(|f| same(&f.0)) {
                found.push((u.0, Nearby { points, distance }));
            }
        }
    }
    found.sort_by(|p, q| p.0[0].total_cmp(&q.0[0]).then(p.0[1].total_cmp(&q.0[1])));
    found.into_iter().map(|f| f.1).collect()
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

/// The local minimum below a start, and which coordinates are held at ends; none along parallel curves.
fn descend(sides: [&Searched<'_>; 2], start: [f64; 2]) -> Option<([f64; 2], [bool; 2])> {
    let lines = sides.map(|s| s.body.centreline());
    let bounds: [Option<[f64; 2]>; 2] = [0, 1].map(|s| match lines[s].closure {
        Closure::Open => Some([0.0, lines[s].elements() as f64]),
        Closure::Closed => None,
    });
    let clamp = |s: usize, u: f64| bounds[s].map_or(u, |[low, high]| u.clamp(low, high));
    let mut u = start;
    for _ in 0..MOST {
        let [p, q] = [jet(sides[0], u[0]), jet(sides[1], u[1])];
        let d = p.x - q.x;
        let gradient = [d.dot(&p.d1), -d.dot(&q.d1)];
        let held: [bool; 2] = [0, 1].map(|s| {
            bounds[s]
                .is_some_and(|[low, high]| (u[s] <= low && gradient[s] >= 0.0) || (u[s] >= high && gradient[s] <= 0.0))
        });
        let metric = [p.d1.norm_squared(), q.d1.norm_squared(), -p.d1.dot(&q.d1)];
        let full = [metric[0] + d.dot(&p.d2), metric[1] - d.dot(&q.d2), metric[2]];
        let determinant = |m: &[f64; 3]| m[0] * m[1] - m[2] * m[2];
        let scale = metric[0] * metric[1];
        let is_minimum = match held {
            [false, false] => full[0] > 0.0 && determinant(&full) > PARALLEL * PARALLEL * scale,
            [true, false] => full[1] > 0.0,
            [false, true] => full[0] > 0.0,
            [true, true] => true,
        };
        let used = if is_minimum { full } else { [metric[0] * (1.0 + 1e-3), metric[1] * (1.0 + 1e-3), metric[2]] };
        let step = match held {
            [true, true] => return Some((u, held)),
            [true, false] => [0.0, -gradient[1] / used[1]],
            [false, true] => [-gradient[0] / used[0], 0.0],
            [false, false] => {
                let det = determinant(&used);
                [
                    (-gradient[0] * used[1] + gradient[1] * used[2]) / det,
                    (-gradient[1] * used[0] + gradient[0] * used[2]) / det,
                ]
            }
        };
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
        if largest < 1e-13 || moved < 1e-15 {
            return is_minimum.then_some((u, held));
        }
    }
    None
}
