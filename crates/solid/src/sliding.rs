//! Newton's method for contacts that slide any way: gaps are measured where the bodies are.
//!
//! The equilibrium `K u - f - Σ λ ∂g(u) = 0` with `λ ≥ 0`, `g(u) ≥ 0`, `λ g = 0` is solved by sequential quadratic
//! programming: each step takes the gaps as linear around the displacement reached and the curvature `-Σ λ ∂²g` into the
//! stiffness, and solves that problem, active set and all, as with small sliding. With the exact second variations of the
//! gaps this is Newton's method, and converges quadratically (Robinson 1974).
//!
//! A step that neither lowers what is left of forces and gaps nor the energy with the violated gaps at the price of their
//! pressures (the exact penalty function of Han 1977) is halved.

use crate::contact::Contact;
use crate::model::{Circumstances, Model, StepError, System, reduced};
use crate::state::{Found, State};
use signorini_contact::{ActiveSet, ActiveSetError, Route, Softness, WeightedGap};
use signorini_solve::{SolveError, SymmetricMatrix};
use std::collections::HashMap;

/// Contact and number of a row: the same row at another displacement.
pub type Key = (usize, u32);

/// A state found: the displacement and the pressures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settled {
    /// Displacement of all unknowns of the bodies.
    pub u: Vec<f64>,
    /// Pressures by contact and number of the row.
    pub pressure: HashMap<Key, f64>,
}

const MOST_ITERATIONS: usize = 25;
const MOST_HALVINGS: i32 = 6;
/// Force relative to the largest of all, and gap relative to the displacement, that are left in the end.
const TOLERANCE: f64 = 1e-10;

/// What is left when the cuts of the faces move no more: they change integrals by the square of it.
const NEAR: f64 = 1e-3;

/// A displacement with the gaps around it, linear in the unknowns of the bodies.
struct Around {
    u: Vec<f64>,
    rows: Vec<(Key, WeightedGap)>,
    ends: Vec<usize>,
}

/// A solution of the problem around a displacement.
struct Step {
    u: Vec<f64>,
    pressure: HashMap<Key, f64>,
    soft: HashMap<Key, Softness>,
    solves: usize,
    route: Route,
}

impl<const D: usize> Model<D> {
    /// Solves with contacts that slide finitely, from the last state settled; on success that is the one found.
    pub(crate) fn solve_sliding(
        &mut self,
        now: &Circumstances<'_, D>,
        offset: &[f64],
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<State<D>, StepError> {
        let zero = || Settled { u: vec![0.0; self.bodies.unknowns()], pressure: HashMap::new() };
        let Settled { u, mut pressure } = self.settled.clone().unwrap_or_else(zero);
        let mut around = self.around(u, now, false)?;
        let mut history: Vec<f64> = Vec::new();
        let mut iterations = 0;
        let mut worst = 0;
        for iteration in 1..=MOST_ITERATIONS {
            let step = self.step(&around, &pressure, now, offset)?;
            iterations += step.solves;
            // The first step takes the prescribed displacements along and has nothing to compare with.
            let before = history.last().map(|rest| (*rest, self.merit(&around, &step, now)));
            let near = history.last().is_some_and(|rest| *rest < NEAR);
            let mut share = 1.0;
            let (reached, rest) = loop {
                let along = around.u.iter().zip(&step.u).map(|(a, b)| a + share * (b - a)).collect();
                let reached = self.around(along, now, near)?;
                let (rest, row) = self.rest(&reached, &step, now);
                worst = row;
                let fine = before.is_none_or(|(r, merit)| rest < r || self.merit(&reached, &step, now) < merit);
                if fine || share < 0.5f64.powi(MOST_HALVINGS) {
                    break (reached, rest);
                }
                share *= 0.5;
            };
            (around, pressure) = (reached, step.pressure);
            history.push(rest);
            if !report(iteration, rest) {
                return Err(StepError::Interrupted);
            }
            if !rest.is_finite() {
                break;
            }
            if rest <= TOLERANCE {
                let of = |key: &Key| pressure.get(key).copied().unwrap_or(0.0);
                let pressures: Vec<f64> = around.rows.iter().map(|(key, _)| of(key)).collect();
                let found = Found {
                    u: around.u.clone(),
                    gap: around.rows.iter().map(|(_, row)| row.at(&around.u)).collect(),
                    active: pressures.iter().map(|p| *p > 0.0).collect(),
                    pressure: pressures,
                    iterations,
                    route: step.route,
                    residuals: history,
                    rubbing: None,
                };
                self.settled = Some(Settled { u: around.u, pressure });
                return Ok(self.state(found, &now.load, &around.ends));
            }
        }
        let which = around.ends.iter().position(|end| worst < *end).unwrap_or(0);
        let first = if which == 0 { 0 } else { around.ends[which - 1] };
        let contact: &Contact<D> = &self.contacts[which];
        let place = contact.rows.get(worst - first).map(|_| contact.position(worst - first));
        let place = place.map_or(String::new(), |x| {
            let x: Vec<String> = x.iter().map(|v| format!("{v:.6}")).collect();
            format!("({})", x.join(", "))
        });
        Err(StepError::Newton {
            contact: contact.name.clone(),
            history,
            place,
            slides_off: self.slides_off(which).map(Box::new),
        })
    }

    /// Measures all gaps at a displacement.
    fn around(&mut self, u: Vec<f64>, now: &Circumstances<'_, D>, near: bool) -> Result<Around, StepError> {
        let ends = self.search(now, &u, near)?;
        let rows = (self.contacts.iter().enumerate())
            .flat_map(|(k, contact)| contact.rows.iter().map(move |row| ((k, row.node), row.clone())))
            .collect();
        Ok(Around { u, rows, ends })
    }

    /// Solves the problem around a displacement, with the curvature that the pressures before give.
    fn step(
        &mut self,
        around: &Around,
        pressure: &HashMap<Key, f64>,
        now: &Circumstances<'_, D>,
        offset: &[f64],
    ) -> Result<Step, StepError> {
        let mut cliques = Vec::new();
        for (k, contact) in self.contacts.iter().enumerate() {
            cliques.extend(contact.curvature(&|number| pressure.get(&(k, number)).copied().unwrap_or(0.0)));
        }
        let mut curvature = SymmetricMatrix::of_cliques(around.u.len(), &cliques);
        let Some(stiffness) = &self.reduced else { return Err(self.free_body(&[])) };
        let with = |curvature: &SymmetricMatrix| {
            stiffness.plus(&curvature.transformed(self.reduction.unknowns, |i| self.reduction.row(i)))
        };
        let mut symbolic = self.symbolic.clone();
        let mut factor = symbolic.factor(with(&curvature));
        if matches!(factor, Err(SolveError::NotPositiveDefinite { .. })) {
            // Far from the solution the curvature may outweigh the stiffness: without it the step still goes down.
            curvature = SymmetricMatrix::from_cliques::<Vec<u32>>(around.u.len(), &[]);
            factor = symbolic.factor(with(&curvature));
        }
        let factor = factor?;
        self.symbolic = symbolic;
        let relative: Vec<f64> = around.u.iter().zip(offset).map(|(u, c)| u - c).collect();
        let load: Vec<f64> = (now.load.iter())
            .zip(self.stiffness.multiply(offset))
            .zip(curvature.multiply(&relative))
            .map(|((f, k), g)| f - k + g)
            .collect();
        let load = self.reduction.restrict(&load);
        let rows: Vec<WeightedGap> = around.rows.iter().map(|(_, row)| reduced(row, &self.reduction, offset)).collect();
        let before = |key: &Key| pressure.get(key).is_some_and(|p| *p > 0.0);
        let start = around.rows.iter().enumerate().filter(|(_, (key, _))| before(key)).map(|(k, _)| k);
        let mut active = ActiveSet::starting_with(start);
        active.route = self.route;
        let (found, soft) = self
            .solve_enforced(&rows, &around.ends, &mut |_, _| true, &mut |soft, report| {
                active.solve(&System(&factor), &rows, soft, &self.springs, &load, report)
            })
            .map_err(|error| match self.check_held(&now.load) {
                // Nothing is found because there is nothing.
                Err(pulled) if error != ActiveSetError::Interrupted => pulled,
                _ => self.explained(error, &around.ends),
            })?;
        let keys = || around.rows.iter().map(|(key, _)| *key);
        Ok(Step {
            u: self.reduction.expand(&found.u, offset),
            pressure: keys().zip(found.pressure).filter(|(_, p)| *p > 0.0).collect(),
            soft: keys().zip(soft).collect(),
            solves: found.iterations,
            route: found.route,
        })
    }

    /// The energy, with violated gaps at twice the price of their pressures, and the energy of those that give way.
    fn merit(&self, around: &Around, step: &Step, now: &Circumstances<'_, D>) -> f64 {
        let ku = self.stiffness.multiply(&around.u);
        let energy: f64 = around.u.iter().zip(ku).zip(&now.load).map(|((u, ku), f)| u * (0.5 * ku - f)).sum();
        let most = step.pressure.values().fold(0.0f64, |m, p| m.max(*p));
        let of_row = |(key, row): &(Key, WeightedGap)| {
            let gap = row.at(&around.u);
            let soft = step.soft.get(key).copied().unwrap_or_default();
            if soft.compliance > 0.0 {
                return 0.5 * soft.compliance * (soft.shift - gap / soft.compliance).max(0.0).powi(2);
            }
            2.0 * step.pressure.get(key).copied().unwrap_or(0.0).max(0.1 * most) * (-gap).max(0.0)
        };
        energy + around.rows.iter().map(of_row).sum::<f64>()
    }

    /// The largest unbalanced force and the largest violation of a contact condition, relative; and the row of that.
    fn rest(&self, around: &Around, step: &Step, now: &Circumstances<'_, D>) -> (f64, usize) {
        let mut forces = self.stiffness.multiply(&around.u);
        let mut scale = forces.iter().chain(&now.load).fold(0.0f64, |m, f| m.max(f.abs()));
        forces.iter_mut().zip(&now.load).for_each(|(r, f)| *r -= f);
        let moved = around.u.iter().fold(0.0f64, |m, u| m.max(u.abs()));
        let (mut lack, mut worst) = (0.0f64, 0);
        for (k, (key, row)) in around.rows.iter().enumerate() {
            let pressure = step.pressure.get(key).copied().unwrap_or(0.0);
            for (unknown, c) in &row.terms {
                forces[*unknown as usize] -= c * pressure;
                scale = scale.max((c * pressure).abs());
            }
            let soft = step.soft.get(key).copied().unwrap_or_default();
            let open = row.at(&around.u) + soft.compliance * (pressure - soft.shift);
            let lacks = if pressure > 0.0 { open.abs() } else { (-open).max(0.0) } / row.weight;
            let relative = lacks / moved.max(1e-4 * self.contacts[key.0].slave.size());
            if relative > lack || relative.is_nan() {
                (lack, worst) = (relative, k);
            }
        }
        // Sums of forces cannot be better than the rounding of the displacement.
        let scale = scale.max(1e-5 * self.stiffness.largest() * moved).max(f64::MIN_POSITIVE);
        let unbalanced = self.reduction.restrict(&forces).iter().fold(0.0f64, |m, f| m.max(f.abs())) / scale;
        (if lack.is_nan() || unbalanced.is_nan() { f64::NAN } else { lack.max(unbalanced) }, worst)
    }
}
