//! What moves: momenta, kinetic energy and inertia of bodies with a mass.

use crate::dynamics::Moving;
use crate::resultants::{dot, resultant};
use crate::system::{AssemblyError, System, SystemState};
use crate::time_step::TimeStep;
use signorini_geometry::Vector;

impl System {
    /// Momenta of displacements, times a factor.
    pub(crate) fn add_momenta(&self, velocities: &[f64], factor: f64, out: &mut [f64]) {
        let (first, _) = self.numbering();
        for ((mass, body), first) in self.masses.iter().zip(&self.bodies).zip(first) {
            let own = first as usize..first as usize + body.unknowns();
            if let Some(mass) = mass {
                mass.add_product(&velocities[own.clone()], factor, &mut out[own]);
            }
        }
    }

    /// The scalar product of two displacements, or velocities, with the mass.
    pub(crate) fn product_by_mass(&self, v: &[f64], w: &[f64]) -> f64 {
        let mut momenta = vec![0.0; v.len()];
        self.add_momenta(v, 1.0, &mut momenta);
        dot(&momenta, w)
    }

    /// Momenta of all unknowns in a state with these velocities.
    pub(crate) fn momenta(&self, state: &SystemState, velocities: &[f64]) -> Vec<f64> {
        let (first, count) = self.numbering();
        let mut out = vec![0.0; count];
        for (k, (body, first)) in self.bodies.iter().zip(first).enumerate().take(self.masses.len()) {
            let own = first as usize..first as usize + body.unknowns();
            out[own.clone()].copy_from_slice(&self.momenta_of(k, state, &velocities[own]));
        }
        out
    }

    /// Momenta of the unknowns of a body with these velocities.
    pub(crate) fn momenta_of(&self, body: usize, state: &SystemState, velocities: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; velocities.len()];
        let Some(mass) = &self.masses[body] else { return out };
        mass.add_product(velocities, 1.0, &mut out);
        for own in &mass.spins {
            let at = own.unknowns.map(|u| velocities[u as usize]);
            let rotation = self.bodies[body].orientation(&state.bodies[body], own.unknowns);
            let momentum = own.after(&rotation) * Vector::<3>::from(at);
            own.unknowns.iter().zip(momentum.iter()).for_each(|(u, m)| out[*u as usize] += m);
        }
        out
    }

    /// Kinetic energy and momenta of each body in a state; nothing of one at rest.
    pub fn moving(&self, state: &SystemState) -> Vec<Moving> {
        let (first, count) = self.numbering();
        if state.velocities.len() != count || self.masses.is_empty() {
            return vec![Moving::default(); self.bodies.len()];
        }
        let momenta = self.momenta(state, &state.velocities);
        let resultants = self.resultants_of(state, &momenta);
        let of = |(body, [momentum, angular_momentum]): (usize, [Vector<3>; 2])| {
            let own = first[body] as usize..first[body] as usize + self.bodies[body].unknowns();
            let twice = dot(&momenta[own.clone()], &state.velocities[own]);
            Moving { mass: self.mass_of(body, state), kinetic_energy: 0.5 * twice, momentum, angular_momentum }
        };
        resultants.into_iter().enumerate().map(of).collect()
    }

    /// The mass of a body: of an axisymmetric one along the axis.
    fn mass_of(&self, body: usize, state: &SystemState) -> f64 {
        let Some(mass) = &self.masses[body] else { return 0.0 };
        let modes = self.bodies[body].rigid_modes(&state.bodies[body]);
        let of = |mode: &Vec<f64>| {
            let mut momenta = vec![0.0; mode.len()];
            mass.add_product(mode, 1.0, &mut momenta);
            dot(&momenta, mode)
        };
        modes[..3].iter().map(of).fold(0.0, f64::max)
    }

    /// Resultants of the forces of inertia on the bodies at the end of an increment, and their moments about the origin; none of
    /// bodies that turn. They are what the other forces on what is free lack, with those of `damping` by stiffness, and `-M a` of
    /// what is held: accelerations are differences over the square of a time that may be short.
    pub(crate) fn inertia(
        &self,
        step: &TimeStep,
        state: &SystemState,
        damping: &[f64],
    ) -> Result<Vec<(Vector<3>, Option<Vector<3>>)>, AssemblyError> {
        let mut of_held = vec![0.0; state.forces.len()];
        self.add_momenta(&state.balancing, -1.0, &mut of_held);
        let mut forces: Vec<f64> = state.forces.iter().zip(damping).map(|(f, d)| f + d).collect();
        forces.iter_mut().zip(&step.has_mass).filter(|(_, has)| !**has).for_each(|(f, _)| *f = 0.0);
        self.held_unknowns(state, state.time)?.into_iter().for_each(|unknown| forces[unknown] = of_held[unknown]);
        let turns = |body: usize| self.masses.get(body).and_then(Option::as_ref).is_some_and(|m| !m.spins.is_empty());
        let all = self.resultants_of(state, &forces).into_iter().enumerate();
        Ok(all.map(|(body, [force, moment])| (force, (!turns(body)).then_some(moment))).collect())
    }

    /// Resultants of what acts on the unknowns, and their moments about the origin, by body.
    pub(crate) fn resultants_of(&self, state: &SystemState, forces: &[f64]) -> Vec<[Vector<3>; 2]> {
        let (first, _) = self.numbering();
        let of = |body: usize| {
            let (own, first) = (self.bodies[body].as_ref(), first[body] as usize);
            resultant(own, &state.bodies[body], &forces[first..first + own.unknowns()])
        };
        (0..self.bodies.len()).map(of).collect()
    }
}
