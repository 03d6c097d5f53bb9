//! What is drawn of a mesh: triangles, edges of cells, lines and points.

use crate::vtk::{Cell, Kind, Mesh};
use std::collections::{BTreeMap, HashMap, HashSet};

/// What joins the points of a part, as numbers of points.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Topology {
    pub triangles: Vec<u32>,
    /// Edges of cells, two points each.
    pub edges: Vec<u32>,
    /// Lines that are bodies or borders themselves, two points each.
    pub lines: Vec<u32>,
    pub vertices: Vec<u32>,
    /// Cells with a volume, four points each, for what a cut shows.
    pub tetrahedra: Vec<u32>,
}

/// Faces of cells with a volume, by the corners of the cell, seen from outside.
const TETRAHEDRON: [&[usize]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]];
const HEXAHEDRON: [&[usize]; 6] =
    [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];
const WEDGE: [&[usize]; 5] = [&[0, 1, 2], &[3, 5, 4], &[0, 3, 4, 1], &[1, 4, 5, 2], &[2, 5, 3, 0]];
/// Tetrahedra that fill a hexahedron, all along one diagonal, and those that fill a wedge.
const OF_HEXAHEDRON: [[usize; 4]; 6] =
    [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]];
const OF_WEDGE: [[usize; 4]; 3] = [[0, 1, 2, 5], [0, 1, 5, 4], [0, 4, 5, 3]];

/// The faces of a cell: itself, where it is flat.
fn faces(cell: &Cell) -> Vec<Vec<u32>> {
    let of: &[&[usize]] = match cell.kind {
        Kind::Tetrahedron => &TETRAHEDRON,
        Kind::Hexahedron => &HEXAHEDRON,
        Kind::Wedge => &WEDGE,
        Kind::Polygon => return vec![cell.corners.clone()],
        Kind::Vertex | Kind::Line => return Vec::new(),
    };
    let corner = |k: &usize| cell.corners.get(*k).copied();
    of.iter().filter_map(|face| face.iter().map(corner).collect()).collect()
}

/// The tetrahedra that fill a cell.
fn filled(cell: &Cell) -> Vec<u32> {
    let of: &[[usize; 4]] = match cell.kind {
        Kind::Tetrahedron => &[[0, 1, 2, 3]],
        Kind::Hexahedron => &OF_HEXAHEDRON,
        Kind::Wedge => &OF_WEDGE,
        _ => &[],
    };
    of.iter().flatten().filter_map(|k| cell.corners.get(*k).copied()).collect()
}

/// The bodies of a mesh by their numbers, each with the numbers of its points in the mesh and what joins them; one body
/// without a number where no array tells them apart.
pub fn parts(mesh: &Mesh) -> Vec<(Option<usize>, Vec<u32>, Topology)> {
    let body = mesh.scalar("body");
    let mut cells: BTreeMap<usize, Vec<&Cell>> = BTreeMap::new();
    for cell in mesh.cells.iter().filter(|cell| !cell.corners.is_empty()) {
        let number = body.map_or(0, |body| body[cell.corners[0] as usize].max(0.0) as usize);
        cells.entry(number).or_default().push(cell);
    }
    cells
        .into_iter()
        .map(|(number, cells)| {
            let (points, topology) = compact(drawn(&cells));
            (body.map(|_| number), points, topology)
        })
        .collect()
}

/// Triangles, edges and lines of cells.
fn drawn(cells: &[&Cell]) -> Topology {
    let mut out = Topology::default();
    let mut inner: HashMap<Vec<u32>, (usize, Vec<u32>)> = HashMap::new();
    let mut flat: Vec<Vec<u32>> = Vec::new();
    for cell in cells {
        match cell.kind {
            Kind::Vertex => out.vertices.extend(&cell.corners),
            Kind::Line => out.lines.extend(cell.corners.windows(2).flatten()),
            Kind::Polygon => flat.push(cell.corners.clone()),
            _ => {
                out.tetrahedra.extend(filled(cell));
                for face in faces(cell) {
                    let mut key = face.clone();
                    key.sort_unstable();
                    inner.entry(key).or_insert_with(|| (0, face)).0 += 1;
                }
            }
        }
    }
    let mut outer: Vec<Vec<u32>> = inner.into_values().filter(|(count, _)| *count == 1).map(|(_, face)| face).collect();
    // The order of a map of hashes is never the same.
    outer.sort_unstable();
    let mut edges: HashSet<[u32; 2]> = HashSet::new();
    for face in flat.iter().chain(&outer).filter(|face| face.len() > 2) {
        for k in 1..face.len() - 1 {
            out.triangles.extend([face[0], face[k], face[k + 1]]);
        }
        for k in 0..face.len() {
            let (a, b) = (face[k], face[(k + 1) % face.len()]);
            if edges.insert([a.min(b), a.max(b)]) {
                out.edges.extend([a, b]);
            }
        }
    }
    out
}

/// Numbers the points that are used anew.
fn compact(topology: Topology) -> (Vec<u32>, Topology) {
    let mut points = Vec::new();
    let mut numbers: HashMap<u32, u32> = HashMap::new();
    let mut renumbered = |list: Vec<u32>| -> Vec<u32> {
        list.into_iter()
            .map(|k| {
                *numbers.entry(k).or_insert_with(|| {
                    points.push(k);
                    points.len() as u32 - 1
                })
            })
            .collect()
    };
    let topology = Topology {
        triangles: renumbered(topology.triangles),
        edges: renumbered(topology.edges),
        lines: renumbered(topology.lines),
        vertices: renumbered(topology.vertices),
        tetrahedra: renumbered(topology.tetrahedra),
    };
    (points, topology)
}

/// The same without what only a cut shows. Returns the points that are kept, and what is left between them.
pub fn without_volume(topology: &Topology) -> (Vec<u32>, Topology) {
    compact(Topology { tetrahedra: Vec::new(), ..topology.clone() })
}

/// Draws points that share a box of a grid together, so that about `wanted` triangles are left. Returns the points that are
/// kept, and what is left between them.
pub fn thinned(points: &[[f64; 3]], topology: &Topology, wanted: usize) -> (Vec<u32>, Topology) {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for x in points {
        for k in 0..3 {
            low[k] = low[k].min(x[k]);
            high[k] = high[k].max(x[k]);
        }
    }
    let longest = (0..3).map(|k| high[k] - low[k]).fold(f64::MIN_POSITIVE, f64::max);
    // A surface crosses about three boxes for each square of a side.
    let side = longest / (wanted as f64 / 3.0).sqrt().max(2.0);
    let mut first: HashMap<[i64; 3], u32> = HashMap::new();
    let kept: Vec<u32> = (points.iter().zip(0u32..))
        .map(|(x, k)| *first.entry(std::array::from_fn(|i| ((x[i] - low[i]) / side) as i64)).or_insert(k))
        .collect();
    let of = |list: &[u32], corners: usize| -> Vec<u32> {
        let moved = list.chunks_exact(corners).map(|c| c.iter().map(|&k| kept[k as usize]).collect::<Vec<u32>>());
        moved.filter(|c| (0..corners).all(|k| c[k] != c[(k + 1) % corners])).flatten().collect()
    };
    let triangles = of(&topology.triangles, 3);
    let lines = of(&topology.lines, 2);
    // Edges of cells and volumes are gone with the cells.
    compact(Topology { triangles, lines, vertices: topology.vertices.clone(), ..Topology::default() })
}
