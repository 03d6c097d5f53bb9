//! Stability of an equilibrium: the second variation of the energy on what may move.
//!
//! A state is stable where the symmetric part of its tangent `K`, on the variations that supports admit, has no negative
//! eigenvalue. Contact that is closed counts as a constraint: its multipliers have as many negative pivots in the saddle point
//! matrix as there are, and penalties have none. Where friction sticks it is a constraint too; where it slips its force is
//! taken as given, as it follows the pressure along no potential (Nguyen 2000, Stability and nonlinear solid mechanics). So such
//! states may be stable all the same: a disturbance tells.
//!
//! Eigenvalues are those of `K v = θ S v`, with the stiffness of each unknown by itself as `S`: numbers without units.

use crate::admissible::Admissible;
use crate::increment_error::IncrementError;
use crate::points::Order;
use crate::system::{Assembled, System, SystemState};
use nalgebra::DMatrix;
use signorini_contact::Law;
use signorini_contact::law::Friction;
use signorini_solve::SolveError;
use signorini_solve::SymmetricMatrix;
use signorini_solve::ldlt::Ldlt;
use std::sync::Arc;

/// What is done with a state that is not stable.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unstable {
    /// It is disturbed, and what follows is followed to a state that is stable.
    #[default]
    Follow,
    /// It is told.
    Tell,
}

/// How stable a state is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stability {
    /// Negative eigenvalues of the tangent on what may move.
    pub negative_eigenvalues: usize,
    /// Of the unstable states at this time, how many were left behind on the way to this one.
    pub followed: usize,
    /// When stability was lost, if the last state was stable.
    pub critical_time: Option<f64>,
    /// The body that moves most as the first unstable state is left, by its number.
    pub body: Option<usize>,
    /// How it moves: by its unknowns, the largest of size 1.
    pub direction: Vec<f64>,
}

impl Stability {
    /// Takes over what was told of an earlier part of the same increment.
    pub fn since(&mut self, earlier: Stability) {
        self.followed += earlier.followed;
        if earlier.body.is_some() {
            (self.body, self.direction, self.critical_time) = (earlier.body, earlier.direction, earlier.critical_time);
        }
    }
}

/// A direction in which the energy falls.
#[derive(Clone, Debug)]
pub(crate) struct UnstableMode {
    /// Number of negative eigenvalues.
    pub negative: usize,
    /// The one nearest to zero.
    pub value: f64,
    /// Its eigenvector in the unknowns of the bodies, towards where the state came from.
    pub direction: Vec<f64>,
    /// The metric `S`.
    pub metric: Vec<f64>,
}

/// Eigenvalue below which a state is not stable: rounding of free motions makes less.
const NEUTRAL: f64 = 1e-13;
/// Stiffness of an unknown that has none, relative to the largest.
const SLACK: f64 = 1e-8;
/// Lanczos: most steps, and residual of an eigenvalue of the inverse relative to it that ends them.
const MOST_STEPS: usize = 60;
const CONVERGED: f64 = 1e-7;
/// What of the first vector is none of where the state came from.
const ELSEWHERE: f64 = 1e-6;

impl System {
    /// Whether states may be unstable: bodies that deform, and not by small strains alone, in equations that are factorised.
    pub(crate) fn may_be_unstable(&self, at: &SystemState) -> Result<bool, IncrementError> {
        let moves = self.bodies.iter().filter(|b| b.unknowns() > 0);
        Ok(moves.into_iter().any(|b| !b.is_rigid() && !b.is_linear()) && !self.is_iterative(at)?)
    }

    /// A direction in which the energy of a state falls to second order, as near as may be to where it came from; none where
    /// it is stable.
    ///
    /// # Errors
    /// Places that are not there.
    pub(crate) fn unstable_mode(
        &mut self,
        at: &SystemState,
        time: f64,
    ) -> Result<Option<UnstableMode>, IncrementError> {
        let out = self.with_given_friction(|system| system.assemble(at, time, Order::Second))?;
        let pencil = Pencil::new(self, out);
        // A pivot that is zero tells nothing.
        let Ok(factor) = Ldlt::factor(&pencil.shifted) else { return Ok(None) };
        let negative = factor.negative_eigenvalues().saturating_sub(pencil.multipliers);
        if negative == 0 {
            return Ok(None);
        }
        let toward: Vec<f64> = at.travel.iter().map(|t| -t).collect();
        let found = pencil.nearest_to_zero(&factor, &toward, -1.0)?;
        let Some((value, y)) = found.filter(|(value, _)| *value < -NEUTRAL) else { return Ok(None) };
        let direction = pencil.admissible.expand(&y)[..pencil.count].to_vec();
        Ok(Some(UnstableMode { negative, value, direction, metric: pencil.metric }))
    }

    /// The eigenvalue that tells how far a state is from the loss of stability: the least of a stable one, the negative one
    /// nearest to zero of an unstable one; none where nothing is known.
    ///
    /// # Errors
    /// Places that are not there.
    pub(crate) fn critical_eigenvalue(&mut self, at: &SystemState, time: f64) -> Result<Option<f64>, IncrementError> {
        if let Some(mode) = self.unstable_mode(at, time)? {
            return Ok(Some(mode.value));
        }
        let out = self.with_given_friction(|system| system.assemble(at, time, Order::Second))?;
        let pencil = Pencil::new(self, out);
        let Ok(factor) = Ldlt::factor(&pencil.shifted) else { return Ok(None) };
        Ok(pencil.nearest_to_zero(&factor, &at.travel, 1.0)?.map(|(value, _)| value))
    }

    /// What is done while friction that slips is a given force.
    fn with_given_friction<T>(&mut self, of: impl FnOnce(&Self) -> T) -> T {
        let stated: Vec<Option<Arc<Box<dyn Law>>>> = (self.contacts.iter_mut())
            .map(|contact| {
                let law = contact.friction_mut()?;
                let stated = Arc::new(law.take()?);
                *law = Some(Box::new(Given(Arc::clone(&stated))));
                Some(stated)
            })
            .collect();
        let found = of(self);
        for (contact, stated) in self.contacts.iter_mut().zip(stated) {
            if let (Some(law), Some(stated)) = (contact.friction_mut(), stated) {
                *law = None;
                *law = Arc::into_inner(stated);
            }
        }
        found
    }
}

/// Friction whose force does not follow the pressure.
#[derive(Debug)]
struct Given(Arc<Box<dyn Law>>);

impl Given {
    fn without_pressure(friction: Friction) -> Friction {
        Friction { by_pressure: [0.0; 2], ..friction }
    }
}

impl Law for Given {
    fn friction(&self, trial: [f64; 2], pressure: f64) -> Friction {
        Self::without_pressure(self.0.friction(trial, pressure))
    }
    fn friction_in_time(&self, trial: [f64; 2], pressure: f64, per_velocity: f64) -> Friction {
        Self::without_pressure(self.0.friction_in_time(trial, pressure, per_velocity))
    }
    fn utilisation(&self, traction: [f64; 2], pressure: f64) -> f64 {
        self.0.utilisation(traction, pressure)
    }
    fn per_pressure(&self) -> Option<[f64; 2]> {
        self.0.per_pressure()
    }
}

/// `K` and `S` on what may move, with the multipliers of contacts.
struct Pencil {
    admissible: Admissible,
    /// Unknowns of the bodies.
    count: usize,
    multipliers: usize,
    metric: Vec<f64>,
    /// `Tᵀ (K + εS) T`: what is free to move does not count.
    shifted: SymmetricMatrix,
}

impl Pencil {
    fn new(system: &System, mut out: Assembled) -> Self {
        let (_, count) = system.numbering();
        let size = out.residual.len() - out.coupled.len();
        let multipliers = size - count;
        out.tangent.without(|unknown| unknown as usize >= size);
        let matrix = out.tangent.matrix(size);
        let rows = matrix.row_sizes();
        let mut is_spin = vec![false; count];
        let (first, _) = system.numbering();
        for (body, first) in system.bodies.iter().zip(first) {
            body.spins().iter().flatten().for_each(|s| is_spin[(first + s) as usize] = true);
        }
        let mut most = [f64::MIN_POSITIVE; 2];
        (0..count).for_each(|k| most[usize::from(is_spin[k])] = most[usize::from(is_spin[k])].max(rows[k]));
        let metric: Vec<f64> = (0..count).map(|k| rows[k].max(SLACK * most[usize::from(is_spin[k])])).collect();
        let admissible = Admissible::new(size, &out.single, &out.coupled);
        out.single.clear();
        for (k, s) in metric.iter().enumerate() {
            out.tangent.add(k as u32, k as u32, NEUTRAL * s);
        }
        let symmetric = out.tangent.matrix(size).symmetric_part();
        let shifted = symmetric.transformed(admissible.columns, |k| &admissible.rows[k]);
        Pencil { admissible, count, multipliers, metric, shifted }
    }

    /// `Tᵀ S T y`.
    fn measure(&self, y: &[f64]) -> Vec<f64> {
        let mut v = self.admissible.expand(y);
        v.iter_mut().enumerate().for_each(|(k, v)| *v *= self.metric.get(k).copied().unwrap_or(0.0));
        self.admissible.gather(&v)
    }

    /// Of the eigenvalues of a sign the one nearest to zero, with its vector of size 1, by Lanczos' method for the inverse from
    /// what a direction has of it; none where there is none of this sign.
    fn nearest_to_zero(
        &self,
        factor: &Ldlt,
        toward: &[f64],
        sign: f64,
    ) -> Result<Option<(f64, Vec<f64>)>, SolveError> {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let unit = |v: &dyn Fn(usize) -> f64| {
            let mut y = self.admissible.coordinates(v);
            let size = dot(&y, &self.measure(&y)).sqrt();
            y.iter_mut().for_each(|y| *y = if size > 0.0 { *y / size } else { 0.0 });
            y
        };
        let given = unit(&|k| toward.get(k).copied().unwrap_or(0.0));
        let elsewhere = unit(&|k| self.metric.get(k).map_or(0.0, |m| (1.0 + k as f64 / self.count as f64) / m.sqrt()));
        let mut q: Vec<f64> = given.iter().zip(&elsewhere).map(|(a, b)| a + ELSEWHERE * b).collect();
        let mut basis: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
        let mut projected = DMatrix::<f64>::zeros(MOST_STEPS, MOST_STEPS);
        for step in 0..MOST_STEPS.min(self.admissible.columns) {
            let mut measured = self.measure(&q);
            let size = dot(&q, &measured).max(0.0).sqrt();
            if size == 0.0 || !size.is_finite() {
                return Ok(None);
            }
            q.iter_mut().chain(&mut measured).for_each(|v| *v /= size);
            let mut next = measured.clone();
            factor.solve(&mut next)?;
            basis.push((q, measured));
            for _ in 0..2 {
                for (k, (own, measured)) in basis.iter().enumerate() {
                    let share = dot(&next, measured);
                    projected[(k, step)] += share;
                    next.iter_mut().zip(own).for_each(|(n, o)| *n -= share * o);
                }
            }
            let rest = dot(&next, &self.measure(&next)).max(0.0).sqrt();
            let n = step + 1;
            let own = projected.view((0, 0), (n, n)).into_owned();
            let eigen = (0.5 * (&own + own.transpose())).symmetric_eigen();
            let outermost = (sign * &eigen.eigenvalues).imax();
            let value = eigen.eigenvalues[outermost];
            let vector = eigen.eigenvectors.column(outermost);
            let left = rest * vector[step].abs();
            if (sign * value > 0.0 && left < CONVERGED * value.abs()) || n == MOST_STEPS.min(self.admissible.columns) {
                if sign * value <= 0.0 {
                    return Ok(None);
                }
                let mut y = vec![0.0; self.admissible.columns];
                for (k, (own, _)) in basis.iter().enumerate() {
                    y.iter_mut().zip(own).for_each(|(y, o)| *y += vector[k] * o);
                }
                // The first vector says which way.
                if vector[0] < 0.0 {
                    y.iter_mut().for_each(|y| *y = -*y);
                }
                return Ok(Some((1.0 / value - NEUTRAL, y)));
            }
            q = next;
        }
        Ok(None)
    }
}
