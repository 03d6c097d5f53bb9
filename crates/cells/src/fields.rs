//! Displacement and stress: at a point, on a lattice of every cell, and on the recovered boundary.

use crate::body::{CellBody, Site};
use crate::region::{BoundaryPoint, Filling};
use crate::space::Tabulation;
use nalgebra::Matrix3;
use rayon::prelude::*;
use signorini_fem::cut::End;
use signorini_fem::elastic::Space;
use signorini_geometry::{Matrix, Point, Vector};
use signorini_mechanics::Means;

/// The state of a body at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointState<const D: usize> {
    pub displacement: Vector<D>,
    /// `∂u_i / ∂x_j`.
    pub gradient: Matrix<D>,
    /// In space; around an axis the third direction is that around it.
    pub stress: Matrix3<f64>,
}

/// Values on a lattice of points of all cells.
#[derive(Clone, Debug, Default)]
pub struct VolumeFields<const D: usize> {
    pub points: Vec<Point<D>>,
    /// Boxes between points: two, four or eight each, the first direction fastest.
    pub boxes: Vec<Vec<usize>>,
    /// The number of the cell of each box.
    pub cell: Vec<usize>,
    /// Whether the middle of each box is in the material.
    pub material: Vec<bool>,
    pub displacement: Vec<Vector<D>>,
    pub stress: Vec<Matrix3<f64>>,
}

impl<const D: usize> CellBody<D> {
    /// The state at a point of a cell, for coefficients of the functions.
    pub fn state_at(&self, cell: usize, x: &Point<D>, u: &[f64]) -> PointState<D> {
        let mut t = Tabulation::default();
        self.functions_at(cell, x, &mut t);
        let (mut displacement, mut gradient) = (Vector::<D>::zeros(), Matrix::<D>::zeros());
        for (f, (value, slope)) in self.cells()[cell].functions.iter().zip(t.value.iter().zip(&t.gradient)) {
            let c = Vector::<D>::from_fn(|k, _| u[D * *f as usize + k]);
            displacement += c * *value;
            gradient += c * slope.transpose();
        }
        let mut in_space = Matrix3::zeros();
        for i in 0..D {
            for j in 0..D {
                in_space[(i, j)] = gradient[(i, j)];
            }
        }
        if self.space() == Space::Axisymmetric {
            in_space[(2, 2)] = if x[0] > 0.0 { displacement[0] / x[0] } else { gradient[(0, 0)] };
        }
        PointState { displacement, gradient, stress: self.stress_at(x, &in_space) }
    }

    /// The body as a piece of a material that fills its box; none around an axis, where a box is a ring.
    pub fn means(&self, u: &[f64]) -> Option<Means> {
        if self.space() == Space::Axisymmetric {
            return None;
        }
        let of_cell = |c: usize| -> Vector<3> {
            let points = self.volume_points(&self.cells()[c]);
            points.iter().map(|(x, w)| self.state_at(c, x, u).stress.diagonal() * *w).sum()
        };
        let parts: Vec<Vector<3>> = (0..self.cells().len()).into_par_iter().map(of_cell).collect();
        let bounds = *self.tree().bounds();
        let mut out = Means { stress: (parts.iter().sum::<Vector<3>>() / bounds.volume()).into(), ..Means::default() };
        for k in 0..D {
            let moved = |end: End| -> Option<f64> {
                let (mut sum, mut area) = (0.0, 0.0);
                let at = end.of(&bounds, k);
                for leaf in self.tree().leaves().iter().filter(|l| end.of(&l.bounds, k) == at) {
                    for p in self.region.side_rule(&leaf.bounds, k, end, self.degree() + 1) {
                        let Some(cell) = self.cell_at(&p.x) else { continue };
                        sum += p.weight * self.state_at(cell, &p.x, u).displacement[k];
                        area += p.weight;
                    }
                }
                (area > 0.0).then(|| sum / area)
            };
            out.strain[k] = moved(End::High).zip(moved(End::Low)).map(|(high, low)| (high - low) / bounds.size()[k]);
        }
        Some(out)
    }

    /// The state at a point of the material; none outside.
    pub fn probe(&self, x: &Point<D>, u: &[f64]) -> Option<PointState<D>> {
        if !self.region.contains(x) {
            return None;
        }
        self.cell_at(x).map(|cell| self.state_at(cell, x, u))
    }

    /// Displacement and stress on a lattice with `n` boxes along each side of every cell.
    pub fn volume_fields(&self, u: &[f64], n: usize) -> VolumeFields<D> {
        let n = n.max(1);
        let per_cell = (n + 1).pow(D as u32);
        let states: Vec<Vec<(Point<D>, PointState<D>)>> = (0..self.cells().len())
            .into_par_iter()
            .map(|c| {
                let b = *self.bounds_of(c);
                (0..per_cell)
                    .map(|i| {
                        let at = |k: usize| (i / (n + 1).pow(k as u32) % (n + 1)) as f64 / n as f64;
                        let x = b.at(&Point::from_fn(|k, _| at(k)));
                        (x, self.state_at(c, &x, u))
                    })
                    .collect()
            })
            .collect();
        let mut out = VolumeFields::default();
        for (c, list) in states.into_iter().enumerate() {
            let first = out.points.len();
            for (x, state) in list {
                out.points.push(x);
                out.displacement.push(state.displacement);
                out.stress.push(state.stress);
            }
            for i in 0..n.pow(D as u32) {
                let corner = |c: usize| -> usize {
                    let at = |k: usize| i / n.pow(k as u32) % n + (c >> k & 1);
                    first + (0..D).map(|k| at(k) * (n + 1).pow(k as u32)).sum::<usize>()
                };
                let corners: Vec<usize> = (0..1 << D).map(corner).collect();
                let middle = 0.5 * (out.points[corners[0]] + out.points[corners[(1 << D) - 1]]);
                out.material.push(self.cells()[c].rule.filling == Filling::Full || self.region.contains(&middle));
                out.cell.push(c);
                out.boxes.push(corners);
            }
        }
        out
    }

    /// The state at the points of the recovered boundary in a place; the stress of a cell with little material is that of
    /// its neighbour.
    pub fn boundary_fields(
        &self,
        u: &[f64],
        place: &dyn Fn(&BoundaryPoint<D>) -> bool,
    ) -> Vec<(Site<D>, PointState<D>)> {
        let state = |site: Site<D>| {
            let mut state = self.state_at(site.cell, &site.x, u);
            let stress_cell = self.cells()[site.cell].stress_cell;
            if stress_cell != site.cell {
                state.stress = self.state_at(stress_cell, &site.x, u).stress;
            }
            (site, state)
        };
        self.sites(place).into_iter().map(state).collect()
    }
}
