//! Contact at points: the nodes or the quadrature points of the slave side against the closest point of the master.
//!
//! The closest point comes from the certified search of `geometry`, over all faces, edges and vertices: it is handed from
//! face to edge to vertex without gaps, and no point is lost or counted twice. On a face the gap is measured along its
//! normal, at an edge or vertex along the line to it.

use crate::mortar::WeightedGap;
use crate::multiplier::PressureNodes;
use crate::surface::ContactSurface;
use signorini_fem::rules::rule;
use signorini_fem::{CellShape, Local};
use signorini_geometry::body::Body;
use signorini_geometry::closest::{FeatureKind, Query};
use signorini_geometry::shape::{Curve, Shape, ShapeError, Surface};
use signorini_geometry::{Point, Vector};
use std::collections::HashMap;

/// Which points of the slave side are tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TestPoints {
    /// The pressure nodes, each with the area of its Lagrange function.
    Nodes,
    /// The quadrature points.
    Gauss,
}

/// Where a point meets the master: distance (negative inside), outward normal, and face and coordinates of a body.
#[derive(Clone, Copy, Debug)]
pub struct Meeting<const D: usize> {
    pub gap: f64,
    pub normal: Point<D>,
    pub foot: Option<(usize, Local)>,
}

/// A master surface ready for closest points.
pub struct MasterShapes {
    body: Body,
    /// Faces around each vertex.
    around: HashMap<u32, Vec<usize>>,
    vertices: Vec<Vec<u32>>,
    size: f64,
}

impl MasterShapes {
    /// # Errors
    /// Faces that make no shape.
    pub fn new<const D: usize>(master: &dyn ContactSurface<D>) -> Result<Self, ShapeError> {
        let mut shapes = Vec::new();
        let mut around: HashMap<u32, Vec<usize>> = HashMap::new();
        let mut vertices = Vec::new();
        for face in 0..master.face_count() {
            shapes.push(shape(master, face)?);
            let list = master.vertices(face);
            list.iter().for_each(|v| around.entry(*v).or_default().push(face));
            vertices.push(list);
        }
        let size = shapes.iter().map(Shape::size).fold(0.0, f64::max);
        Ok(MasterShapes { body: Body::new(shapes), around, vertices, size })
    }

    /// The closest point of the master; `None` if it has no faces.
    pub fn meet<const D: usize>(&self, master: &dyn ContactSurface<D>, x: &Point<D>) -> Option<Meeting<D>> {
        let found = self.body.closest_to_point(&spatial(x), &Query::default())?;
        let face = found.shapes[1];
        let foot = found.projection.closest.b;
        let mut s = [0.0; 3];
        s.iter_mut().zip(foot.parameters()).for_each(|(s, p)| *s = *p);
        let d = x - master.at(face, &s).x;
        // The mean normal of all faces that meet at the foot tells outside from inside.
        let faces: Vec<usize> = if foot.feature.kind == FeatureKind::Interior {
            vec![face]
        } else {
            self.meeting(face, master.shape(face), &s)
        };
        let mean = faces
            .iter()
            .map(|f| master.at(*f, &nearest(master, *f, face, &s)).area_normal().normalize())
            .sum::<Point<D>>();
        let mean = mean.normalize();
        let distance = d.norm();
        if foot.feature.kind == FeatureKind::Interior || distance <= 1e-9 * self.size {
            return Some(Meeting { gap: d.dot(&mean), normal: mean, foot: Some((face, s)) });
        }
        let sign = if d.dot(&mean) < 0.0 { -1.0 } else { 1.0 };
        Some(Meeting { gap: sign * distance, normal: d * (sign / distance), foot: Some((face, s)) })
    }

    /// The faces that share the edge or vertex of a face at `s`.
    fn meeting(&self, face: usize, shape: CellShape, s: &Local) -> Vec<usize> {
        let corners = shape.vertices();
        let at = |c: &Local| (0..3).all(|k| (c[k] - s[k]).abs() < 1e-9);
        if let Some(v) = corners.iter().position(at) {
            return self.around[&self.vertices[face][v]].clone();
        }
        for &[a, b] in shape.edges() {
            let along: f64 = (0..3).map(|k| (corners[b][k] - corners[a][k]).powi(2)).sum::<f64>().sqrt();
            let part = |c: &Local| (0..3).map(|k| (c[k] - s[k]).powi(2)).sum::<f64>().sqrt();
            if (part(&corners[a]) + part(&corners[b]) - along).abs() < 1e-9 {
                let [p, q] = [a, b].map(|v| &self.around[&self.vertices[face][v]]);
                return p.iter().copied().filter(|f| q.contains(f)).collect();
            }
        }
        vec![face]
    }
}

/// The coordinates on another face of a point shared with it; its middle tells the normal well enough.
fn nearest<const D: usize>(master: &dyn ContactSurface<D>, other: usize, face: usize, s: &Local) -> Local {
    if other == face { *s } else { master.shape(other).centre() }
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

/// One row per point: its gap times its area. The rows' `node` counts the points; positions and, for quadrature points,
/// face and coordinates come along.
pub struct PointRows<const D: usize> {
    pub rows: Vec<WeightedGap>,
    /// Face and coordinates of every row.
    pub places: Vec<(usize, Local)>,
}

/// The rows of all points no farther from the master than `reach`.
pub fn point_rows<const D: usize>(
    slave: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    test: TestPoints,
    reach: f64,
    master: Option<&dyn ContactSurface<D>>,
    meet: &dyn Fn(&Point<D>) -> Option<Meeting<D>>,
) -> PointRows<D> {
    let mut out = PointRows { rows: Vec::new(), places: Vec::new() };
    let mut trace = Vec::new();
    let mut add = |number: u32, face: usize, s: Local, weight: f64, out: &mut PointRows<D>| {
        let x = slave.at(face, &s).x;
        let Some(meeting) = meet(&x) else { return };
        if meeting.gap > reach || weight <= 0.0 {
            return;
        }
        trace.clear();
        slave.trace(face, &s, &mut trace);
        let of_slave = trace.len();
        if let (Some((other, eta)), Some(master)) = (&meeting.foot, master) {
            master.trace(*other, eta, &mut trace);
        }
        let mut terms = Vec::new();
        for (k, (unknown, value)) in trace.iter().enumerate() {
            let sign = if k < of_slave { weight } else { -weight };
            for i in 0..D {
                let c = sign * value * meeting.normal[i];
                if c != 0.0 {
                    terms.push((unknown + i as u32, c));
                }
            }
        }
        out.rows.push(WeightedGap { gap: weight * meeting.gap, weight, terms, node: number });
        out.places.push((face, s));
    };
    match test {
        TestPoints::Gauss => {
            for face in 0..slave.face_count() {
                for (s, w) in rule(slave.shape(face), slave.degree(face) + 1) {
                    let point = slave.at(face, &s);
                    let weight = w * point.area_normal().norm() * slave.measure(&point.x);
                    let number = out.rows.len() as u32;
                    add(number, face, s, weight, &mut out);
                }
            }
        }
        TestPoints::Nodes => {
            let mut weight = vec![0.0; nodes.len()];
            let mut place: Vec<Option<(usize, Local)>> = vec![None; nodes.len()];
            let mut at = signorini_fem::hierarchic::Values::default();
            for face in 0..nodes.face_count() {
                let map = nodes.map(face);
                for (s, w) in rule(map.shape(), map.order() + 2) {
                    map.tabulate(&s, &mut at);
                    let point = slave.at(face, &s);
                    let w = w * point.area_normal().norm() * slave.measure(&point.x);
                    for ((node, _), v) in nodes.of_face(face).iter().zip(&at.value) {
                        weight[*node as usize] += w * v;
                    }
                }
                for ((node, _), s) in nodes.of_face(face).iter().zip(map.nodes()) {
                    place[*node as usize].get_or_insert((face, s));
                }
            }
            for (node, place) in place.into_iter().enumerate() {
                if let Some((face, s)) = place {
                    add(node as u32, face, s, weight[node], &mut out);
                }
            }
        }
    }
    out
}
