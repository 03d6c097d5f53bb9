//! Impacts: velocities that change at once where contacts close.
//!
//! With impulses `P` of the contacts, `M (v⁺ - v⁻) = Gᵀ P`, Newton's law `0 ≤ u_N⁺ + e u_N⁻ ⟂ P_N ≥ 0`, and Coulomb's law for
//! impulses, `|P_T| ≤ μ P_N`, against the slip `u_T⁺` (Moreau 1988). One law for all contacts at once would stop the last ball but one of
//! Newton's cradle. So rounds follow each other, as impacts do along a row of stiff balls: in each only contacts that close take part,
//! and those that would not rebound by their coefficient anyway; the velocities after it may close others (Smith, Kaufman, Vouga,
//! Tamstorf & Grinspun 2012). Contacts that close together rebound together, whatever their order.
//!
//! With friction Newton's law may add energy (Kane 1984). The coefficients of a round are then reduced, all alike, until it adds
//! none; without restitution it takes energy always.

use super::driven::Driven;
use super::masses::Masses;
use super::step::Forces;
use crate::body::BodyState;
use crate::increment_error::IncrementError;
use crate::rigid_system::complementarity::{Complementarity, Kind};
use crate::rigid_system::motion::Motion;
use crate::rigid_system::touching::{Id, Touching};
use crate::system::AssemblyError;
use nalgebra::{DMatrix, DVector};
use signorini_geometry::Vector;
use std::collections::BTreeSet;

/// Velocity of closing relative to the largest that is rounding.
const ROUNDING: f64 = 1e-11;
/// Rounds after which what still closes does not rebound.
const ROUNDS: usize = 1000;
/// Gain of energy, relative to all of it, that is rounding; and halvings of the interval of the coefficients.
const GAIN: f64 = 1e-13;
const HALVINGS: usize = 50;

/// What an impact came to.
pub struct Impact<'a> {
    pub velocities: Vec<f64>,
    /// Impulses of the contacts, and the energy that friction took from each.
    pub impulses: Forces,
    pub friction_work: Vec<(Id, f64)>,
    pub points: Vec<Touching<'a>>,
    /// Impulse and impulsive moment of each support on the bodies.
    pub supports: Vec<[Vector<3>; 2]>,
}

impl<'a> Motion<'a> {
    /// The impact of the contacts that are closed, where one closes further; none where none does. `calm` is the velocity below
    /// which nothing rebounds.
    ///
    /// # Errors
    /// Supports that cannot act, and impulses that are not found.
    pub(super) fn impact(
        &self,
        masses: &Masses,
        (bodies, velocities): (&[BodyState], &[f64]),
        driven: &Driven,
        (closed, calm): (&BTreeSet<Id>, f64),
    ) -> Result<Option<Impact<'a>>, IncrementError> {
        let twists = driven.at_start();
        let n = self.turns.len();
        let held = driven.held(self.system, bodies, false)?;
        let points: Vec<Touching<'a>> = self.named(bodies, &twists, closed).into_values().collect();
        let mut v = DVector::from_column_slice(velocities);
        let mut is_free = vec![true; n];
        for (held, rate) in held.single.iter().zip(&held.single_rates) {
            let (unknown, factor) = held.constraint.terms[0];
            is_free[unknown as usize] = false;
            v[unknown as usize] = -rate / factor;
        }
        let held_at_once = v.iter().zip(velocities).any(|(a, b)| a != b);
        let (blocks, rows) = self.rows(&points.iter().collect::<Vec<_>>(), &held.coupled);
        let mut driven_rates = DVector::zeros(rows.nrows());
        for (b, p) in blocks.iter().zip(&points) {
            driven_rates[b.first] = p.driven_gap;
            (1..b.rows).for_each(|i| driven_rates[b.first + i] = -p.axes[b.axes[i - 1]].dot(&p.driven));
        }
        let of_coupled = &blocks[points.len()..];
        of_coupled.iter().zip(&held.coupled_rates).for_each(|(b, rate)| driven_rates[b.first] = *rate);
        let speeds = |v: &DVector<f64>| &rows * v + &driven_rates;
        let scale = (rows.map(f64::abs) * v.map(f64::abs) + driven_rates.map(f64::abs)).amax();
        let closes = |u: &DVector<f64>, first: usize| u[first] < -ROUNDING * scale;
        let lacks = |u: &DVector<f64>| of_coupled.iter().any(|b| u[b.first].abs() > ROUNDING * scale);
        let first = speeds(&v);
        let any = blocks[..points.len()].iter().any(|b| closes(&first, b.first)) || lacks(&first);
        if !any && !held_at_once {
            return Ok(None);
        }

        let free: Vec<usize> = (0..n).filter(|k| is_free[*k]).collect();
        let mass = masses.matrix(self.system, bodies);
        let Some(factor) = mass.select_rows(&free).select_columns(&free).cholesky() else { return Err(unsolved()) };
        let by_impulse = factor.solve(&rows.select_columns(&free).transpose());
        let energy = |v: &DVector<f64>| 0.5 * v.dot(&(&mass * v));
        let restitution = |p: &Touching<'_>| self.contacts[p.id.contact].restitution;
        let mut sum = DVector::zeros(rows.nrows());
        let mut work = vec![0.0; points.len()];
        let before = DVector::from_column_slice(velocities);
        for round in 0..=ROUNDS {
            let u = speeds(&v);
            if !blocks[..points.len()].iter().any(|b| closes(&u, b.first)) && !lacks(&u) {
                break;
            }
            let is_last = round == ROUNDS;
            // Contacts of this round, with the velocities after which they rebound.
            let mut taken = Vec::new();
            let mut rebounds = Vec::new();
            for (k, (b, p)) in blocks.iter().zip(&points).enumerate() {
                let e = restitution(p);
                if is_last || e == 0.0 || closes(&u, b.first) {
                    taken.push(k);
                    let closing = (-u[b.first]).max(0.0);
                    rebounds.push(if is_last || e * closing <= calm { 0.0 } else { e * closing });
                }
            }
            taken.extend(points.len()..blocks.len());
            let solve = |share: f64| -> Option<(DVector<f64>, DVector<f64>)> {
                let mut own = Vec::new();
                let mut list = Vec::new();
                for k in &taken {
                    let mut b = blocks[*k];
                    list.extend(b.first..b.first + b.rows);
                    b.first = list.len() - b.rows;
                    // Friction that knows no pressure has no impulse.
                    if let Kind::Contact { law: Some(law), .. } = b.kind
                        && law.per_pressure().is_none()
                    {
                        let weight = points[*k].weight;
                        b.kind = Kind::Contact { law: None, weight };
                    }
                    own.push(b);
                }
                let across = rows.select_rows(&list).select_columns(&free);
                let moved = by_impulse.select_columns(&list);
                let w = &across * &moved;
                let w = (&w + w.transpose()) * 0.5;
                let mut q = DVector::from_iterator(list.len(), list.iter().map(|i| u[*i]));
                own.iter().zip(&rebounds).for_each(|(b, rebound)| q[b.first] -= share * rebound);
                let known = DVector::zeros(list.len());
                let found = Complementarity { blocks: own, w, q, known }.solve()?;
                let mut after = v.clone();
                free.iter().zip((moved * &found).iter()).for_each(|(k, d)| after[*k] += d);
                let mut impulses = DVector::zeros(rows.nrows());
                list.iter().zip(found.iter()).for_each(|(i, p)| impulses[*i] = *p);
                Some((after, impulses))
            };
            // Nothing that is driven has to give energy.
            let gains = |after: &DVector<f64>| driven_rates.amax() == 0.0 && energy(after) > (1.0 + GAIN) * energy(&v);
            let Some(mut found) = solve(1.0) else { return Err(unsolved()) };
            if gains(&found.0) {
                let (mut low, mut high) = (0.0, 1.0);
                let Some(least) = solve(0.0) else { return Err(unsolved()) };
                found = least;
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    match solve(middle) {
                        Some(next) if !gains(&next.0) => (low, found) = (middle, next),
                        _ => high = middle,
                    }
                }
            }
            let mean = (speeds(&v) + speeds(&found.0)) * 0.5;
            for (k, b) in blocks[..points.len()].iter().enumerate() {
                work[k] -= (1..b.rows).map(|i| found.1[b.first + i] * mean[b.first + i]).sum::<f64>();
            }
            v = found.0;
            sum += found.1;
        }
        let impulses = (blocks.iter().zip(&points))
            .map(|(b, p)| (p.id, std::array::from_fn(|k| if k < b.rows { sum[b.first + k] } else { 0.0 })))
            .collect();
        let rest: DVector<f64> = &mass * (&v - before) - rows.tr_mul(&sum);
        let mut supports = vec![[Vector::<3>::zeros(); 2]; self.system.supports.len()];
        for own in &held.single {
            let (unknown, factor) = own.constraint.terms[0];
            own.add_reaction(rest[unknown as usize] / factor, &mut supports);
        }
        of_coupled.iter().zip(&held.coupled).for_each(|(b, own)| own.add_reaction(sum[b.first], &mut supports));
        Ok(Some(Impact {
            velocities: v.as_slice().to_vec(),
            impulses,
            friction_work: points.iter().map(|p| p.id).zip(work).collect(),
            supports,
            points,
        }))
    }

    /// The velocity with which each of some points opens.
    pub(super) fn opening(&self, points: &[Touching<'_>], velocities: &[f64]) -> Vec<f64> {
        let own = |p: &Touching<'_>| {
            let terms = p.pair.unknowns.iter().zip(&p.pair.opening);
            p.driven_gap + terms.map(|(u, o)| o * velocities[*u as usize]).sum::<f64>()
        };
        points.iter().map(own).collect()
    }

    /// The largest acceleration that loads give by themselves.
    ///
    /// # Errors
    /// Loads that cannot act.
    pub(super) fn acceleration(&self, masses: &Masses, bodies: &[BodyState], time: f64) -> Result<f64, AssemblyError> {
        let loads = self.loads(bodies, time)?.forces;
        let Some(factor) = masses.matrix(self.system, bodies).cholesky() else { return Ok(0.0) };
        let found: DMatrix<f64> = factor.solve(&DMatrix::from_column_slice(loads.len(), 1, &loads));
        let size = |k: usize| if self.turns[k] { self.extent[k] } else { 1.0 };
        Ok((0..loads.len()).map(|k| (found[k] * size(k)).abs()).fold(0.0, f64::max))
    }
}

fn unsolved() -> IncrementError {
    let worst = Some("; no impulses were found for an impact".to_string());
    IncrementError::NotConverged { history: vec![f64::INFINITY], worst }
}

/// A vector of friction by its components.
pub fn in_space(point: &Touching<'_>, force: &[f64; 3]) -> Vector<3> {
    let axes = point.slip_axes();
    (1..point.rows()).map(|k| point.axes[axes[k - 1]] * force[k]).sum()
}
