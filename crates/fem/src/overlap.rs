//! Whether cells of a mesh cover the same place.
//!
//! Cells of positive volume: the number of them over a point changes only across sides that do not have one cell on
//! each of their two sides. Wherever cells overlap, one of them therefore does so right behind such a side, and only
//! points there are looked at, of about `n^((D-1)/D)` of `n` cells.

use crate::hierarchic::Values;
use crate::mesh::{Mesh, Side};
use crate::reference::{CellShape, Local};
use crate::small;
use signorini_geometry::bvh::Bvh;
use signorini_geometry::{Aabb, Point};

/// How deep in a cell points are looked at, in parts of the way from its side to its middle: what cells overlap by less
/// comes from coordinates rounded in files, and from two ways to draw one curved line.
const DEPTH: f64 = 0.02;
/// Parts of a side between the points that are looked at, in the plane and in space.
const PARTS: [usize; 2] = [8, 3];
/// Steps of Newton's method, in coordinates of a cell, from which on it converges quadratically.
const SHORT: f64 = 0.25;
/// By what the box round the nodes of a cell of order 2 or more is enlarged: a curved side bulges beyond its nodes by no
/// more than it bulges at them.
pub(crate) const BULGE: f64 = 1.25;

/// Two cells that cover the same place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlap<const D: usize> {
    pub cells: [usize; 2],
    pub at: Point<D>,
}

impl<const D: usize> Mesh<D> {
    /// Two cells that cover the same place, in a mesh that [`Mesh::check`] accepts; none where cells at most touch each
    /// other. Cells that overlap by less than about a fiftieth of their size may be passed over.
    pub fn overlap(&self) -> Option<Overlap<D>> {
        self.meeting(DEPTH, |_, _| true)
    }

    /// Two cells of different pieces, as [`Mesh::pieces`] tells them, that meet at a side or a corner without a gap of more than
    /// about a fiftieth of their size.
    pub fn touching(&self, pieces: &[u32]) -> Option<Overlap<D>> {
        self.meeting(-DEPTH, |cell, other| pieces[cell] != pieces[other])
    }

    /// A place at a depth behind a side that is not between two cells, or at a height before it where the depth is
    /// negative, that another cell covers too.
    fn meeting(&self, depth: f64, wanted: impl Fn(usize, usize) -> bool) -> Option<Overlap<D>> {
        let boxes: Vec<Aabb<3>> = (0..self.cell_count()).map(|cell| self.box_of(cell)).collect();
        let tree = Bvh::new(&boxes);
        let mut at = Values::default();
        for side in self.unpaired_sides() {
            let cell = side.cell as usize;
            let (shape, centre) = (self.shape(cell), self.shape(cell).centre());
            for s in points_of(self.side_shape(side)) {
                let on_side = shape.on_side(side.side as usize, &s).0;
                let xi: Local = std::array::from_fn(|k| on_side[k] + depth * (centre[k] - on_side[k]));
                self.map(cell).tabulate(&xi, &mut at);
                let x = self.position(cell, &at);
                let mut other = None;
                tree.nearest(&in_space(&x), 0.0, |k| {
                    if other.is_none() && k != cell && wanted(cell, k) && self.covers(k, &x) {
                        other = Some(k);
                    }
                    0.0
                });
                if let Some(other) = other {
                    return Some(Overlap { cells: [cell.min(other), cell.max(other)], at: x });
                }
            }
        }
        None
    }

    /// The sides that do not lie between exactly two cells, one on each side.
    fn unpaired_sides(&self) -> Vec<Side> {
        let mut all: Vec<([u32; 4], bool, Side)> = self
            .all_sides()
            .map(|side| {
                let (key, turned) = cycle(&self.side_vertices(side));
                (key, turned, side)
            })
            .collect();
        all.sort_unstable();
        let mut out: Vec<Side> = (all.chunk_by(|a, b| a.0 == b.0))
            .filter(|same| !matches!(same, [a, b] if a.1 != b.1))
            .flat_map(|same| same.iter().map(|s| s.2))
            .collect();
        out.sort_unstable();
        out
    }

    fn box_of(&self, cell: usize) -> Aabb<3> {
        let nodes = self.cell_nodes(cell).iter().map(|&n| in_space(&self.nodes()[n as usize]));
        let bounds = Aabb::around(nodes).expect("cells have nodes");
        bounds.scaled(if self.map(cell).order() > 1 { BULGE } else { 1.0 })
    }

    /// Whether a point lies in a cell, by Newton's method from its middle.
    fn covers(&self, cell: usize, x: &Point<D>) -> bool {
        let shape = self.shape(cell);
        let mut xi = shape.centre();
        let mut at = Values::default();
        for _ in 0..30 {
            self.map(cell).tabulate(&xi, &mut at);
            let (y, jacobian) = self.jacobian(cell, &at);
            let step = small::inverse(&jacobian) * (x - y);
            let length = step.norm();
            if !length.is_finite() {
                return false;
            }
            // A cell has the size 1 or 2 in its own coordinates.
            let factor = (0.5 / length).min(1.0);
            (0..D).for_each(|k| xi[k] += factor * step[k]);
            // Where steps are short against the cell each is less than half the one before: the way left is no longer.
            if length < SHORT && shape.beyond(&xi) > length {
                return false;
            }
            if length < 1e-9 {
                return shape.beyond(&xi) <= 0.0;
            }
        }
        false
    }
}

fn in_space<const D: usize>(x: &Point<D>) -> Point<3> {
    Point::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 })
}

/// Points of a side, its vertices and edges included.
fn points_of(shape: CellShape) -> Vec<Local> {
    let n = PARTS[shape.dimension() - 1];
    let part = |i: usize| i as f64 / n as f64;
    let line = |i: usize| 2.0 * part(i) - 1.0;
    match shape {
        CellShape::Line => (0..=n).map(|i| [line(i), 0.0, 0.0]).collect(),
        CellShape::Triangle => (0..=n).flat_map(|j| (0..=n - j).map(move |i| [part(i), part(j), 0.0])).collect(),
        _ => (0..=n).flat_map(|j| (0..=n).map(move |i| [line(i), line(j), 0.0])).collect(),
    }
}

/// The vertices of a side in an order that all cells at it have, and whether this cell has them the other way round.
fn cycle(vertices: &[u32]) -> ([u32; 4], bool) {
    let n = vertices.len();
    let first = (0..n).min_by_key(|&k| vertices[k]).unwrap_or(0);
    let turned = if n == 2 { first == 1 } else { vertices[(first + 1) % n] > vertices[(first + n - 1) % n] };
    let mut key = [u32::MAX; 4];
    for k in 0..n {
        key[k] = vertices[if turned && n > 2 { first + n - k } else { first + k } % n];
    }
    (key, turned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::block;

    /// Two blocks in one mesh, the second moved.
    fn two<const D: usize>(cells: usize, order: usize, moved: Point<D>, bent: f64) -> Mesh<D> {
        let axes: [Vec<f64>; D] = std::array::from_fn(|_| (0..=cells).map(|k| k as f64 / cells as f64).collect());
        let bend =
            |x: Point<D>| Point::<D>::from_fn(|k, _| if k == 1 { x[1] + bent * x[0] * (1.0 - x[0]) } else { x[k] });
        let mut mesh = block::<D>(&axes, order, bend);
        let second = block::<D>(&axes, order, |x| bend(x) + moved);
        let first = mesh.nodes().len() as u32;
        second.nodes().iter().for_each(|x| {
            mesh.add_node(*x);
        });
        for cell in 0..second.cell_count() {
            let nodes: Vec<u32> = second.cell_nodes(cell).iter().map(|n| n + first).collect();
            mesh.add_cell(second.shape(cell), order, &nodes);
        }
        mesh.check().unwrap();
        mesh
    }

    #[test]
    fn blocks_that_touch_do_not_overlap_and_those_that_reach_into_each_other_do() {
        for order in [1, 2] {
            for bent in [0.0, 0.4] {
                for (moved, touch) in [([0.0, 1.0], true), ([1.0, 0.1], true), ([1.0, 1.0], true), ([0.0, 1.2], false)]
                {
                    let mesh = two::<2>(3, order, moved.into(), bent);
                    assert_eq!(mesh.overlap(), None, "{order} {bent} {moved:?}");
                    assert_eq!(mesh.touching(&mesh.pieces()).is_some(), touch, "{order} {bent} {moved:?}");
                }
                // Also on the very same nodes, by a tenth of a cell, and at a corner.
                for moved in [[0.0, 0.0], [0.0, 0.967], [-0.967, 0.1], [0.95, 0.95], [0.5, 0.5]] {
                    let mesh = two::<2>(3, order, moved.into(), bent);
                    let found = mesh.overlap().unwrap_or_else(|| panic!("{order} {bent} {moved:?}"));
                    assert!(found.cells.iter().all(|&c| mesh.covers(c, &found.at)));
                }
            }
        }
        assert_eq!(two::<3>(2, 1, [1.0, 0.5, 0.3].into(), 0.4).overlap(), None);
        for moved in [[0.0; 3], [0.95, 0.5, 0.3]] {
            assert!(two::<3>(2, 2, moved.into(), 0.4).overlap().is_some(), "{moved:?}");
        }
        // One block within a cell of the other.
        let mut mesh = block::<2>(&[vec![0.0, 1.0], vec![0.0, 1.0]], 1, |x| x);
        let nodes: Vec<u32> = [[0.3, 0.4], [0.4, 0.4], [0.3, 0.5]].map(|x| mesh.add_node(x.into())).into();
        mesh.add_cell(CellShape::Triangle, 1, &nodes);
        assert_eq!(mesh.overlap().map(|o| o.cells), Some([0, 1]));
    }

    #[test]
    fn cells_on_one_side_of_a_side_that_they_share_overlap() {
        let nodes = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(Point::<2>::from);
        let mut mesh = Mesh::<2>::new(nodes.to_vec());
        mesh.add_cell(CellShape::Triangle, 1, &[0, 1, 2]);
        mesh.add_cell(CellShape::Triangle, 1, &[0, 1, 3]);
        assert_eq!(mesh.overlap().map(|o| o.cells), Some([0, 1]));
        let nodes =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.2, 0.2, 0.5], [0.2, 0.2, -1.0]];
        let mut mesh = Mesh::<3>::new(nodes.map(Point::<3>::from).to_vec());
        mesh.add_cell(CellShape::Tetrahedron, 1, &[0, 1, 2, 3]);
        mesh.add_cell(CellShape::Tetrahedron, 1, &[1, 0, 2, 5]);
        assert_eq!(mesh.overlap(), None);
        mesh.add_cell(CellShape::Tetrahedron, 1, &[1, 2, 0, 4]);
        assert_eq!(mesh.overlap().map(|o| o.cells), Some([0, 2]));
    }
}
