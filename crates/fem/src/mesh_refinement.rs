//! Meshes of the plane with every cell divided into four.

use crate::adjacency::Adjacency;
use crate::cell_map::CellMap;
use crate::cell_parts::{Corner, PARTS, parts};
use crate::hierarchic::Values;
use crate::mesh::{Group, Mesh, Side};
use crate::reference::{CellShape, Local};
use signorini_geometry::Point;

/// How far a node may lie from where a cell without bends has it, as a fraction of the size of the cell.
const BENT: f64 = 1e-13;

/// Reference coordinates of a corner.
pub(crate) fn place(shape: CellShape, corner: &Corner) -> Local {
    let vertices = shape.vertices();
    std::array::from_fn(|k| 0.25 * corner.iter().map(|&v| vertices[v as usize][k]).sum::<f64>())
}

/// The nodes at the vertices of the parts of a cell, by those at its own, in the middles of its sides and in its centre. The
/// fourth of a triangle is none.
pub(crate) fn vertices_of_parts(
    shape: CellShape,
    corners: &[u32],
    middle: &dyn Fn(u8) -> u32,
    centre: u32,
) -> [[u32; 4]; PARTS] {
    let node = |&[a, b, _, d]: &Corner| match (a == d, a == b) {
        (true, _) => corners[usize::from(a)],
        (_, false) => centre,
        // The side from the last vertex to the first is the last.
        _ => middle(if d == a + 1 { a } else { d }),
    };
    parts(shape).map(|part| std::array::from_fn(|k| part.get(k).map_or(u32::MAX, node)))
}

/// The sides of the parts of a cell that lie on one of its own sides.
pub(crate) fn on_side(shape: CellShape, side: usize) -> impl Iterator<Item = (usize, usize)> {
    let ends = shape.sides()[side];
    let on = move |corner: &Corner| corner.iter().all(|v| ends.contains(&usize::from(*v)));
    (0..PARTS).flat_map(move |part| {
        let corners = parts(shape)[part];
        (0..shape.sides().len())
            .filter(move |&s| shape.sides()[s].iter().all(|&v| on(&corners[v])))
            .map(move |s| (part, s))
    })
}

/// The nodes of each part of a cell that is bent.
pub(crate) type CurvedParts = [Option<Vec<Point<2>>>; PARTS];
pub(crate) const NONE_CURVED: CurvedParts = [const { None }; PARTS];

impl Mesh<2> {
    /// The mesh with every cell divided into four at the middles of its sides, curved ones along their curves. The parts of
    /// cell `k` have the numbers `4 k` to `4 k + 3`, in the order of [`parts`]; groups go over to the parts.
    pub fn refined(&self, adjacency: &Adjacency) -> Self {
        // About as many nodes as cells are new.
        let mut nodes = Vec::with_capacity(self.nodes().len() + 2 * self.cell_count());
        nodes.extend_from_slice(self.nodes());
        let mut fine = Self::new(nodes);
        fine.reserve(PARTS * self.cell_count());
        let mut middles = vec![u32::MAX; adjacency.places()];
        let mut at = Values::default();
        let mut corners = Vec::new();
        for cell in 0..self.cell_count() {
            // What is not bent is divided with the nodes at its vertices alone.
            let bent = self.is_bent(cell);
            let mut new = |corner: &Corner| fine.add_node(self.corner(cell, bent, corner, &mut at));
            corners.clear();
            corners.extend(self.vertices(cell));
            let sides = corners.len();
            for side in 0..sides {
                let of = Side { cell: cell as u32, side: side as u8 };
                let (a, b) = (side as u8, ((side + 1) % sides) as u8);
                // The first cell at a side makes its middle.
                let known = adjacency.opposite(of).map_or(u32::MAX, |other| middles[adjacency.place(other)]);
                middles[adjacency.place(of)] = if known == u32::MAX { new(&[a, a, b, b]) } else { known };
            }
            let centre = if sides == 4 { new(&[0, 1, 2, 3]) } else { u32::MAX };
            let middle = |side: u8| middles[adjacency.place(Side { cell: cell as u32, side })];
            let whole = vertices_of_parts(self.shape(cell), &corners, &middle, centre);
            let curved = if bent { self.curved_parts(cell, &whole, fine.nodes(), &mut at) } else { NONE_CURVED };
            for (nodes, curved) in whole.into_iter().zip(curved) {
                fine.add_part(self.map(cell), &nodes[..sides], curved);
            }
        }
        let part = |Side { cell, side }: Side| {
            let of_cell = on_side(self.shape(cell as usize), side as usize);
            of_cell.map(move |(part, s)| Side { cell: cell * PARTS as u32 + part as u32, side: s as u8 })
        };
        self.hand_groups_to(&mut fine, |cell| cell * PARTS as u32..(cell + 1) * PARTS as u32, part);
        fine
    }

    /// Gives the groups to a mesh of parts, by the parts of a cell and those of a side.
    pub(crate) fn hand_groups_to<Cells: IntoIterator<Item = u32>, Sides: IntoIterator<Item = Side>>(
        &self,
        fine: &mut Self,
        cells: impl Fn(u32) -> Cells,
        sides: impl Fn(Side) -> Sides,
    ) {
        for (name, group) in self.groups() {
            *fine.group_mut(name) = Group {
                cells: group.cells.iter().flat_map(|&cell| cells(cell)).collect(),
                sides: group.sides.iter().flat_map(|&side| sides(side)).collect(),
                vertices: group.vertices.clone(),
                between: Vec::new(),
            };
        }
    }

    /// Where a corner of a part of a cell lies, which may be bent.
    pub(crate) fn corner(&self, cell: usize, bent: bool, corner: &Corner, at: &mut Values) -> Point<2> {
        if bent {
            let map = self.map(cell);
            map.tabulate(&place(map.shape(), corner), at);
            return self.position(cell, at);
        }
        let vertices: Vec<u32> = self.vertices(cell).collect();
        corner.iter().map(|&v| 0.25 * self.nodes()[vertices[usize::from(v)] as usize]).sum()
    }

    /// Adds a part of a cell of the given map, by the nodes at its vertices and, where it is curved, where all its nodes lie.
    pub(crate) fn add_part(&mut self, map: &CellMap, vertices: &[u32], curved: Option<Vec<Point<2>>>) -> u32 {
        let Some(curved) = curved else {
            return match *vertices {
                // Nodes of tensor shapes run along the first direction.
                [a, b, c, d] => self.add_cell(CellShape::Quadrilateral, 1, &[a, b, d, c]),
                _ => self.add_cell(CellShape::Triangle, 1, vertices),
            };
        };
        let places = map.vertex_nodes();
        let node = |(k, x): (usize, Point<2>)| match places.iter().position(|v| *v == k) {
            Some(v) => vertices[v],
            None => self.add_node(x),
        };
        let nodes: Vec<u32> = curved.into_iter().enumerate().map(node).collect();
        self.add_cell(map.shape(), map.order(), &nodes)
    }

    /// Where the nodes of the parts of a bent cell lie, by their vertices; none for a part that is not bent. Within a
    /// triangle sides are straight, if no part is folded by that: only what lies along a curved side is curved, and with
    /// every division half as many parts are.
    pub(crate) fn curved_parts(
        &self,
        cell: usize,
        vertices: &[[u32; 4]; PARTS],
        nodes: &[Point<2>],
        at: &mut Values,
    ) -> CurvedParts {
        let map = self.map(cell);
        let shape = map.shape();
        let exact = parts(shape).map(|part| {
            let corners: Vec<Local> = part.iter().map(|corner| place(shape, corner)).collect();
            self.nodes_of_part(cell, map, &corners, at)
        });
        if shape != CellShape::Triangle {
            return exact.map(Some);
        }
        let mut out = NONE_CURVED;
        for (k, vertices) in vertices.iter().enumerate() {
            let x = [0, 1, 2].map(|v| nodes[vertices[v] as usize]);
            let mut nodes = exact[k].clone();
            let mut curved = false;
            for (node, &[a, b]) in nodes[3..].iter_mut().zip(shape.edges()) {
                let ends = [parts(shape)[k][a], parts(shape)[k][b]];
                let on = |side: &&[usize]| ends.iter().flatten().all(|v| side.contains(&usize::from(*v)));
                let straight = 0.5 * (x[a] + x[b]);
                if !shape.sides().iter().any(on) {
                    *node = straight;
                }
                curved |= (*node - straight).norm() > BENT * (x[b] - x[a]).norm();
            }
            let mut trial = Self::new(nodes);
            trial.add_cell(shape, map.order(), &[0, 1, 2, 3, 4, 5]);
            if trial.check().is_err() {
                return exact.map(Some);
            }
            out[k] = curved.then(|| trial.nodes().to_vec());
        }
        out
    }

    /// Where the nodes of a part of a cell lie on that cell's map, by the reference coordinates of the part's corners.
    pub(crate) fn nodes_of_part(
        &self,
        cell: usize,
        part: &CellMap,
        corners: &[Local],
        at: &mut Values,
    ) -> Vec<Point<2>> {
        let node = |xi: &Local| {
            self.map(cell).tabulate(&within(part.shape(), corners, xi), at);
            self.position(cell, at)
        };
        part.nodes().iter().map(node).collect()
    }

    /// Whether a cell is not what its vertices alone would make it.
    pub(crate) fn is_bent(&self, cell: usize) -> bool {
        let (map, nodes) = (self.map(cell), self.cell_nodes(cell));
        if map.order() == 1 {
            return false;
        }
        let shape = map.shape();
        let corners: Vec<Point<2>> = self.vertices(cell).map(|n| self.nodes()[n as usize]).collect();
        let size = (corners[1] - corners[0]).norm();
        map.nodes().iter().zip(nodes).any(|(xi, &node)| {
            let weights = linear(shape, xi);
            let x: Point<2> = corners.iter().zip(&weights).map(|(x, w)| x * *w).sum();
            (self.nodes()[node as usize] - x).norm() > BENT * size
        })
    }
}

/// The functions of the vertices of a cell of degree 1.
fn linear(shape: CellShape, [x, y, _]: &Local) -> Vec<f64> {
    match shape {
        CellShape::Triangle => vec![1.0 - x - y, *x, *y],
        _ => [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .iter()
            .map(|[a, b]| 0.25 * (1.0 + a * x) * (1.0 + b * y))
            .collect(),
    }
}

/// Reference coordinates in a cell of a point of a part with the given corners.
fn within(shape: CellShape, corners: &[Local], xi: &Local) -> Local {
    let weights = linear(shape, xi);
    std::array::from_fn(|k| corners.iter().zip(&weights).map(|(x, w)| w * x[k]).sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rules::rule;
    use crate::small;

    /// A quarter of a disc: a curved triangle and, above it, a curved quadrilateral beside a straight triangle.
    fn quarter() -> Mesh<2> {
        let at = |r: f64, angle: f64| Point::<2>::new(r * angle.cos(), r * angle.sin());
        let right = std::f64::consts::FRAC_PI_2;
        let nodes = vec![
            at(0.0, 0.0),
            at(1.0, 0.0),
            at(1.0, 0.5),
            at(1.0, right),
            at(0.5, right),
            at(1.0, 0.25),
            at(0.5, 0.0),
            at(0.5, 0.5),
            at(1.0, 0.5 * (0.5 + right)),
            at(0.75, right),
            0.5 * (at(1.0, 0.5) + at(0.5, right)),
            0.25 * (at(1.0, 0.5) + at(0.5, right)),
        ];
        let mut mesh = Mesh::<2>::new(nodes);
        mesh.add_cell(CellShape::Triangle, 2, &[0, 1, 2, 6, 5, 7]);
        mesh.add_cell(CellShape::Triangle, 1, &[0, 2, 4]);
        mesh.add_cell(CellShape::Triangle, 2, &[4, 2, 3, 10, 8, 9]);
        mesh.group_mut("round").sides = vec![Side { cell: 0, side: 1 }, Side { cell: 2, side: 1 }];
        mesh.group_mut("film").cells = vec![0, 1, 2];
        mesh.check().unwrap();
        mesh
    }

    fn area(mesh: &Mesh<2>) -> f64 {
        let mut at = Values::default();
        let of = |cell: usize| {
            let map = mesh.map(cell);
            let points = rule(map.shape(), 9).into_iter();
            points
                .map(|(x, w)| {
                    map.tabulate(&x, &mut at);
                    w * small::determinant(&mesh.jacobian(cell, &at).1)
                })
                .sum::<f64>()
        };
        (0..mesh.cell_count()).map(of).sum()
    }

    #[test]
    fn parts_are_what_they_were_made_of() {
        let coarse = quarter();
        let fine = coarse.refined(&Adjacency::new(&coarse));
        fine.check().unwrap();
        assert_eq!(fine.cell_count(), 12);
        assert!((area(&fine) - area(&coarse)).abs() < 1e-14);
        // Where a triangle is straight so are its parts.
        assert!((3..8).all(|cell| fine.map(cell).order() == 1) && fine.map(1).order() == 2);
        // The boundary has twice as many sides, those of the group on the same curve, one after the other.
        assert_eq!(fine.boundary().len(), 2 * coarse.boundary().len());
        let round = &fine.groups()["round"].sides;
        assert_eq!(round.len(), 4);
        for side in round {
            assert!(fine.boundary().contains(side));
            for s in [-1.0, -0.3, 0.6, 1.0] {
                let x = fine.on_side(*side, &[s, 0.0, 0.0]).0;
                let on_coarse = [0, 2].iter().any(|&cell| {
                    (0..=4000).any(|k| {
                        let s = k as f64 / 2000.0 - 1.0;
                        (coarse.on_side(Side { cell, side: 1 }, &[s, 0.0, 0.0]).0 - x).norm() < 1e-9
                    })
                });
                assert!(on_coarse, "{x:?}");
            }
        }
        assert_eq!(fine.groups()["film"].cells, (0..12).collect::<Vec<u32>>());
        // Once more: parts of straight parts, of curved parts.
        let finest = fine.refined(&Adjacency::new(&fine));
        finest.check().unwrap();
        assert!((area(&finest) - area(&coarse)).abs() < 1e-14);
        assert_eq!(finest.boundary().len(), 4 * coarse.boundary().len());
    }

    #[test]
    fn quadrilaterals_too_straight_and_curved() {
        for bend in [0.0, 0.05] {
            let corners = [[0.0, 0.0], [1.0, 0.1], [0.1, 1.1], [1.2, 0.9]].map(Point::<2>::from);
            let mut nodes: Vec<Point<2>> = (0..9)
                .map(|i| {
                    let weights = linear(CellShape::Quadrilateral, &[(i % 3) as f64 - 1.0, (i / 3) as f64 - 1.0, 0.0]);
                    [0, 1, 3, 2].iter().zip(&weights).map(|(&c, w)| corners[c] * *w).sum()
                })
                .collect();
            nodes[5][0] += bend;
            let mut mesh = Mesh::<2>::new(nodes);
            mesh.add_cell(CellShape::Quadrilateral, 2, &[0, 1, 2, 3, 4, 5, 6, 7, 8]);
            mesh.group_mut("right").sides = vec![Side { cell: 0, side: 1 }];
            let once = mesh.refined(&Adjacency::new(&mesh));
            let fine = once.refined(&Adjacency::new(&once));
            fine.check().unwrap();
            assert_eq!(fine.cell_count(), 16);
            assert_eq!(fine.map(0).order(), if bend == 0.0 { 1 } else { 2 });
            assert!((area(&fine) - area(&mesh)).abs() < 1e-14);
            assert_eq!(fine.boundary().len(), 16);
            assert_eq!(fine.groups()["right"].sides.len(), 4);
            assert!(fine.groups()["right"].sides.iter().all(|s| fine.boundary().contains(s)));
        }
    }
}
