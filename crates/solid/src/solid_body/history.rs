//! What a solid remembers: the history variables of its law at the quadrature points.
//!
//! The internal numbers of a state are the history at the start of its increment, so that every iterate of Newton's method, a
//! cut-back and a resumed run start from the same. Before the next increment they are renewed from the state that was reached.

use super::SolidBody;
use super::spatial::spatial;
use nalgebra::{DVector, Matrix3};
use rayon::prelude::*;
use signorini_geometry::Point;
use signorini_material::law::{Plastic, StressLaw};
use signorini_material::{Elastic, Space};
use signorini_mechanics::{BodyState, Constitution, PointValues, UnstableMaterial};

impl<const D: usize> SolidBody<D> {
    /// What the points of a cell of a law with history came to, with their weights; nothing of elastic laws.
    pub(super) fn plastic_points(&self, cell: usize, state: &BodyState) -> Vec<(f64, Plastic)> {
        let at = self.gradients_in(cell, self.table(cell), state);
        let displacement: DVector<f64> = &at.rows * self.own(cell, &state.configuration);
        let of = |(q, (elastic, law)): (usize, &(Elastic, StressLaw))| {
            let f: Matrix3<f64> = at.deformation(q, &displacement);
            let found = law.plastic(elastic, self.space(), &f, self.history.at(&state.internal, cell, q))?;
            Some((at.weights[q], found))
        };
        at.laws.iter().enumerate().filter_map(of).collect()
    }

    fn all_plastic_points(&self, state: &BodyState) -> Vec<Vec<(f64, Plastic)>> {
        (0..self.mesh().cell_count()).into_par_iter().map(|cell| self.plastic_points(cell, state)).collect()
    }
}

/// Lamé's constant over the shear modulus from which a body is nearly incompressible: a Poisson's ratio of 0.49.
const INCOMPRESSIBLE: f64 = 49.0;

impl<const D: usize> Constitution for SolidBody<D> {
    fn at(&self, state: &BodyState, x: &Point<3>) -> Option<PointValues> {
        self.state_at_point(state, x)
    }

    fn law_name(&self) -> Option<String> {
        Some(self.law().name())
    }

    fn is_nearly_incompressible(&self) -> bool {
        let (lambda, mu) = self.body().material.lame(Space::Solid);
        !self.law().is_small_strain() && lambda > INCOMPRESSIBLE * mu
    }

    fn is_inelastic(&self) -> bool {
        self.law().has_history()
    }

    fn renewed(&self, state: &BodyState) -> Vec<f64> {
        let history = self.all_plastic_points(state).into_iter().flatten().flat_map(|(_, point)| point.history);
        history.chain(self.thermal_of(state).iter().copied()).collect()
    }

    /// The first point of quadrature of an isotropic hyperelastic law that has lost its stability, cell by cell.
    fn unstable_material(&self, state: &BodyState) -> Option<UnstableMaterial> {
        if !matches!(self.law(), StressLaw::Rubber(_)) {
            return None;
        }
        let of = |cell: usize| {
            let table = self.table(cell);
            let at = self.gradients_in(cell, table, state);
            let displacement: DVector<f64> = &at.rows * self.own(cell, &state.configuration);
            (0..at.laws.len()).find_map(|q| {
                let (elastic, law) = &at.laws[q];
                let stretches = law.unstable(elastic, self.space(), &at.deformation(q, &displacement))?;
                let x = spatial(&self.body().mesh.position(cell, &table.map[q]));
                Some(UnstableMaterial { x, stretches })
            })
        };
        (0..self.mesh().cell_count()).into_par_iter().find_map_first(of)
    }

    fn dissipated(&self, state: &BodyState) -> f64 {
        self.all_plastic_points(state).iter().flatten().map(|(weight, point)| weight * point.dissipated).sum()
    }
}
