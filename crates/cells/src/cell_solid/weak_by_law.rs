//! Places held by Nitsche's method where the stress is not linear in the displacement: for each component `d` that is held,
//! with the nominal traction `T = P N`,
//!
//! `-∫ (d·T(u)) (d·v) + ∫ γ (d·u - ū) (d·v)`.
//!
//! The adjoint term `-∫ (d·T'(u) v) (d·u - ū)` of the linear method is left out: its derivative would need that of the tangent.
//! It vanishes with `d·u - ū`, and without it the method is stable for `γ` a quarter of that of the linear one, so that `γ` at
//! rest allows for a material that stiffens four times and more.

use super::CellSolid;
use super::weak::WeakHold;
use crate::by_law::{CellPoints, Traction, traction};
use crate::cell::Site;
use crate::shapes::spatial;
use crate::space::Tabulation;
use crate::stress_fit::Fit;
use rayon::prelude::*;
use signorini_geometry::{Point, Vector};
use signorini_material::StrainError;
use signorini_material::law::Response;
use signorini_mechanics::{BodyState, Contribution, Direction, Function, Hold, Order, PlaceError};

/// Stresses of a cell of a law with history at its points.
struct Known<const D: usize> {
    at: CellPoints<D>,
    responses: Vec<Response>,
    fit: Fit<D>,
}

/// The terms of the points in a cell.
struct Terms {
    unknowns: Vec<u32>,
    forces: Vec<f64>,
    block: Vec<f64>,
    force: Vector<3>,
}

impl<const D: usize> CellSolid<D> {
    /// The nominal traction at a point by a cell of an elastic law.
    pub(super) fn traction_by_law(&self, cell: usize, point: &Site<D>, state: &BodyState) -> Option<Direction> {
        if self.body.law().has_history() {
            return None;
        }
        let found = self.body.traction_at(cell, point, Some(&state.configuration));
        let found = found.unwrap_or_else(|_| Traction { vector: Vector::<D>::repeat(f64::NAN), changes: Vec::new() });
        let mut out = Direction { vector: spatial(&Point::<D>::from(found.vector)), ..Direction::default() };
        for (unknown, change) in self.body.unknowns_of(cell).into_iter().zip(&found.changes) {
            if !self.is_zero[unknown as usize] {
                let value = spatial(&Point::<D>::from(*change));
                out.functions.push(Function { unknown, value, ..Function::default() });
            }
        }
        Some(out)
    }

    fn known(&self, cell: usize, state: &BodyState) -> Result<Known<D>, StrainError> {
        let at = self.body.cell_points(cell);
        let own = self.body.own(cell, &state.configuration);
        let responses = self.body.responses(&at, &own, &|q| self.history.at(&state.internal, cell, q))?;
        let fit = Fit::new(&self.body, cell, &at);
        Ok(Known { at, responses, fit })
    }

    /// Adds the terms of a place that is held; gives the force of the support.
    pub(super) fn add_terms_by_law(
        &self,
        terms: &WeakHold<D>,
        hold: &Hold<'_>,
        state: &BodyState,
        order: Order,
        out: &mut Contribution,
    ) -> Result<Vector<3>, PlaceError> {
        let components: Vec<usize> = (0..D).filter(|k| hold.displacement[*k].is_some()).collect();
        let field = |s: &Site<D>| -> [f64; D] {
            std::array::from_fn(|k| hold.displacement[k].map_or(0.0, |field| field(&spatial(&s.x))))
        };
        // Fields need not be shared between threads.
        let wanted: Vec<Vec<[f64; D]>> = terms.groups.iter().map(|g| g.sites.iter().map(field).collect()).collect();
        let found: Vec<Result<Terms, StrainError>> = (terms.groups.par_iter().zip(&wanted))
            .map(|(group, wanted)| self.terms_of(group, &components, wanted, state, order))
            .collect();
        let mut force = Vector::<3>::zeros();
        for found in found {
            // Where the law covers no such deformation the cell itself has none either.
            let found = found.map_err(|e| self.unsuitable(e.to_string()))?;
            for (unknown, f) in found.unknowns.iter().zip(&found.forces) {
                out.forces[*unknown as usize] += f;
            }
            force += found.force;
            if order == Order::Second {
                out.add_block(&found.unknowns, &found.block);
            }
        }
        Ok(force)
    }

    fn terms_of(
        &self,
        group: &super::weak::Group<D>,
        components: &[usize],
        wanted: &[[f64; D]],
        state: &BodyState,
        order: Order,
    ) -> Result<Terms, StrainError> {
        let (cell, stress_cell) = (group.rows.cell(), group.rows.stress_cell());
        let u = &state.configuration;
        let known = if self.body.law().has_history() { Some(self.known(stress_cell, state)?) } else { None };
        let unknowns = group.rows.unknowns.clone();
        let n = unknowns.len();
        let held = |k: usize| !self.is_zero[unknowns[k] as usize];
        let mut out = Terms {
            forces: vec![0.0; n],
            block: vec![0.0; if order == Order::Second { n * n } else { 0 }],
            force: Vector::<3>::zeros(),
            unknowns: unknowns.clone(),
        };
        let mut t = Tabulation::default();
        for (site, wanted) in group.sites.iter().zip(wanted) {
            let stress = match &known {
                Some(known) => traction(&known.at, &known.responses, &known.fit.shares(&site.x), &site.normal),
                None => self.body.traction_at(stress_cell, site, Some(u))?,
            };
            self.body.functions_at(cell, &site.x, &mut t);
            let moved = self.displacement(cell, &t, u).0;
            for &k in components {
                let force = site.weight * (group.gamma * (moved[k] - wanted[k]) - stress.vector[k]);
                out.force[k] -= force;
                for (f, value) in t.value.iter().enumerate() {
                    let row = D * f + k;
                    if !held(row) {
                        continue;
                    }
                    out.forces[row] += value * force;
                    if order == Order::First {
                        continue;
                    }
                    for (g, other) in t.value.iter().enumerate() {
                        if held(D * g + k) {
                            out.block[row * n + D * g + k] += site.weight * group.gamma * value * other;
                        }
                    }
                    for (place, change) in group.rows.places().iter().zip(&stress.changes) {
                        if held(*place) {
                            out.block[row * n + place] -= site.weight * value * change[k];
                        }
                    }
                }
            }
        }
        Ok(out)
    }
}
