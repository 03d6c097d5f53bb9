//! Displacement and stress at any point of a solid.

use super::SolidBody;
use super::spatial::spatial;
use nalgebra::Matrix3;
use signorini_fem::Local;
use signorini_fem::hierarchic::Values;
use signorini_fem::small::inverse;
use signorini_geometry::{Aabb, Point};
use signorini_material::von_mises;
use signorini_mechanics::{BodyState, PointValues};

/// How far beyond a reference cell a point still belongs to it: rounding of the map and its inverse.
const BEYOND: f64 = 1e-9;
/// Newton's method on the map of a cell needs fewer; from points beyond the cell it may not end.
const MOST_ITERATIONS: usize = 30;

impl<const D: usize> SolidBody<D> {
    /// The state at a point before the body deforms; none outside of the mesh.
    pub(super) fn state_at_point(&self, state: &BodyState, x: &Point<3>) -> Option<PointValues> {
        let within = Point::<D>::from_fn(|i, _| x[i]);
        if spatial(&within) != *x {
            return None;
        }
        let (cell, xi) = (0..self.mesh().cell_count()).find_map(|cell| Some((cell, self.local(cell, &within)?)))?;
        let pressure = self.fitted_pressure(self.pieces.of(cell), state);
        let at = |xi: &Local| self.points_of(cell, &self.table_at(cell, &[*xi]), state, pressure.as_ref())[0];
        let found = at(&xi);
        // Where the map of a cell has a pole its stress is that beside it.
        let inner = self.body().mesh.shown_at(cell, &xi);
        let stress: Matrix3<f64> = if inner == xi { found.stress } else { at(&inner).stress };
        let temperature = self
            .heated
            .as_ref()
            .map(|_| self.temperatures_at(cell, &self.table_at(cell, &[xi]), self.temperature_of(state))[0]);
        Some(PointValues { displacement: found.displacement, von_mises: von_mises(&stress), temperature })
    }

    /// Reference coordinates of a point in a cell; none where it is not in it.
    fn local(&self, cell: usize, x: &Point<D>) -> Option<Local> {
        let mesh = &self.body().mesh;
        let bounds = Aabb::around(mesh.cell_nodes(cell).iter().map(|n| mesh.nodes()[*n as usize]))?;
        // A curved side reaches beyond its nodes by less than the size of the cell.
        let size = bounds.size().norm();
        if (0..D).any(|k| x[k] < bounds.min[k] - size || x[k] > bounds.max[k] + size) {
            return None;
        }
        let (map, shape) = (mesh.map(cell), mesh.shape(cell));
        let mut xi = shape.centre();
        let mut at = Values::default();
        for _ in 0..MOST_ITERATIONS {
            map.tabulate(&xi, &mut at);
            let (position, jacobian) = mesh.jacobian(cell, &at);
            let step = inverse(&jacobian) * (x - position);
            (0..D).for_each(|k| xi[k] += step[k]);
            if !step.norm().is_finite() {
                return None;
            }
            if step.norm() <= f64::EPSILON.sqrt() {
                return (shape.beyond(&xi) <= BEYOND).then_some(xi);
            }
        }
        None
    }
}
