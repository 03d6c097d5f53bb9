//! Unstructured meshes: cells of all shapes, straight or curved, with named groups of cells, sides and vertices.

use super::cell_map::CellMap;
use super::hierarchic::Values;
use super::rational::RationalBasis;
use super::reference::{CellShape, Local};
use signorini_geometry::{Matrix, Point};
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// One side of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Side {
    pub cell: u32,
    pub side: u8,
}

/// What a name of a mesh stands for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Group {
    pub cells: Vec<u32>,
    pub sides: Vec<Side>,
    pub vertices: Vec<u32>,
    /// Nodes that are no vertices.
    pub between: Vec<NodeBetween>,
}

/// A node in the middle of an edge, a face or a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeBetween {
    pub node: u32,
    /// A cell that has it, and its place among the nodes of the cell.
    pub cell: u32,
    pub place: u8,
}

#[derive(Clone, Copy, Debug)]
struct Cell {
    /// Number in `maps`.
    map: u32,
    /// First entry in `cell_nodes`.
    first: u32,
}

/// Where a cell lies in a macro cell: for each direction the coordinates of its ends, those of the macro cell from -1 to 1.
pub type Window = [[f64; 2]; 3];

/// A mesh of a body in `D` dimensions. The cells of a spline are its spans: their nodes are control points, and further nodes are
/// at their vertices.
#[derive(Clone, Debug)]
pub struct Mesh<const D: usize> {
    nodes: Vec<Point<D>>,
    maps: Vec<CellMap>,
    vertex_places: Vec<Vec<usize>>,
    cells: Vec<Cell>,
    cell_nodes: Vec<u32>,
    groups: BTreeMap<String, Group>,
    macro_cells: Vec<Vec<(u32, Window)>>,
}

/// A mesh that cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    #[error("the mesh has no {dimension}-dimensional cells")]
    Empty { dimension: usize },
    #[error("cell {cell}, a {shape} at {position}, is {what} (Jacobian {jacobian:.3e})")]
    BadCell { cell: usize, shape: &'static str, position: String, what: &'static str, jacobian: f64 },
    #[error("node {node} of cell {cell} does not exist")]
    NoNode { cell: usize, node: u64 },
    #[error("node {node} is at {position}, which is not finite")]
    NotFinite { node: usize, position: String },
}

/// A position for messages.
pub fn position<const D: usize>(x: &Point<D>) -> String {
    let list: Vec<String> = x.iter().map(|v| format!("{v:.6}")).collect();
    format!("({})", list.join(", "))
}

/// Sine of the angle between the sides of a cell below which it is flat.
const FLAT: f64 = 1e-6;
/// Where a gradient is shown of a cell that is flat at a point: this part of the way to its middle.
const INWARDS: f64 = 0.1;

impl<const D: usize> Mesh<D> {
    pub fn new(nodes: Vec<Point<D>>) -> Self {
        Mesh {
            nodes,
            maps: Vec::new(),
            vertex_places: Vec::new(),
            cells: Vec::new(),
            cell_nodes: Vec::new(),
            groups: BTreeMap::new(),
            macro_cells: Vec::new(),
        }
    }

    /// Adds a cell with its nodes in the order of [`CellMap`].
    pub fn add_cell(&mut self, shape: CellShape, order: usize, nodes: &[u32]) -> u32 {
        let same = |m: &CellMap| m.is_polynomial(shape, order);
        let found = self.maps.iter().position(same);
        let map = found.unwrap_or_else(|| {
            let map = CellMap::new(shape, order);
            self.vertex_places.push(map.vertex_nodes());
            self.maps.push(map);
            self.maps.len() - 1
        });
        debug_assert_eq!(nodes.len(), self.maps[map].len());
        self.cells.push(Cell { map: map as u32, first: self.cell_nodes.len() as u32 });
        self.cell_nodes.extend_from_slice(nodes);
        (self.cells.len() - 1) as u32
    }

    /// Adds a span of a spline with its control points, and nodes at its vertices in the order of the reference cell.
    pub fn add_span(&mut self, basis: Arc<RationalBasis>, controls: &[u32], vertices: &[u32]) -> u32 {
        debug_assert_eq!(controls.len(), basis.len());
        // Vertices stand behind the control points.
        self.vertex_places.push((controls.len()..controls.len() + vertices.len()).collect());
        self.maps.push(CellMap::spline(basis));
        self.cells.push(Cell { map: self.maps.len() as u32 - 1, first: self.cell_nodes.len() as u32 });
        self.cell_nodes.extend_from_slice(controls);
        self.cell_nodes.extend_from_slice(vertices);
        (self.cells.len() - 1) as u32
    }

    /// Adds cells, with their places in the whole, on which dilatations are projected together.
    pub fn add_macro_cell(&mut self, cells: impl IntoIterator<Item = (u32, Window)>) {
        self.macro_cells.push(cells.into_iter().collect());
    }

    /// Cells on which dilatations are projected together: of splines all, each once; of other meshes none.
    pub fn macro_cells(&self) -> &[Vec<(u32, Window)>] {
        &self.macro_cells
    }

    /// Whether the cells are spans of splines.
    pub fn is_spline(&self) -> bool {
        self.maps.iter().any(|map| map.rational().is_some())
    }

    /// Makes room for so many triangles of order 1.
    pub(crate) fn reserve(&mut self, cells: usize) {
        self.cells.reserve(cells);
        self.cell_nodes.reserve(3 * cells);
    }

    /// Adds a node.
    pub fn add_node(&mut self, x: Point<D>) -> u32 {
        self.nodes.push(x);
        (self.nodes.len() - 1) as u32
    }

    /// Moves all nodes.
    pub fn move_nodes(&mut self, to: impl Fn(&Point<D>) -> Point<D>) {
        self.nodes.iter_mut().for_each(|x| *x = to(x));
    }

    pub fn group_mut(&mut self, name: &str) -> &mut Group {
        self.groups.entry(name.to_string()).or_default()
    }

    pub fn groups(&self) -> &BTreeMap<String, Group> {
        &self.groups
    }

    pub fn nodes(&self) -> &[Point<D>] {
        &self.nodes
    }

    pub fn cell_count(&self) -> usize {
        self.cells.len()
    }

    pub fn shape(&self, cell: usize) -> CellShape {
        self.map(cell).shape()
    }

    /// The Lagrange functions that map the reference cell.
    pub fn map(&self, cell: usize) -> &CellMap {
        &self.maps[self.cells[cell].map as usize]
    }

    /// Number of the map of a cell, to tabulate once for all cells that share it.
    pub fn map_number(&self, cell: usize) -> usize {
        self.cells[cell].map as usize
    }

    pub fn cell_nodes(&self, cell: usize) -> &[u32] {
        let first = self.cells[cell].first as usize;
        &self.cell_nodes[first..first + self.map(cell).len()]
    }

    /// The nodes at the vertices of a cell.
    pub fn vertices(&self, cell: usize) -> impl Iterator<Item = u32> + '_ {
        let first = self.cells[cell].first as usize;
        self.vertex_places[self.cells[cell].map as usize].iter().map(move |&k| self.cell_nodes[first + k])
    }

    /// The nodes at the vertices of a side, in the order of the side.
    pub fn side_vertices(&self, side: Side) -> Vec<u32> {
        let cell = side.cell as usize;
        let places = &self.vertex_places[self.cells[cell].map as usize];
        let first = self.cells[cell].first as usize;
        self.shape(cell).sides()[side.side as usize].iter().map(|&v| self.cell_nodes[first + places[v]]).collect()
    }

    pub fn side_shape(&self, side: Side) -> CellShape {
        CellShape::of_side(self.shape(side.cell as usize).sides()[side.side as usize].len())
    }

    /// Position from tabulated functions of the cell's map.
    pub fn position(&self, cell: usize, at: &Values) -> Point<D> {
        self.cell_nodes(cell).iter().zip(&at.value).map(|(&node, value)| self.nodes[node as usize] * *value).sum()
    }

    /// Position and Jacobian `∂x_i/∂ξ_j` from tabulated functions of the cell's map.
    pub fn jacobian(&self, cell: usize, at: &Values) -> (Point<D>, Matrix<D>) {
        let mut x = Point::<D>::zeros();
        let mut jacobian = Matrix::<D>::zeros();
        for (&node, (value, gradient)) in self.cell_nodes(cell).iter().zip(at.value.iter().zip(&at.gradient)) {
            let p = &self.nodes[node as usize];
            x += p * *value;
            for j in 0..D {
                for i in 0..D {
                    jacobian[(i, j)] += p[i] * gradient[j];
                }
            }
        }
        (x, jacobian)
    }

    /// Whether the map flattens a cell at a point, as where two sides of a square become one arc: no gradient exists there.
    pub fn is_flat(&self, cell: usize, at: &Values) -> bool {
        let (_, jacobian) = self.jacobian(cell, at);
        let sides: f64 = jacobian.column_iter().map(|c| c.norm()).product();
        crate::small::determinant(&jacobian).abs() <= FLAT * sides
    }

    /// Where gradients are shown for a point of a cell: there, or farther in where the cell is flat.
    pub fn shown_at(&self, cell: usize, xi: &Local) -> Local {
        let mut at = Values::default();
        self.map(cell).tabulate(xi, &mut at);
        if !self.is_flat(cell, &at) {
            return *xi;
        }
        let middle = self.shape(cell).centre();
        std::array::from_fn(|k| xi[k] + INWARDS * (middle[k] - xi[k]))
    }

    /// Position and tangents of a point of a side.
    pub fn on_side(&self, side: Side, s: &Local) -> (Point<D>, [Point<D>; 2]) {
        let cell = side.cell as usize;
        let (xi, directions) = self.shape(cell).on_side(side.side as usize, s);
        let mut at = Values::default();
        self.map(cell).tabulate(&xi, &mut at);
        let (x, jacobian) = self.jacobian(cell, &at);
        (x, directions.map(|d| jacobian * Point::<D>::from_fn(|k, _| d[k])))
    }

    /// Sides that belong to one cell only.
    pub fn boundary(&self) -> Vec<Side> {
        let mut open: HashMap<Vec<u32>, Option<Side>> = HashMap::new();
        for side in self.all_sides() {
            let mut key = self.side_vertices(side);
            key.sort_unstable();
            open.entry(key).and_modify(|s| *s = None).or_insert(Some(side));
        }
        let mut sides: Vec<Side> = open.into_values().flatten().collect();
        sides.sort_unstable();
        sides
    }

    /// Every side of every cell.
    pub fn all_sides(&self) -> impl Iterator<Item = Side> + '_ {
        (0..self.cells.len()).flat_map(|cell| {
            (0..self.shape(cell).sides().len()).map(move |side| Side { cell: cell as u32, side: side as u8 })
        })
    }

    /// Refuses what no computation can use: positions that are not finite, cells that are inverted or have no volume.
    pub fn check(&self) -> Result<(), MeshError> {
        if self.cells.is_empty() {
            return Err(MeshError::Empty { dimension: D });
        }
        for (node, x) in self.nodes.iter().enumerate() {
            if !x.iter().all(|v| v.is_finite()) {
                return Err(MeshError::NotFinite { node, position: position(x) });
            }
        }
        let mut tables: HashMap<usize, Vec<Values>> = HashMap::new();
        for cell in 0..self.cells.len() {
            if let Some(&node) = self.cell_nodes(cell).iter().find(|&&n| n as usize >= self.nodes.len()) {
                return Err(MeshError::NoNode { cell, node: u64::from(node) });
            }
            let map = self.map(cell);
            let tables = tables.entry(self.map_number(cell)).or_insert_with(|| {
                (map.nodes().into_iter().chain([map.shape().centre()]))
                    .map(|x| {
                        let mut at = Values::default();
                        map.tabulate(&x, &mut at);
                        at
                    })
                    .collect()
            });
            for at in tables.iter() {
                let (x, jacobian) = self.jacobian(cell, at);
                let value = crate::small::determinant(&jacobian);
                let size: f64 = jacobian.column_iter().map(|c| c.norm()).product();
                if value.is_nan() || value <= 1e-10 * size {
                    let what = if value < -1e-10 * size { "inverted" } else { "degenerate" };
                    let shape = map.shape().name();
                    return Err(MeshError::BadCell { cell, shape, position: position(&x), what, jacobian: value });
                }
            }
        }
        Ok(())
    }
}
