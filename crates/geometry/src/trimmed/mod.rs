//! Bodies of CAD programs: solids within faces, which are parts of surfaces cut off along edges.
//!
//! The closest point of a body lies inside a face, where the distance to its surface is stationary, on an edge, or at a vertex:
//!
//! - the distance to a plane, cylinder, cone, sphere or torus has one local minimum, in closed form, or a whole circle or sphere
//!   of them, of which one is an edge unless all are of the face;
//! - splines are searched through bounded cells (`spline_tree`), edges by their certified closest point ([`crate::closest`]).
//!
//! All of them stand in one tree of boxes, and what cannot hold anything closer is not looked at. A closest point on a surface
//! counts where the face contains it (`region`). The side is that of the pseudo-normal (Baerentzen & Aanaes 2005): of a face
//! its normal, of an edge the mean of both faces, of a vertex the mean over the angles of the faces around.

mod closest;
mod edge;
mod error;
mod face;
mod face_surface;
mod mass;
mod merge;
mod region;
mod solids;
mod spline_tree;
mod triangulate;

pub use closest::{SolidFeature, SolidFoot};
pub use error::{SolidError, Wrong};
pub use face::FaceData;
pub use face_surface::FaceSurface;
pub use solids::TrimmedSolids;

use crate::bvh::Bvh;
use crate::mass_properties::MassProperties;
use crate::mesh::TriangleMesh;
use crate::shape::{Curve, Shape};
use crate::{Aabb, Point, Vector};
use face::Face;
use std::sync::OnceLock;

/// A curve between two vertices.
#[derive(Clone, Debug)]
pub struct Edge {
    pub curve: Curve,
    /// Numbers of the vertices at its start and its end.
    pub ends: [usize; 2],
}

/// The boundary of a body as it is stated.
#[derive(Clone, Debug, Default)]
pub struct SolidData {
    pub vertices: Vec<Point<3>>,
    pub edges: Vec<Edge>,
    pub faces: Vec<FaceData>,
    /// Whether faces are said to enclose the body; else the body is what lies behind them.
    pub is_closed: bool,
    /// Distance within which edges are said to lie on their faces.
    pub uncertainty: f64,
}

/// Sizes of a body by which edges may lie beside their faces where the file states less: CAD programs join faces at tolerances of
/// about this, and what touches the body does not tell it.
const JOINED: f64 = 1e-5;

/// What a query looks at: all of a body is within one of these.
#[derive(Clone, Copy, Debug)]
enum Item {
    Face(usize),
    Leaf(usize, usize),
    /// A point of a face at which parameters meet.
    Pole(usize, [f64; 2]),
    Edge(usize),
}

/// A solid within trimmed faces.
#[derive(Debug)]
pub struct TrimmedSolid {
    vertices: Vec<Point<3>>,
    edges: Vec<Edge>,
    /// The curves of the edges, for closest points.
    curves: Vec<Shape>,
    faces: Vec<Face>,
    /// Of each edge its faces with the number of the use.
    uses: Vec<Vec<(usize, usize)>>,
    /// Of each vertex; not unit vectors.
    vertex_normals: Vec<Vector<3>>,
    items: Vec<Item>,
    tree: Bvh,
    bounds: Aabb<3>,
    size: f64,
    mass: Option<MassProperties>,
    mesh: OnceLock<Option<TriangleMesh>>,
}

impl TrimmedSolid {
    /// # Errors
    /// Edges beside their faces, faces that are not joined along all edges where they are said to be closed, faces with bounds the
    /// wrong way around.
    pub fn new(mut data: SolidData) -> Result<Self, SolidError> {
        if data.faces.is_empty() {
            return Err(SolidError { face: None, edge: None, wrong: Wrong::NoFaces });
        }
        let hulls = data.edges.iter().map(|e| e.curve.atlas.hull()).map(|h| Aabb::new(h[0], h[1]));
        let extent = hulls.reduce(|a, b| a.joined(&b)).map_or(0.0, |b| b.size().norm());
        // Faces without edges have no gaps.
        let tolerance = data.uncertainty.max(JOINED * extent).max(f64::MIN_POSITIVE);
        if !data.is_closed {
            merge::merge(&mut data, tolerance);
        }
        let SolidData { vertices, edges, faces, is_closed, .. } = data;
        for (k, edge) in edges.iter().enumerate() {
            for (end, t) in edge.ends.iter().zip(edge.curve.domain()) {
                let at = edge.curve.position(t);
                let distance = (at - vertices[*end]).norm();
                if distance > tolerance {
                    return Err(SolidError::edge(k, Wrong::OffVertex { distance, at }));
                }
            }
        }
        let faces = (faces.into_iter().enumerate())
            .map(|(k, face)| Face::new(k, face, &edges, tolerance))
            .collect::<Result<Vec<_>, _>>()?;
        let mut uses = vec![Vec::new(); edges.len()];
        for (k, face) in faces.iter().enumerate() {
            face.uses.iter().enumerate().for_each(|(of, use_)| uses[use_.edge].push((k, of)));
        }
        for (k, own) in uses.iter().enumerate() {
            let [from, to] = edges[k].curve.domain();
            let at = edges[k].curve.position(0.5 * (from + to));
            let wrong = match own[..] {
                [] => continue,
                [_] if is_closed => Wrong::Free { at },
                [_] => continue,
                [(f, i), (g, j)] if faces[f].uses[i].forward != faces[g].uses[j].forward => continue,
                [_, _] => Wrong::Flipped { at },
                _ => Wrong::Branching { count: own.len(), at },
            };
            return Err(SolidError::edge(k, wrong));
        }
        let curves: Vec<Shape> = edges.iter().map(|e| e.curve.clone().into()).collect();
        let (mut items, mut boxes) = (Vec::new(), Vec::new());
        for (k, face) in faces.iter().enumerate() {
            match &face.tree {
                None => {
                    items.push(Item::Face(k));
                    boxes.push(face.bounds(&edges));
                }
                Some(tree) => {
                    items.extend((0..tree.leaves.len()).map(|leaf| Item::Leaf(k, leaf)));
                    boxes.extend(tree.leaves.iter().map(|leaf| leaf.bounds()));
                }
            }
            let poles = match &face.tree {
                Some(tree) => tree.poles.clone(),
                None if face.has_apex() => vec![[0.0; 2]],
                None => Vec::new(),
            };
            for pole in poles.into_iter().filter(|z| !face.around(*z).is_empty()) {
                let x = face.surface.position(pole);
                items.push(Item::Pole(k, pole));
                boxes.push(Aabb::new(x, x));
            }
        }
        for k in (0..edges.len()).filter(|k| !uses[*k].is_empty()) {
            let [low, high] = *edges[k].curve.atlas.hull();
            items.push(Item::Edge(k));
            boxes.push(Aabb::new(low, high));
        }
        let tree = Bvh::new(&boxes);
        let bounds = *tree.bounds();
        let mut solid = TrimmedSolid {
            vertex_normals: vec![Vector::<3>::zeros(); vertices.len()],
            size: bounds.size().norm(),
            vertices,
            edges,
            curves,
            faces,
            uses,
            items,
            tree,
            bounds,
            mass: None,
            mesh: OnceLock::new(),
        };
        solid.find_vertex_normals();
        if let Some(face) = solid.empty_face() {
            let noun = solid.faces[face].surface.noun();
            return Err(SolidError::face(face, Wrong::Empty { noun }));
        }
        if solid.uses.iter().all(|own| own.len() != 1) {
            let mass = solid.integrate();
            if mass.volume <= 0.0 {
                return Err(SolidError { face: None, edge: None, wrong: Wrong::Inward { volume: mass.volume } });
            }
            solid.mass = Some(mass);
        }
        Ok(solid)
    }

    /// Diagonal of the box around it.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// The box around it.
    pub fn hull(&self) -> &Aabb<3> {
        &self.bounds
    }

    /// Whether faces are on both sides of all edges, so that there is an inside.
    pub fn is_closed(&self) -> bool {
        self.mass.is_some()
    }

    /// The largest distance of an edge from the surface of one of its faces.
    pub fn largest_gap(&self) -> f64 {
        self.faces.iter().map(|f| f.gap).fold(0.0, f64::max)
    }

    /// How many vertices, edges and faces there are.
    pub fn counts(&self) -> [usize; 3] {
        [self.vertices.len(), self.edges.len(), self.faces.len()]
    }

    /// Triangles whose corners lie on the faces, for pictures; none where they could not be made.
    pub fn mesh(&self) -> Option<&TriangleMesh> {
        self.mesh.get_or_init(|| self.triangulate()).as_ref()
    }

    /// The first face that has no inside by its loops.
    fn empty_face(&self) -> Option<usize> {
        self.faces.iter().position(|face| face.tree.as_ref().is_some_and(|tree| tree.leaves.is_empty()))
    }
}
