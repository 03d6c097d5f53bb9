//! Edges of a solid as curves that touch: a smooth curve through the vertices along which two surfaces meet, with a rounding
//! about it.
//!
//! Each element of the curve is cubic, along an edge of cells, from vertex to vertex. The tangent at a vertex is the mean of
//! those of the edges to both sides, weighted so that of straight edges it is that of the parabola through three vertices:
//! all is linear in the displacements, and an edge of the mesh that is smooth itself is what it was. So contact between
//! curves sees no kinks from cell to cell. A rounding turns with the edge and the first of its faces.

mod build;
mod chain;
mod section;

pub use chain::EdgeError;

use super::faces::Faces;
use super::spatial::spatial;
use section::{Change, Section};
use signorini_fem::Local;
use signorini_fem::rules::rule;
use signorini_geometry::shape::CurveJet;
use signorini_geometry::{Matrix, Point, Vector};
use signorini_mechanics::curve::{Closure, Continuity, Curve, CurvePoint};
use signorini_mechanics::pair::axis;
use signorini_mechanics::{Foot, Function, Sampling, Site, SlavePoint};

/// An edge as it is stated: where two surfaces meet, by their groups, and the radius of its rounding, 0 if it is sharp.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeOf {
    pub surfaces: [String; 2],
    pub radius: f64,
}

/// Along an edge of cells, from one vertex to the next.
pub(super) struct Element {
    /// Points of Bezier at rest.
    points: [Point<3>; 4],
    /// Functions that move it, with their weights in each point of Bezier.
    functions: Vec<(u32, [f64; 4])>,
    /// A vector into the first face at both ends, and functions with their weights in both.
    aside: [Vector<3>; 2],
    turning: Vec<(u32, [f64; 2])>,
    length: f64,
    /// The faces that meet there, and where on them the edge begins and ends.
    faces: [(u32, [Local; 2]); 2],
    /// Half of the depth of the cells below these.
    depth: f64,
}

/// An edge of a solid.
pub(super) struct EdgeCurve {
    pub(super) elements: Vec<Element>,
    closure: Closure,
    radius: f64,
    /// Length up to each element.
    starts: Vec<f64>,
    /// Of the material: with a length the force that moves a point.
    youngs_modulus: f64,
    degree: usize,
    /// The first number of its elements among all edges of the body, as sites have it.
    pub(super) first: u32,
}

/// Points of Gauss of each element: as many as of other curves.
const CONTACT_POINTS: usize = 4;
/// Polynomials of Bernstein of degree three on 0 to 1, and three derivatives of them.
fn bernstein(t: f64) -> [[f64; 4]; 4] {
    let s = 1.0 - t;
    [
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t],
        [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t],
        [6.0 * s, 6.0 * (t - 2.0 * s), 6.0 * (s - 2.0 * t), 6.0 * t],
        [-6.0, 18.0, -18.0, 6.0],
    ]
}

fn weighted(weights: &[f64; 4], points: &[Point<3>; 4]) -> Vector<3> {
    (0..4).map(|k| points[k] * weights[k]).sum()
}

/// The place on a face between the ends of an edge.
fn between([a, b]: &[Local; 2], t: f64) -> Local {
    std::array::from_fn(|k| a[k] + t * (b[k] - a[k]))
}

/// Numbers of sites from which on they are those of edges.
pub(super) const EDGES: u32 = 1 << 31;

impl EdgeCurve {
    /// Where the points of Bezier of an element are now.
    fn points(&self, element: usize, u: &[f64]) -> [Point<3>; 4] {
        let Element { mut points, ref functions, .. } = self.elements[element];
        for (f, weights) in functions {
            let moved = Vector::<3>::from_column_slice(&u[3 * *f as usize..3 * *f as usize + 3]);
            (0..4).for_each(|k| points[k] += moved * weights[k]);
        }
        points
    }

    fn jet(&self, element: usize, xi: f64, u: &[f64]) -> CurveJet {
        let points = self.points(element, u);
        let [x, d1, d2, d3] = bernstein(xi).map(|row| weighted(&row, &points));
        CurveJet { x, d1, d2, d3 }
    }

    /// What moves a point.
    fn functions(&self, element: usize, xi: f64) -> Vec<Function> {
        let [value, first, second, _] = bernstein(xi);
        let zero = Vector::<3>::zeros();
        let of = |row: &[f64; 4], weights: &[f64; 4]| (0..4).map(|k| row[k] * weights[k]).sum::<f64>();
        let mut out = Vec::with_capacity(3 * self.elements[element].functions.len());
        for (f, weights) in &self.elements[element].functions {
            let [n, n1, n2] = [of(&value, weights), of(&first, weights), of(&second, weights)];
            out.extend((0..3).map(|i| Function {
                unknown: 3 * f + i as u32,
                value: axis(i) * n,
                slopes: [axis(i) * n1, zero],
                second: [axis(i) * n2, zero, zero],
            }));
        }
        out
    }

    /// The section at a point, how its vectors change along the edge, and what turns it.
    fn section(&self, element: usize, xi: f64, u: &[f64]) -> (Section, Change, Vec<Turning>) {
        let own = &self.elements[element];
        let jet = self.jet(element, xi, u);
        let mut aside = own.aside;
        let [_, first, second, _] = bernstein(xi);
        let of = |row: &[f64; 4], weights: &[f64; 4]| (0..4).map(|k| row[k] * weights[k]).sum::<f64>();
        let mut list = Vec::with_capacity(3 * own.turning.len());
        for (f, across) in &own.turning {
            let moved = Vector::<3>::from_column_slice(&u[3 * *f as usize..3 * *f as usize + 3]);
            (0..2).for_each(|k| aside[k] += moved * across[k]);
            let along = own.functions.binary_search_by_key(f, |g| g.0).map_or([0.0; 4], |k| own.functions[k].1);
            let [a, a_along] = [of(&first, &along), of(&second, &along)];
            let [w, w_along] = [(1.0 - xi) * across[0] + xi * across[1], across[1] - across[0]];
            list.extend((0..3).map(|i| Turning {
                unknown: 3 * f + i as u32,
                change: Change { a: axis(i) * a, w: axis(i) * w },
                slope: Change { a: axis(i) * a_along, w: axis(i) * w_along },
            }));
        }
        let along = Change { a: jet.d2, w: aside[1] - aside[0] };
        (Section::new(jet.d1, aside[0] * (1.0 - xi) + aside[1] * xi), along, list)
    }

    /// What turns the section at a point, and how it is turned.
    fn spin(&self, element: usize, xi: f64, u: &[f64]) -> (Vec<Function>, Matrix<3>) {
        let (section, along, list) = self.section(element, xi, u);
        let spin = (list.iter())
            .map(|t| Function {
                unknown: t.unknown,
                value: section.spin(&t.change),
                slopes: [section.spin(&t.slope) + section.bend(&t.change, &along), Vector::<3>::zeros()],
                ..Function::default()
            })
            .collect();
        (spin, section.frame())
    }

    fn stiffness(&self, element: usize) -> f64 {
        self.youngs_modulus * self.elements[element].length * self.degree as f64
    }

    /// The points that are tested along the edge.
    pub(super) fn sites(&self, sampling: Sampling) -> Vec<Site> {
        let patch = |e: usize| EDGES + self.first + e as u32;
        let count = self.elements.len();
        let length = |e: usize| self.elements[e].length;
        match sampling {
            Sampling::GaussPoints => (0..count)
                .flat_map(|e| {
                    let rule = rule(signorini_fem::CellShape::Line, CONTACT_POINTS);
                    rule.into_iter().map(move |(s, w)| Site {
                        patch: patch(e),
                        xi: [0.5 * (1.0 + s[0]), 0.0],
                        weight: 0.5 * w * length(e),
                    })
                })
                .collect(),
            Sampling::Nodes => {
                let is_open = self.closure == Closure::Open;
                let node = |n: usize| {
                    let before = if n == 0 && is_open { 0.0 } else { length((n + count - 1) % count) };
                    let after = if n == count { 0.0 } else { length(n) };
                    let (e, xi) = if n == count { (n - 1, 1.0) } else { (n, 0.0) };
                    Site { patch: patch(e), xi: [xi, 0.0], weight: 0.5 * (before + after) }
                };
                (0..count + usize::from(is_open)).map(node).collect()
            }
        }
    }

    pub(super) fn placed(&self, element: usize, site: &Site, u: &[f64]) -> SlavePoint {
        let jet = self.jet(element, site.xi[0], u);
        let (section, _, list) = self.section(element, site.xi[0], u);
        let spin_bends = list.iter().flat_map(|t| list.iter().map(|l| section.bend(&t.change, &l.change))).collect();
        let (spin, frame) = self.spin(element, site.xi[0], u);
        SlavePoint {
            x: jet.x,
            tangent: Some(jet.d1),
            radius: self.radius,
            functions: self.functions(element, site.xi[0]),
            spin,
            spin_bends,
            frame,
            ..SlavePoint::default()
        }
    }

    /// As [`Body::site_stiffness`](signorini_mechanics::Body::site_stiffness): the part of an element that a site stands for.
    pub(super) fn site_stiffness(&self, element: usize, site: &Site) -> f64 {
        self.stiffness(element) * site.weight / self.elements[element].length
    }
}

/// How an unknown changes the vectors of a section, and how that changes along the edge.
struct Turning {
    unknown: u32,
    change: Change,
    slope: Change,
}

/// An edge of a body as a curve.
pub(super) struct PlacedEdge<'a, const D: usize> {
    pub(super) edge: &'a EdgeCurve,
    pub(super) faces: &'a Faces<D>,
}

impl<const D: usize> Curve for PlacedEdge<'_, D> {
    fn elements(&self) -> usize {
        self.edge.elements.len()
    }

    fn closure(&self) -> Closure {
        self.edge.closure
    }

    fn continuity(&self) -> Continuity {
        Continuity::C1
    }

    fn arc(&self, element: usize, xi: f64) -> f64 {
        self.edge.starts[element] + xi * self.edge.elements[element].length
    }

    fn radius(&self) -> f64 {
        self.edge.radius
    }

    fn contact_points(&self) -> usize {
        CONTACT_POINTS
    }

    fn stiffness(&self, element: usize) -> f64 {
        self.edge.stiffness(element)
    }

    fn faces(&self, configuration: &[f64], element: usize, xi: f64) -> Option<[Vector<3>; 2]> {
        Some(self.edge.elements[element].faces.map(|(face, ends)| {
            let s = between(&ends, xi);
            let list = self.faces.derivatives(face, &s);
            spatial(&self.faces.current(face, &s, &list, configuration).area_normal().normalize())
        }))
    }

    fn depth(&self, element: usize) -> f64 {
        self.edge.elements[element].depth
    }

    fn jet(&self, configuration: &[f64], element: usize, xi: f64) -> CurveJet {
        self.edge.jet(element, xi, configuration)
    }

    fn hull(&self, configuration: &[f64], element: usize) -> Vec<Point<3>> {
        self.edge.points(element, configuration).to_vec()
    }

    fn foot(&self, configuration: &[f64], element: usize, xi: f64, coordinates: usize) -> Foot {
        let functions = self.edge.functions(element, xi);
        let jet = self.edge.jet(element, xi, configuration);
        let (spin, frame) = self.edge.spin(element, xi, configuration);
        let foot = CurvePoint { element, xi, coordinates }.foot(&jet, self.edge.radius, functions);
        Foot { spin, frame, ..foot }
    }

    fn spin_bends(&self, configuration: &[f64], element: usize, xi: f64) -> Vec<Vector<3>> {
        let (section, _, list) = self.edge.section(element, xi, configuration);
        list.iter().flat_map(|t| list.iter().map(|l| section.bend(&t.change, &l.change))).collect()
    }
}
