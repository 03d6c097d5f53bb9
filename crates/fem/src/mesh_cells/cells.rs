//! The mesh as the cells of a membrane: functions, quadrature, neighbours.

use super::curved::{edges, longest};
use super::{MOST_ON_TRIANGLES, MeshCells, bounds_of};
use crate::cells::{
    BoundarySide, CellByCell, Cells, Divided, Extension, Neighbours, SidePoint, own_extension, quadrilaterals,
};
use crate::cut::{CellPartition, CellRule, QuadraturePoint};
use crate::hierarchic::{MAX_DEGREE, Values};
use crate::lagrange::Tabulation;
use crate::mesh::Side;
use crate::reference::CellShape;
use crate::small;
use nalgebra::{DMatrix, DVector};
use signorini_geometry::outline::outlines_between;
use signorini_geometry::{Aabb, Matrix, Point, Vector};
use std::sync::Arc;

impl MeshCells {
    /// Functions tabulated in the reference cell, with their slopes in space by the inverse Jacobian.
    fn slopes(&self, cell: usize, values: &Values, inverse: &Matrix<2>, out: &mut Tabulation<2>) {
        out.value.clear();
        out.gradient.clear();
        for ((value, g), (_, sign)) in values.value.iter().zip(&values.gradient).zip(self.dofs.cell(cell)) {
            out.value.push(sign * value);
            out.gradient.push(Vector::from_fn(|k, _| sign * (g[0] * inverse[(0, k)] + g[1] * inverse[(1, k)])));
        }
    }
}

impl CellByCell<2> for MeshCells {
    fn neighbours_of(&self, cell: usize, out: &mut Vec<Neighbours>) {
        for side in 0..self.mesh.shape(cell).sides().len() {
            let side = Side { cell: cell as u32, side: side as u8 };
            if let Some(other) = self.adjacency.across(side).filter(|other| *other > cell) {
                let ends = self.mesh.side_vertices(side);
                let length = (self.mesh.nodes()[ends[0] as usize] - self.mesh.nodes()[ends[1] as usize]).norm();
                let width = 0.5 * (self.volume(cell) + self.volume(other)) / length;
                out.push(Neighbours { cells: [cell, other], width, kind: None });
            }
        }
    }
    fn sides_of(&self, cell: usize, out: &mut Vec<BoundarySide>) {
        let from = self.sides.partition_point(|side| side.cell < cell);
        out.extend(self.sides[from..].iter().take_while(|side| side.cell == cell));
    }
}

impl Cells<2> for MeshCells {
    fn degree(&self) -> usize {
        self.degree
    }
    fn count(&self) -> usize {
        self.bent_at.len()
    }
    fn bounds_of(&self, cell: usize) -> Aabb<2> {
        bounds_of(&self.mesh, &self.bent_at, &self.bent, cell)
    }
    fn size(&self, cell: usize) -> f64 {
        let of_triangle = || {
            let corners = self.corners(cell);
            small::determinant(&edges(&corners)) / longest(&corners)
        };
        self.bent(cell).map_or_else(of_triangle, |bent| bent.size)
    }
    fn volume(&self, cell: usize) -> f64 {
        let of_triangle = || 0.5 * small::determinant(&edges(&self.corners(cell)));
        self.bent(cell).map_or_else(of_triangle, |bent| bent.volume)
    }
    fn containing(&self, x: &Point<2>) -> Option<usize> {
        self.cell_of(x)
    }
    fn cut(&self, cell: usize, partition: &CellPartition<'_, 2>, order: usize) -> CellRule<2> {
        self.cut_in_square(cell, partition, order)
    }
    fn sum_to_one(&self) -> bool {
        self.degree == 1
    }
    fn function_count(&self) -> usize {
        self.dofs.count()
    }
    fn functions(&self, cell: usize, out: &mut Vec<u32>) {
        out.clear();
        out.extend_from_slice(self.dofs.functions(cell));
    }
    fn edges(&self, cell: usize) -> &'static [[usize; 2]] {
        self.mesh.shape(cell).edges()
    }
    fn tabulate(&self, cell: usize, x: &Point<2>, out: &mut Tabulation<2>) {
        if self.degree == 1 && self.is_straight(cell) {
            let corners = self.corners(cell);
            let inverse = small::inverse(&edges(&corners));
            let (first, slopes) = (inverse * (x - corners[0]), inverse.transpose());
            out.value.clear();
            out.gradient.clear();
            out.value.extend([1.0 - first[0] - first[1], first[0], first[1]]);
            let [b, c] = [0, 1].map(|k| slopes.column(k).into_owned());
            out.gradient.extend([-b - c, b, c]);
            return;
        }
        let xi = self.local(cell, x);
        let inverse = small::inverse(&self.at(cell, &xi).1);
        let mut values = Values::default();
        self.dofs.basis(cell).tabulate(&xi, &mut values);
        self.slopes(cell, &values, &inverse, out);
    }
    fn extension<'a>(&'a self, cell: usize) -> Extension<'a, 2> {
        // The functions of a cell that is not affine may not be carried on: its map folds. Of their polynomials of the
        // same degree, those are taken that are closest in the mean square.
        let degree = self.degree;
        let Some(bent) = self.bent(cell) else { return own_extension(self, cell) };
        let (centre, scale) = (bent.centre, bent.bounds.radius());
        let monomials = move |x: &Point<2>| {
            let y = (x - centre) / scale;
            let powers = (0..=degree).flat_map(move |n| (0..=n).map(move |k| (n - k, k)));
            powers.map(|(i, j)| y[0].powi(i as i32) * y[1].powi(j as i32)).collect::<Vec<f64>>()
        };
        let m = (degree + 1) * (degree + 2) / 2;
        let n = self.dofs.cell(cell).len();
        let (mut mass, mut load) = (DMatrix::<f64>::zeros(m, m), DMatrix::<f64>::zeros(m, n));
        let mut t = Tabulation::default();
        for p in self.rule(cell) {
            self.tabulate(cell, &p.x, &mut t);
            let basis = DVector::from_vec(monomials(&p.x));
            mass.ger(p.weight, &basis, &basis, 1.0);
            load.ger(p.weight, &basis, &DVector::from_column_slice(&t.value), 1.0);
        }
        let coefficients = mass.cholesky().map_or_else(|| DMatrix::zeros(m, n), |factor| factor.solve(&load));
        let values = move |x: &Point<2>, out: &mut Vec<f64>| {
            let basis = monomials(x);
            out.clear();
            out.extend(coefficients.column_iter().map(|c| c.iter().zip(&basis).map(|(c, b)| c * b).sum::<f64>()));
        };
        Extension { values: Box::new(values), is_own: false }
    }
    fn node(&self, function: usize) -> Point<2> {
        self.nodes[function]
    }
    fn linear(&self, _: usize) -> Arc<dyn Cells<2>> {
        Arc::new(Self::new(self.mesh.clone(), 1))
    }
    fn raised(&self) -> Option<Arc<dyn Cells<2>>> {
        let most = if (0..self.count()).any(|cell| !self.mesh.shape(cell).is_tensor()) {
            MOST_ON_TRIANGLES
        } else {
            MAX_DEGREE
        };
        (self.degree < most).then(|| -> Arc<dyn Cells<2>> { Arc::new(Self::new(self.mesh.clone(), self.degree + 1)) })
    }
    fn coarser(&self) -> Option<Arc<dyn Cells<2>>> {
        let coarse = &self.parent()?.cells;
        Some(if self.degree == 1 { coarse.clone() } else { Arc::new(Self::new(coarse.mesh.clone(), 1)) })
    }
    fn mesh(self: Arc<Self>) -> Option<Arc<MeshCells>> {
        Some(self)
    }
    fn halved(self: Arc<Self>) -> Option<Arc<dyn Cells<2>>> {
        Some(Arc::new(self.refined()))
    }
    fn outlines(&self, value: &dyn Fn(&Point<2>) -> f64) -> Option<Vec<Vec<Point<2>>>> {
        let cells = (0..self.count()).map(|cell| self.mesh.vertices(cell).collect());
        let place = |vertex: u32| self.mesh.nodes()[vertex as usize];
        outlines_between(cells, |vertex| value(&place(vertex)), place, 1e-12 * self.bounds().radius())
    }
    fn divisions(&self, cell: usize) -> usize {
        self.levels.get(cell).map_or(0, |level| usize::from(*level))
    }
    fn for_each_point(&self, cell: usize, visit: &mut dyn FnMut(&QuadraturePoint<2>, &Tabulation<2>)) {
        let mut t = Tabulation::default();
        for point in &self.rules[self.mesh.map_number(cell)] {
            let (x, jacobian) = self.mesh.jacobian(cell, &point.map);
            let determinant = small::determinant(&jacobian);
            self.slopes(cell, &point.functions, &small::inverse(&jacobian), &mut t);
            visit(&QuadraturePoint { x, weight: point.weight * determinant.abs() }, &t);
        }
    }
    fn rule(&self, cell: usize) -> Vec<QuadraturePoint<2>> {
        self.rules[self.mesh.map_number(cell)]
            .iter()
            .map(|point| {
                let (x, jacobian) = self.mesh.jacobian(cell, &point.map);
                QuadraturePoint { x, weight: point.weight * small::determinant(&jacobian).abs() }
            })
            .collect()
    }
    fn kind(&self, _: usize) -> Option<usize> {
        None
    }
    fn kinds(&self) -> Vec<usize> {
        Vec::new()
    }
    fn neighbours(&self) -> Vec<Neighbours> {
        let mut out = Vec::new();
        (0..self.count()).for_each(|cell| self.neighbours_of(cell, &mut out));
        out
    }
    fn boundary_sides(&self) -> Vec<BoundarySide> {
        self.sides.clone()
    }
    fn on_side(&self, side: &BoundarySide, t: f64) -> SidePoint<2> {
        let of = Side { cell: side.cell as u32, side: side.side as u8 };
        let (x, [along, _]) = self.mesh.on_side(of, &[2.0 * t - 1.0, 0.0, 0.0]);
        let tangent = 2.0 * along;
        SidePoint { x, tangent, normal: Vector::<2>::new(tangent[1], -tangent[0]).normalize() }
    }
    fn divided(&self, cell: usize, n: usize) -> Divided<2> {
        let at = |i: usize, j: usize| [i as f64 / n as f64, j as f64 / n as f64];
        if self.mesh.shape(cell) != CellShape::Triangle {
            let points = (0..=n).flat_map(|j| (0..=n).map(move |i| at(i, j).map(|t| 2.0 * t - 1.0)));
            let points = points.map(|[a, b]| self.at(cell, &[a, b, 0.0]).0).collect();
            return Divided { points, parts: quadrilaterals(n) };
        }
        // Rows of n + 1, n, ... 1 points.
        let points = (0..=n).flat_map(|j| (0..=n - j).map(move |i| at(i, j)));
        let points = points.map(|[a, b]| self.at(cell, &[a, b, 0.0]).0).collect();
        let number = |i: usize, j: usize| j * (n + 1) - j * j.saturating_sub(1) / 2 + i;
        let mut parts = Vec::new();
        for j in 0..n {
            for i in 0..n - j {
                parts.push(vec![number(i, j), number(i + 1, j), number(i, j + 1)]);
                if i + j + 1 < n {
                    parts.push(vec![number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)]);
                }
            }
        }
        Divided { points, parts }
    }
}
