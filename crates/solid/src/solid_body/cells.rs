//! Forces and tangent of cells from a stress law.
//!
//! `Π = Σ_q w_q (V(F_q) + U(θ_q))` with the dilatation `θ = P φ(F)`, projected on polynomials of one degree less as the
//! divergence is at small strain (Simo, Taylor & Pister 1985 for degree 1), or not at all. `P` is its own adjoint under the
//! weights `w`, so that the forces are `Σ w (V' + p φ') δF` with the pressure `p = P U'(θ)`, and the tangent adds
//! `Σ w U''(θ) (P φ' δF)²` to `V'' + p φ''`: symmetric, with an energy.

use super::SolidBody;
use super::spatial::spatial;
use crate::stiffness::{Table, pressures, projects};
use nalgebra::{DMatrix, DVector, Matrix3};
use rayon::prelude::*;
use signorini_fem::small::{determinant, inverse};
use signorini_material::law::{Response, StrainError, StressLaw, Tensor};
use signorini_material::{Elastic, Space};
use signorini_mechanics::{BodyError, BodyState, Contribution, Order};

/// Radii below this share of the size of the body are on the axis.
const ON_AXIS: f64 = 1e-12;

/// What a cell adds.
struct CellForces {
    energy: f64,
    forces: DVector<f64>,
    tangent: Option<DMatrix<f64>>,
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

    pub fn reduced(&self, tensor: &Tensor) -> DVector<f64> {
        DVector::from_iterator(self.components.len(), self.components.iter().map(|c| tensor[*c]))
    }
}

impl<const D: usize> SolidBody<D> {
    pub(super) fn integrated(&self, state: &BodyState, order: Order, out: &mut Contribution) -> Result<f64, BodyError> {
        let of = |cell: usize| self.cell(cell, state, order).map_err(|e| self.refused(cell, e));
        let found: Vec<Result<CellForces, BodyError>> = self.kept.par_iter().map(|cell| of(*cell)).collect();
        let mut energy = 0.0;
        for (cell, found) in self.kept.iter().zip(found) {
            let found = found?;
            let (unknowns, signs) = self.unknowns_of(*cell);
            energy += found.energy;
            for (a, k) in unknowns.iter().enumerate() {
                out.forces[*k as usize] += signs[a] * found.forces[a];
            }
            if let Some(tangent) = found.tangent {
                let n = unknowns.len();
                let values = (0..n * n).map(|k| tangent[(k / n, k % n)] * signs[k / n] * signs[k % n]).collect();
                out.blocks.push((unknowns, values));
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

    /// The projection of the dilatation at the points of a cell to those of a table, where there is one.
    pub(super) fn projection(&self, cell: usize, weights: &[f64], to: &Table) -> Option<DMatrix<f64>> {
        let body = self.body();
        let basis = body.dofs.basis(cell);
        if !projects(basis, &body.material, self.bodies.space) {
            return None;
        }
        self.fit(cell, weights, to)
    }

    /// The best fit by polynomials of one degree less, discontinuous from cell to cell: from values at the points of a cell to
    /// those at the points of a table.
    pub(super) fn fit(&self, cell: usize, weights: &[f64], to: &Table) -> Option<DMatrix<f64>> {
        let basis = self.body().dofs.basis(cell);
        let psi = pressures::<D>(basis, self.table(cell));
        let mut weighted = psi.clone();
        weighted.column_iter_mut().zip(weights).for_each(|(mut c, w)| c *= *w);
        let factor = (&weighted * psi.transpose()).cholesky()?;
        Some(pressures::<D>(basis, to).transpose() * factor.solve(&weighted))
    }

    /// The tangent of a cell in a state, functions in the order and sign of the basis.
    pub(super) fn tangent_of(&self, cell: usize, state: &BodyState) -> Result<DMatrix<f64>, StrainError> {
        Ok(self.cell(cell, state, Order::Second)?.tangent.unwrap_or_default())
    }

    fn cell(&self, cell: usize, state: &BodyState, order: Order) -> Result<CellForces, StrainError> {
        let unknowns = D * self.body().dofs.basis(cell).len();
        let own = self.own(cell, &state.configuration);
        let at = self.gradients_in(cell, self.table(cell), state);
        let displacement = &at.rows * &own;
        let points = at.weights.len();
        let count = at.components.len();
        let mut energy = 0.0;
        let mut responses: Vec<Response> = Vec::with_capacity(points);
        let mut dilatations: Vec<Response> = Vec::new();
        for q in 0..points {
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
        // Volumetric part: pressure at each point, and how it changes with the dilatation.
        let mut curvature = vec![0.0; points];
        let mut projection = None;
        if !dilatations.is_empty() {
            projection = self.projection(cell, &at.weights, self.table(cell));
            let phi = DVector::from_iterator(points, dilatations.iter().map(|d| d.energy));
            let theta = projection.as_ref().map_or(phi.clone(), |p| p * &phi);
            let mut pressure = DVector::<f64>::zeros(points);
            for q in 0..points {
                let (elastic, law) = &at.laws[q];
                let [value, slope, second] = law.volumetric(elastic, theta[q])?;
                energy += at.weights[q] * value;
                (pressure[q], curvature[q]) = (slope, second);
            }
            let pressure = projection.as_ref().map_or(pressure.clone(), |p| p * &pressure);
            for (q, (response, dilatation)) in responses.iter_mut().zip(&dilatations).enumerate() {
                response.stress += dilatation.stress * pressure[q];
                if order == Order::Second {
                    response.tangent += dilatation.tangent * pressure[q];
                }
            }
        }
        let mut stress = DVector::<f64>::zeros(count * points);
        for (q, response) in responses.iter().enumerate() {
            energy += at.weights[q] * response.energy;
            stress.rows_mut(q * count, count).copy_from(&(at.reduced(&response.stress) * at.weights[q]));
        }
        let forces = at.rows.tr_mul(&stress);
        if order == Order::First {
            return Ok(CellForces { energy, forces, tangent: None });
        }
        let mut turned = DMatrix::<f64>::zeros(count * points, unknowns);
        for (q, response) in responses.iter().enumerate() {
            let tangent = DMatrix::from_fn(count, count, |r, c| {
                at.weights[q] * response.tangent[(at.components[r], at.components[c])]
            });
            turned.rows_mut(q * count, count).copy_from(&(tangent * at.rows.rows(q * count, count)));
        }
        let mut tangent = at.rows.tr_mul(&turned);
        if !dilatations.is_empty() {
            let mut change = DMatrix::<f64>::zeros(points, unknowns);
            for (q, dilatation) in dilatations.iter().enumerate() {
                let row = at.rows.rows(q * count, count).tr_mul(&at.reduced(&dilatation.stress));
                change.row_mut(q).copy_from(&row.transpose());
            }
            let change = projection.as_ref().map_or(change.clone(), |p| p * &change);
            let mut weighted = change.clone();
            for (q, mut row) in weighted.row_iter_mut().enumerate() {
                row *= at.weights[q] * curvature[q];
            }
            tangent += change.tr_mul(&weighted);
        }
        Ok(CellForces { energy, forces, tangent: Some(tangent) })
    }
}
