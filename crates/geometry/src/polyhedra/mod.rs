//! Polyhedra: facets, edges and corners of closed triangle meshes, and where those of two polyhedra meet.
//!
//! Triangles in one plane that share an edge are one facet; an edge lies between two facets, and a corner is the end of edges.
//! Two polyhedra that are apart, or touch, do so by one of these pairs of features (Ericson 2005, Real-Time Collision Detection):
//!
//! | pair | gap `g` | normal `n`, from the second body to the first |
//! |---|---|---|
//! | corner and facet | height over the plane | of the facet |
//! | edge and edge | `n·(x - y)` at their nearest points | across both |
//! | corner and edge, corner and corner | distance | along it; where they touch, that of a plane that separates both bodies there |
//!
//! Facets that lie on each other, and edges on facets, touch at the corners of what they share: corners of either body within a
//! facet of the other, and crossings of edges.

mod meeting;
mod prism;
mod separation;
#[cfg(test)]
mod tests;

pub use meeting::{Meeting, Placed, meeting, meetings};

use crate::mass_properties::MassProperties;
use crate::mesh::TriangleMesh;
use crate::sets::root;
use crate::{Point, Vector};
use std::collections::HashMap;

/// Sine of the angle between triangles of one facet.
const FLAT: f64 = 1e-9;

/// A feature of a polyhedron, by its number among those of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    Facet(usize),
    Edge(usize),
    Corner(usize),
}

/// A plane part of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// A point of it.
    pub point: Point<3>,
    /// Unit normal, outwards.
    pub normal: Vector<3>,
}

/// Where two facets meet at an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    pub ends: [Point<3>; 2],
    /// Unit vector from the first end to the second.
    pub along: Vector<3>,
    pub facets: [usize; 2],
    /// Unit vectors across the edge into each of the facets.
    pub inwards: [Vector<3>; 2],
    /// Whether the body is less than a half space there.
    pub is_convex: bool,
}

/// Where edges end.
#[derive(Clone, Debug, PartialEq)]
pub struct Corner {
    pub point: Point<3>,
    /// Unit vectors along the edges that leave it.
    pub along: Vec<Vector<3>>,
    pub facets: Vec<usize>,
    /// Facets beside edges that are not convex.
    pub hollow: Vec<usize>,
    /// The mean normal (Baerentzen & Aanaes 2005).
    pub normal: Vector<3>,
}

/// The features of a polyhedron.
#[derive(Clone, Debug)]
pub struct Features {
    mesh: TriangleMesh,
    facets: Vec<Facet>,
    edges: Vec<Edge>,
    corners: Vec<Corner>,
    /// Of each triangle, edge and vertex of the mesh the feature if it is one.
    facet_of: Vec<Option<usize>>,
    edge_of: Vec<Option<usize>>,
    corner_of: Vec<Option<usize>>,
    width: f64,
    middle: Point<3>,
    radius: f64,
    is_flat: bool,
}

impl Features {
    /// The features of a closed mesh with outward normals; none of a mesh that is not closed.
    pub fn new(mesh: TriangleMesh) -> Option<Self> {
        if !mesh.quality().has_inside() {
            return None;
        }
        let count = mesh.triangles().len();
        let area = |k: usize| -> Vector<3> {
            let [a, b, c] = mesh.corners(k);
            (b - a).cross(&(c - a)) * 0.5
        };
        let normals: Vec<Vector<3>> = (0..count).map(|k| area(k).try_normalize(0.0).unwrap_or_default()).collect();
        // Triangles at each edge, with the side that is the edge.
        let mut beside: Vec<Vec<(usize, usize)>> = vec![Vec::new(); mesh.edge_count()];
        for k in 0..count {
            mesh.edges(k).iter().enumerate().for_each(|(side, edge)| beside[*edge as usize].push((k, side)));
        }
        let mut sets: Vec<u32> = (0..count as u32).collect();
        for pair in &beside {
            let [(a, _), (b, _)] = pair[..] else { return None };
            let none = Vector::<3>::zeros();
            let is_flat = normals[a].cross(&normals[b]).norm() <= FLAT && normals[a].dot(&normals[b]) > 0.0;
            if is_flat || normals[a] == none || normals[b] == none {
                let [a, b] = [a, b].map(|k| root(&mut sets, k as u32));
                sets[a.max(b) as usize] = a.min(b);
            }
        }
        // A facet has the plane of its largest triangle.
        let mut numbers = HashMap::new();
        let mut facets: Vec<Facet> = Vec::new();
        let mut largest: Vec<f64> = Vec::new();
        let mut facet_of = Vec::with_capacity(count);
        for k in 0..count {
            let of = root(&mut sets, k as u32);
            let number = *numbers.entry(of).or_insert_with(|| {
                facets.push(Facet { point: mesh.corners(k)[0], normal: normals[k] });
                largest.push(0.0);
                facets.len() - 1
            });
            let size = area(k).norm();
            if size > largest[number] {
                largest[number] = size;
                facets[number] = Facet { point: mesh.corners(k)[0], normal: normals[k] };
            }
            facet_of.push(Some(number));
        }
        let mut out = Features {
            facets,
            edges: Vec::new(),
            corners: Vec::new(),
            facet_of,
            edge_of: vec![None; mesh.edge_count()],
            corner_of: vec![None; mesh.vertices().len()],
            width: 2.0 * MassProperties::polyhedron(&mesh).volume / (0..count).map(|k| area(k).norm()).sum::<f64>(),
            middle: mesh.bounds().center(),
            radius: 0.5 * mesh.size(),
            is_flat: false,
            mesh,
        };
        let mut ends: Vec<(u32, usize)> = Vec::new();
        for (number, pair) in beside.iter().enumerate() {
            let [(a, side), (b, _)] = pair[..] else { return None };
            let [Some(of_a), Some(of_b)] = [out.facet_of[a], out.facet_of[b]] else { continue };
            if of_a == of_b {
                continue;
            }
            let of = [of_a, of_b];
            let [i, j] = [[0, 1], [0, 2], [1, 2]][side].map(|i: usize| out.mesh.triangles()[a][i]);
            let [p, q] = [i, j].map(|v| out.mesh.vertices()[v as usize]);
            let Some(along) = (q - p).try_normalize(0.0) else { continue };
            // Across the edge to the third corner: in the plane of the facet, on the side of the mean of the triangle.
            let inwards = [(a, of[0]), (b, of[1])].map(|(k, f)| {
                let across = out.facets[f].normal.cross(&along);
                let mean = out.mesh.corners(k).iter().sum::<Vector<3>>() / 3.0 - p;
                if across.dot(&mean) < 0.0 { -across } else { across }
            });
            let is_convex = out.facets[of[0]].normal.dot(&inwards[1]) < 0.0;
            out.edge_of[number] = Some(out.edges.len());
            ends.extend([(i, out.edges.len()), (j, out.edges.len())]);
            out.edges.push(Edge { ends: [p, q], along, facets: of, inwards, is_convex });
        }
        for (vertex, edge) in ends {
            let Edge { ends, along, facets, is_convex, .. } = out.edges[edge];
            let point = out.mesh.vertices()[vertex as usize];
            let number = *out.corner_of[vertex as usize].get_or_insert(out.corners.len());
            if number == out.corners.len() {
                let (along, normal) = (Vec::new(), Vector::<3>::zeros());
                out.corners.push(Corner { point, along, facets: Vec::new(), hollow: Vec::new(), normal });
            }
            let own = &mut out.corners[number];
            own.along.push(if ends[0] == point { along } else { -along });
            for facet in facets {
                if !own.facets.contains(&facet) {
                    own.facets.push(facet);
                }
                if !is_convex && !own.hollow.contains(&facet) {
                    own.hollow.push(facet);
                }
            }
        }
        for k in 0..count {
            for (i, v) in out.mesh.triangles()[k].iter().enumerate() {
                if let Some(corner) = out.corner_of[*v as usize] {
                    let x = out.mesh.corners(k);
                    let (p, q) = (x[(i + 1) % 3] - x[i], x[(i + 2) % 3] - x[i]);
                    out.corners[corner].normal += normals[k] * p.cross(&q).norm().atan2(p.dot(&q));
                }
            }
        }
        out.corners.iter_mut().for_each(|c| c.normal = c.normal.try_normalize(0.0).unwrap_or_default());
        Some(out)
    }

    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    pub fn facets(&self) -> &[Facet] {
        &self.facets
    }

    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    pub fn corners(&self) -> &[Corner] {
        &self.corners
    }

    /// Twice the volume over the area of the surface: the thickness of a plate, a third of the side of a cube.
    pub fn width(&self) -> f64 {
        self.width
    }

    /// The middle of the box around it.
    pub fn middle(&self) -> Point<3> {
        self.middle
    }

    /// Of a ball about the middle that holds it.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Whether it is a prism that stands for a polygon in the plane.
    pub fn is_flat(&self) -> bool {
        self.is_flat
    }

    /// How many features there are.
    pub fn count(&self) -> usize {
        self.facets.len() + self.edges.len() + self.corners.len()
    }

    /// The number of a feature among all: facets, edges, corners.
    pub fn number(&self, feature: Feature) -> usize {
        match feature {
            Feature::Facet(k) => k,
            Feature::Edge(k) => self.facets.len() + k,
            Feature::Corner(k) => self.facets.len() + self.edges.len() + k,
        }
    }

    /// The feature with a number.
    pub fn feature(&self, number: usize) -> Feature {
        let (facets, edges) = (self.facets.len(), self.edges.len());
        match number {
            k if k < facets => Feature::Facet(k),
            k if k < facets + edges => Feature::Edge(k - facets),
            k => Feature::Corner(k - facets - edges),
        }
    }

    /// A point in the middle of a feature.
    pub fn position(&self, feature: Feature) -> Point<3> {
        match feature {
            Feature::Facet(k) => self.facets[k].point,
            Feature::Edge(k) => (self.edges[k].ends[0] + self.edges[k].ends[1]) * 0.5,
            Feature::Corner(k) => self.corners[k].point,
        }
    }

    /// The feature nearest to a point, with the distance from it, negative inside. What is within `snap` of an edge or a corner
    /// is on it.
    fn nearest(&self, x: &Point<3>, snap: f64) -> Option<(Feature, f64)> {
        let foot = self.mesh.closest(x, 0.0).into_iter().next()?;
        let gap = foot.gap?;
        let [a, b, c] = self.mesh.triangles()[foot.triangle];
        let facet = self.facet_of[foot.triangle].map(Feature::Facet);
        let corner = |v: u32| {
            let near = (self.mesh.vertices()[v as usize] - foot.point).norm() <= snap;
            self.corner_of[v as usize].filter(|_| near).map(Feature::Corner)
        };
        let edge = |number: u32| {
            let own = self.edge_of[number as usize]?;
            let Edge { ends, along, .. } = self.edges[own];
            let d = foot.point - ends[0];
            ((d - along * along.dot(&d)).norm() <= snap).then_some(Feature::Edge(own))
        };
        let on_corner = [a, b, c].into_iter().find_map(corner);
        let on = on_corner.or_else(|| self.mesh.edges(foot.triangle).into_iter().find_map(edge));
        Some((on.or(facet)?, gap))
    }
}
