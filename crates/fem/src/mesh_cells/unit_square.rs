//! A cell is cut in a unit square: a quadrilateral's own, and for a triangle the one that collapses onto it with one side
//! at the vertex that is farthest from what cuts it.

use super::MeshCells;
use crate::cut::{CellPartition, CellRule, QuadraturePoint, cut_cell};
use crate::reference::{CellShape, Local};
use crate::small;
use signorini_geometry::{Aabb, ImplicitShape, Matrix, Point, Vector};

impl MeshCells {
    /// The quadrature of a cell that surfaces cut, of the order on each smooth piece.
    pub(super) fn cut_in_square(&self, cell: usize, partition: &CellPartition<'_, 2>, order: usize) -> CellRule<2> {
        let square = UnitCell::new(self, cell, partition);
        let sheets = partition.sheets.iter().map(|sheet| {
            let drawn: Box<dyn ImplicitShape<2> + '_> = Box::new(MappedCell { square: &square, sheet: &**sheet });
            drawn
        });
        let drawn = CellPartition {
            sheets: sheets.collect(),
            tags: partition.tags.clone(),
            features: partition.features.iter().map(|x| square.parameters(x)).collect(),
            region: Box::new(|s, values| (partition.region)(&square.at(s).0, values)),
        };
        let unit = Aabb::new(Point::<2>::zeros(), Point::<2>::repeat(1.0));
        let mut rule = cut_cell(&drawn, &unit, order);
        for p in rule.volumes.iter_mut().flat_map(|(_, points)| points) {
            let (x, jacobian) = square.at(&p.x);
            *p = QuadraturePoint { x, weight: p.weight * small::determinant(&jacobian).abs() };
        }
        for p in &mut rule.surfaces {
            let (x, j) = square.at(&p.x);
            // Nanson's formula: the cofactors take normal and length along, also where a triangle's side is collapsed.
            let turned = small::determinant(&j).signum()
                * Vector::<2>::new(
                    j[(1, 1)] * p.normal[0] - j[(1, 0)] * p.normal[1],
                    j[(0, 0)] * p.normal[1] - j[(0, 1)] * p.normal[0],
                );
            let length = turned.norm();
            (p.x, p.weight, p.normal) = (x, p.weight * length, turned / length.max(f64::MIN_POSITIVE));
        }
        rule
    }
}

/// The unit square drawn onto a cell.
struct UnitCell<'a> {
    cells: &'a MeshCells,
    cell: usize,
    /// For a triangle, the vertices: the first takes a whole side of the square.
    corners: Option<[Local; 3]>,
}

impl<'a> UnitCell<'a> {
    fn new(cells: &'a MeshCells, cell: usize, partition: &CellPartition<'_, 2>) -> Self {
        let shape = cells.mesh.shape(cell);
        let corners = (shape == CellShape::Triangle).then(|| {
            let vertices = shape.vertices();
            let distance = |v: &Local| {
                let x = cells.at(cell, v).0;
                partition.sheets.iter().map(|s| s.value(&x).abs()).fold(f64::INFINITY, f64::min)
            };
            let farthest =
                (0..3).max_by(|&a, &b| distance(&vertices[a]).total_cmp(&distance(&vertices[b]))).unwrap_or(0);
            [0, 1, 2].map(|k| vertices[(farthest + k) % 3])
        });
        Self { cells, cell, corners }
    }

    /// Reference coordinates of a point of the square, and their derivatives.
    fn reference(&self, s: &Point<2>) -> (Local, Matrix<2>) {
        match &self.corners {
            None => ([2.0 * s[0] - 1.0, 2.0 * s[1] - 1.0, 0.0], Matrix::<2>::identity() * 2.0),
            Some([apex, a, b]) => {
                let mut xi = [0.0; 3];
                let mut derivatives = Matrix::<2>::zeros();
                for k in 0..2 {
                    let base = a[k] + s[0] * (b[k] - a[k]);
                    xi[k] = base + s[1] * (apex[k] - base);
                    derivatives[(k, 0)] = (1.0 - s[1]) * (b[k] - a[k]);
                    derivatives[(k, 1)] = apex[k] - base;
                }
                (xi, derivatives)
            }
        }
    }

    fn at(&self, s: &Point<2>) -> (Point<2>, Matrix<2>) {
        let (xi, derivatives) = self.reference(s);
        let (x, jacobian) = self.cells.at(self.cell, &xi);
        (x, jacobian * derivatives)
    }

    /// The point of the square for a point of the cell.
    fn parameters(&self, x: &Point<2>) -> Point<2> {
        let xi = self.cells.local(self.cell, x);
        match &self.corners {
            None => Point::<2>::new(0.5 * (1.0 + xi[0]), 0.5 * (1.0 + xi[1])),
            Some([apex, a, b]) => {
                let edges = Matrix::<2>::new(b[0] - a[0], apex[0] - a[0], b[1] - a[1], apex[1] - a[1]);
                let st = small::inverse(&edges) * Vector::<2>::new(xi[0] - a[0], xi[1] - a[1]);
                // Along the base, and towards the apex.
                Point::<2>::new(st[0] / (1.0 - st[1]).max(f64::MIN_POSITIVE), st[1])
            }
        }
    }
}

/// A surface in the coordinates of the unit square.
struct MappedCell<'a> {
    square: &'a UnitCell<'a>,
    sheet: &'a dyn ImplicitShape<2>,
}

impl ImplicitShape<2> for MappedCell<'_> {
    fn value(&self, s: &Point<2>) -> f64 {
        self.sheet.value(&self.square.at(s).0)
    }
    fn gradient(&self, s: &Point<2>) -> Vector<2> {
        self.value_and_gradient(s).1
    }
    fn value_and_gradient(&self, s: &Point<2>) -> (f64, Vector<2>) {
        let (x, jacobian) = self.square.at(s);
        let (value, gradient) = self.sheet.value_and_gradient(&x);
        (value, jacobian.transpose() * gradient)
    }
}
