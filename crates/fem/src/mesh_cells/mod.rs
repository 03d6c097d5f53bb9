//! Triangles and quadrilaterals of a mesh, straight or curved, as the cells of a membrane.
//!
//! | file | what it holds |
//! |---|---|
//! | `mod` | the cells with their functions, straight and curved, and what is kept of them |
//! | `curved`, `rule`, `boundary` | measures of curved cells, tabulated rules, pieces of the boundary |
//! | `place` | where a point is |
//! | `unit_square` | how a cell is cut |
//! | `division` | cells divided into four |
//! | `cells` | the trait [`Cells`](crate::cells::Cells) |

mod boundary;
mod cells;
mod curved;
mod division;
mod grid;
mod place;
mod rule;
#[cfg(test)]
mod tests;
mod unit_square;

use crate::adjacency::Adjacency;
use crate::boundary_side::BoundarySide;
use crate::dofs::DofMap;
use crate::grid::Grid;
use crate::hierarchic::{Mode, Values};
use crate::lists::Lists;
use crate::mesh::{Mesh, Side};
use crate::overlap::BULGE;
use crate::reference::CellShape;
use crate::small;
use boundary::boundary;
use curved::{CurvedCell, box_round, edges, longest};
use rule::{RulePoint, tabulated};
use signorini_geometry::{Aabb, Point};
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

/// The cells of a plane mesh with functions of one degree.
pub struct MeshCells {
    mesh: Mesh<2>,
    dofs: DofMap,
    /// The vertex of each function that belongs to one.
    nodes: Vec<Point<2>>,
    degree: usize,
    /// For each cell whose map is not linear, its place in `bent`.
    bent_at: Vec<u32>,
    bent: Vec<CurvedCell>,
    /// Rule of each map, tabulated.
    rules: Vec<Vec<RulePoint>>,
    buckets: Grid<2>,
    /// For each bucket, the cells and the boundary sides that reach into it, once these are asked for.
    cells_in: OnceLock<Lists<u32>>,
    sides_in: OnceLock<Lists<u32>>,
    adjacency: Adjacency,
    /// Sides on the boundary, cell by cell, and points along each.
    sides: Vec<BoundarySide>,
    drawn: Vec<[Point<2>; DRAWN + 1]>,
    groups: Vec<(String, Vec<usize>)>,
    pieces: usize,
    parent: Option<Parent>,
    /// The cells before some were divided, and how often each was; none where none was.
    whole: Option<Arc<MeshCells>>,
    levels: Vec<u8>,
}

/// The cells of which each was divided into four.
pub struct Parent {
    pub cells: Arc<MeshCells>,
    /// For each vertex function those of the parent at four vertices: its vertex is the mean of these, in the reference
    /// cell, and a function of degree 1 is there the mean of its values.
    pub nodes: Vec<[u32; 4]>,
}

/// The functions of three or four vertices.
pub struct CornerFunctions {
    list: [u32; 4],
    count: usize,
}

impl std::ops::Deref for CornerFunctions {
    type Target = [u32];
    fn deref(&self) -> &[u32] {
        &self.list[..self.count]
    }
}

const STRAIGHT: u32 = u32::MAX;

/// The highest degree of functions on triangles.
pub const MOST_ON_TRIANGLES: usize = 2;

/// Parts that a side of the boundary is drawn in.
const DRAWN: usize = 4;

impl MeshCells {
    /// Functions of the given degree on a mesh that [`Mesh::check`] accepts.
    ///
    /// # Panics
    /// If the degree is above 2 on a mesh with triangles.
    pub fn new(mesh: Mesh<2>, degree: usize) -> Self {
        let adjacency = Adjacency::new(&mesh);
        Self::with(mesh, adjacency, degree)
    }

    fn with(mesh: Mesh<2>, adjacency: Adjacency, degree: usize) -> Self {
        let count = mesh.cell_count();
        let dofs = DofMap::new(&mesh, degree);
        let mut vertices = vec![Point::<2>::zeros(); dofs.count()];
        for node in (0..count).flat_map(|cell| mesh.vertices(cell)) {
            if let Some(function) = dofs.vertex(node) {
                vertices[function as usize] = mesh.nodes()[node as usize];
            }
        }
        let nodes = vertices;
        let mut rules: BTreeMap<usize, Vec<RulePoint>> = BTreeMap::new();
        let mut total = 0.0;
        let (mut bent_at, mut bent) = (Vec::with_capacity(count), Vec::new());
        let mut at = Values::default();
        let mut vertices: Vec<Point<2>> = Vec::new();
        for cell in 0..count {
            let map = mesh.map(cell);
            vertices.clear();
            vertices.extend(mesh.vertices(cell).map(|n| mesh.nodes()[n as usize]));
            if map.shape() == CellShape::Triangle && map.order() == 1 {
                total += 0.5 * small::determinant(&edges(&vertices));
                bent_at.push(STRAIGHT);
                continue;
            }
            let table = rules.entry(mesh.map_number(cell)).or_insert_with(|| tabulated(map, degree));
            let volume: f64 =
                table.iter().map(|p| p.weight * small::determinant(&mesh.jacobian(cell, &p.map).1).abs()).sum();
            // The height of a triangle; the width of a quadrilateral, less where a corner is nearly straight and slopes
            // are steep.
            let least = (map.nodes().iter())
                .map(|x| {
                    map.tabulate(x, &mut at);
                    small::determinant(&mesh.jacobian(cell, &at).1)
                })
                .fold(f64::INFINITY, f64::min);
            let size = least / longest(&vertices) * if vertices.len() == 3 { 1.0 } else { 4.0 };
            total += volume;
            map.tabulate(&map.shape().centre(), &mut at);
            let (centre, jacobian) = mesh.jacobian(cell, &at);
            if map.shape() == CellShape::Triangle
                && table.iter().all(|p| (mesh.jacobian(cell, &p.map).1 - jacobian).norm() < 1e-13 * jacobian.norm())
            {
                bent_at.push(STRAIGHT);
                continue;
            }
            let mut bounds = box_round(mesh.cell_nodes(cell).iter().map(|&n| mesh.nodes()[n as usize]));
            if map.order() > 1 {
                bounds = bounds.scaled(BULGE);
            }
            let regular = least > 0.2 * volume / if vertices.len() == 3 { 0.5 } else { 4.0 };
            bent_at.push(bent.len() as u32);
            bent.push(CurvedCell { bounds, size, volume, centre, inverse: small::inverse(&jacobian), regular });
        }
        for cell in 0..count {
            rules.entry(mesh.map_number(cell)).or_insert_with(|| tabulated(mesh.map(cell), degree));
        }
        let maps = rules.keys().max().map_or(0, |m| m + 1);
        let rules = (0..maps).map(|m| rules.remove(&m).unwrap_or_default()).collect();
        let box_of = |cell: usize| bounds_of(&mesh, &bent_at, &bent, cell);
        let bounds = (1..count).map(box_of).fold(box_of(0), |a, b| a.joined(&b));
        // About one cell in each bucket.
        let spacing = (total / count as f64).sqrt();
        let number = |k: usize| ((bounds.size()[k] / spacing).ceil() as usize).clamp(1, 4096);
        let buckets = Grid::new(bounds, [number(0), number(1)], 1);
        let (groups, sides, pieces) = boundary(&mesh, &adjacency);
        let drawn = |side: &BoundarySide| {
            let of = Side { cell: side.cell as u32, side: side.side as u8 };
            std::array::from_fn(|i| mesh.on_side(of, &[2.0 * i as f64 / DRAWN as f64 - 1.0, 0.0, 0.0]).0)
        };
        let drawn = sides.iter().map(drawn).collect();
        Self {
            mesh,
            dofs,
            nodes,
            degree,
            bent_at,
            bent,
            rules,
            buckets,
            cells_in: OnceLock::new(),
            sides_in: OnceLock::new(),
            adjacency,
            sides,
            drawn,
            groups,
            pieces,
            parent: None,
            whole: None,
            levels: Vec::new(),
        }
    }

    /// The cells of which each was divided into four of these.
    pub fn parent(&self) -> Option<&Parent> {
        self.parent.as_ref()
    }

    /// The functions of the vertices of a cell, in their order.
    pub fn corner_functions(&self, cell: usize) -> CornerFunctions {
        let mut list = [0; 4];
        let mut count = 0;
        for (at, node) in list.iter_mut().zip(self.mesh.vertices(cell)) {
            *at = self.dofs.vertex(node).unwrap_or(0);
            count += 1;
        }
        CornerFunctions { list, count }
    }

    /// Calls `visit` with every function of a cell and the corners of the cell at which it does not end: its own corner, the
    /// two of its edge, all of them where it lives within.
    pub fn for_each_function_at_corners(&self, cell: usize, mut visit: impl FnMut(u32, &[usize])) {
        let shape = self.mesh.shape(cell);
        for (&function, mode) in self.dofs.functions(cell).iter().zip(self.dofs.basis(cell).modes()) {
            match *mode {
                Mode::Vertex(v) => visit(function, &[usize::from(v)]),
                Mode::Edge(e, _) => visit(function, &shape.edges()[usize::from(e)]),
                Mode::Side(..) | Mode::Interior => visit(function, &[0, 1, 2, 3][..shape.vertices().len()]),
            }
        }
    }

    /// For each function the one of degree 1 of the same vertex, in the numbers of [`MeshCells::new`] with that degree on the
    /// same mesh; none for functions of no vertex.
    pub fn functions_of_degree_one(&self) -> Vec<Option<u32>> {
        let mut out = vec![None; self.dofs.count()];
        let mut count = 0;
        for cell in 0..self.mesh.cell_count() {
            for &function in self.corner_functions(cell).iter() {
                out[function as usize].get_or_insert_with(|| {
                    count += 1;
                    count - 1
                });
            }
        }
        out
    }

    /// The cell across a side of a cell.
    pub fn across(&self, cell: usize, side: usize) -> Option<usize> {
        self.adjacency.across(Side { cell: cell as u32, side: side as u8 })
    }

    /// Whether a cell is a triangle with straight sides.
    pub fn is_straight(&self, cell: usize) -> bool {
        self.bent(cell).is_none()
    }

    /// The cells across the sides of a cell.
    pub fn beside(&self, cell: usize) -> impl Iterator<Item = usize> + '_ {
        self.adjacency.of(cell)
    }

    /// The smallest box round all cells.
    pub fn bounds(&self) -> &Aabb<2> {
        self.buckets.bounds()
    }

    /// The boundary's groups by name, each with its pieces.
    pub fn groups(&self) -> &[(String, Vec<usize>)] {
        &self.groups
    }

    /// Number of pieces of the boundary.
    pub fn pieces(&self) -> usize {
        self.pieces
    }

    fn bent(&self, cell: usize) -> Option<&CurvedCell> {
        self.bent.get(self.bent_at[cell] as usize)
    }

    /// The corners of a triangle.
    fn corners(&self, cell: usize) -> [Point<2>; 3] {
        let nodes = self.mesh.cell_nodes(cell);
        [0, 1, 2].map(|k| self.mesh.nodes()[nodes[k] as usize])
    }
}

fn bounds_of(mesh: &Mesh<2>, bent_at: &[u32], bent: &[CurvedCell], cell: usize) -> Aabb<2> {
    match bent.get(bent_at[cell] as usize) {
        Some(bent) => bent.bounds,
        None => box_round(mesh.vertices(cell).map(|n| mesh.nodes()[n as usize])),
    }
}
