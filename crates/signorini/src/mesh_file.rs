//! Triangle meshes from files: STL (binary and ASCII), OBJ and PLY (ASCII and binary), told apart by their extension.

use std::collections::HashMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, Property};
use signorini_geometry::Point;
use signorini_geometry::mesh::TriangleMesh;

/// A mesh file that cannot be used, and why.
#[derive(Debug, thiserror::Error)]
#[error("{}: {message}", path.display())]
pub struct MeshFileError {
    pub path: PathBuf,
    pub message: String,
}

type Raw = (Vec<Point<3>>, Vec<[u32; 3]>);

/// The largest file that is read.
const LARGEST: u64 = 4 << 30;

/// Reads a mesh. Corners at the same position are one vertex; polygons are cut into triangles from their first corner.
///
/// # Errors
/// A file that cannot be read, of an unknown kind, damaged, or that makes no mesh.
pub fn read(path: &Path) -> Result<TriangleMesh, MeshFileError> {
    let fail = |message: String| MeshFileError { path: path.to_path_buf(), message };
    let length = std::fs::metadata(path).map_err(|e| fail(format!("cannot read: {e}")))?.len();
    if length > LARGEST {
        return Err(fail(format!("{length} bytes, more than {} GiB", LARGEST >> 30)));
    }
    let known = matches!(extension(path).as_str(), "stl" | "obj" | "ply");
    let bytes = if known { std::fs::read(path).map_err(|e| fail(format!("cannot read: {e}")))? } else { Vec::new() };
    parse(path, &bytes)
}

fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// The mesh in the bytes of a file, whose kind its name tells.
///
/// # Errors
/// As of [`read`].
pub fn parse(path: &Path, bytes: &[u8]) -> Result<TriangleMesh, MeshFileError> {
    let fail = |message: String| MeshFileError { path: path.to_path_buf(), message };
    let (vertices, triangles) = match extension(path).as_str() {
        "stl" => stl(bytes),
        "obj" => obj(bytes),
        "ply" => ply(bytes),
        other => Err(format!("`{other}` is not a mesh format; valid are stl, obj and ply")),
    }
    .map_err(fail)?;
    let (vertices, triangles) = welded(&vertices, &triangles).map_err(fail)?;
    TriangleMesh::new(vertices, &triangles).map_err(|e| fail(e.to_string()))
}

fn stl(bytes: &[u8]) -> Result<Raw, String> {
    let mut cursor = Cursor::new(bytes);
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    let reader = stl_io::create_stl_reader(&mut cursor).map_err(|e| format!("not STL: {e}"))?;
    for (k, triangle) in reader.enumerate() {
        let triangle = triangle.map_err(|e| format!("damaged at triangle {k}: {e}"))?;
        let first = vertices.len() as u32;
        for v in triangle.vertices {
            vertices.push(Point::<3>::new(v[0].into(), v[1].into(), v[2].into()));
        }
        triangles.push([first, first + 1, first + 2]);
    }
    Ok((vertices, triangles))
}

fn obj(bytes: &[u8]) -> Result<Raw, String> {
    let options =
        tobj::LoadOptions { triangulate: true, ignore_points: true, ignore_lines: true, ..Default::default() };
    let materials = |_: &Path| Ok((Vec::new(), Default::default()));
    let (models, _) =
        tobj::load_obj_buf(&mut Cursor::new(bytes), &options, materials).map_err(|e| format!("not OBJ: {e}"))?;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for model in models {
        let first = vertices.len() as u32;
        vertices.extend(model.mesh.positions.chunks_exact(3).map(|p| Point::<3>::new(p[0], p[1], p[2])));
        triangles.extend(model.mesh.indices.chunks_exact(3).map(|t| [first + t[0], first + t[1], first + t[2]]));
    }
    Ok((vertices, triangles))
}

fn ply(bytes: &[u8]) -> Result<Raw, String> {
    let parser = Parser::<DefaultElement>::new();
    let ply = parser.read_ply(&mut Cursor::new(bytes)).map_err(|e| format!("not PLY: {e}"))?;
    let mut vertices = Vec::new();
    for (k, vertex) in ply.payload.get("vertex").ok_or("no element `vertex`")?.iter().enumerate() {
        let mut x = [0.0; 3];
        for (value, key) in x.iter_mut().zip(["x", "y", "z"]) {
            *value = vertex.get(key).and_then(number).ok_or_else(|| format!("vertex {k} has no number `{key}`"))?;
        }
        vertices.push(Point::<3>::from(x));
    }
    let mut triangles = Vec::new();
    for (k, face) in ply.payload.get("face").ok_or("no element `face`")?.iter().enumerate() {
        let corners = face
            .get("vertex_indices")
            .or_else(|| face.get("vertex_index"))
            .and_then(Property::to_u32_list)
            .ok_or_else(|| format!("face {k} has no list `vertex_indices`"))?;
        for pair in corners.windows(2).skip(1) {
            triangles.push([corners[0], pair[0], pair[1]]);
        }
    }
    Ok((vertices, triangles))
}

fn number(property: &Property) -> Option<f64> {
    Some(match property {
        Property::Char(v) => f64::from(*v),
        Property::UChar(v) => f64::from(*v),
        Property::Short(v) => f64::from(*v),
        Property::UShort(v) => f64::from(*v),
        Property::Int(v) => f64::from(*v),
        Property::UInt(v) => f64::from(*v),
        Property::Float(v) => f64::from(*v),
        Property::Double(v) => *v,
        _ => return None,
    })
}

/// Joins vertices at the same position and drops those without a triangle.
fn welded(vertices: &[Point<3>], triangles: &[[u32; 3]]) -> Result<Raw, String> {
    let mut numbers: HashMap<[u64; 3], u32> = HashMap::new();
    let mut kept = Vec::new();
    let mut out = Vec::with_capacity(triangles.len());
    for (k, t) in triangles.iter().enumerate() {
        let mut corners = [0; 3];
        for (corner, &v) in corners.iter_mut().zip(t) {
            let x = vertices
                .get(v as usize)
                .ok_or_else(|| format!("triangle {k} has vertex {v}, but there are {}", vertices.len()))?;
            // Zero has two signs and one position.
            let key = [x.x + 0.0, x.y + 0.0, x.z + 0.0].map(f64::to_bits);
            *corner = *numbers.entry(key).or_insert_with(|| {
                kept.push(*x);
                kept.len() as u32 - 1
            });
        }
        out.push(corners);
    }
    Ok((kept, out))
}

/// Distances, as shares of the extent, within which corners that ought to be one are joined.
const NEARLY: [f64; 5] = [0.0, 1e-6, 1e-5, 1e-4, 1e-3];

/// A surface that is nearly closed as a closed one, with the largest distance over which corners were joined: at the least of
/// some distances that is enough. Triangles without area are left out, if that helps.
pub fn mended(mesh: &TriangleMesh) -> Option<(TriangleMesh, f64)> {
    let extent = mesh.bounds().size().norm();
    NEARLY.iter().find_map(|share| {
        let (vertices, triangles) = joined(mesh, share * extent);
        let flat = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| vertices[v as usize]);
            (b - a).cross(&(c - a)).norm() <= 1e-12 * extent * extent
        };
        let with_area: Vec<[u32; 3]> = triangles.iter().filter(|t| !flat(t)).copied().collect();
        let found = [triangles, with_area]
            .into_iter()
            .find_map(|list| TriangleMesh::new(vertices.clone(), &list).ok().filter(|m| m.quality().has_inside()));
        found.map(|mesh| (mesh, share * extent))
    })
}

/// Each corner as the first one within a distance of it; triangles of which two corners become one are left out.
fn joined(mesh: &TriangleMesh, distance: f64) -> Raw {
    let mut boxes: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut kept: Vec<Point<3>> = Vec::new();
    let size = distance.max(f64::MIN_POSITIVE);
    let low = mesh.bounds().min;
    let numbers: Vec<u32> = (mesh.vertices().iter())
        .map(|x| {
            let at = [0, 1, 2].map(|k| if distance > 0.0 { ((x[k] - low[k]) / size) as i64 } else { 0 });
            let around = (0..27).map(|i| [at[0] + i % 3 - 1, at[1] + i / 3 % 3 - 1, at[2] + i / 9 - 1]);
            let near = |k: &u32| (kept[*k as usize] - x).norm() <= distance;
            let mut found = around.filter_map(|b| boxes.get(&b)).flatten().copied().filter(near);
            if let Some(known) = found.next().filter(|_| distance > 0.0) {
                return known;
            }
            let new = kept.len() as u32;
            kept.push(*x);
            if distance > 0.0 {
                boxes.entry(at).or_default().push(new);
            }
            new
        })
        .collect();
    let renumbered = mesh.triangles().iter().map(|t| t.map(|v| numbers[v as usize]));
    (kept, renumbered.filter(|[a, b, c]| a != b && b != c && c != a).collect())
}
