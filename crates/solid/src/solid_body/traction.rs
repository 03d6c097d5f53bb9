//! The traction by the stress of a solid of small strains at a tested point, for Nitsche's method.

use super::SolidBody;
use super::cells::Gradients;
use super::faces::Faces;
use super::spatial::spatial;
use crate::stiffness::{Table, traction};
use nalgebra::{DMatrix, DVector, Matrix3};
use signorini_fem::Local;
use signorini_geometry::Point;
use signorini_material::StressLaw;
use signorini_material::{Elastic, Space};
use signorini_mechanics::{BodyState, Direction, Function, Site};

impl<const D: usize> SolidBody<D> {
    /// `σ n` with the normal at rest, and what changes it; none at edges, of laws that are not linear, and of a body that
    /// expands.
    pub(super) fn traction_at(&self, state: &BodyState, site: &Site) -> Option<Direction> {
        let expands = self.heated.as_ref().is_some_and(|own| own.material.expansion.is_some());
        if !self.law().is_linear() || expands || self.edge_at(site).is_some() {
            return None;
        }
        let rows = self.faces.point(site).traction.get_or_init(|| self.traction_rows(&self.faces, site));
        let mut out = Direction::default();
        for (unknown, value) in rows {
            let value = spatial(value);
            out.vector += value * state.configuration[*unknown as usize];
            out.functions.push(Function { unknown: *unknown, value, ..Function::default() });
        }
        Some(out)
    }

    /// The traction on the first face of a tested point by each unknown of its cell.
    fn traction_rows(&self, faces: &Faces<D>, site: &Site) -> Vec<(u32, Point<D>)> {
        let body = self.body();
        let Some(face) = faces.faces_of(site).next() else { return Vec::new() };
        let side = faces.face(face).side;
        let (cell, s) = (side.cell as usize, [site.xi[0], site.xi[1], 0.0]);
        let basis = body.dofs.basis(cell);
        let (xi, _) = basis.shape().on_side(side.side as usize, &s);
        let normal = faces.reference(face, &s).area_normal().normalize();
        let table = Table::new(&body.mesh, &body.dofs, cell);
        let law = (&body.material, self.bodies.space);
        let values = match self.material.is_uniform_hooke() {
            true => traction(&body.mesh, cell, &table, basis, law, (&xi, &normal)),
            false => self.traction_by_law(cell, &xi, &normal),
        };
        let functions = body.dofs.cell(cell).enumerate();
        let of = |(a, (f, sign)): (usize, (u32, f64))| {
            (0..D).map(|i| (D as u32 * f + i as u32, values[a * D + i] * sign)).collect::<Vec<_>>()
        };
        functions.flat_map(of).collect()
    }

    /// The traction at a point of a cell by each of its unknowns, from the linear law there: that of `V`, and the pressure as it
    /// acts in the cell.
    fn traction_by_law(&self, cell: usize, xi: &Local, normal: &Point<D>) -> Vec<Point<D>> {
        let here = self.table_at(cell, &[*xi]);
        let at = self.gradients(cell, &here);
        let (elastic, law) = &at.laws[0];
        let rest = Matrix3::identity();
        let in_plane_stress = self.bodies.space == Space::PlaneStress;
        let tangent = match law.plane_stress(elastic, &rest, &[]) {
            Ok(plane) if in_plane_stress => plane.tangent,
            _ => law.deviatoric(elastic, &rest, &[]).tangent,
        };
        let pressure = if in_plane_stress { None } else { self.pressure_by_unknown(cell, &here) };
        let volumetric = law.dilatation(&rest).stress;
        let force = |column: usize| {
            Point::<D>::from_fn(|i, _| {
                (0..D)
                    .map(|j| {
                        let by_shape: f64 = (at.components.iter().enumerate())
                            .map(|(r, c)| tangent[(3 * i + j, *c)] * at.rows[(r, column)])
                            .sum();
                        let by_volume = pressure.as_ref().map_or(0.0, |p| p[column] * volumetric[3 * i + j]);
                        (by_shape + by_volume) * normal[j]
                    })
                    .sum()
            })
        };
        (0..at.rows.ncols()).map(force).collect()
    }

    /// The pressure at the point of a table by each unknown of a cell of a linear law.
    fn pressure_by_unknown(&self, cell: usize, here: &Table) -> Option<DVector<f64>> {
        let rest = Matrix3::identity();
        let of_points = |at: &Gradients| {
            let count = at.components.len();
            let row = |q: usize| {
                let slope = at.reduced(&at.laws[q].1.dilatation(&rest).stress);
                at.rows.rows(q * count, count).tr_mul(&slope).transpose()
            };
            DMatrix::from_rows(&(0..at.laws.len()).map(row).collect::<Vec<_>>())
        };
        let modulus = |(elastic, law): &(Elastic, StressLaw)| law.volumetric(elastic, 0.0).map_or(0.0, |u| u[2]);
        let inner = self.gradients(cell, self.table(cell));
        let Some(within) = self.projection(cell, &inner.weights, self.table(cell)) else {
            let at = self.gradients(cell, here);
            return Some((of_points(&at) * modulus(&at.laws[0])).row(0).transpose());
        };
        let mut pressure = within * of_points(&inner);
        pressure.row_iter_mut().zip(&inner.laws).for_each(|(mut row, law)| row *= modulus(law));
        let to = self.projection(cell, &inner.weights, here)?;
        Some((to * pressure).row(0).transpose())
    }
}
