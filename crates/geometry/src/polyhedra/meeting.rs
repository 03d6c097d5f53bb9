//! Where two polyhedra meet: pairs of features with gap, normal, and how both change.

use super::separation::{CUTS, Turning, duals, separation};
use super::{Edge, Feature, Features};
use crate::straight::{along as on_segment, segments};
use crate::{Aabb, Matrix, Point, Vector};
use std::collections::BTreeSet;

/// Sine of the angle between edges that cross; others lie along each other, and meet by their ends.
const CROSSING: f64 = 1e-6;
/// Sine by which a normal may lie beside those of two facets and count as between them: rounding of those.
const BETWEEN: f64 = 1e-9;

/// A polyhedron where it is: a point `x` of it is at `centre + rotation (x - origin)`.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    pub features: &'a Features,
    pub rotation: Matrix<3>,
    pub origin: Point<3>,
    pub centre: Point<3>,
}

/// A pair of features that face each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// Of the first and of the second body.
    pub on: [Feature; 2],
    /// Where each is nearest to the other.
    pub points: [Point<3>; 2],
    /// Negative where the bodies overlap.
    pub gap: f64,
    /// From the second body to the first.
    pub normal: Vector<3>,
    turning: Turning,
}

impl Meeting {
    /// The change of the normal, with the motion of the point of the first body relative to that of the second, and the spins of
    /// both. With it the second variation of the gap is `n·δ²(x - y) + δn·δ(x - y) + δ(x - y)·δn - g δn·δn`.
    pub fn normal_rate(&self, moved: &Vector<3>, spins: [Vector<3>; 2]) -> Vector<3> {
        self.turning.rate(&self.normal, moved, spins)
    }
}

impl Placed<'_> {
    /// A point of the body, in space.
    pub fn point(&self, x: &Point<3>) -> Point<3> {
        self.centre + self.rotation * (x - self.origin)
    }

    /// A point in space, seen from the body.
    fn seen(&self, x: &Point<3>) -> Point<3> {
        self.origin + self.rotation.transpose() * (x - self.centre)
    }

    fn middle(&self) -> Point<3> {
        self.point(&self.features.middle())
    }

    fn ends(&self, edge: &Edge) -> [Point<3>; 2] {
        edge.ends.map(|x| self.point(&x))
    }

    /// By how much a unit vector across an edge looks into one of its facets; it lies between their outward normals where that is
    /// nothing.
    fn beside(&self, normal: &Vector<3>, edge: &Edge) -> f64 {
        edge.inwards.iter().map(|into| normal.dot(&(self.rotation * into))).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether a point in space is in the body, or on it.
    fn holds(&self, x: &Point<3>, snap: f64) -> bool {
        self.features.nearest(&self.seen(x), 0.0).is_some_and(|(_, gap)| gap <= snap)
    }
}

/// The height of a point over a facet, and the normal of that.
fn over(body: &Placed<'_>, facet: usize, x: &Point<3>) -> (f64, Vector<3>) {
    let own = &body.features.facets()[facet];
    let normal = body.rotation * own.normal;
    (normal.dot(&(x - body.point(&own.point))), normal)
}

/// A pair of features in a state. Features are taken to go on beyond their ends, so that gaps are smooth functions of the
/// state. What is nearer than `snap` touches; with an infinite one what touched before is followed, whichever way it moves. None
/// where both do not face each other.
pub fn meeting(bodies: [&Placed<'_>; 2], on: [Feature; 2], snap: f64) -> Option<Meeting> {
    let corner = |k: usize, number: usize| bodies[k].point(&bodies[k].features.corners()[number].point);
    let foot = |k: usize, number: usize, x: &Point<3>| {
        let edge = &bodies[k].features.edges()[number];
        let (from, along) = (bodies[k].point(&edge.ends[0]), bodies[k].rotation * edge.along);
        (from + along * along.dot(&(x - from)), along)
    };
    match on {
        [Feature::Corner(v), Feature::Facet(f)] => {
            let x = corner(0, v);
            let (gap, normal) = over(bodies[1], f, &x);
            Some(Meeting { on, points: [x, x - normal * gap], gap, normal, turning: Turning::With(1) })
        }
        [Feature::Facet(f), Feature::Corner(w)] => {
            let y = corner(1, w);
            let (gap, normal) = over(bodies[0], f, &y);
            Some(Meeting { on, points: [y - normal * gap, y], gap, normal: -normal, turning: Turning::With(0) })
        }
        [Feature::Edge(a), Feature::Edge(b)] => crossing(bodies, [a, b], snap.is_infinite()),
        [Feature::Corner(v), Feature::Corner(w)] => {
            let (x, y) = (corner(0, v), corner(1, w));
            beside(bodies, on, [x, y], snap, &|gap| Turning::Apart { gap })
        }
        [Feature::Corner(v), Feature::Edge(b)] => {
            let x = corner(0, v);
            let (y, along) = foot(1, b, &x);
            beside(bodies, on, [x, y], snap, &|gap| Turning::FromEdge { body: 1, along, gap })
        }
        [Feature::Edge(a), Feature::Corner(w)] => {
            let y = corner(1, w);
            let (x, along) = foot(0, a, &y);
            beside(bodies, on, [x, y], snap, &|gap| Turning::FromEdge { body: 0, along, gap })
        }
        _ => None,
    }
}

/// A corner beside an edge or a corner.
fn beside(
    bodies: [&Placed<'_>; 2],
    on: [Feature; 2],
    points: [Point<3>; 2],
    snap: f64,
    turning: &dyn Fn(f64) -> Turning,
) -> Option<Meeting> {
    let d = points[0] - points[1];
    let distance = d.norm();
    if distance > snap {
        // The side on which the point lies is that of the mean normal (Baerentzen & Aanaes 2005).
        let mean = |k: usize| match on[k] {
            Feature::Edge(e) => {
                let edge = &bodies[k].features.edges()[e];
                edge.facets.iter().map(|f| bodies[k].features.facets()[*f].normal).sum::<Vector<3>>()
            }
            Feature::Corner(c) => bodies[k].features.corners()[c].normal,
            Feature::Facet(f) => bodies[k].features.facets()[f].normal,
        };
        let sides = [-(bodies[0].rotation * mean(0)).dot(&d), (bodies[1].rotation * mean(1)).dot(&d)];
        // Of an edge it is its body that tells the side, of two corners either, as one need not be the nearest of the other.
        let is_inside = match on {
            [Feature::Edge(_), _] => sides[0] < 0.0,
            [_, Feature::Edge(_)] => sides[1] < 0.0,
            _ => sides[0] < 0.0 && sides[1] < 0.0,
        };
        let sign = if is_inside { -1.0 } else { 1.0 };
        let gap = sign * distance;
        return Some(Meeting { on, points, gap, normal: d / gap, turning: turning(gap) });
    }
    let (normal, turning) = separation(bodies, on, snap.is_infinite())?;
    Some(Meeting { on, points, gap: normal.dot(&d), normal, turning })
}

/// Two edges that cross; none of edges along each other, or that do not face each other unless they are known to touch.
fn crossing(bodies: [&Placed<'_>; 2], [a, b]: [usize; 2], is_known: bool) -> Option<Meeting> {
    let edges = [&bodies[0].features.edges()[a], &bodies[1].features.edges()[b]];
    let along = [0, 1].map(|k| bodies[k].rotation * edges[k].along);
    let cross = along[0].cross(&along[1]);
    if cross.norm() <= CROSSING || !edges.iter().all(|e| e.is_convex) {
        return None;
    }
    let one = cross.normalize();
    // How far a direction lies beside the outward normals of the facets of both edges, the most.
    let beside = |n: &Vector<3>| bodies[1].beside(n, edges[1]).max(bodies[0].beside(&-n, edges[0]));
    let normal = if beside(&one) <= beside(&-one) { one } else { -one };
    if !is_known && beside(&normal) > BETWEEN {
        return None;
    }
    let dual = duals(&along[0], &along[1]);
    let from = [0, 1].map(|k| bodies[k].point(&edges[k].ends[0]));
    let d = from[0] - from[1];
    // The points at which what is between them is across both.
    let points = [from[0] - along[0] * dual[0].dot(&d), from[1] + along[1] * dual[1].dot(&d)];
    Some(Meeting {
        on: [Feature::Edge(a), Feature::Edge(b)],
        points,
        gap: normal.dot(&d),
        normal,
        turning: Turning::Across { along, dual },
    })
}

/// All pairs of features by which two polyhedra are no farther apart than `reach`, or overlap.
pub fn meetings(bodies: [&Placed<'_>; 2], reach: f64, snap: f64) -> Vec<Meeting> {
    let apart = (bodies[0].middle() - bodies[1].middle()).norm();
    if apart - bodies[0].features.radius() - bodies[1].features.radius() > reach {
        return Vec::new();
    }
    let mut pairs = BTreeSet::new();
    for k in 0..2 {
        let other = bodies[1 - k].features;
        let near = grown(other.mesh().bounds(), reach);
        for (number, corner) in bodies[k].features.corners().iter().enumerate() {
            let x = bodies[1 - k].seen(&bodies[k].point(&corner.point));
            if !near.contains(&x) {
                continue;
            }
            let Some((on, gap)) = other.nearest(&x, snap) else { continue };
            if gap > reach {
                continue;
            }
            // In a hollow there are several facets side by side.
            let places = match on {
                Feature::Edge(e) if gap.abs() <= snap && !other.edges()[e].is_convex => {
                    other.edges()[e].facets.map(Feature::Facet).to_vec()
                }
                Feature::Corner(c) if gap.abs() <= snap && !other.corners()[c].hollow.is_empty() => {
                    other.corners()[c].hollow.iter().map(|f| Feature::Facet(*f)).collect()
                }
                on if gap.abs() <= snap => vec![pushed_out(bodies, (k, number), on, (&x, snap)).unwrap_or(on)],
                on => vec![on],
            };
            pairs.extend(places.into_iter().map(|on| of_corner((k, number), on)));
        }
    }
    let mut out: Vec<Meeting> = pairs.into_iter().filter_map(|on| meeting(bodies, on, snap)).collect();
    out.extend(crossings(bodies, reach, snap));
    out
}

/// A corner of one of the bodies, and what of the other one it meets.
fn of_corner((k, corner): (usize, usize), on: Feature) -> [Feature; 2] {
    let own = Feature::Corner(corner);
    if k == 0 { [own, on] } else { [on, own] }
}

/// A facet over a corner that lies on the other body, at a place beside which both bodies overlap: faces of both in one plane, or
/// edges on each other, have its nearest place on a side through which it did not come. Of the facets that the body of the corner
/// does not cut there, the nearest; none where the bodies do not overlap.
fn pushed_out(
    bodies: [&Placed<'_>; 2],
    (k, number): (usize, usize),
    on: Feature,
    (x, snap): (&Point<3>, f64),
) -> Option<Feature> {
    let other = bodies[1 - k].features;
    // The edges at the corner, as the other body sees them.
    let seen = bodies[1 - k].rotation.transpose() * bodies[k].rotation;
    let along: Vec<Vector<3>> = bodies[k].features.corners()[number].along.iter().map(|d| seen * d).collect();
    let is_cut = |f: usize| along.iter().any(|d| d.dot(&other.facets()[f].normal) < -CUTS);
    let overlaps = match on {
        Feature::Facet(f) => is_cut(f),
        _ => meeting(bodies, of_corner((k, number), on), snap).is_none(),
    };
    let height = |f: usize| {
        let facet = &other.facets()[f];
        facet.normal.dot(&(x - facet.point))
    };
    // Whether the foot on the plane of a facet is on the facet.
    let is_on = |f: usize| {
        let foot = x - other.facets()[f].normal * height(f);
        match other.nearest(&foot, snap) {
            Some((_, gap)) if gap.abs() > snap => false,
            Some((Feature::Facet(own), _)) => own == f,
            Some((Feature::Edge(e), _)) => other.edges()[e].facets.contains(&f),
            Some((Feature::Corner(c), _)) => other.corners()[c].facets.contains(&f),
            None => false,
        }
    };
    if !overlaps {
        return None;
    }
    let facets = (0..other.facets().len()).filter(|f| height(*f) < -snap && !is_cut(*f) && is_on(*f));
    facets.max_by(|a, b| height(*a).total_cmp(&height(*b))).map(Feature::Facet)
}

/// The edges that cross within both.
fn crossings(bodies: [&Placed<'_>; 2], reach: f64, snap: f64) -> Vec<Meeting> {
    let boxes = [0, 1].map(|k| {
        let own = bodies[k].features;
        let near = grown(bodies[1 - k].features.mesh().bounds(), reach);
        let convex = own.edges().iter().enumerate().filter(|(_, e)| e.is_convex);
        convex
            .filter_map(|(number, edge)| {
                let ends = bodies[k].ends(edge);
                let [p, q] = ends.map(|x| bodies[1 - k].seen(&x));
                let there = Aabb::new(p.inf(&q), p.sup(&q));
                overlap(&there, &near).then_some((
                    number,
                    ends,
                    Aabb::new(ends[0].inf(&ends[1]), ends[0].sup(&ends[1])),
                ))
            })
            .collect::<Vec<_>>()
    });
    // Twice the width is the thickness of a square bar.
    let deepest = 2.0 * bodies[0].features.width().min(bodies[1].features.width());
    let mut out = Vec::new();
    for (a, p, of_a) in &boxes[0] {
        let near = grown(of_a, reach.max(deepest));
        for (b, q, of_b) in boxes[1].iter() {
            if !overlap(&near, of_b) {
                continue;
            }
            let pair = segments(p, q);
            let inside = |k: usize, ends: &[Point<3>; 2]| {
                let place = on_segment(&ends[0], &ends[1], pair.parameters[k]);
                ends.iter().all(|end| (place - end).norm() > snap)
            };
            if !inside(0, p) || !inside(1, q) {
                continue;
            }
            let Some(found) = crossing(bodies, [*a, *b], false) else { continue };
            // Behind each other are also edges at the far sides of bodies: those are in nothing.
            let is_real = found.gap >= -snap
                || (found.gap > -deepest
                    && bodies[1].holds(&found.points[0], snap)
                    && bodies[0].holds(&found.points[1], snap));
            if found.gap <= reach && is_real {
                out.push(found);
            }
        }
    }
    out
}

fn grown(of: &Aabb<3>, by: f64) -> Aabb<3> {
    Aabb::new(of.min - Vector::<3>::repeat(by), of.max + Vector::<3>::repeat(by))
}

fn overlap(a: &Aabb<3>, b: &Aabb<3>) -> bool {
    (0..3).all(|i| a.min[i] <= b.max[i] && b.min[i] <= a.max[i])
}
