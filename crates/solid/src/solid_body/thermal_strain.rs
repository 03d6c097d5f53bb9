//! Thermal strain: how the temperature of a state enters the strain that bears stress.
//!
//! At small strain `ε_e = ε - α (T - T_0) 1`, at finite strain `F_e = F/ϑ` with the stretch `ϑ = 1 + α (T - T_0)`, and the energy
//! per reference volume is `ϑ³ W(F_e)` (Lu and Pister, *Int. J. Solids Struct.* 11, 1975). In plane strain and around an axis this
//! concerns the strain across the plane too.
//!
//! The temperature has the degree of the displacement, one more than strains have. In each cell its thermal strain is projected
//! on polynomials of one degree less, as are dilatations: with degree 1 it is the mean of the cell. Otherwise stresses oscillate
//! within cells (Prathap and Naganarayana, *Comput. Struct.* 54, 1995).
//!
//! The internal numbers of a state are the history of the law, then the coefficients of the temperature, and of laws that are
//! linear the forces of thermal strain where nothing is displaced, with their energy: Newton's method does not compute them anew.

use super::SolidBody;
use super::cells::Gradients;
use super::spatial::spatial;
use crate::stiffness::Table;
use nalgebra::DVector;
use signorini_mechanics::{BodyState, Contribution, Order};

impl<const D: usize> SolidBody<D> {
    /// Internal numbers of the temperature at the start.
    pub(super) fn start_with_temperature(&self, mut history: Vec<f64>) -> BodyState {
        let configuration = vec![0.0; D * self.dofs().count()];
        let Some(own) = &self.heated else { return BodyState { configuration, internal: history } };
        history.resize(history.len() + self.thermal_numbers(), 0.0);
        let mut state = BodyState { configuration, internal: history };
        self.give_temperature(&mut state, &own.initial);
        state
    }

    /// Numbers that a state has beyond the history of the law.
    fn thermal_numbers(&self) -> usize {
        let (count, forces) = (self.dofs().count(), D * self.dofs().count() + 1);
        match &self.heated {
            Some(own) if self.law().is_linear() && own.material.expansion.is_some() => count + forces,
            Some(_) => count,
            None => 0,
        }
    }

    /// Those numbers of a state.
    pub(super) fn thermal_of<'a>(&self, state: &'a BodyState) -> &'a [f64] {
        let count = self.thermal_numbers().min(state.internal.len());
        &state.internal[state.internal.len() - count..]
    }

    pub(super) fn temperature_of<'a>(&self, state: &'a BodyState) -> &'a [f64] {
        let own = self.thermal_of(state);
        &own[..self.dofs().count().min(own.len())]
    }

    pub(super) fn give_temperature(&self, state: &mut BodyState, temperature: &[f64]) {
        let (count, numbers) = (self.dofs().count(), self.thermal_numbers());
        if numbers == 0 {
            return;
        }
        let first = state.internal.len() - numbers;
        state.internal[first..first + count].copy_from_slice(temperature);
        if numbers == count {
            return;
        }
        let at_rest = BodyState { configuration: vec![0.0; D * count], internal: state.internal.clone() };
        let mut out = Contribution::new(D * count);
        // A law that is linear covers all strains.
        let energy = self.integrated(&at_rest, Order::First, &mut out).unwrap_or(f64::NAN);
        state.internal[first + count..first + numbers - 1].copy_from_slice(&out.forces);
        state.internal[first + numbers - 1] = energy;
    }

    /// Forces of thermal strain of a law that is linear, and their energy, where nothing is displaced; none without expansion.
    pub(super) fn thermal_forces<'a>(&self, state: &'a BodyState) -> Option<(&'a [f64], f64)> {
        let own = self.thermal_of(state);
        let count = self.dofs().count();
        let (energy, forces) = own.get(count..)?.split_last()?;
        Some((forces, *energy))
    }

    /// Temperatures at the points of a table of a cell.
    pub(super) fn temperatures_at(&self, cell: usize, table: &Table, t: &[f64]) -> Vec<f64> {
        let list: Vec<(u32, f64)> = self.dofs().cell(cell).collect();
        let at = |value: &[f64]| list.iter().zip(value).map(|((f, sign), v)| sign * v * t[*f as usize]).sum();
        table.basis.iter().map(|basis| at(&basis.value)).collect()
    }

    /// Thermal strains at the points of a table of a cell; none without expansion.
    fn thermal_strains(&self, cell: usize, table: &Table, state: &BodyState) -> Option<DVector<f64>> {
        let material = &self.heated.as_ref()?.material;
        let expansion = material.expansion.as_ref()?;
        let t = self.temperature_of(state);
        let strains = |table: &Table| {
            let at = self.temperatures_at(cell, table, t).into_iter().zip(&table.map);
            let strain = |(t, map): (f64, _)| {
                expansion(&spatial(&self.body().mesh.position(cell, map))) * (t - material.stress_free)
            };
            DVector::from_vec(at.map(strain).collect())
        };
        let own = self.table(cell);
        let weights = self.gradients(cell, own).weights;
        Some(match self.fit_to(cell, &weights, table) {
            Some(fit) => fit * strains(own),
            None => strains(table),
        })
    }

    /// Gradients at the points of a table, as thermal strain at the temperature of a state leaves them to the law.
    pub(super) fn gradients_in(&self, cell: usize, table: &Table, state: &BodyState) -> Gradients {
        let mut at = self.gradients(cell, table);
        let Some(strains) = self.thermal_strains(cell, table, state) else { return at };
        let count = at.components.len();
        if self.law().is_small_strain() {
            at.unstrained = strains.iter().map(|strain| 1.0 - strain).collect();
            return at;
        }
        for (q, strain) in strains.iter().enumerate() {
            let stretch = 1.0 + strain;
            at.rows.rows_mut(q * count, count).scale_mut(1.0 / stretch);
            at.weights[q] *= stretch.powi(3);
            at.unstrained.push(1.0 / stretch);
        }
        at
    }
}
