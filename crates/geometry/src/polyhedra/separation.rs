//! A plane that separates two polyhedra where a corner or an edge of one touches a corner or an edge of the other.
//!
//! Beside such a place each body is the cone of the directions into it. The plane is one of a facet of either body, along an
//! edge of each, or half way between the mean normals; of these the one from which both cones keep farthest. So bodies whose corners
//! lie on each other, such as stones of one size in a stack, touch by their facets; corners that strike head on do so along both.

use super::{Feature, Placed};
use crate::Vector;

/// Sines of angles to planes that are equal but for rounding.
const SAME: f64 = 1e-9;
/// Sine by which the plane may cut into a cone: of bodies that overlap by rounding.
pub(super) const CUTS: f64 = 1e-6;

/// How the normal of a meeting turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Turning {
    /// With one of the bodies.
    With(usize),
    /// As what is across an edge of each: unit vectors along both, and their duals in the plane of both.
    Across { along: [Vector<3>; 2], dual: [Vector<3>; 2] },
    /// As the difference of two normals, one of each body.
    Between([Vector<3>; 2]),
    /// As the distance from an edge, which turns with a body, to a point at a gap.
    FromEdge { body: usize, along: Vector<3>, gap: f64 },
    /// As the distance of two points.
    Apart { gap: f64 },
}

impl Turning {
    /// The change of the normal with the relative motion of the points that meet, and the spins of both bodies.
    pub(super) fn rate(&self, normal: &Vector<3>, moved: &Vector<3>, spins: [Vector<3>; 2]) -> Vector<3> {
        let across = |v: Vector<3>| v - normal * normal.dot(&v);
        match self {
            Turning::With(body) => spins[*body].cross(normal),
            Turning::Across { along, dual } => {
                let of = |k: usize| dual[k] * -normal.dot(&spins[k].cross(&along[k]));
                of(0) + of(1)
            }
            Turning::Between([a, b]) => across(spins[1].cross(b) - spins[0].cross(a)) / (b - a).norm(),
            Turning::FromEdge { body, along, gap } => {
                let beside = normal.cross(along);
                along * -normal.dot(&spins[*body].cross(along)) + beside * (beside.dot(moved) / gap)
            }
            Turning::Apart { gap } => across(*moved) / *gap,
        }
    }
}

/// Duals of two unit vectors in their plane.
pub(super) fn duals(a: &Vector<3>, b: &Vector<3>) -> [Vector<3>; 2] {
    let c = a.dot(b);
    let scale = 1.0 / (1.0 - c * c);
    [(a - b * c) * scale, (b - a * c) * scale]
}

impl Placed<'_> {
    /// Directions into the body at a feature, and the normals of its facets there; in space.
    fn cone(&self, feature: Feature) -> (Vec<Vector<3>>, Vec<Vector<3>>, Vec<Vector<3>>, Vector<3>) {
        let shape = self.features;
        let turned = |v: &Vector<3>| self.rotation * v;
        let normals = |of: &[usize]| of.iter().map(|f| turned(&shape.facets()[*f].normal)).collect::<Vec<_>>();
        match feature {
            Feature::Facet(k) => {
                let normal = turned(&shape.facets()[k].normal);
                (Vec::new(), vec![normal], Vec::new(), normal)
            }
            Feature::Edge(k) => {
                let edge = &shape.edges()[k];
                let along = turned(&edge.along);
                let normals = normals(&edge.facets);
                let mean = (normals[0] + normals[1]).normalize();
                let into = vec![along, -along, turned(&edge.inwards[0]), turned(&edge.inwards[1])];
                (into, normals, vec![along], mean)
            }
            Feature::Corner(k) => {
                let corner = &shape.corners()[k];
                let along: Vec<Vector<3>> = corner.along.iter().map(turned).collect();
                (along.clone(), normals(&corner.facets), along, turned(&corner.normal))
            }
        }
    }
}

/// The normal of a plane between two bodies that touch at a feature of each, from the second to the first, and how it turns; none
/// where they overlap, unless they are known to touch.
pub(super) fn separation(bodies: [&Placed<'_>; 2], on: [Feature; 2], is_known: bool) -> Option<(Vector<3>, Turning)> {
    let [(into, normals, along, mean), (other_into, other_normals, other_along, other_mean)] =
        [0, 1].map(|k| bodies[k].cone(on[k]));
    let mut best: Option<([f64; 2], Vector<3>, Turning)> = None;
    let mut offer = |n: Vector<3>, turning: Turning| {
        let heights = || into.iter().map(|d| n.dot(d)).chain(other_into.iter().map(|d| -n.dot(d)));
        let (least, sum) = (heights().fold(f64::INFINITY, f64::min), heights().sum::<f64>());
        let is_better =
            best.as_ref().is_none_or(|(b, ..)| least > b[0] + SAME || (least > b[0] - SAME && sum > b[1] + SAME));
        if (is_known || least >= -CUTS) && is_better {
            best = Some(([least, sum], n, turning));
        }
    };
    other_normals.iter().for_each(|n| offer(*n, Turning::With(1)));
    normals.iter().for_each(|n| offer(-n, Turning::With(0)));
    if let Some(n) = (other_mean - mean).try_normalize(SAME) {
        offer(n, Turning::Between([mean, other_mean]));
    }
    for a in &along {
        for b in &other_along {
            if let Some(n) = a.cross(b).try_normalize(SAME) {
                let turning = Turning::Across { along: [*a, *b], dual: duals(a, b) };
                offer(n, turning);
                offer(-n, turning);
            }
        }
    }
    best.map(|(_, n, turning)| (n, turning))
}
