//! What is drawn of a state: pieces with points, what joins them, and values.

use crate::collection::{Role, Source};
use crate::surface::{Topology, parts};
use crate::vtk::Mesh;
use std::path::Path;

/// How a piece is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Look {
    Solid,
    Membrane,
    Rigid,
    /// A rope, a beam, a path.
    Curve,
    /// A surface that is tested for contact.
    Contact,
    /// Where a contact zone ends.
    Outline,
    /// Forces at points of a contact.
    Arrows,
    /// A pair of closest points.
    Pair,
}

/// A part of what is seen, at one time.
#[derive(Clone, Debug)]
pub struct Piece {
    pub name: String,
    pub look: Look,
    pub points: Vec<[f64; 3]>,
    /// By which points move; none for what is where its points are.
    pub displacement: Option<Vec<[f64; 3]>>,
    pub topology: Topology,
    pub fields: Vec<(String, Vec<f64>)>,
    /// Of arrows: what acts at each point.
    pub tractions: Vec<[f64; 3]>,
}

/// Names of the bodies in the order of their numbers in the files.
pub struct Names {
    pub bodies: Vec<String>,
}

/// Components of the stresses, as they are stored.
const STRESS: &str = "stress_xx_yy_zz_xy_yz_xz";
const COMPONENTS: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];
/// More arrows than this hide each other.
const ARROWS: usize = 60;

impl Piece {
    /// Where a point is now.
    pub fn at(&self, point: usize) -> [f64; 3] {
        let x = self.points[point];
        match &self.displacement {
            Some(u) => std::array::from_fn(|k| x[k] + u[point][k]),
            None => x,
        }
    }

    /// Points and what joins them.
    pub fn new(name: &str, look: Look, points: Vec<[f64; 3]>, topology: Topology) -> Self {
        let (displacement, fields, tractions) = (None, Vec::new(), Vec::new());
        Self { name: name.into(), look, points, displacement, topology, fields, tractions }
    }

    /// The points of a mesh with these numbers, and what the mesh tells of them.
    fn of_mesh(name: &str, look: Look, mesh: &Mesh, points: &[u32], topology: Topology) -> Self {
        let at = points.iter().map(|&k| mesh.points[k as usize]).collect();
        let mut piece = Self::new(name, look, at, topology);
        for array in &mesh.arrays {
            let component = |c: usize| -> Vec<f64> {
                points.iter().map(|&k| array.values[k as usize * array.components + c]).collect()
            };
            match array.components {
                1 => piece.fields.push((array.name.clone(), component(0))),
                3 if array.name == "displacement" => {
                    let u = points.iter().map(|&k| mesh.vector("displacement", k as usize).unwrap_or_default());
                    piece.displacement = Some(u.collect());
                }
                3 => {
                    let [x, y, z] = [0, 1, 2].map(component);
                    let size = (0..x.len()).map(|k| (x[k] * x[k] + y[k] * y[k] + z[k] * z[k]).sqrt());
                    piece.fields.push((array.name.clone(), size.collect()));
                }
                6 if array.name == STRESS => {
                    let of = COMPONENTS.iter().enumerate();
                    piece.fields.extend(of.map(|(c, name)| (format!("stress_{name}"), component(c))));
                }
                _ => {}
            }
        }
        piece
    }
}

/// All pieces of a time, and what could not be read.
pub fn pieces(sources: &[Source], time: f64, names: &Names) -> (Vec<Piece>, Vec<String>) {
    let (mut out, mut notes) = (Vec::new(), Vec::new());
    for source in sources {
        let Some(path) = source.at(time) else { continue };
        match Mesh::read(path) {
            Err(what) => {
                let file = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
                notes.push(format!("The file {file} cannot be read: {what}"));
            }
            Ok(mesh) => match source.role {
                Role::Bodies => bodies(&mesh, names, &mut out),
                Role::Contact => contact(&source.name, &mesh, path, &mut out),
                Role::Rigid => whole(&source.name, Look::Rigid, &mesh, &mut out),
                Role::Pairs => whole("closest pairs", Look::Pair, &mesh, &mut out),
                Role::Path => whole(&source.name, Look::Curve, &mesh, &mut out),
            },
        }
    }
    (out, notes)
}

/// A mesh as one piece.
fn whole(name: &str, look: Look, mesh: &Mesh, out: &mut Vec<Piece>) {
    let undivided = Mesh { arrays: mesh.arrays.iter().filter(|a| a.name != "body").cloned().collect(), ..mesh.clone() };
    for (_, points, topology) in parts(&undivided) {
        out.push(Piece::of_mesh(name, look, &undivided, &points, topology));
    }
}

/// The bodies of a file, one by one; a membrane with what is below and above it.
fn bodies(mesh: &Mesh, names: &Names, out: &mut Vec<Piece>) {
    let is_membrane = mesh.array("body").is_none() && mesh.array("displacement").is_some();
    let is_rigid = mesh.array("displacement").is_none();
    for (number, points, topology) in parts(mesh) {
        let known = names.bodies.get(number.unwrap_or(0)).cloned();
        let name = known.unwrap_or_else(|| format!("body {}", number.unwrap_or(0) + 1));
        let look = match (is_rigid, is_membrane, topology.triangles.is_empty()) {
            (true, ..) => Look::Rigid,
            (_, true, _) => Look::Membrane,
            (_, _, true) => Look::Curve,
            _ => Look::Solid,
        };
        let piece = Piece::of_mesh(&name, look, mesh, &points, topology);
        for side in ["floor", "ceiling"] {
            out.extend(height(&piece, side));
        }
        out.push(piece);
    }
}

/// What is below or above a membrane, where its height is stored; without what falls away far from the membrane.
fn height(membrane: &Piece, side: &str) -> Option<Piece> {
    let heights = &membrane.fields.iter().find(|f| f.0 == side)?.1;
    let deflections = (0..membrane.points.len()).map(|k| membrane.at(k)[2]);
    let (low, high) = deflections.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
    let room = (high - low).max(f64::MIN_POSITIVE);
    let is_near = |k: u32| (low - room..=high + room).contains(&heights[k as usize]);
    let near = |list: &[u32], n: usize| -> Vec<u32> {
        list.chunks_exact(n).filter(|c| c.iter().all(|&k| is_near(k))).flatten().copied().collect()
    };
    let own = &membrane.topology;
    let topology = Topology { triangles: near(&own.triangles, 3), lines: near(&own.lines, 2), ..Topology::default() };
    let at = |(x, z): (&[f64; 3], &f64)| [x[0], x[1], z.clamp(low - room, high + room)];
    let points = membrane.points.iter().zip(heights).map(at).collect();
    Some(Piece::new(side, Look::Rigid, points, topology))
}

/// A contact: its surface, what acts at its points, where its zones end.
fn contact(name: &str, mesh: &Mesh, path: &Path, out: &mut Vec<Piece>) {
    if mesh.array("front").is_some() || mesh.arrays.is_empty() {
        let mut outlines = Vec::new();
        whole(name, Look::Outline, mesh, &mut outlines);
        outlines.iter_mut().for_each(|outline| lift(outline, out));
        out.extend(outlines);
        return;
    }
    let is_surface = mesh.cells.iter().any(|cell| cell.kind == crate::vtk::Kind::Polygon);
    if is_surface {
        whole(name, Look::Contact, mesh, out);
    } else {
        out.extend(arrows(name, mesh));
    }
    if let Some(outline) = outline(name, path) {
        out.push(outline);
    }
}

/// The outline of a membrane's zone at the height of the membrane.
fn lift(outline: &mut Piece, others: &[Piece]) {
    let Some(membrane) = others.iter().find(|p| p.look == Look::Membrane) else { return };
    for x in &mut outline.points {
        let apart = |k: &usize| (membrane.points[*k][0] - x[0]).powi(2) + (membrane.points[*k][1] - x[1]).powi(2);
        let nearest = (0..membrane.points.len()).min_by(|a, b| apart(a).total_cmp(&apart(b)));
        x[2] = nearest.map_or(0.0, |k| membrane.at(k)[2]);
    }
}

/// Pressure and friction at the points of a contact that touch.
fn arrows(name: &str, mesh: &Mesh) -> Option<Piece> {
    let pressure = mesh.scalar("contact_pressure")?;
    let traction = |k: usize| -> Option<[f64; 3]> {
        let normal = mesh.vector("normal", k)?;
        let friction = mesh.vector("friction_traction", k).unwrap_or_default();
        Some(std::array::from_fn(|i| normal[i] * pressure[k] + friction[i]))
    };
    let closed: Vec<usize> = (0..pressure.len()).filter(|&k| pressure[k] > 0.0).collect();
    let shown: Vec<u32> = closed.iter().step_by(closed.len().div_ceil(ARROWS).max(1)).map(|&k| k as u32).collect();
    let vertices = (0..shown.len() as u32).collect();
    let mut piece = Piece::of_mesh(name, Look::Arrows, mesh, &shown, Topology { vertices, ..Topology::default() });
    piece.tractions = shown.iter().map(|&k| traction(k as usize).unwrap_or_default()).collect();
    Some(piece)
}

/// The border of the zones of a contact in space, from the table beside its surface.
fn outline(name: &str, surface: &Path) -> Option<Piece> {
    let stem = surface.file_stem()?.to_string_lossy();
    let text = std::fs::read_to_string(surface.with_file_name(format!("{stem}_outline.csv"))).ok()?;
    let mut lines = text.lines();
    let is_in_space = lines.next()?.split(',').count() == 4;
    let numbers = |line: &str| line.split(',').skip(1).filter_map(|v| v.parse().ok()).collect::<Vec<f64>>();
    let points: Vec<[f64; 3]> = lines.filter_map(|line| numbers(line).try_into().ok()).collect();
    let count = points.len() as u32 / 2 * 2;
    let topology = Topology { lines: (0..count).collect(), ..Topology::default() };
    (is_in_space && count > 0).then(|| Piece::new(name, Look::Outline, points, topology))
}
