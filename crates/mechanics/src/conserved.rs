//! What internal forces of elastic bodies conserve at finite strain: energy and momenta.
//!
//! The mean of the internal forces at the ends of an increment does another work than the change of the stored energy, and has a
//! moment, by terms of third order in the size of the increment. Both are known exactly and are taken out of the velocities at its
//! end: the moment by velocities of a rigid motion, the work by a factor of the velocities relative to it. This is a projection on
//! what is conserved (Hairer, Lubich and Wanner 2006, §IV.4); the method stays of order two.

use crate::body::Body;
use crate::energy_in_time::{Solved, share};
use crate::resultants::dot;
use crate::system::{AssemblyError, SystemState};
use nalgebra::{Matrix6, Vector6};

/// Inertia of a motion relative to the largest that is none: of directions that a body in the plane does not move along.
const NO_INERTIA: f64 = 1e-12;

/// What the mean internal forces of a body did in an increment, and should not have done.
struct Errors {
    /// Work beside the change of the stored energy.
    work: f64,
    /// Impulses along the unit motions of the body.
    impulses: Vector6<f64>,
}

/// Velocities of a body by parts.
struct Parts {
    /// Those that take the impulses away.
    turned: Vec<f64>,
    /// Those relative to a rigid motion.
    relative: Vec<f64>,
}

impl Solved<'_> {
    /// Takes out of the velocities at the end what the internal forces of elastic bodies should not have done. `unbalanced` are the
    /// mean forces that Newton's method left.
    pub fn conserve(&self, state: &mut SystemState, unbalanced: &[f64]) -> Result<(), AssemblyError> {
        let system = self.system;
        let (first, _) = system.numbering();
        let held = system.held_unknowns(state, state.time)?;
        let motion = self.step.motion(system, state);
        state.owed.resize(system.bodies.len(), 0.0);
        for (k, body) in system.bodies.iter().enumerate() {
            let is_elastic = !body.is_rigid() && !body.is_linear() && !body.is_inelastic();
            if !is_elastic || system.masses[k].is_none() {
                continue;
            }
            let own = first[k] as usize..first[k] as usize + body.unknowns();
            let errors = self.errors(k, (&motion[own.clone()], &unbalanced[own.clone()]), state)?;
            let velocities = &state.velocities[own.clone()];
            let Parts { mut turned, relative } = if system.supports.iter().all(|s| s.part.body != k) {
                self.parts(k, velocities, &errors.impulses, state)
            } else {
                let mut relative = velocities.to_vec();
                held.iter().filter(|u| own.contains(u)).for_each(|u| relative[u - own.start] = 0.0);
                Parts { turned: velocities.to_vec(), relative }
            };
            let product = |v: &[f64], w: &[f64]| dot(&system.momenta_of(k, state, v), w);
            let turning = 0.5 * (product(&turned, &turned) - product(velocities, velocities));
            let work = state.owed[k] + errors.work + turning;
            let share = share(product(&relative, &relative), product(&turned, &relative), work);
            // More than the relative velocities themselves waits until they are larger.
            let share = share.filter(|share| share.abs() <= 1.0);
            turned.iter_mut().zip(&relative).for_each(|(v, r)| *v += share.unwrap_or(0.0) * r);
            state.owed[k] = if share.is_some() { 0.0 } else { work };
            state.velocities[own].copy_from_slice(&turned);
        }
        Ok(())
    }

    /// The errors of a body, of which the motion in the increment and the unbalanced forces are given.
    fn errors(
        &self,
        k: usize,
        (motion, unbalanced): (&[f64], &[f64]),
        state: &SystemState,
    ) -> Result<Errors, AssemblyError> {
        let body = self.system.bodies[k].as_ref();
        let [(energy, first), (energy_after, last)] = self.internal(k, state)?;
        let forces = |by_change: f64| -> Vec<f64> {
            let ends = first.iter().zip(&last);
            ends.zip(unbalanced).map(|((a, b), r)| 0.5 * (a + b) + by_change * (b - a) - r).collect()
        };
        let size = self.step.size;
        let damped = forces(self.step.damping[1] / size);
        let modes = [self.start, state].map(|at| body.rigid_modes(&at.bodies[k]));
        let along = |mode: usize| 0.5 * (dot(&damped, &modes[0][mode]) + dot(&damped, &modes[1][mode]));
        Ok(Errors {
            work: energy_after - energy - dot(&forces(0.0), motion),
            impulses: Vector6::from_fn(|mode, _| -size * along(mode)),
        })
    }

    /// The velocities of a body without impulses, and those relative to a rigid motion.
    fn parts(&self, k: usize, velocities: &[f64], impulses: &Vector6<f64>, state: &SystemState) -> Parts {
        let body: &dyn Body = self.system.bodies[k].as_ref();
        let mut modes = body.rigid_modes(&state.bodies[k]);
        // Turns with velocities of the size of those of translations.
        let size = body.size();
        modes[3..].iter_mut().flatten().for_each(|m| *m /= size);
        let impulses = Vector6::from_fn(|i, _| if i < 3 { impulses[i] } else { impulses[i] / size });
        let momenta: Vec<Vec<f64>> = modes.iter().map(|mode| self.system.momenta_of(k, state, mode)).collect();
        let inertia = Matrix6::from_fn(|i, j| 0.5 * (dot(&momenta[i], &modes[j]) + dot(&momenta[j], &modes[i])));
        let inverse = inertia.symmetric_eigen();
        let largest = inverse.eigenvalues.max();
        let solve = |right: Vector6<f64>| {
            let mut along = inverse.eigenvectors.transpose() * right;
            for (a, value) in along.iter_mut().zip(&inverse.eigenvalues) {
                *a = if *value > NO_INERTIA * largest { *a / value } else { 0.0 };
            }
            inverse.eigenvectors * along
        };
        let combined = |shares: &Vector6<f64>, k: usize| (0..6).map(|i| shares[i] * modes[i][k]).sum::<f64>();
        let (by, rigid) = (solve(impulses), solve(Vector6::from_fn(|i, _| dot(&momenta[i], velocities))));
        Parts {
            turned: velocities.iter().enumerate().map(|(k, v)| v - combined(&by, k)).collect(),
            relative: velocities.iter().enumerate().map(|(k, v)| v - combined(&rigid, k)).collect(),
        }
    }
}
