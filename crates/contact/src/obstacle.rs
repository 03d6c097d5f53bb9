//! What a slave point may meet: the faces of a body, or a rigid body.
//!
//! The closest point comes from the certified search of `geometry`, over all faces, edges and vertices: it is handed from
//! face to edge to vertex without gaps, and no point is lost or counted twice. On a face the gap is measured along its
//! normal (a point and a surface), at an edge or vertex along the line to it (a point and a curve, two points).

use crate::kinematics::{Kinematics, Partner, ShapeFunction};
use crate::surface::ContactSurface;
use signorini_basis::{CellShape, Local};
use signorini_geometry::body::Body;
use signorini_geometry::closest::{FeatureKind, Query};
use signorini_geometry::measures::PartnerJet;
use signorini_geometry::rigid_shape::GapJet;
use signorini_geometry::shape::{Curve, CurveJet, Shape, ShapeError, Surface, SurfaceJet};
use signorini_geometry::{Point, Vector};
use std::collections::HashMap;

/// What a slave point may meet.
pub trait Obstacle<const D: usize>: Sync {
    /// The pair of a slave point, moved by `functions`, and the closest point.
    /// `None` if there is nothing to meet, or no coordinates there.
    fn meet(&self, x: &Point<D>, functions: &[ShapeFunction]) -> Option<Kinematics>;
}

/// A rigid body, by the gap of any point.
pub struct Rigid<'a, const D: usize>(pub &'a (dyn Fn(&Point<D>) -> GapJet<D> + Sync));

impl<const D: usize> Obstacle<D> for Rigid<'_, D> {
    fn meet(&self, x: &Point<D>, functions: &[ShapeFunction]) -> Option<Kinematics> {
        Some(Kinematics::of_rigid(functions, &(self.0)(x)))
    }
}

/// The faces of a surface, as they are or [moved](crate::surface::Moved).
pub struct Faces<'a, const D: usize> {
    surface: &'a dyn ContactSurface<D>,
    body: Body,
    /// Faces around each vertex.
    around: HashMap<u32, Vec<usize>>,
    vertices: Vec<Vec<u32>>,
    size: f64,
}

/// Sine of the angle to the normal of a face below which a point beside its border is over the face itself.
const OVER: f64 = 1e-8;

impl<'a, const D: usize> Faces<'a, D> {
    /// # Errors
    /// Faces that make no shape.
    pub fn new(surface: &'a dyn ContactSurface<D>) -> Result<Self, ShapeError> {
        let mut shapes = Vec::new();
        let mut around: HashMap<u32, Vec<usize>> = HashMap::new();
        let mut vertices = Vec::new();
        for face in 0..surface.face_count() {
            shapes.push(shape(surface, face)?);
            let list = surface.vertices(face);
            list.iter().for_each(|v| around.entry(*v).or_default().push(face));
            vertices.push(list);
        }
        let size = shapes.iter().map(Shape::size).fold(0.0, f64::max);
        Ok(Faces { surface, body: Body::new(shapes), around, vertices, size })
    }

    /// The mean normal of all faces that meet at a point of the border of one: it tells outside from inside.
    fn mean_normal(&self, face: usize, s: &Local) -> Point<D> {
        let of = |f: usize| {
            // The middle of another face tells its normal well enough.
            let at = if f == face { *s } else { self.surface.shape(f).centre() };
            self.surface.at(f, &at).area_normal().normalize()
        };
        let corners = self.surface.shape(face).vertices();
        let list = match Place::of(self.surface.shape(face), s) {
            Place::Interior => vec![face],
            Place::Vertex(v) => self.around[&self.vertices[face][v]].clone(),
            Place::Edge([a, b]) if corners.len() > 2 => {
                let [p, q] = [a, b].map(|v| &self.around[&self.vertices[face][v]]);
                p.iter().copied().filter(|f| q.contains(f)).collect()
            }
            Place::Edge(_) => vec![face],
        };
        list.into_iter().map(of).sum::<Point<D>>().normalize()
    }

    /// The pair with a face.
    fn with_face(&self, face: usize, s: &Local, slave: Partner<'_>, normal: &Point<D>) -> Option<Kinematics> {
        let functions = self.surface.functions(face, s);
        let jet = match &self.body.shapes()[face] {
            Shape::Surface(surface) => surface.jet(s[0], s[1]),
            // In the plane a face is a strip that reaches across it.
            Shape::Curve(curve) => strip(&curve.jet(s[0])),
            _ => return None,
        };
        let master = Partner { jet: PartnerJet::Surface(&jet), functions: &functions };
        Kinematics::of_pair::<D, 2>(slave, master, spatial(normal))
    }

    /// The pair with an edge or a vertex.
    fn with_border(&self, face: usize, s: &Local, slave: Partner<'_>, normal: &Point<D>) -> Option<Kinematics> {
        let mut functions = self.surface.functions(face, s);
        let normal = spatial(normal);
        let x = spatial(&self.surface.at(face, s).x);
        if D == 2 {
            // In the plane a vertex is a line across it.
            functions.iter_mut().for_each(|f| f.slopes = [0.0; 2]);
            let zero = Vector::<3>::zeros();
            let line = CurveJet { x, d1: Vector::<3>::z() * self.size, d2: zero, d3: zero };
            let master = Partner { jet: PartnerJet::Curve(&line), functions: &functions };
            return Kinematics::of_pair::<D, 1>(slave, master, normal);
        }
        let (Place::Edge([a, b]), Shape::Surface(surface)) =
            (Place::of(self.surface.shape(face), s), &self.body.shapes()[face])
        else {
            let master = Partner { jet: PartnerJet::Point(&x), functions: &functions };
            return Kinematics::of_pair::<D, 0>(slave, master, normal);
        };
        let corners = self.surface.shape(face).vertices();
        let [p, q] = [0, 1].map(|k| corners[b][k] - corners[a][k]);
        let jet = surface.jet(s[0], s[1]);
        let edge = CurveJet {
            x: jet.x,
            d1: jet.u * p + jet.v * q,
            d2: jet.uu * (p * p) + jet.uv * (2.0 * p * q) + jet.vv * (q * q),
            d3: jet.uuu * p.powi(3) + (jet.uuv * (p * p * q) + jet.uvv * (p * q * q)) * 3.0 + jet.vvv * q.powi(3),
        };
        functions.iter_mut().for_each(|f| f.slopes = [f.slopes[0] * p + f.slopes[1] * q, 0.0]);
        let master = Partner { jet: PartnerJet::Curve(&edge), functions: &functions };
        Kinematics::of_pair::<D, 1>(slave, master, normal)
    }
}

impl<const D: usize> Obstacle<D> for Faces<'_, D> {
    fn meet(&self, x: &Point<D>, functions: &[ShapeFunction]) -> Option<Kinematics> {
        let position = spatial(x);
        let found = self.body.closest_to_point(&position, &Query::default())?;
        let face = found.shapes[1];
        let foot = found.projection.closest.b;
        let mut s = [0.0; 3];
        s.iter_mut().zip(foot.parameters()).for_each(|(s, p)| *s = *p);
        let slave = Partner { jet: PartnerJet::Point(&position), functions };
        let at = self.surface.at(face, &s);
        let normal = at.area_normal().normalize();
        if foot.feature.kind == FeatureKind::Interior {
            return self.with_face(face, &s, slave, &normal);
        }
        let d = x - at.x;
        let distance = d.norm();
        let mean = self.mean_normal(face, &s);
        if distance <= 1e-9 * self.size {
            return self.with_face(face, &s, slave, &mean);
        }
        // Beside a border that is no edge, as between the faces of a plane, the point is over the face.
        if (d - normal * normal.dot(&d)).norm() <= OVER * distance {
            return self.with_face(face, &s, slave, &normal);
        }
        let outward = d * (d.dot(&mean).signum() / distance);
        self.with_border(face, &s, slave, &outward)
    }
}

/// Where on a reference face a point is.
pub enum Place {
    Interior,
    /// Between two vertices.
    Edge([usize; 2]),
    Vertex(usize),
}

impl Place {
    /// Within rounding of the reference coordinates.
    pub fn of(shape: CellShape, s: &Local) -> Self {
        let corners = shape.vertices();
        let part = |c: &Local| (0..3).map(|k| (c[k] - s[k]).powi(2)).sum::<f64>().sqrt();
        if let Some(v) = corners.iter().position(|c| part(c) < 1e-9) {
            return Place::Vertex(v);
        }
        for &[a, b] in shape.edges() {
            let along: f64 = (0..3).map(|k| (corners[b][k] - corners[a][k]).powi(2)).sum::<f64>().sqrt();
            if (part(&corners[a]) + part(&corners[b]) - along).abs() < 1e-9 {
                return Place::Edge([a, b]);
            }
        }
        Place::Interior
    }
}

/// The face of a body in the plane: a strip along z, as wide as its curve is fast.
pub fn strip(curve: &CurveJet) -> SurfaceJet {
    let zero = Vector::<3>::zeros();
    SurfaceJet {
        x: curve.x,
        u: curve.d1,
        v: Vector::<3>::z() * curve.d1.norm(),
        uu: curve.d2,
        uuu: curve.d3,
        uv: zero,
        vv: zero,
        uuv: zero,
        uvv: zero,
        vvv: zero,
    }
}

fn spatial<const D: usize>(x: &Point<D>) -> Vector<3> {
    Vector::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 })
}

/// A face as a shape of `geometry`, with the same coordinates.
fn shape<const D: usize>(surface: &dyn ContactSurface<D>, face: usize) -> Result<Shape, ShapeError> {
    let n = surface.order(face);
    let at = |s: Local| spatial(&surface.at(face, &s).x);
    let share = |k: usize| k as f64 / n as f64;
    let side = |k: usize| 2.0 * share(k) - 1.0;
    Ok(match surface.shape(face) {
        CellShape::Line => {
            let nodes: Vec<Point<3>> = (0..=n).map(|i| at([side(i), 0.0, 0.0])).collect();
            Curve::lagrange(&nodes)?.into()
        }
        CellShape::Triangle => {
            let nodes: Vec<Point<3>> = (0..=n)
                .flat_map(|j| (0..=n - j).map(move |i| (i, j)))
                .map(|(i, j)| at([share(i), share(j), 0.0]))
                .collect();
            Surface::lagrange_triangle(&nodes)?.into()
        }
        _ => {
            let grid: Vec<Vec<Point<3>>> =
                (0..=n).map(|i| (0..=n).map(|j| at([side(i), side(j), 0.0])).collect()).collect();
            Surface::lagrange_quad(&grid)?.into()
        }
    })
}
