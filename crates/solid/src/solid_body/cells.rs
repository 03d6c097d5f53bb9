//! Forces and tangent of cells from a stress law.
//!
//! `Π = Σ_q w_q (V(F_q) + U(θ_q))` with the dilatation `θ = P φ(F)`, projected on polynomials of one degree less as the
//! divergence is at small strain (Simo, Taylor & Pister 1985 for degree 1), or not at all. `P` is its own adjoint under the
//! weights `w`, so that the forces are `Σ w (V' + p φ') δF` with the pressure `p = P U'(θ)`, and the tangent adds
//! `Σ w U''(θ) (P φ' δF)²` to `V'' + p φ''`: symmetric, with an energy.

use super::SolidBody;
use super::pieces::Piece;
use super::spatial::spatial;
use crate::stiffness::Table;
use nalgebra::{DMatrix, DVector, Matrix3};
use rayon::prelude::*;
use signorini_fem::mesh::Window;
use signorini_fem::small::{determinant, inverse};
use signorini_material::law::{Response, StrainError, StressLaw, Tensor};
use signorini_material::{Elastic, Space};
use signorini_mechanics::{BodyError, BodyState, Contribution, Order};

/// Radii below this share of the size of the body are on the axis.
const ON_AXIS: f64 = 1e-12;

/// What a piece of cells adds.
struct PieceForces {
    energy: f64,
    forces: DVector<f64>,
    tangent: Option<DMatrix<f64>>,
}

/// What the law makes of the points of a cell: the part of the shape, and the dilatation, none in plane stress.
struct CellPoints {
    at: Gradients,
    responses: Vec<Response>,
    dilatations: Vec<Response>,
}

/// The gradient of the displacement at the points of a cell: the components that there are, point after point, for each
/// unknown.
pub(super) struct Gradients {
    pub components: &'static [usize],
    pub rows: DMatrix<f64>,
    pub weights: Vec<f64>,
    /// Constants and law at each point.
    pub laws: Vec<(Elastic, StressLaw)>,
    /// What thermal strain leaves of a stretch of one at each point; nothing where there is none.
    pub unstrained: Vec<f64>,
}

impl Gradients {
    /// The deformation gradient at a point, less thermal strain.
    pub fn deformation(&self, q: usize, displacement: &DVector<f64>) -> Matrix3<f64> {
        let mut f = Matrix3::identity() * self.unstrained.get(q).copied().unwrap_or(1.0);
        let count = self.components.len();
        for (r, c) in self.components.iter().enumerate() {
            f[(c / 3, c % 3)] += displacement[q * count + r];
        }
        f
    }

    /// The change of the dilatation at each point by each unknown.
    pub fn changes(&self, dilatations: &[Response]) -> DMatrix<f64> {
        let count = self.components.len();
        let mut out = DMatrix::<f64>::zeros(dilatations.len(), self.rows.ncols());
        for (q, dilatation) in dilatations.iter().enumerate() {
            let row = self.rows.rows(q * count, count).tr_mul(&self.reduced(&dilatation.stress));
            out.row_mut(q).copy_from(&row.transpose());
        }
        out
    }

    pub fn reduced(&self, tensor: &Tensor) -> DVector<f64> {
        DVector::from_iterator(self.components.len(), self.components.iter().map(|c| tensor[*c]))
    }
}

impl<const D: usize> SolidBody<D> {
    pub(super) fn integrated(&self, state: &BodyState, order: Order, out: &mut Contribution) -> Result<f64, BodyError> {
        let of = |number: &usize| {
            let piece = self.piece(*number);
            let found = self.forces_of(&piece, state, order).map_err(|(cell, e)| self.refused(cell, e))?;
            Ok((piece, found))
        };
        let found: Vec<Result<(Piece<'_>, PieceForces), BodyError>> = self.kept.par_iter().map(of).collect();
        let mut energy = 0.0;
        for found in found {
            let (piece, found) = found?;
            energy += found.energy;
            for (a, k) in piece.unknowns.iter().enumerate() {
                out.forces[*k as usize] += piece.signs[a] * found.forces[a];
            }
            if let Some(tangent) = found.tangent {
                out.blocks.push(piece.block(&tangent));
            }
        }
        Ok(energy)
    }

    fn refused(&self, cell: usize, error: StrainError) -> BodyError {
        let body = self.body().name.clone();
        match error {
            StrainError::Inverted { .. } => BodyError::Inverted { body, cell },
            StrainError::Compressed { .. } => BodyError::Material { body, cell, message: error.to_string() },
        }
    }

    /// The unknowns of a cell, as its basis has them.
    pub(super) fn own(&self, cell: usize, u: &[f64]) -> DVector<f64> {
        let (unknowns, signs) = self.unknowns_of(cell);
        DVector::from_iterator(unknowns.len(), unknowns.iter().zip(&signs).map(|(k, s)| s * u[*k as usize]))
    }

    /// Gradients at the points of a table.
    pub(super) fn gradients(&self, cell: usize, table: &Table) -> Gradients {
        let body = self.body();
        let n = body.dofs.basis(cell).len();
        let components: &'static [usize] = match (D, self.bodies.space) {
            (3, _) => &[0, 1, 2, 3, 4, 5, 6, 7, 8],
            (_, Space::Axisymmetric) => &[0, 1, 3, 4, 8],
            _ => &[0, 1, 3, 4],
        };
        let count = components.len();
        let mut rows = DMatrix::<f64>::zeros(count * table.points.len(), n * D);
        let mut weights = Vec::with_capacity(table.points.len());
        let mut laws = Vec::with_capacity(table.points.len());
        for (q, (_, w)) in table.points.iter().enumerate() {
            let (x, jacobian) = body.mesh.jacobian(cell, &table.map[q]);
            weights.push(w * determinant(&jacobian) * self.bodies.measure(&x));
            laws.push(self.material.at(&spatial(&x)));
            let inverse = inverse(&jacobian);
            for (a, slope) in table.basis[q].gradient.iter().enumerate() {
                let along: [f64; D] = std::array::from_fn(|j| (0..D).map(|k| slope[k] * inverse[(k, j)]).sum());
                for (r, c) in components.iter().enumerate() {
                    let (i, j) = (c / 3, c % 3);
                    if i < D && j < D {
                        rows[(q * count + r, a * D + i)] = along[j];
                    } else {
                        // The hoop stretch; on the axis it is the radial one.
                        let on_axis = x[0] <= ON_AXIS * self.size;
                        rows[(q * count + r, a * D)] = if on_axis { along[0] } else { table.basis[q].value[a] / x[0] };
                    }
                }
            }
        }
        Gradients { components, rows, weights, laws, unstrained: Vec::new() }
    }

    /// The tangent of a piece in a state, functions in the order and sign of the basis.
    pub(super) fn tangent_of(&self, piece: &Piece<'_>, state: &BodyState) -> Result<DMatrix<f64>, StrainError> {
        let found = self.forces_of(piece, state, Order::Second).map_err(|(_, e)| e)?;
        Ok(found.tangent.unwrap_or_default())
    }

    fn points_in(&self, cell: usize, state: &BodyState) -> Result<CellPoints, StrainError> {
        let own = self.own(cell, &state.configuration);
        let at = self.gradients_in(cell, self.table(cell), state);
        let displacement = &at.rows * &own;
        let mut responses: Vec<Response> = Vec::with_capacity(at.weights.len());
        let mut dilatations: Vec<Response> = Vec::new();
        for q in 0..at.weights.len() {
            let f = at.deformation(q, &displacement);
            let (elastic, law) = &at.laws[q];
            if self.bodies.space == Space::PlaneStress {
                responses.push(law.plane_stress(elastic, &f, self.history.at(&state.internal, cell, q))?);
                continue;
            }
            law.check(&f)?;
            responses.push(law.deviatoric(elastic, &f, self.history.at(&state.internal, cell, q)));
            dilatations.push(law.dilatation(&f));
        }
        Ok(CellPoints { at, responses, dilatations })
    }

    /// # Errors
    /// A deformation that the law does not cover, with its cell.
    fn forces_of(
        &self,
        piece: &Piece<'_>,
        state: &BodyState,
        order: Order,
    ) -> Result<PieceForces, (usize, StrainError)> {
        let points = |(cell, _): &(u32, Window)| self.points_in(*cell as usize, state).map_err(|e| (*cell as usize, e));
        let mut cells = piece.cells.iter().map(points).collect::<Result<Vec<CellPoints>, _>>()?;
        let unknowns = piece.unknowns.len();
        let mut energy = 0.0;
        let mut tangent = (order == Order::Second).then(|| DMatrix::<f64>::zeros(unknowns, unknowns));
        if self.bodies.space != Space::PlaneStress {
            energy += self.add_pressure(piece, &mut cells, tangent.as_mut())?;
        }
        let mut forces = DVector::<f64>::zeros(unknowns);
        for (c, CellPoints { at, responses, .. }) in cells.iter().enumerate() {
            let count = at.components.len();
            let mut stress = DVector::<f64>::zeros(count * responses.len());
            for (q, response) in responses.iter().enumerate() {
                energy += at.weights[q] * response.energy;
                stress.rows_mut(q * count, count).copy_from(&(at.reduced(&response.stress) * at.weights[q]));
            }
            piece.add(c, &at.rows.tr_mul(&stress), &mut forces);
            let Some(tangent) = &mut tangent else { continue };
            let mut turned = DMatrix::<f64>::zeros(count * responses.len(), at.rows.ncols());
            for (q, response) in responses.iter().enumerate() {
                let own = DMatrix::from_fn(count, count, |r, c| {
                    at.weights[q] * response.tangent[(at.components[r], at.components[c])]
                });
                turned.rows_mut(q * count, count).copy_from(&(own * at.rows.rows(q * count, count)));
            }
            piece.add_square(c, &at.rows.tr_mul(&turned), tangent);
        }
        Ok(PieceForces { energy, forces, tangent })
    }

    /// The volumetric part: adds the pressure at each point to the stress and its derivative there, and what it changes with the
    /// dilatation to the tangent. Its energy.
    fn add_pressure(
        &self,
        piece: &Piece<'_>,
        cells: &mut [CellPoints],
        tangent: Option<&mut DMatrix<f64>>,
    ) -> Result<f64, (usize, StrainError)> {
        let weights: Vec<&[f64]> = cells.iter().map(|cell| cell.at.weights.as_slice()).collect();
        let projection = self.projection(piece, &weights);
        let fitted = |values: Vec<DVector<f64>>| match &projection {
            Some(fit) => fit.fitted(&values),
            None => values,
        };
        let of_points = |cell: &CellPoints| cell.dilatations.iter().map(|d| d.energy).collect::<Vec<f64>>().into();
        let theta: Vec<DVector<f64>> = fitted(cells.iter().map(of_points).collect());
        let mut energy = 0.0;
        let (mut slopes, mut curvatures) = (Vec::new(), Vec::new());
        for ((cell, theta), (number, _)) in cells.iter().zip(&theta).zip(piece.cells.iter()) {
            let mut own = [Vec::new(), Vec::new()];
            for (q, (elastic, law)) in cell.at.laws.iter().enumerate() {
                let found = law.volumetric(elastic, theta[q]).map_err(|e| (*number as usize, e))?;
                energy += cell.at.weights[q] * found[0];
                own.iter_mut().zip(&found[1..]).for_each(|(list, v)| list.push(*v));
            }
            let [slope, curvature] = own;
            slopes.push(DVector::from_vec(slope));
            curvatures.push(curvature);
        }
        if let Some(tangent) = tangent {
            let rows: Vec<DMatrix<f64>> = cells.iter().map(|cell| cell.at.changes(&cell.dilatations)).collect();
            if let Some(fit) = &projection {
                let change = fit.coefficients_by_unknown(piece, &rows);
                *tangent += change.tr_mul(&(fit.products(&curvatures) * &change));
            } else {
                for (c, (change, curvature)) in rows.iter().zip(&curvatures).enumerate() {
                    let mut weighted = change.clone();
                    for (q, mut row) in weighted.row_iter_mut().enumerate() {
                        row *= weights[c][q] * curvature[q];
                    }
                    piece.add_square(c, &change.tr_mul(&weighted), tangent);
                }
            }
        }
        let pressure = fitted(slopes);
        for (CellPoints { responses, dilatations, .. }, pressure) in cells.iter_mut().zip(&pressure) {
            for ((response, dilatation), p) in responses.iter_mut().zip(dilatations).zip(pressure.iter()) {
                response.stress += dilatation.stress * *p;
                response.tangent += dilatation.tangent * *p;
            }
        }
        Ok(energy)
    }
}
