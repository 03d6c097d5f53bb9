//! Tables and VTP files of a scene.

use std::fmt::Write as _;

use serde_json::{Value, json};
use signorini_geometry::Point;
use signorini_geometry::shape::Shape;
use vtkio::model::{Attribute, Attributes, DataSet, PolyDataPiece, VertexNumbers};

use super::case::{Frame, KINDS, Scene};
use crate::output::vtk::{collection, to_bytes};
use crate::output::{Folder, OutputError};

/// Which features touch, in words.
pub fn describe(scene: &Scene, frame: &Frame, pair: usize) -> Value {
    let p = &frame.pairs[pair];
    let name = |k: usize| format!("{} {}", scene.bodies[k].name, scene.bodies[k].parts[p.parts[k]].0);
    json!({"kind": KINDS[p.kind].1, "a": name(0), "b": name(1)})
}

pub fn write(scene: &Scene, frames: &[Frame], folder: &Folder) -> Result<(), OutputError> {
    folder.write("pairs.csv", table(scene, frames).as_bytes())?;
    let (mut bodies, mut pairs) = (Vec::new(), Vec::new());
    for (k, frame) in frames.iter().enumerate() {
        let names = [format!("frames/bodies_{k:04}.vtp"), format!("frames/pairs_{k:04}.vtp")];
        folder.write(&names[0], &body_file(frame)?)?;
        folder.write(&names[1], &pair_file(frame)?)?;
        bodies.push((frame.time, names[0].clone()));
        pairs.push((frame.time, names[1].clone()));
    }
    folder.write("bodies.pvd", collection(&bodies).as_bytes())?;
    folder.write("pairs.pvd", collection(&pairs).as_bytes())
}

fn table(scene: &Scene, frames: &[Frame]) -> String {
    let mut text = String::from(
        "frame,time,kind,contact,part_a,feature_a,part_b,feature_b,gap,xa_x,xa_y,xa_z,xb_x,xb_y,xb_z,\
         n_x,n_y,n_z,t_x,t_y,t_z,unique,lambda_min\n",
    );
    for (k, frame) in frames.iter().enumerate() {
        for (l, p) in frame.pairs.iter().enumerate() {
            let part = |b: usize| &scene.bodies[b].parts[p.parts[b]].0;
            let vector = |v: Option<&Point<3>>| v.map_or(",,".to_string(), |v| format!("{},{},{}", v.x, v.y, v.z));
            let lambda = if p.pair.lambda_min.is_finite() { p.pair.lambda_min.to_string() } else { String::new() };
            let _ = writeln!(
                text,
                "{k},{},{},{},{},{},{},{},{},{},{},{},{},{},{lambda}",
                frame.time,
                KINDS[p.kind].1,
                u8::from(l == frame.governing),
                part(0),
                p.pair.a.feature.kind,
                part(1),
                p.pair.b.feature.kind,
                p.pair.distance,
                vector(Some(&p.pair.a.point)),
                vector(Some(&p.pair.b.point)),
                vector(p.normal.as_ref()),
                vector(p.tangent.as_ref()),
                u8::from(p.unique),
            );
        }
    }
    text
}

/// A shape as points, lines and polygons.
#[derive(Default)]
pub struct Tessellation {
    pub points: Vec<Point<3>>,
    pub vertices: Vec<usize>,
    pub lines: Vec<Vec<usize>>,
    pub polygons: Vec<Vec<usize>>,
}

/// Samples along a curve, and along each side of a surface.
const ALONG: usize = 24;

impl Tessellation {
    pub fn new(shape: &Shape) -> Self {
        let mut out = Tessellation::default();
        match shape {
            Shape::Point(p) => {
                out.points.push(*p);
                out.vertices.push(0);
            }
            Shape::Curve(c) => {
                let [from, to] = c.domain();
                out.points = (0..=ALONG).map(|k| c.position(from + (to - from) * k as f64 / ALONG as f64)).collect();
                out.lines.push((0..=ALONG).collect());
            }
            Shape::Surface(s) => {
                let [u, v] = s.domain();
                let at = |i: usize, j: usize| {
                    let (a, b) = (i as f64 / ALONG as f64, j as f64 / ALONG as f64);
                    // A triangle is the square with one side drawn together.
                    let b = if s.is_triangle() { b * (1.0 - a) } else { b };
                    s.position(u[0] + (u[1] - u[0]) * a, v[0] + (v[1] - v[0]) * b)
                };
                for i in 0..=ALONG {
                    for j in 0..=ALONG {
                        out.points.push(at(i, j));
                    }
                }
                let number = |i: usize, j: usize| i * (ALONG + 1) + j;
                for i in 0..ALONG {
                    for j in 0..ALONG {
                        out.polygons.push(vec![number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)]);
                    }
                }
            }
            Shape::Mesh(m) => out.add_mesh(m.vertices(), m.triangles()),
            Shape::Implicit(s) => out.add_mesh(s.mesh().vertices(), s.mesh().triangles()),
            Shape::Solid(s) => {
                if let Some(mesh) = s.mesh() {
                    out.add_mesh(mesh.vertices(), mesh.triangles());
                }
            }
        }
        out
    }

    fn add_mesh(&mut self, vertices: &[Point<3>], triangles: &[[u32; 3]]) {
        self.points = vertices.to_vec();
        self.polygons = triangles.iter().map(|t| t.map(|v| v as usize).to_vec()).collect();
    }
}

pub(crate) fn numbers<'a>(cells: impl Iterator<Item = &'a Vec<usize>>) -> Option<VertexNumbers> {
    let (mut connectivity, mut offsets) = (Vec::new(), Vec::new());
    for cell in cells {
        connectivity.extend(cell.iter().map(|&v| v as u64));
        offsets.push(connectivity.len() as u64);
    }
    (!offsets.is_empty()).then_some(VertexNumbers::XML { connectivity, offsets })
}

fn body_file(frame: &Frame) -> Result<Vec<u8>, OutputError> {
    let mut all = Tessellation::default();
    let mut body = Vec::new();
    for (k, shapes) in frame.shapes.iter().enumerate() {
        for shape in shapes {
            let part = Tessellation::new(shape);
            let first = all.points.len();
            let shift = |cells: Vec<Vec<usize>>| -> Vec<Vec<usize>> {
                cells.into_iter().map(|c| c.into_iter().map(|v| v + first).collect()).collect()
            };
            body.extend(vec![k as f64; part.points.len()]);
            all.points.extend(part.points);
            all.vertices.extend(part.vertices.iter().map(|v| v + first));
            all.lines.extend(shift(part.lines));
            all.polygons.extend(shift(part.polygons));
        }
    }
    let vertices: Vec<Vec<usize>> = all.vertices.iter().map(|&v| vec![v]).collect();
    let piece = PolyDataPiece {
        points: all.points.iter().flat_map(|p| [p.x, p.y, p.z]).collect::<Vec<f64>>().into(),
        verts: numbers(vertices.iter()),
        lines: numbers(all.lines.iter()),
        polys: numbers(all.polygons.iter()),
        data: Attributes { point: vec![Attribute::scalars("body", 1).with_data(body)], cell: Vec::new() },
        ..PolyDataPiece::default()
    };
    to_bytes("bodies", DataSet::inline(piece))
}

/// Closest pairs as lines from foot to foot.
fn pair_file(frame: &Frame) -> Result<Vec<u8>, OutputError> {
    let mut points = Vec::new();
    let mut lines = Vec::new();
    let (mut kind, mut gap, mut contact) = (Vec::new(), Vec::new(), Vec::new());
    for (k, p) in frame.pairs.iter().enumerate() {
        lines.push(vec![2 * k, 2 * k + 1]);
        for foot in [&p.pair.a, &p.pair.b] {
            points.extend([foot.point.x, foot.point.y, foot.point.z]);
            kind.push(p.kind as f64);
            gap.push(p.pair.distance);
            contact.push(f64::from(u8::from(k == frame.governing)));
        }
    }
    let scalar = |name: &str, values: Vec<f64>| Attribute::scalars(name, 1).with_data(values);
    let piece = PolyDataPiece {
        points: points.into(),
        lines: numbers(lines.iter()),
        data: Attributes {
            point: vec![scalar("kind", kind), scalar("gap", gap), scalar("contact", contact)],
            cell: Vec::new(),
        },
        ..PolyDataPiece::default()
    };
    to_bytes("pairs", DataSet::inline(piece))
}
