//! Rigid bodies that move with inertia: time stepping after Moreau (1988) and Jean (1999), of the second order between impacts.
//!
//! - `masses`: momenta, and velocities by the midpoint rule;
//! - `driven`: what is prescribed;
//! - `step`: a step without impacts; `impact`: velocities that change at once;
//! - `increment`: one after the other, to the end of an increment.
//!
//! Contact forces are the means of an increment: their impulses over its duration, impacts included.

mod driven;
mod impact;
mod increment;
mod masses;
mod step;

use super::motion::{Motion, Stepped};
use crate::body::{Body, BodyState};
use crate::dynamics::{Moved, Moving};
use crate::increment::IncrementResult;
use crate::increment_error::IncrementError;
use crate::system::{System, SystemState};
use increment::InTime;
use masses::Masses;
use nalgebra::DVector;
use signorini_geometry::Vector;

impl System {
    /// Rigid bodies at a time.
    pub(super) fn solve_rigid_in_time(
        &mut self,
        from: &SystemState,
        time: f64,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(SystemState, IncrementResult), IncrementError> {
        let (_, count) = self.numbering();
        let mut from = from.clone();
        if from.velocities.len() != count {
            from.velocities = self.bodies.iter().flat_map(|b| b.initial_velocity()).collect();
        }
        let motion = Motion::new(self, &from, time)?;
        let masses = Masses::new(self)?;
        let duration = time - from.time;
        let mut state = SystemState { time, ..from.clone() };
        let mut run = InTime::new(&motion, &masses);
        if duration > 0.0 {
            let moved = run.advance(&from, time, report)?;
            (state.bodies, state.velocities) = (moved.bodies, moved.velocities);
        }
        let loaded = run.loaded(&state.bodies, duration);
        let found = Stepped { step: Vec::new(), bodies: Vec::new(), loaded, reactions: Vec::new(), iterations: 0 };
        let contacts = 0..motion.contacts.len();
        let mean = if duration > 0.0 { 1.0 / duration } else { 0.0 };
        let (before, after) = (moving(&motion, &masses, &from), moving(&motion, &masses, &state));
        let inertia = before.iter().zip(&after).map(|(a, b)| ((a.momentum - b.momentum) * mean, None)).collect();
        let result = IncrementResult {
            iterations: run.so_far.iterations,
            history: run.so_far.history.clone(),
            sites: contacts.clone().map(|c| motion.sites(c, &state, (&found, &run.so_far))).collect(),
            support_forces: run.supports.iter().map(|own| own.map(|impulse| impulse * mean)).collect(),
            dissipated: contacts.map(|c| run.so_far.work(c)).collect(),
            unknowns: count,
            moved: Some(Moved { before, after, inertia, damped: 0.0 }),
            ..IncrementResult::default()
        };
        let memory = motion.memory(&found, &run.so_far);
        let values = self.contacts.iter().zip(&memory).flat_map(|(c, own)| c.as_points().map(|c| c.values(&own.0)));
        state.multipliers = values.flatten().collect();
        for (contact, own) in self.contacts.iter_mut().zip(memory) {
            if let Some(contact) = contact.as_points_mut() {
                (contact.law.kept, contact.memory) = own;
            }
        }
        Ok((state, result))
    }
}

/// Kinetic energy and momenta of each body.
fn moving(motion: &Motion<'_>, masses: &Masses, state: &SystemState) -> Vec<Moving> {
    let system = motion.system;
    let matrix = masses.matrix(system, &state.bodies);
    let momenta = &matrix * DVector::from_column_slice(&state.velocities);
    let of = |((body, own), first): ((&dyn Body, &BodyState), &u32)| {
        let modes = body.rigid_modes(own);
        let own = *first as usize..*first as usize + body.unknowns();
        let along = |k: usize| modes[k].iter().zip(&momenta.as_slice()[own.clone()]).map(|(m, p)| m * p).sum::<f64>();
        let twice: f64 = own.clone().map(|k| state.velocities[k] * momenta[k]).sum();
        let displaced = |k: &usize| !motion.turns[*k];
        Moving {
            mass: own.clone().filter(displaced).map(|k| matrix[(k, k)]).fold(0.0, f64::max),
            kinetic_energy: 0.5 * twice,
            momentum: Vector::<3>::from_fn(|i, _| along(i)),
            angular_momentum: Vector::<3>::from_fn(|i, _| along(3 + i)),
        }
    };
    system.bodies.iter().map(Box::as_ref).zip(&state.bodies).zip(&motion.first).map(of).collect()
}
