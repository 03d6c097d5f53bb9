//! Gmsh meshes: MSH 2.2 and 4.1, ASCII and binary, with physical groups.
//!
//! Cells of order 1 and 2 are read: triangles, quadrilaterals, tetrahedra, hexahedra and wedges, serendipity cells
//! included (their missing nodes are where the serendipity map puts them).

mod error;
mod kind;
mod read;
mod source;

pub use error::GmshError;

use crate::cell_map::CellMap;
use crate::mesh::{Mesh, Side};
use crate::reference::CellShape;
use kind::{close, kind};
use signorini_geometry::Point;
use std::collections::{BTreeMap, BTreeSet, HashMap};

#[derive(Clone, Debug)]
struct Element {
    number: u64,
    kind: i64,
    /// The curve, surface or volume that it is a part of.
    entity: i64,
    groups: Vec<i64>,
    nodes: Vec<u64>,
}

impl Element {
    /// Dimension of its shape, which is known once it was read.
    fn dimension(&self) -> usize {
        kind(self.kind).and_then(|kind| kind.shape).map_or(0, CellShape::dimension)
    }
}

/// What a mesh file holds.
#[derive(Clone, Debug, Default)]
pub struct GmshFile {
    nodes: HashMap<u64, [f64; 3]>,
    elements: Vec<Element>,
    /// Names of physical groups by dimension and number.
    names: BTreeMap<(usize, i64), String>,
}

impl GmshFile {
    fn name(&self, dimension: usize, group: i64) -> String {
        self.names.get(&(dimension, group)).cloned().unwrap_or_else(|| group.to_string())
    }

    /// The elements of all cells of a dimension, or of those in a physical group.
    fn cells<'a>(&'a self, dimension: usize, group: Option<&'a str>) -> impl Iterator<Item = &'a Element> {
        self.elements.iter().filter(move |e| {
            let named = |name: &str| e.groups.iter().any(|g| self.name(dimension, *g) == name);
            e.dimension() == dimension && group.is_none_or(named)
        })
    }

    /// Where a cell of [`GmshFile::mesh`] comes from: the number of its element, and in words its surface or volume with
    /// the physical groups of it.
    pub fn origin<const D: usize>(&self, group: Option<&str>, cell: usize) -> Option<(u64, String)> {
        let element = self.cells(D, group).nth(cell)?;
        let what = if D == 2 { "surface" } else { "volume" };
        let names: Vec<String> = element.groups.iter().map(|g| format!("`{}`", self.name(D, *g))).collect();
        let names = if names.is_empty() { String::new() } else { format!(" ({})", names.join(", ")) };
        Some((element.number, format!("{what} {}{names}", element.entity)))
    }

    /// The mesh of all cells, or of those in a physical group, with the other groups that touch it.
    ///
    /// # Errors
    /// An unknown group, no cells, nodes that do not exist, or a plane mesh out of its plane.
    pub fn mesh<const D: usize>(&self, group: Option<&str>) -> Result<Mesh<D>, GmshError> {
        let mut known = BTreeSet::new();
        for e in &self.elements {
            for g in &e.groups {
                known.insert((e.dimension(), self.name(e.dimension(), *g)));
            }
        }
        if let Some(group) = group
            && !known.contains(&(D, group.to_string()))
        {
            let list: Vec<String> = known.iter().map(|(d, n)| format!("`{n}` ({d})")).collect();
            let known = if list.is_empty() { "none".into() } else { list.join(", ") };
            return Err(GmshError::NoGroup { group: group.to_string(), dimension: D, known });
        }
        let cells: Vec<&Element> = self.cells(D, group).collect();
        if cells.is_empty() {
            let hint = "check whether the cells are in no physical group, or whether `space` has another dimension";
            return Err(GmshError::NoCells { dimension: D, hint });
        }
        let mut numbers: HashMap<u64, u32> = HashMap::new();
        let mut positions: Vec<Point<D>> = Vec::new();
        let mut magnitude = 0.0f64;
        for e in &cells {
            for tag in &e.nodes {
                let Some(x) = self.nodes.get(tag) else {
                    return Err(GmshError::NoNode { place: String::new(), element: e.number, node: *tag });
                };
                magnitude = x.iter().fold(magnitude, |m, v| m.max(v.abs()));
                numbers.entry(*tag).or_insert_with(|| {
                    positions.push(Point::<D>::from_fn(|k, _| x[k]));
                    positions.len() as u32 - 1
                });
            }
        }
        if D == 2 {
            for tag in numbers.keys() {
                let z = self.nodes[tag][2];
                if z.abs() > 1e-9 * magnitude {
                    return Err(GmshError::NotPlane { node: *tag, z });
                }
            }
        }
        let mut lists = Vec::new();
        let mut added: HashMap<Vec<u32>, u32> = HashMap::new();
        for e in &cells {
            let Some(kind) = kind(e.kind) else { continue };
            let Some(shape) = kind.shape else { continue };
            let given: Vec<u32> = e.nodes.iter().map(|n| numbers[n]).collect();
            lists.push((shape, kind.order, kind.arrange(shape, &given, &mut positions, &mut added)));
        }
        // A plane mesh that faces the other way is turned over.
        if D == 2 && lists.iter().all(|(shape, order, nodes)| signed_area(*shape, *order, nodes, &positions) < 0.0) {
            for (shape, order, nodes) in &mut lists {
                *nodes = turned_over(*shape, *order, nodes);
            }
        }
        let mut mesh = Mesh::<D>::new(positions);
        for (shape, order, nodes) in &lists {
            mesh.add_cell(*shape, *order, nodes);
        }
        self.groups(&mut mesh, &cells, &numbers);
        Ok(mesh)
    }

    fn groups<const D: usize>(&self, mesh: &mut Mesh<D>, cells: &[&Element], numbers: &HashMap<u64, u32>) {
        for (k, e) in cells.iter().enumerate() {
            for g in &e.groups {
                mesh.group_mut(&self.name(D, *g)).cells.push(k as u32);
            }
        }
        let mut sides: HashMap<Vec<u32>, Vec<Side>> = HashMap::new();
        for side in mesh.all_sides() {
            let mut key = mesh.side_vertices(side);
            key.sort_unstable();
            sides.entry(key).or_default().push(side);
        }
        for e in &self.elements {
            let Some(kind) = kind(e.kind) else { continue };
            let dimension = kind.shape.map_or(0, CellShape::dimension);
            if e.groups.is_empty() || dimension >= D {
                continue;
            }
            let vertices: Option<Vec<u32>> =
                (e.nodes.iter().take(kind.vertices()).map(|n| numbers.get(n).copied())).collect();
            let Some(mut vertices) = vertices else { continue };
            for g in &e.groups {
                let name = self.name(dimension, *g);
                if dimension + 1 == D {
                    vertices.sort_unstable();
                    // Sides between two cells belong to both.
                    if let Some(found) = sides.get(&vertices) {
                        mesh.group_mut(&name).sides.extend(found);
                    }
                } else {
                    mesh.group_mut(&name).vertices.extend(&vertices);
                }
            }
        }
        let boundary = mesh.boundary();
        if !mesh.groups().contains_key("boundary") {
            mesh.group_mut("boundary").sides = boundary;
        }
    }
}

/// The cells of a shape by its name and number of nodes, in the order of a Gmsh file.
pub struct ListedCells<'a> {
    pub shape: &'a str,
    pub nodes: &'a [Vec<u32>],
}

impl GmshFile {
    /// The file that would hold some points and cells, with neither groups nor sides.
    ///
    /// # Errors
    /// In words: an unknown shape or number of nodes, of which cell; a node that is no point.
    pub fn from_arrays(points: Vec<[f64; 3]>, cells: &[ListedCells]) -> Result<Self, String> {
        let count = points.len();
        let nodes = points.into_iter().enumerate().map(|(k, x)| (k as u64, x)).collect();
        let mut elements = Vec::new();
        for block in cells {
            for (cell, list) in block.nodes.iter().enumerate() {
                let what = || format!("cell {cell} of the {}s", block.shape);
                let kind = match (block.shape, list.len()) {
                    ("triangle", 3) => 2,
                    ("quadrilateral", 4) => 3,
                    ("tetrahedron", 4) => 4,
                    ("hexahedron", 8) => 5,
                    ("wedge", 6) => 6,
                    ("triangle", 6) => 9,
                    ("quadrilateral", 9) => 10,
                    ("tetrahedron", 10) => 11,
                    ("hexahedron", 27) => 12,
                    ("wedge", 18) => 13,
                    ("quadrilateral", 8) => 16,
                    ("hexahedron", 20) => 17,
                    ("wedge", 15) => 18,
                    (_, found) => return Err(format!("{}: no such cell has {found} nodes", what())),
                };
                if let Some(beyond) = list.iter().find(|n| **n as usize >= count) {
                    return Err(format!("{}: there is no point {beyond}, the last is {}", what(), count.max(1) - 1));
                }
                let number = elements.len() as u64;
                let nodes = list.iter().map(|n| u64::from(*n)).collect();
                elements.push(Element { number, kind, entity: 0, groups: Vec::new(), nodes });
            }
        }
        Ok(Self { nodes, elements, names: BTreeMap::new() })
    }
}

fn signed_area<const D: usize>(shape: CellShape, order: usize, nodes: &[u32], x: &[Point<D>]) -> f64 {
    let corners: Vec<Point<D>> =
        CellMap::new(shape, order).vertex_nodes().iter().map(|&k| x[nodes[k] as usize]).collect();
    let n = corners.len();
    (0..n).map(|k| corners[k][0] * corners[(k + 1) % n][1] - corners[k][1] * corners[(k + 1) % n][0]).sum()
}

/// The nodes with the two directions of the reference cell exchanged.
fn turned_over(shape: CellShape, order: usize, nodes: &[u32]) -> Vec<u32> {
    let places = CellMap::new(shape, order).nodes();
    places
        .iter()
        .map(|p| {
            let at = places.iter().position(|q| close(q, &[p[1], p[0], 0.0])).unwrap_or(0);
            nodes[at]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(list: [u32; 4]) -> Result<GmshFile, String> {
        let points = vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        GmshFile::from_arrays(points, &[ListedCells { shape: "quadrilateral", nodes: &[list.to_vec()] }])
    }

    /// Cells listed clockwise are turned over: their Jacobian is positive and their area that of the others.
    #[test]
    fn a_plane_mesh_that_faces_down_is_turned_over() {
        for list in [[0, 1, 2, 3], [0, 3, 2, 1]] {
            let mesh = square(list).unwrap().mesh::<2>(None).unwrap();
            let points = crate::rules::rule(CellShape::Quadrilateral, 2);
            let mut at = crate::hierarchic::Values::default();
            let area: f64 = (points.iter())
                .map(|(s, w)| {
                    mesh.map(0).tabulate(s, &mut at);
                    w * mesh.jacobian(0, &at).1.determinant()
                })
                .sum();
            assert!((area - 2.0).abs() < 1e-15, "{list:?}: {area}");
            assert_eq!(mesh.groups()["boundary"].sides.len(), 4);
        }
    }

    #[test]
    fn arrays_that_make_no_cells_are_told_by_their_place() {
        assert_eq!(
            square([0, 1, 2, 4]).unwrap_err(),
            "cell 0 of the quadrilaterals: there is no point 4, the last is 3"
        );
        let five = ListedCells { shape: "triangle", nodes: &[vec![0, 1, 2, 3, 0]] };
        let told = GmshFile::from_arrays(vec![[0.0; 3]; 4], &[five]).unwrap_err();
        assert_eq!(told, "cell 0 of the triangles: no such cell has 5 nodes");
    }

    /// A quadrilateral of eight nodes gets the ninth of the serendipity map: minus a quarter of the corners, half of the rest.
    #[test]
    fn serendipity_cells_get_their_missing_node() {
        let corner = [[0.0, 0.0], [2.0, 0.1], [2.2, 1.0], [0.1, 1.3]];
        let middle = [[1.0, -0.2], [2.3, 0.5], [1.1, 1.4], [0.0, 0.6]];
        let points: Vec<[f64; 3]> = corner.iter().chain(&middle).map(|[x, y]| [*x, *y, 0.0]).collect();
        let file = GmshFile::from_arrays(points, &[ListedCells { shape: "quadrilateral", nodes: &[(0..8).collect()] }])
            .unwrap();
        let mesh = file.mesh::<2>(None).unwrap();
        let mut at = crate::hierarchic::Values::default();
        mesh.map(0).tabulate(&[0.0; 3], &mut at);
        let sum = |list: &[[f64; 2]; 4], k: usize| list.iter().map(|x| x[k]).sum::<f64>();
        let exact = Point::<2>::from_fn(|k, _| 0.5 * sum(&middle, k) - 0.25 * sum(&corner, k));
        assert!((mesh.position(0, &at) - exact).norm() < 1e-15);
    }
}
