//! On which side of a closed mesh a point lies.
//!
//! The pseudo-normal at the closest point tells the side of that sheet of the surface. Where the mesh is one shell that
//! nowhere meets itself and has no triangle too thin for a normal, the sheet bounds the body and this is the answer. Else
//! the winding number is: how often a ray leaves through the mesh, less how often it enters. Shells that overlap make
//! the union of what they hold; a shell turned inwards takes a cavity away.

use super::{TriangleMesh, triangle_box, triangle_triangle};
use crate::scale::unit_for;
use crate::sets::root;
use crate::{Point, Vector};

/// How a mesh tells the side of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    /// By the pseudo-normal at the closest point.
    Normals,
    /// By the winding number of a mesh whose volume is positive (`outward`) or negative, which holds all of space but
    /// what the shells hold.
    Winding { outward: bool },
}

/// Directions without a relation to the axes, tried until the ray passes no edge.
const DIRECTIONS: [[f64; 3]; 6] = [
    [0.577, 0.211, 0.789],
    [-0.313, 0.871, 0.379],
    [0.137, -0.653, 0.745],
    [-0.831, -0.419, -0.365],
    [0.919, -0.283, -0.275],
    [-0.107, 0.349, -0.931],
];

impl TriangleMesh {
    /// A distance with its sign, negative inside: of a point `d` from its closest point, at which the pseudo-normal is
    /// `normal`. `None` where the mesh bounds no body, or holds the point a negative number of times.
    pub(crate) fn signed(&self, p: &Point<3>, d: &Vector<3>, normal: &Vector<3>, distance: f64) -> Option<f64> {
        if !self.quality.has_inside() {
            return None;
        }
        let inside = match *self.rule.get_or_init(|| self.find_rule()) {
            _ if distance == 0.0 => false,
            Rule::Normals => d.dot(normal) < 0.0,
            Rule::Winding { outward } => match (self.winding(p)?, outward) {
                (1.., true) | (0, false) => true,
                (0, true) | (..0, false) => false,
                _ => return None,
            },
        };
        Some(if inside { -distance } else { distance })
    }

    /// How often the mesh goes around a point; `None` where every ray passes an edge closer than rounding can tell.
    fn winding(&self, p: &Point<3>) -> Option<i32> {
        DIRECTIONS.iter().find_map(|d| self.crossings(p, &Vector::<3>::from(*d).normalize()))
    }

    /// How often a ray leaves through the mesh, less how often it enters; `None` where it passes an edge.
    fn crossings(&self, p: &Point<3>, direction: &Vector<3>) -> Option<i32> {
        let (unit, mut count) = (self.unit(), Some(0));
        self.bvh.along_ray(p, direction, |k| {
            let [a, b, c] = self.corners(k).map(|x| (x - p) * unit);
            if [a, b, c].iter().all(|x| x.dot(direction) < 0.0) {
                return;
            }
            // Volumes of the line with each side: of one sign where it goes through the triangle.
            let sides = [(b, c), (c, a), (a, b)].map(|(p, q)| {
                let volume = direction.dot(&p.cross(&q));
                // What rounding leaves of the product of two differences of coordinates.
                let noise = 16.0 * f64::EPSILON * (p.amax() * q.amax() + unit * self.magnitude * (p.amax() + q.amax()));
                if volume.abs() <= noise { 0 } else { volume.signum() as i32 }
            });
            if sides.contains(&1) && sides.contains(&-1) {
                return;
            }
            if sides.contains(&0) {
                count = None;
                return;
            }
            let along = a.dot(&(b - a).cross(&(c - a))) * f64::from(sides[0]);
            if along > 0.0 {
                count = count.map(|n| n + sides[0]);
            }
        });
        count
    }

    fn find_rule(&self) -> Rule {
        let origin = self.bounds().center();
        let volume: f64 = (0..self.triangles.len())
            .map(|k| {
                let [a, b, c] = self.corners(k).map(|x| (x - origin) * self.unit());
                a.dot(&b.cross(&c))
            })
            .sum();
        if self.has_thin_triangle() || self.shells() > 1 || self.meets_itself() {
            Rule::Winding { outward: volume >= 0.0 }
        } else {
            Rule::Normals
        }
    }

    /// Whether some triangle is so thin that rounding turns its normal.
    fn has_thin_triangle(&self) -> bool {
        (0..self.triangles.len()).any(|k| {
            let [a, b, c] = self.corners(k).map(|x| x * self.unit());
            let longest = (b - a).norm().max((c - a).norm()).max((c - b).norm());
            let height = (b - a).cross(&(c - a)).norm() / longest;
            // A triangle that is a point has no height at all.
            height.is_nan() || height <= 1e4 * f64::EPSILON * self.unit() * self.magnitude
        })
    }

    /// The number of parts that share no edge.
    fn shells(&self) -> usize {
        let mut parent: Vec<u32> = (0..self.edge_count as u32).collect();
        for [a, b, c] in &self.edges {
            let r = root(&mut parent, *a);
            for edge in [*b, *c] {
                let s = root(&mut parent, edge);
                parent[s as usize] = r;
            }
        }
        parent.iter().enumerate().filter(|(k, p)| *k == **p as usize).count()
    }

    /// See [`unit_for`].
    fn unit(&self) -> f64 {
        unit_for(self.magnitude)
    }

    /// Whether triangles touch elsewhere than in what they share.
    fn meets_itself(&self) -> bool {
        let tolerance = 1e2 * f64::EPSILON * self.magnitude;
        let mut meets = false;
        self.bvh.nearest_pairs(&self.bvh, tolerance * tolerance, |i, j| {
            meets = meets || (i < j && self.touch(i, j, tolerance));
            if meets { -1.0 } else { tolerance * tolerance }
        });
        meets
    }

    fn touch(&self, i: usize, j: usize, tolerance: f64) -> bool {
        let [p, q] = [i, j].map(|k| self.corners(k).map(|x| x * self.unit()));
        let tolerance = tolerance * self.unit();
        let (a, b) = (triangle_box(&p), triangle_box(&q));
        if (a.min - b.max).sup(&(b.min - a.max)).max() > tolerance {
            return false;
        }
        let (s, t) = (self.triangles[i], self.triangles[j]);
        let apart = |x: [Point<3>; 3], y: [Point<3>; 3]| triangle_triangle(&x, &y).0 > tolerance;
        let lonely: Vec<usize> = (0..3).filter(|&k| !t.contains(&s[k])).collect();
        match lonely[..] {
            [_, _, _] => !apart(p, q),
            // One corner in common: the sides across from it must stay clear of the other triangle.
            [k, l] => {
                let others: Vec<usize> = (0..3).filter(|&k| !s.contains(&t[k])).collect();
                !apart([p[k], p[l], p[l]], q) || !apart([q[others[0]], q[others[1]], q[others[1]]], p)
            }
            // One side in common: folded onto each other they have opposite normals.
            _ => self.face_normals[i].dot(&self.face_normals[j]) < -1.0 + 1e-12,
        }
    }
}
