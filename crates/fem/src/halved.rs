//! Meshes of any cells with every cell divided into `2^D` at the middles of its edges, to see how a solution changes.
//!
//! The map of a part is that of its cell, restricted: bodies keep their shape exactly. Nodes are shared by what they are a
//! combination of: the vertices of the cell with the values of their linear functions, the same from all cells around.

use crate::cell_map::CellMap;
use crate::hierarchic::Values;
use crate::mesh::{Group, Mesh, Side};
use crate::reference::{CellShape, Local};
use std::collections::HashMap;

/// A mesh with every cell divided, and what became of the cells and sides of the one before.
#[derive(Clone, Debug)]
pub struct Halved<const D: usize> {
    pub mesh: Mesh<D>,
    /// By shape, the parts at each side of a cell and their own sides there.
    at_sides: HashMap<CellShape, Vec<Vec<(u32, u8)>>>,
    shapes: Vec<CellShape>,
}

/// The reference coordinates of the vertices of the parts of a cell. A tetrahedron has four parts at its vertices and four
/// around a diagonal of the octahedron between them (Bey 1995).
fn parts(shape: CellShape) -> Vec<Vec<Local>> {
    let vertices = shape.vertices();
    let middle = |&[a, b]: &[usize; 2]| -> Local { std::array::from_fn(|k| 0.5 * (vertices[a][k] + vertices[b][k])) };
    let at_vertex = |a: usize| (0..vertices.len()).map(|b| middle(&[a, b])).collect();
    let mut out: Vec<Vec<Local>> = (0..vertices.len()).map(at_vertex).collect();
    let between: &[&[[usize; 2]]] = match shape {
        CellShape::Triangle => &[&[[0, 1], [1, 2], [0, 2]]],
        CellShape::Wedge => {
            &[&[[0, 1], [1, 2], [0, 2], [0, 4], [1, 5], [0, 5]], &[[0, 4], [1, 5], [0, 5], [3, 4], [4, 5], [3, 5]]]
        }
        CellShape::Tetrahedron => &[
            &[[0, 1], [0, 2], [0, 3], [1, 3]],
            &[[0, 2], [0, 1], [1, 2], [1, 3]],
            &[[0, 2], [0, 3], [1, 3], [2, 3]],
            &[[1, 2], [0, 2], [1, 3], [2, 3]],
        ],
        _ => &[],
    };
    out.extend(between.iter().map(|part| part.iter().map(middle).collect()));
    out
}

/// The parts at each side of a cell, and their own sides there.
fn parts_at_sides(shape: CellShape, parts: &[Vec<Local>]) -> Vec<Vec<(u32, u8)>> {
    let on = |ends: &[usize], x: &Local| {
        let weights = linear(shape, x);
        weights.iter().enumerate().all(|(v, w)| ends.contains(&v) || w.abs() < 1e-12)
    };
    let of_side = |ends: &&[usize]| {
        let mut out = Vec::new();
        for (number, corners) in parts.iter().enumerate() {
            for (side, own) in shape.sides().iter().enumerate() {
                if own.iter().all(|&v| on(ends, &corners[v])) {
                    out.push((number as u32, side as u8));
                }
            }
        }
        out
    };
    shape.sides().iter().map(of_side).collect()
}

/// The functions of the vertices of a cell of order 1.
fn linear(shape: CellShape, x: &Local) -> Vec<f64> {
    let map = CellMap::new(shape, 1);
    let mut at = Values::default();
    map.tabulate(x, &mut at);
    map.vertex_nodes().iter().map(|&k| at.value[k]).collect()
}

/// A node of a part of a cell: the linear functions of the cell's vertices there, and the functions of its map.
struct Node {
    weights: Vec<f64>,
    at: Values,
}

/// The nodes of all parts of cells with a map.
fn nodes_of_parts(map: &CellMap) -> Vec<Vec<Node>> {
    let shape = map.shape();
    let node = |corners: &[Local], xi: &Local| {
        let weights = linear(shape, xi);
        let x: Local = std::array::from_fn(|k| corners.iter().zip(&weights).map(|(c, w)| w * c[k]).sum());
        let mut at = Values::default();
        map.tabulate(&x, &mut at);
        Node { weights: linear(shape, &x), at }
    };
    parts(shape).iter().map(|corners| map.nodes().iter().map(|xi| node(corners, xi)).collect()).collect()
}

impl<const D: usize> Halved<D> {
    /// Parts of a cell.
    const PARTS: u32 = 1 << D;

    pub fn new(mesh: &Mesh<D>) -> Self {
        // The nodes there are keep their numbers, as groups of vertices know them.
        let mut fine = Mesh::new(mesh.nodes().to_vec());
        let mut known: HashMap<Vec<(u32, i64)>, u32> = HashMap::new();
        // The functions are told apart by a millionth: those at the same place differ by rounding alone.
        let key = |vertices: &[u32], weights: &[f64]| {
            let mut key: Vec<(u32, i64)> = (vertices.iter().zip(weights))
                .map(|(v, w)| (*v, (w * f64::from(1 << 20)).round() as i64))
                .filter(|(_, w)| *w != 0)
                .collect();
            key.sort_unstable();
            key
        };
        let mut tables: HashMap<usize, (Vec<Vec<f64>>, Vec<Vec<Node>>)> = HashMap::new();
        for cell in 0..mesh.cell_count() {
            let map = mesh.map(cell);
            let (own, parts) = tables.entry(mesh.map_number(cell)).or_insert_with(|| {
                (map.nodes().iter().map(|xi| linear(map.shape(), xi)).collect(), nodes_of_parts(map))
            });
            let vertices: Vec<u32> = mesh.vertices(cell).collect();
            for (node, weights) in mesh.cell_nodes(cell).iter().zip(own) {
                known.entry(key(&vertices, weights)).or_insert(*node);
            }
            for part in parts {
                let mut node = |n: &Node| {
                    let new = || fine.add_node(mesh.position(cell, &n.at));
                    *known.entry(key(&vertices, &n.weights)).or_insert_with(new)
                };
                let nodes: Vec<u32> = part.iter().map(&mut node).collect();
                fine.add_cell(map.shape(), map.order(), &nodes);
            }
        }
        let shapes: Vec<CellShape> = (0..mesh.cell_count()).map(|cell| mesh.shape(cell)).collect();
        let mut at_sides = HashMap::new();
        for &shape in &shapes {
            at_sides.entry(shape).or_insert_with(|| parts_at_sides(shape, &parts(shape)));
        }
        let mut out = Self { mesh: fine, at_sides, shapes };
        for (name, group) in mesh.groups() {
            *out.mesh.group_mut(name) = out.group(group);
        }
        out
    }

    /// The parts of sides.
    pub fn sides(&self, of: &[Side]) -> Vec<Side> {
        let parts = |side: &Side| {
            let cell = side.cell;
            let list = &self.at_sides[&self.shapes[cell as usize]][usize::from(side.side)];
            list.iter().map(move |&(part, side)| Side { cell: cell * Self::PARTS + part, side })
        };
        of.iter().flat_map(parts).collect()
    }

    /// A group with the parts of its cells and sides; its nodes are the same, and all of them vertices now.
    pub fn group(&self, of: &Group) -> Group {
        Group {
            cells: of.cells.iter().flat_map(|cell| cell * Self::PARTS..(cell + 1) * Self::PARTS).collect(),
            sides: self.sides(&of.sides),
            vertices: of.vertices.iter().copied().chain(of.between.iter().map(|b| b.node)).collect(),
            between: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rules::rule;
    use crate::small;
    use CellShape::*;
    use signorini_geometry::{Matrix, Point};

    fn volume<const D: usize>(mesh: &Mesh<D>) -> f64 {
        let mut at = Values::default();
        let mut of = |cell: usize| -> f64 {
            let map = mesh.map(cell);
            (rule(map.shape(), 8).into_iter())
                .map(|(x, w)| {
                    map.tabulate(&x, &mut at);
                    w * small::determinant(&mesh.jacobian(cell, &at).1)
                })
                .sum()
        };
        (0..mesh.cell_count()).map(&mut of).sum()
    }

    fn area<const D: usize>(mesh: &Mesh<D>, sides: &[Side]) -> f64 {
        let of = |side: &Side| -> f64 {
            (rule(mesh.side_shape(*side), 12).into_iter())
                .map(|(s, w)| {
                    let [a, b] = mesh.on_side(*side, &s).1;
                    let at = |v: &Point<D>, k: usize| v[k % 3];
                    w * match D {
                        2 => a.norm(),
                        _ => {
                            let n = |k: usize| at(&a, k + 1) * at(&b, k + 2) - at(&a, k + 2) * at(&b, k + 1);
                            (0..3).map(|k| n(k).powi(2)).sum::<f64>().sqrt()
                        }
                    }
                })
                .sum()
        };
        sides.iter().map(of).sum()
    }

    /// One bent cell of every shape and order, and a neighbour of the same shape across a side.
    fn checked<const D: usize>(shape: CellShape, order: usize) {
        let map = CellMap::new(shape, order);
        let bent = |x: &Local| {
            let [a, b, c] = *x;
            let all = [a + 0.05 * b * b, b + 0.1 * a * b + 0.03 * c * c, c + 0.05 * a * a];
            Point::<D>::from_fn(|k, _| all[k])
        };
        let mut mesh = Mesh::<D>::new(map.nodes().iter().map(bent).collect());
        let own: Vec<u32> = (0..map.len() as u32).collect();
        mesh.add_cell(shape, order, &own);
        mesh.group_mut("all").cells = vec![0];
        mesh.group_mut("outside").sides = mesh.boundary();
        mesh.group_mut("corner").vertices = vec![0];
        let halved = Halved::new(&mesh);
        let fine = &halved.mesh;
        fine.check().unwrap_or_else(|e| panic!("{shape:?} of order {order}: {e}"));
        assert_eq!(fine.cell_count(), 1 << D, "{shape:?}");
        let same =
            |a: f64, b: f64, what: &str| assert!((a / b - 1.0).abs() < 1e-12, "{shape:?} {order} {what}: {a} {b}");
        same(volume(fine), volume(&mesh), "volume");
        let mut outside = fine.groups()["outside"].sides.clone();
        outside.sort_unstable();
        assert_eq!(outside, fine.boundary(), "{shape:?} of order {order}");
        for side in mesh.boundary() {
            let sides = halved.sides(&[side]);
            assert_eq!(sides.len(), 1 << (D - 1));
            // The roots in areas of bent sides are integrated to a few digits only.
            let (fine, coarse) = (area(fine, &sides), area(&mesh, &[side]));
            assert!((fine / coarse - 1.0).abs() < 1e-5, "{shape:?} {order} {side:?}: {fine} {coarse}");
        }
        // Once more: sides between parts have the same nodes from both.
        let finest = Halved::new(fine);
        assert_eq!(finest.mesh.boundary().len(), fine.boundary().len() << (D - 1), "{shape:?} of order {order}");
        same(volume(&finest.mesh), volume(&mesh), "volume of parts of parts");
        assert_eq!(finest.mesh.groups()["all"].cells.len(), 1 << (2 * D));
        assert_eq!(finest.mesh.groups()["corner"].vertices, [0]);
    }

    #[test]
    fn parts_make_up_their_cells() {
        for order in [1, 2] {
            [Triangle, Quadrilateral].into_iter().for_each(|shape| checked::<2>(shape, order));
            [Tetrahedron, Hexahedron, Wedge].into_iter().for_each(|shape| checked::<3>(shape, order));
        }
    }

    #[test]
    fn cells_of_different_shapes_share_nodes() {
        // A hexahedron and a wedge on a quadrilateral, the wedge and a tetrahedron on a triangle.
        let corners: [Local; 11] = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 1.0],
            [0.0, 1.0, 1.0],
            [1.0, 1.0, 1.0],
            [2.0, 0.0, 0.0],
            [2.0, 0.0, 1.0],
            [1.5, 0.5, 2.0],
        ];
        let nodes: Vec<Point<3>> = corners.iter().map(|x| (*x).into()).collect();
        let mut mesh = Mesh::<3>::new(nodes);
        mesh.add_cell(Hexahedron, 1, &[0, 1, 2, 3, 4, 5, 6, 7]);
        mesh.add_cell(Wedge, 1, &[1, 8, 3, 5, 9, 7]);
        mesh.add_cell(Tetrahedron, 1, &[5, 9, 7, 10]);
        mesh.check().unwrap();
        let fine = Halved::new(&mesh).mesh;
        fine.check().unwrap();
        assert_eq!(fine.boundary().len(), 4 * mesh.boundary().len());
    }

    #[test]
    fn parts_of_tetrahedra_are_not_turned() {
        for corners in parts(Tetrahedron) {
            let edge = |k: usize| corners[k].iter().zip(&corners[0]).map(|(a, b)| a - b).collect::<Vec<f64>>();
            let columns = [edge(1), edge(2), edge(3)];
            let volume = small::determinant(&Matrix::<3>::from_fn(|i, j| columns[j][i]));
            assert!((volume - 0.125).abs() < 1e-15, "{volume}");
        }
    }
}
