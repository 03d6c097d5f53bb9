//! Triangle meshes: closest points with the face, edge or vertex they lie on, and the side where there is one.

mod side;

use std::collections::HashMap;
use std::sync::OnceLock;

use crate::bvh::Bvh;
use crate::feature::{Entity, Feature, FeatureKind};
use crate::patch::{Atlas, Border, SurfaceChart};
use crate::scale::unit_for;
use crate::shape::error::{self, ShapeError};
use crate::shape::surface::Surface;
use crate::straight::{closest_on_triangle, segments};
use crate::{Aabb, Looking, Point, Vector};

/// What the triangles of a mesh make together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshQuality {
    /// Edges with one triangle: the rim of a hole.
    pub open_edges: usize,
    /// Edges with three triangles or more.
    pub branching_edges: usize,
    /// Edges along which two triangles disagree about the side.
    pub flipped_edges: usize,
    /// Triangles without area; they count as the segment they are.
    pub degenerate_triangles: usize,
    /// Triangles with the corners of an earlier one; they are left out.
    pub duplicate_triangles: usize,
}

impl MeshQuality {
    /// Whether the mesh bounds a body, so that points have a side.
    pub fn has_inside(&self) -> bool {
        self.open_edges == 0 && self.branching_edges == 0 && self.flipped_edges == 0
    }
}

/// A surface of triangles.
#[derive(Debug)]
pub struct TriangleMesh {
    vertices: Vec<Point<3>>,
    triangles: Vec<[u32; 3]>,
    /// Edge numbers of each triangle: opposite to its third corner, its second, its first.
    edges: Vec<[u32; 3]>,
    edge_count: usize,
    face_normals: Vec<Vector<3>>,
    edge_normals: Vec<Vector<3>>,
    vertex_normals: Vec<Vector<3>>,
    bvh: Bvh,
    quality: MeshQuality,
    /// The largest coordinate.
    magnitude: f64,
    /// Found at the first point whose side is asked for.
    rule: OnceLock<side::Rule>,
    atlas: OnceLock<Atlas<2, SurfaceChart>>,
}

impl Clone for TriangleMesh {
    fn clone(&self) -> Self {
        TriangleMesh {
            vertices: self.vertices.clone(),
            triangles: self.triangles.clone(),
            edges: self.edges.clone(),
            face_normals: self.face_normals.clone(),
            edge_normals: self.edge_normals.clone(),
            vertex_normals: self.vertex_normals.clone(),
            bvh: self.bvh.clone(),
            rule: self.rule.clone(),
            atlas: OnceLock::new(),
            ..*self
        }
    }
}

/// A closest point of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshFoot {
    pub distance: f64,
    pub point: Point<3>,
    pub triangle: usize,
    /// Parameters on the triangle, along its sides from its first corner.
    pub parameters: [f64; 2],
    /// Feature of the triangle.
    pub feature: Feature,
    /// Number of that feature in the mesh: of the triangle, the edge or the vertex.
    pub number: usize,
    /// Face normal, or the angle-weighted mean at edges and vertices (Baerentzen & Aanaes 2005).
    pub normal: Vector<3>,
    /// Distance with a sign, negative inside; `None` where the mesh bounds no body or the side has no meaning.
    pub gap: Option<f64>,
}

impl TriangleMesh {
    /// A mesh of triangles given by vertex numbers, counter-clockwise seen from outside.
    ///
    /// # Errors
    /// No triangles, a vertex number out of range, coordinates that are not finite.
    pub fn new(vertices: Vec<Point<3>>, triangles: &[[u32; 3]]) -> Result<Self, ShapeError> {
        if triangles.is_empty() {
            return Err(ShapeError::new("triangles", "a mesh needs one triangle at least"));
        }
        if triangles.len() > 1 << 29 {
            return Err(ShapeError::new("triangles", "more than 2^29"));
        }
        for p in &vertices {
            error::position("vertices", p)?;
        }
        let mut quality = MeshQuality::default();
        let mut seen = std::collections::HashSet::with_capacity(triangles.len());
        let mut kept = Vec::with_capacity(triangles.len());
        for (k, t) in triangles.iter().enumerate() {
            if let Some(&v) = t.iter().find(|&&v| v as usize >= vertices.len()) {
                let message = format!("triangle {k} has vertex {v}, valid are 0 to {}", vertices.len() as i64 - 1);
                return Err(ShapeError::new("triangles", message));
            }
            let mut sorted = *t;
            sorted.sort_unstable();
            if seen.insert(sorted) {
                kept.push(*t);
            } else {
                quality.duplicate_triangles += 1;
            }
        }
        let corners = |t: &[u32; 3]| t.map(|v| vertices[v as usize]);
        let largest = vertices.iter().map(|x| x.amax()).fold(0.0, f64::max);
        let unit = unit_for(largest);
        let boxes: Vec<Aabb<3>> = kept.iter().map(|t| triangle_box(&corners(t))).collect();
        let mut numbers: HashMap<[u32; 2], u32> = HashMap::with_capacity(2 * kept.len());
        // Number of triangles of each edge, and the balance of their directions.
        let mut uses: Vec<(u32, i32)> = Vec::new();
        let mut edges = Vec::with_capacity(kept.len());
        let mut face_normals = Vec::with_capacity(kept.len());
        for t in &kept {
            let [a, b, c] = corners(t);
            // A power of two changes no digit.
            let normal = ((b - a) * unit).cross(&((c - a) * unit)).try_normalize(0.0).unwrap_or_default();
            quality.degenerate_triangles += usize::from(normal == Vector::<3>::zeros());
            face_normals.push(normal);
            edges.push([[t[0], t[1]], [t[0], t[2]], [t[1], t[2]]].map(|pair| {
                let key = [pair[0].min(pair[1]), pair[0].max(pair[1])];
                let number = *numbers.entry(key).or_insert_with(|| {
                    uses.push((0, 0));
                    uses.len() as u32 - 1
                });
                // The side from the first to the third corner runs against the order of the triangle.
                let forward = (pair[0] < pair[1]) != (pair == [t[0], t[2]]);
                let entry = &mut uses[number as usize];
                entry.0 += 1;
                entry.1 += if forward { 1 } else { -1 };
                number
            }));
        }
        for (count, balance) in &uses {
            match count {
                1 => quality.open_edges += 1,
                2 => quality.flipped_edges += usize::from(*balance != 0),
                _ => quality.branching_edges += 1,
            }
        }
        let mut edge_normals = vec![Vector::<3>::zeros(); uses.len()];
        let mut vertex_normals = vec![Vector::<3>::zeros(); vertices.len()];
        for (k, t) in kept.iter().enumerate() {
            let x = corners(t);
            for i in 0..3 {
                edge_normals[edges[k][i] as usize] += face_normals[k];
                let (p, q) = ((x[(i + 1) % 3] - x[i]) * unit, (x[(i + 2) % 3] - x[i]) * unit);
                let angle = p.cross(&q).norm().atan2(p.dot(&q));
                vertex_normals[t[i] as usize] += face_normals[k] * angle;
            }
        }
        for normal in edge_normals.iter_mut().chain(&mut vertex_normals) {
            *normal = normal.try_normalize(0.0).unwrap_or_default();
        }
        let bvh = Bvh::new(&boxes);
        let magnitude = bvh.bounds().min.amax().max(bvh.bounds().max.amax());
        Ok(TriangleMesh {
            vertices,
            triangles: kept,
            edges,
            edge_count: uses.len(),
            face_normals,
            edge_normals,
            vertex_normals,
            bvh,
            quality,
            magnitude,
            rule: OnceLock::new(),
            atlas: OnceLock::new(),
        })
    }

    pub fn vertices(&self) -> &[Point<3>] {
        &self.vertices
    }

    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Edge numbers of a triangle: from its first corner to its second, from its first to its third, from its second to its third.
    pub fn edges(&self, triangle: usize) -> [u32; 3] {
        self.edges[triangle]
    }

    pub fn edge_count(&self) -> usize {
        self.edge_count
    }

    pub fn quality(&self) -> &MeshQuality {
        &self.quality
    }

    pub fn bounds(&self) -> &Aabb<3> {
        self.bvh.bounds()
    }

    /// The largest coordinate.
    pub(crate) fn magnitude(&self) -> f64 {
        self.magnitude
    }

    /// Diagonal of the bounding box.
    pub fn size(&self) -> f64 {
        self.bvh.bounds().size().norm()
    }

    pub fn corners(&self, triangle: usize) -> [Point<3>; 3] {
        self.triangles[triangle].map(|v| self.vertices[v as usize])
    }

    /// Position on a triangle.
    pub fn position(&self, triangle: usize, [u, v]: [f64; 2]) -> Point<3> {
        let [a, b, c] = self.corners(triangle);
        a + (b - a) * u + (c - a) * v
    }

    /// Moves the vertices and adapts the search tree.
    ///
    /// # Errors
    /// Another number of vertices, or coordinates that are not finite: the mesh then stays as it was.
    pub fn move_vertices(&mut self, vertices: Vec<Point<3>>) -> Result<(), ShapeError> {
        if vertices.len() != self.vertices.len() {
            return Err(ShapeError::new(
                "vertices",
                format!("{} for a mesh of {}", vertices.len(), self.vertices.len()),
            ));
        }
        let mut bvh = self.bvh.clone();
        let moved = Self::new(vertices, &self.triangles)?;
        let boxes: Vec<Aabb<3>> = (0..moved.triangles.len()).map(|k| triangle_box(&moved.corners(k))).collect();
        bvh.refit(&boxes);
        *self = TriangleMesh { bvh, ..moved };
        Ok(())
    }

    /// All closest points of a point: several where different places share the distance within `tie`.
    pub fn closest(&self, p: &Point<3>, tie: f64) -> Vec<MeshFoot> {
        let unit = unit_for(self.magnitude.max(p.amax()));
        let scaled = p * unit;
        let mut best = f64::INFINITY;
        let mut feet: Vec<(f64, usize, Point<3>, [f64; 2], Feature)> = Vec::with_capacity(2);
        self.bvh.nearest(p, f64::INFINITY, |k| {
            let corners = self.corners(k);
            let ([u, v], feature) = closest_on_triangle(&scaled, &corners.map(|x| x * unit));
            let x = corners[0] + (corners[1] - corners[0]) * u + (corners[2] - corners[0]) * v;
            let d = (x - p).norm();
            if d <= best + tie {
                best = best.min(d);
                feet.push((d, k, x, [u, v], feature));
            }
            (best + tie) * (best + tie)
        });
        feet.retain(|f| f.0 <= best + tie);
        feet.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        let apart = 1e-9 * self.size();
        let mut distinct: Vec<MeshFoot> = Vec::with_capacity(1);
        for (distance, triangle, point, parameters, feature) in feet {
            if distinct.iter().all(|f| (f.point - point).norm() > apart) {
                distinct.push(self.foot(p, distance, triangle, point, parameters, feature));
            }
        }
        distinct
    }

    /// The gap of a point to the nearest triangle that it is under and looks at, with the normal of that.
    pub fn facing(&self, p: &Point<3>, looking: &Looking) -> Option<(f64, Vector<3>)> {
        let mut best: Option<(f64, usize)> = None;
        let limit = (looking.within + looking.rounding()).powi(2);
        self.bvh.nearest(p, limit, |k| {
            let least = best.map_or(limit, |(gap, _)| gap * gap);
            let normal = &self.face_normals[k];
            if !looking.sees(normal) {
                return least;
            }
            let corners = self.corners(k);
            let apart = p - self.position(k, closest_on_triangle(p, &corners).0);
            let gap = normal.dot(&(p - corners[0]));
            if !looking.is_under(&apart, normal) || best.is_some_and(|(g, of)| (g.abs(), of) <= (gap.abs(), k)) {
                return least;
            }
            best = Some((gap, k));
            gap * gap
        });
        best.map(|(gap, k)| (gap, self.face_normals[k]))
    }

    fn foot(
        &self,
        p: &Point<3>,
        distance: f64,
        triangle: usize,
        point: Point<3>,
        parameters: [f64; 2],
        feature: Feature,
    ) -> MeshFoot {
        let (number, normal) = self.numbered(triangle, feature);
        let gap = self.signed(p, &(p - point), &normal, distance);
        MeshFoot { distance, point, triangle, parameters, feature, number, normal, gap }
    }

    /// Number and normal of a feature.
    fn numbered(&self, triangle: usize, feature: Feature) -> (usize, Vector<3>) {
        match feature.entity {
            Entity::Border(Border::V0) => self.edge(triangle, 0),
            Entity::Border(Border::U0) => self.edge(triangle, 1),
            Entity::Border(_) => self.edge(triangle, 2),
            Entity::Corner(Border::U0, Border::V0) => self.vertex(triangle, 0),
            Entity::Corner(Border::V0, _) => self.vertex(triangle, 1),
            Entity::Corner(..) => self.vertex(triangle, 2),
            _ => (triangle, self.face_normals[triangle]),
        }
    }

    fn edge(&self, triangle: usize, k: usize) -> (usize, Vector<3>) {
        let number = self.edges[triangle][k] as usize;
        (number, self.edge_normals[number])
    }

    fn vertex(&self, triangle: usize, k: usize) -> (usize, Vector<3>) {
        let number = self.triangles[triangle][k] as usize;
        (number, self.vertex_normals[number])
    }

    /// The pseudo-normal at a feature of a triangle: a point is outside where it lies on its side.
    pub fn normal_at(&self, triangle: usize, feature: Feature) -> Vector<3> {
        self.numbered(triangle, feature).1
    }

    /// The closest pair of points of two meshes: distance, triangle and parameters on each.
    pub fn closest_to_mesh(&self, other: &TriangleMesh) -> MeshPair {
        let mut best = MeshPair { distance: f64::INFINITY, triangles: [0; 2], parameters: [[0.0; 2]; 2] };
        self.bvh.nearest_pairs(&other.bvh, f64::INFINITY, |i, j| {
            let (distance, parameters) = triangle_triangle(&self.corners(i), &other.corners(j));
            if distance < best.distance || (distance == best.distance && [i, j] < best.triangles) {
                best = MeshPair { distance, triangles: [i, j], parameters };
            }
            best.distance * best.distance
        });
        best
    }

    /// The mesh as pieces for the general search; built at the first use.
    pub(crate) fn atlas(&self) -> &Atlas<2, SurfaceChart> {
        self.atlas.get_or_init(|| {
            let pieces = (0..self.triangles.len())
                .flat_map(|k| Surface::tri3(&self.corners(k)).expect("checked at construction").into_pieces())
                .collect();
            Atlas::new(pieces)
        })
    }
}

/// A closest pair of points of two meshes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshPair {
    pub distance: f64,
    pub triangles: [usize; 2],
    pub parameters: [[f64; 2]; 2],
}

fn triangle_box(x: &[Point<3>; 3]) -> Aabb<3> {
    Aabb::new(x[0].inf(&x[1]).inf(&x[2]), x[0].sup(&x[1]).sup(&x[2]))
}

/// Distance of two triangles: corners against faces, edges against edges, and zero where an edge pierces a face.
fn triangle_triangle(p: &[Point<3>; 3], q: &[Point<3>; 3]) -> (f64, [[f64; 2]; 2]) {
    const CORNERS: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let at = |x: &[Point<3>; 3], [u, v]: [f64; 2]| x[0] + (x[1] - x[0]) * u + (x[2] - x[0]) * v;
    let on_edge = |i: usize, t: f64| {
        let (a, b) = (CORNERS[i], CORNERS[(i + 1) % 3]);
        [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]
    };
    let mut best = (f64::INFINITY, [[0.0; 2]; 2]);
    let mut offer = |z: [[f64; 2]; 2]| {
        let d = (at(p, z[0]) - at(q, z[1])).norm();
        if d < best.0 {
            best = (d, z);
        }
    };
    for i in 0..3 {
        offer([CORNERS[i], closest_on_triangle(&p[i], q).0]);
        offer([closest_on_triangle(&q[i], p).0, CORNERS[i]]);
        for j in 0..3 {
            let [s, t] = segments(&[p[i], p[(i + 1) % 3]], &[q[j], q[(j + 1) % 3]]).parameters;
            offer([on_edge(i, s), on_edge(j, t)]);
        }
        if let Some((t, z)) = pierce(&p[i], &p[(i + 1) % 3], q) {
            offer([on_edge(i, t), z]);
        }
        if let Some((t, z)) = pierce(&q[i], &q[(i + 1) % 3], p) {
            offer([z, on_edge(i, t)]);
        }
    }
    best
}

/// Where a segment goes through a triangle.
fn pierce(a: &Point<3>, b: &Point<3>, x: &[Point<3>; 3]) -> Option<(f64, [f64; 2])> {
    let (e, f) = (x[1] - x[0], x[2] - x[0]);
    let n = e.cross(&f);
    let (from, to) = (n.dot(&(a - x[0])), n.dot(&(b - x[0])));
    if from * to > 0.0 || from == to {
        return None;
    }
    let t = from / (from - to);
    let d = a + (b - a) * t - x[0];
    let squared = n.norm_squared();
    let (u, v) = (d.cross(&f).dot(&n) / squared, e.cross(&d).dot(&n) / squared);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then_some((t, [u, v]))
}

impl MeshFoot {
    /// The kind of the feature of the mesh.
    pub fn kind(&self) -> FeatureKind {
        self.feature.kind
    }
}
