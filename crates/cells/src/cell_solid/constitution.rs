//! A body of cells by its law: forces, history, and what is shown.

use super::CellSolid;
use crate::fields::PointState;
use crate::shapes::spatial;
use crate::stress_fit::Fit;
use nalgebra::{DMatrix, Matrix3};
use rayon::prelude::*;
use signorini_geometry::{Point, Vector};
use signorini_material::law::Plastic;
use signorini_material::{Space, StrainError, StressLaw, von_mises};
use signorini_mechanics::{BodyError, BodyState, Constitution, Contribution, Order, PointValues, UnstableMaterial};

/// Lamé's constant over the shear modulus from which a body is nearly incompressible: a Poisson's ratio of 0.49.
const INCOMPRESSIBLE: f64 = 49.0;

/// Part of a cell beside the material at which a point is on its boundary.
const BESIDE: f64 = 1e-9;

/// Stress and plastic strain of the cells of a law with history, as polynomials.
pub(super) struct Fitted<const D: usize>(Vec<(Fit<D>, DMatrix<f64>)>);

impl<const D: usize> CellSolid<D> {
    /// Adds forces and tangent of the cells of this process by the law; the energy.
    pub(super) fn integrated(&self, state: &BodyState, order: Order, out: &mut Contribution) -> Result<f64, BodyError> {
        let body = &self.body;
        let fictitious = self.fictitious.get_or_init(|| body.fictitious_of(&self.kept));
        let of = |(cell, fictitious): (&usize, &Option<DMatrix<f64>>)| {
            let cell = *cell;
            let own = body.own(cell, &state.configuration);
            let history = |q: usize| self.history.at(&state.internal, cell, q);
            let mut found = body.material_forces(cell, &own, &history, order == Order::Second)?;
            if let Some(fictitious) = fictitious {
                let own = nalgebra::DVector::from_vec(own);
                let forces = fictitious * &own;
                found.energy += 0.5 * forces.dot(&own);
                found.forces += forces;
                if let Some(tangent) = &mut found.tangent {
                    *tangent += fictitious;
                }
            }
            Ok(found)
        };
        let found: Vec<Result<_, StrainError>> = self.kept.par_iter().zip(fictitious).map(of).collect();
        let mut energy = 0.0;
        for (cell, found) in self.kept.iter().copied().zip(found) {
            let mut found = found.map_err(|e| self.refused(cell, &e))?;
            let unknowns = body.unknowns_of(cell);
            energy += found.energy;
            for (k, f) in unknowns.iter().zip(found.forces.iter()) {
                if !self.is_zero[*k as usize] {
                    out.forces[*k as usize] += f;
                }
            }
            if let Some(tangent) = &mut found.tangent {
                super::untie(&unknowns, &self.is_zero, tangent);
                // Symmetric: rows are columns.
                out.add_block(&unknowns, tangent.as_slice());
            }
        }
        Ok(energy)
    }

    fn refused(&self, cell: usize, error: &StrainError) -> BodyError {
        let body = self.name.clone();
        match error {
            StrainError::Inverted { .. } => BodyError::Inverted { body, cell },
            StrainError::Compressed { .. } => BodyError::Material { body, cell, message: error.to_string() },
        }
    }

    /// What the points of all cells of a law with history came to, with their weights; nothing of elastic laws.
    fn plastic_points(&self, state: &BodyState) -> Vec<Vec<(f64, Plastic)>> {
        if !self.body.law().has_history() {
            return Vec::new();
        }
        let of = |cell: usize| {
            let at = self.body.cell_points(cell);
            let own = self.body.own(cell, &state.configuration);
            let found = self.body.plastic_points(&at, &own, &|q| self.history.at(&state.internal, cell, q));
            at.weights.iter().copied().zip(found).collect()
        };
        (0..self.body.cells().len()).into_par_iter().map(of).collect()
    }

    /// The stresses of a law with history, from the points where they are known.
    pub(super) fn fitted(&self, state: &BodyState) -> Option<Fitted<D>> {
        let body = &self.body;
        if !body.law().has_history() {
            return None;
        }
        let of = |cell: usize| {
            let at = body.cell_points(cell);
            let own = body.own(cell, &state.configuration);
            let history = |q: usize| self.history.at(&state.internal, cell, q);
            let fit = Fit::new(body, cell, &at);
            let mut values = DMatrix::<f64>::from_element(at.x.len(), 10, f64::NAN);
            if let Ok(responses) = body.responses(&at, &own, &history) {
                let plastic = body.plastic_points(&at, &own, &history);
                for (q, (f, point)) in at.deformations(&own).iter().zip(&plastic).enumerate() {
                    let stress = body.cauchy_from(&at.x[q], f, &responses[q].stress, history(q));
                    (0..9).for_each(|c| values[(q, c)] = stress[(c / 3, c % 3)]);
                    values[(q, 9)] = point.history[0];
                }
            }
            let coefficients = fit.coefficients(&values);
            (fit, coefficients)
        };
        Some(Fitted((0..body.cells().len()).into_par_iter().map(of).collect()))
    }

    /// Displacement and stress at a point of a cell; the stress of a cell with little material is that of its neighbour.
    pub(super) fn shown_at(&self, fitted: Option<&Fitted<D>>, cell: usize, x: &Point<D>, u: &[f64]) -> PointState<D> {
        let Some(fitted) = fitted else { return self.body.shown_at(cell, x, u) };
        let mut out = self.body.state_at(cell, x, u);
        let (fit, coefficients) = &fitted.0[self.body.cells()[cell].stress_cell];
        let found = fit.at(coefficients, x);
        out.stress = Matrix3::from_fn(|i, j| found[3 * i + j]);
        // A fit may fall below zero where plastic strain begins.
        out.plastic_strain = found[9].max(0.0);
        out
    }

    /// The normal stresses integrated over the material of a cell: nominal ones at finite strain.
    pub(super) fn normal_stresses(&self, cell: usize, state: &BodyState) -> Vector<3> {
        let body = &self.body;
        let own = body.own(cell, &state.configuration);
        let at = body.cell_points(cell);
        let found = body.responses(&at, &own, &|q| self.history.at(&state.internal, cell, q)).unwrap_or_default();
        let of = |(w, r): (&f64, &signorini_material::law::Response)| {
            Vector::<3>::new(r.stress[0], r.stress[4], r.stress[8]) * *w
        };
        at.weights.iter().zip(&found).map(of).sum()
    }
}

impl<const D: usize> Constitution for CellSolid<D> {
    fn at(&self, state: &BodyState, x: &Point<3>) -> Option<PointValues> {
        let within = Point::<D>::from_fn(|i, _| x[i]);
        let cell = self.body.cell_at(&within).filter(|_| spatial(&within) == *x)?;
        // On the boundary but for rounding.
        let aside = BESIDE * self.body.bounds_of(cell).size().max();
        let moved = |k: usize, by: f64| Point::<D>::from_fn(|i, _| within[i] + if i == k { by } else { 0.0 });
        let near = (0..D).flat_map(|k| [moved(k, aside), moved(k, -aside)]);
        if !std::iter::once(within).chain(near).any(|p| self.body.region.contains(&p)) {
            return None;
        }
        let found = self.shown_at(self.fitted(state).as_ref(), cell, &within, &state.configuration);
        let displacement = spatial(&Point::<D>::from(found.displacement));
        Some(PointValues { displacement, von_mises: von_mises(&found.stress), temperature: None })
    }

    fn law_name(&self) -> Option<String> {
        Some(self.body.law().name())
    }

    fn is_nearly_incompressible(&self) -> bool {
        let (lambda, mu) = self.body.elastic().lame(Space::Solid);
        !self.body.law().is_small_strain() && lambda > INCOMPRESSIBLE * mu
    }

    fn is_inelastic(&self) -> bool {
        self.body.law().has_history()
    }

    fn renewed(&self, state: &BodyState) -> Vec<f64> {
        self.plastic_points(state).into_iter().flatten().flat_map(|(_, point)| point.history).collect()
    }

    /// The first point of quadrature of an isotropic hyperelastic law that has lost its stability, cell by cell.
    fn unstable_material(&self, state: &BodyState) -> Option<UnstableMaterial> {
        if !matches!(self.body.law(), StressLaw::Rubber(_)) {
            return None;
        }
        let of = |cell: usize| {
            let at = self.body.cell_points(cell);
            let deformations = at.deformations(&self.body.own(cell, &state.configuration));
            at.x.iter().zip(&deformations).find_map(|(x, f)| {
                let stretches = self.body.unstable_at(x, f)?;
                Some(UnstableMaterial { x: crate::shapes::spatial(x), stretches })
            })
        };
        (0..self.body.cells().len()).into_par_iter().find_map_first(of)
    }

    fn dissipated(&self, state: &BodyState) -> f64 {
        self.plastic_points(state).iter().flatten().map(|(weight, point)| weight * point.dissipated).sum()
    }
}
