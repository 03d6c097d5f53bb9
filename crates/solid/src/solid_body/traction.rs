//! The traction by the stress of a solid of small strains at a tested point, for Nitsche's method.

use super::SolidBody;
use super::cells::Gradients;
use super::faces::Faces;
use super::pieces::Piece;
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

    /// The traction on the first face of a tested point by each unknown of its piece.
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
        let piece = self.piece(self.pieces.of(cell));
        let values = match self.material.is_uniform_hooke() && piece.cells.len() == 1 {
            true => traction(&body.mesh, cell, &table, basis, law, (&xi, &normal)),
            false => self.traction_by_law(&piece, cell, &xi, &normal),
        };
        let signed = piece.signs.iter().zip(values).map(|(sign, value)| value * *sign);
        piece.unknowns.iter().copied().zip(signed).collect()
    }

    /// The traction at a point of a cell by each unknown of its piece, from the linear law there: that of `V`, and the pressure as
    /// it acts in the piece.
    fn traction_by_law(&self, piece: &Piece<'_>, cell: usize, xi: &Local, normal: &Point<D>) -> Vec<Point<D>> {
        let here = self.table_at(cell, &[*xi]);
        let at = self.gradients(cell, &here);
        let (elastic, law) = &at.laws[0];
        let rest = Matrix3::identity();
        let in_plane_stress = self.bodies.space == Space::PlaneStress;
        let tangent = match law.plane_stress(elastic, &rest, &[]) {
            Ok(plane) if in_plane_stress => plane.tangent,
            _ => law.deviatoric(elastic, &rest, &[]).tangent,
        };
        let pressure = if in_plane_stress { None } else { Some(self.pressure_by_unknown(piece, cell, &here)) };
        let mut rows = DMatrix::<f64>::zeros(at.rows.nrows(), piece.unknowns.len());
        piece.add_columns(piece.number_of(cell), &at.rows, &mut rows);
        let volumetric = law.dilatation(&rest).stress;
        let force = |column: usize| {
            Point::<D>::from_fn(|i, _| {
                (0..D)
                    .map(|j| {
                        let by_shape: f64 = (at.components.iter().enumerate())
                            .map(|(r, c)| tangent[(3 * i + j, *c)] * rows[(r, column)])
                            .sum();
                        let by_volume = pressure.as_ref().map_or(0.0, |p| p[column] * volumetric[3 * i + j]);
                        (by_shape + by_volume) * normal[j]
                    })
                    .sum()
            })
        };
        (0..rows.ncols()).map(force).collect()
    }

    /// The pressure at the point of a table of a cell by each unknown of its piece, of a linear law.
    fn pressure_by_unknown(&self, piece: &Piece<'_>, cell: usize, here: &Table) -> DVector<f64> {
        let rest = Matrix3::identity();
        let of_points =
            |at: &Gradients| at.changes(&at.laws.iter().map(|(_, law)| law.dilatation(&rest)).collect::<Vec<_>>());
        let modulus = |(elastic, law): &(Elastic, StressLaw)| law.volumetric(elastic, 0.0).map_or(0.0, |u| u[2]);
        let inner: Vec<Gradients> =
            piece.cells.iter().map(|(cell, _)| self.gradients(*cell as usize, self.table(*cell as usize))).collect();
        let weights: Vec<&[f64]> = inner.iter().map(|at| at.weights.as_slice()).collect();
        let Some(fit) = self.projection(piece, &weights) else {
            // Then the cell is alone.
            let at = self.gradients(cell, here);
            return (of_points(&at) * modulus(&at.laws[0])).row(0).transpose();
        };
        let rows: Vec<DMatrix<f64>> = inner.iter().map(of_points).collect();
        let moduli: Vec<Vec<f64>> = inner.iter().map(|at| at.laws.iter().map(modulus).collect()).collect();
        let pressure = fit.solve(&(fit.products(&moduli) * fit.coefficients_by_unknown(piece, &rows)));
        let psi = self.polynomials(cell, &self.pieces.place(cell), here);
        pressure.tr_mul(&psi.column(0))
    }
}
