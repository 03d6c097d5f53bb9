//! Numbering of the functions of a mesh: hierarchic ones with the orientation of edges and sides, and those of splines, which
//! have the numbers of their control points.
//!
//! Edges run from the lower to the higher vertex number; quadrilateral sides have their origin at the lowest vertex and
//! their first axis towards the lower of its neighbours. A function of odd degree along a reversed axis changes sign.

use super::cell_basis::CellBasis;
use super::hierarchic::{HierarchicBasis, Mode, Values, spanned};
use super::mesh::{Mesh, Side};
use super::reference::CellShape;
use std::collections::HashMap;
use std::sync::Arc;

/// A node without a function.
const NONE: u32 = u32::MAX;

/// The functions of all cells.
#[derive(Clone, Debug)]
pub struct DofMap {
    bases: Vec<CellBasis>,
    basis_of: Vec<u32>,
    start: Vec<u32>,
    /// Number of every function of every cell, and its sign, where there are others than +1.
    functions: Vec<u32>,
    signs: Vec<i8>,
    count: usize,
    /// Function of each vertex, by node.
    vertices: Vec<u32>,
}

impl DofMap {
    /// Numbers the functions of the given degree on a mesh.
    ///
    /// The functions of a spline have the degree of its mesh.
    ///
    /// # Panics
    /// If the degree is above 2 on a mesh with cells other than quadrilaterals and hexahedra.
    pub fn new<const D: usize>(mesh: &Mesh<D>, degree: usize) -> Self {
        if mesh.is_spline() {
            return DofMap::of_splines(mesh);
        }
        let mut start = Vec::with_capacity(mesh.cell_count() + 1);
        start.push(0);
        let mut map = DofMap {
            bases: Vec::new(),
            basis_of: Vec::with_capacity(mesh.cell_count()),
            start,
            signs: Vec::new(),
            functions: Vec::with_capacity(mesh.cell_count() * (degree + 1) * (degree + 2) / 2),
            count: 0,
            vertices: vec![NONE; mesh.nodes().len()],
        };
        let mut edges: HashMap<[u32; 2], u32> = HashMap::new();
        let mut sides: HashMap<[u32; 3], u32> = HashMap::new();
        let per_edge = degree - 1;
        let mut vertices = Vec::new();
        for cell in 0..mesh.cell_count() {
            let shape = mesh.shape(cell);
            let found = map.bases.iter().position(|b| b.shape() == shape);
            let basis = found.unwrap_or_else(|| {
                map.bases.push(CellBasis::Hierarchic(HierarchicBasis::new(shape, degree)));
                map.bases.len() - 1
            });
            map.basis_of.push(basis as u32);
            vertices.clear();
            vertices.extend(mesh.vertices(cell));
            let mut next = map.count as u32;
            let mut take = |n: usize| {
                next += n as u32;
                next - n as u32
            };
            for mode in map.bases[basis].modes() {
                let (function, sign) = match *mode {
                    Mode::Vertex(v) => {
                        let function = &mut map.vertices[vertices[v as usize] as usize];
                        if *function == NONE {
                            *function = take(1);
                        }
                        (*function, 1)
                    }
                    Mode::Edge(e, k) => {
                        let [a, b] = shape.edges()[e as usize].map(|v| vertices[v]);
                        let first = *edges.entry([a.min(b), a.max(b)]).or_insert_with(|| take(per_edge));
                        (first + u32::from(k) - 2, sign(a > b, k))
                    }
                    Mode::Side(s, [i, j]) => {
                        let corners = shape.sides()[s as usize];
                        let mut key: Vec<u32> = corners.iter().map(|&v| vertices[v]).collect();
                        let (swapped, reversed) = orientation(shape, corners, &vertices);
                        key.sort_unstable();
                        // Three corners tell sides apart.
                        let first = *sides.entry([key[0], key[1], key[2]]).or_insert_with(|| take(per_edge * per_edge));
                        let [m, n] = if swapped { [j, i] } else { [i, j] };
                        let offset = (usize::from(m) - 2) * per_edge + usize::from(n) - 2;
                        (first + offset as u32, sign(reversed[0], i) * sign(reversed[1], j))
                    }
                    Mode::Interior => (take(1), 1),
                };
                map.functions.push(function);
                if degree > 1 {
                    map.signs.push(sign);
                }
            }
            map.count = next as usize;
            map.start.push(map.functions.len() as u32);
        }
        map
    }

    fn of_splines<const D: usize>(mesh: &Mesh<D>) -> Self {
        let mut map = DofMap {
            bases: Vec::new(),
            basis_of: Vec::new(),
            start: vec![0],
            functions: Vec::new(),
            signs: Vec::new(),
            count: 0,
            vertices: vec![NONE; mesh.nodes().len()],
        };
        let mut at = Values::default();
        for cell in 0..mesh.cell_count() {
            let Some(basis) = mesh.map(cell).rational() else { continue };
            map.basis_of.push(map.bases.len() as u32);
            map.bases.push(CellBasis::Rational(Arc::clone(basis)));
            let controls = mesh.cell_nodes(cell);
            map.functions.extend_from_slice(controls);
            map.start.push(map.functions.len() as u32);
            map.count = controls.iter().fold(map.count, |n, c| n.max(*c as usize + 1));
            // At the corners of a patch one function is alone.
            for (vertex, xi) in mesh.vertices(cell).zip(basis.shape().vertices()) {
                basis.tabulate(xi, &mut at);
                let alone = at.value.iter().position(|v| (v - 1.0).abs() < 1e-12);
                map.vertices[vertex as usize] = alone.map_or(map.vertices[vertex as usize], |k| controls[k]);
            }
        }
        map
    }

    /// Whether the functions are those of splines.
    pub fn is_spline(&self) -> bool {
        self.bases.iter().any(CellBasis::is_spline)
    }

    /// The functions that add up to one: the sum of the forces on them is the resultant. They are those of the vertices, and of
    /// splines all.
    pub fn unity(&self) -> Vec<u32> {
        if self.is_spline() {
            return (0..self.count as u32).collect();
        }
        self.vertices.iter().copied().filter(|function| *function != NONE).collect()
    }

    /// Number of functions.
    pub fn count(&self) -> usize {
        self.count
    }

    pub fn basis(&self, cell: usize) -> &CellBasis {
        &self.bases[self.basis_of[cell] as usize]
    }

    /// Number of the basis of a cell, to tabulate once for all cells that share it.
    pub fn basis_number(&self, cell: usize) -> usize {
        self.basis_of[cell] as usize
    }

    /// Numbers of the functions of a cell.
    pub fn functions(&self, cell: usize) -> &[u32] {
        &self.functions[self.start[cell] as usize..self.start[cell + 1] as usize]
    }

    /// Number and sign of a function of a cell, by its place in the list of the cell.
    pub fn function(&self, cell: usize, place: usize) -> (u32, f64) {
        let at = self.start[cell] as usize + place;
        (self.functions[at], self.signs.get(at).map_or(1.0, |sign| f64::from(*sign)))
    }

    /// Number and sign of each function of a cell.
    pub fn cell(&self, cell: usize) -> impl ExactSizeIterator<Item = (u32, f64)> + '_ {
        (0..self.functions(cell).len()).map(move |place| self.function(cell, place))
    }

    /// The function of a vertex.
    pub fn vertex(&self, node: u32) -> Option<u32> {
        self.vertices.get(node as usize).copied().filter(|function| *function != NONE)
    }

    /// Places, in the list of the cell, of the functions that do not vanish on a side.
    pub fn on_side(&self, side: Side) -> Vec<usize> {
        let basis = self.basis(side.cell as usize);
        if let CellBasis::Rational(basis) = basis {
            return basis.on_side(side.side as usize);
        }
        let shape = basis.shape();
        let corners = shape.sides()[side.side as usize];
        let on = |mode: &Mode| match mode {
            Mode::Vertex(v) => corners.contains(&(*v as usize)),
            Mode::Edge(e, _) => shape.edges()[*e as usize].iter().all(|v| corners.contains(v)),
            Mode::Side(s, _) => *s == side.side,
            Mode::Interior => false,
        };
        (0..basis.len()).filter(|&k| on(&basis.modes()[k])).collect()
    }
}

fn sign(reversed: bool, degree: u8) -> i8 {
    if reversed && degree % 2 == 1 { -1 } else { 1 }
}

/// Whether the axes of a side change places in its global orientation, and which of its local axes are reversed.
fn orientation(shape: CellShape, corners: &[usize], vertices: &[u32]) -> (bool, [bool; 2]) {
    if shape == CellShape::Wedge {
        // Of degree two only: even.
        return (false, [false; 2]);
    }
    let axes = spanned(shape, corners);
    let high = |v: usize, k: usize| shape.vertices()[v][axes[k]] > 0.0;
    let origin = corners.iter().copied().min_by_key(|&v| vertices[v]).unwrap_or(corners[0]);
    // The neighbour of the origin along each local axis.
    let neighbour = |k: usize| {
        let other = 1 - k;
        corners.iter().copied().find(|&v| high(v, k) != high(origin, k) && high(v, other) == high(origin, other))
    };
    let swapped = match (neighbour(0), neighbour(1)) {
        (Some(p), Some(q)) => vertices[q] < vertices[p],
        _ => false,
    };
    (swapped, [high(origin, 0), high(origin, 1)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_geometry::Point;

    /// Two hexahedra side by side, the second turned in all 24 ways: functions agree on the common side.
    #[test]
    fn functions_are_continuous_whatever_the_orientation() {
        let corners: Vec<Point<3>> =
            (0..12).map(|i| Point::<3>::new(f64::from(i % 3), f64::from(i / 3 % 2), f64::from(i / 6))).collect();
        let at = |x: f64, y: f64, z: f64| corners.iter().position(|c| *c == Point::<3>::new(x, y, z)).unwrap() as u32;
        let hexahedron = |x: f64| {
            let mut list = Vec::new();
            for (z, y, dx) in [
                (0., 0., 0.),
                (0., 0., 1.),
                (0., 1., 0.),
                (0., 1., 1.),
                (1., 0., 0.),
                (1., 0., 1.),
                (1., 1., 0.),
                (1., 1., 1.),
            ] {
                list.push(at(x + dx, y, z));
            }
            list
        };
        let mut turns = 0;
        for axes in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            for flips in 0..8usize {
                let odd = [[0, 2, 1], [2, 1, 0], [1, 0, 2]].contains(&axes);
                if odd != (flips.count_ones() % 2 == 1) {
                    continue;
                }
                turns += 1;
                let second = hexahedron(1.0);
                // Local node (i, j, k) of the turned cell.
                let turned: Vec<u32> = (0..8usize)
                    .map(|n| {
                        let local = [n & 1, n >> 1 & 1, n >> 2 & 1];
                        let mut global = [0; 3];
                        for k in 0..3 {
                            global[axes[k]] = local[k] ^ (flips >> k & 1);
                        }
                        second[global[0] + 2 * global[1] + 4 * global[2]]
                    })
                    .collect();
                let mut mesh = Mesh::<3>::new(corners.clone());
                mesh.add_cell(CellShape::Hexahedron, 1, &hexahedron(0.0));
                mesh.add_cell(CellShape::Hexahedron, 1, &turned);
                mesh.check().unwrap();
                let degree = 4;
                let dofs = DofMap::new(&mesh, degree);
                let n = degree + 1;
                assert_eq!(dofs.count(), (2 * n - 1) * n * n);
                let evaluate = |cell: usize, x: &Point<3>| {
                    // Inverse of the affine map by the corners.
                    let nodes = mesh.cell_nodes(cell);
                    let p = |k: usize| mesh.nodes()[nodes[k] as usize];
                    let local: [f64; 3] = std::array::from_fn(|k| {
                        let axis = p(1 << k) - p(0);
                        2.0 * (x - p(0)).dot(&axis) / axis.norm_squared() - 1.0
                    });
                    let mut values = Values::default();
                    dofs.basis(cell).tabulate(&local, &mut values);
                    let mut out = vec![0.0; dofs.count()];
                    for ((f, s), v) in dofs.cell(cell).zip(&values.value) {
                        out[f as usize] += s * v;
                    }
                    out
                };
                for x in [Point::<3>::new(1.0, 0.3, 0.8), Point::<3>::new(1.0, 0.9, 0.55)] {
                    let (p, q) = (evaluate(0, &x), evaluate(1, &x));
                    assert!(p.iter().zip(&q).all(|(p, q)| (p - q).abs() < 1e-13));
                }
            }
        }
        assert_eq!(turns, 24);
    }
}
