//! One increment in time by the generalised-α method (Chung and Hulbert 1993).
//!
//! | symbol | meaning |
//! |---|---|
//! | `r` | forces of the bodies less loads and contact forces: the residual of equilibrium |
//! | `u`, `v`, `a` | displacements since the last state, velocities, accelerations |
//! | `α_m`, `α_f`, `β`, `γ` | weights by the spectral radius `ρ` at high frequencies |
//!
//! `M ((1-α_m) a₁ + α_m a₀) + (1-α_f) r₁ + α_f r₀ = 0` with Newmark's `u = h v₀ + h² ((½-β) a₀ + β a₁)` and
//! `v₁ = v₀ + h ((1-γ) a₀ + γ a₁)`. Divided by `1-α_f` it is the equation of equilibrium at the end of the increment with
//! a stiffness `c M` and known forces more, and Newton's method for equilibria solves it. With `ρ = 1` nothing is damped.
//!
//! Unknowns without mass, as those of surfaces that touch (Khenous, Laborde and Renard 2008), are in equilibrium at the end of
//! each increment: forces of contact do not oscillate, and energy is not lost by impacts of single nodes.
//!
//! Angular momenta `π = R J Rᵀ ω` follow from moments by the same weights with `ρ = 1`; with the rotation vector `ψ` of the
//! increment `ω₁ = 2 ψ/h - exp(ψ) ω₀`. Free rotations then conserve angular momentum and energy: `ψ·(π₁ - π₀) = 0` as `exp(ψ)`
//! leaves `ψ` where it is (Simo and Wong 1991).

use crate::body::Contribution;
use crate::dynamics::{Dynamics, Mass, Moving, SpinInertia};
use crate::increment::UNBALANCED;
use crate::increment_error::IncrementError;
use crate::interaction::Assembler;
use crate::points::Order;
use crate::rotation;
use crate::site_result::SiteResult;
use crate::system::{AssemblyError, System, SystemState};
use nalgebra::{Rotation3, UnitQuaternion};
use signorini_contact::Status;
use signorini_geometry::{Matrix, Vector};
use signorini_solve::general::{Analysis, Entries};
use std::collections::BTreeMap;

/// Gap relative to the size of the bodies with which they touch.
const TOUCHES: f64 = 1e-9;

/// The weights of the method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    pub alpha_m: f64,
    pub alpha_f: f64,
    pub beta: f64,
    pub gamma: f64,
}

impl Weights {
    /// The first order, with all forces at the end.
    const BACKWARD: Weights = Weights { alpha_m: 0.0, alpha_f: 0.0, beta: 0.5, gamma: 1.0 };

    /// Those of a spectral radius at high frequencies.
    pub fn of_radius(rho: f64) -> Self {
        let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
        Weights { alpha_m, alpha_f, beta: 0.25 * (1.0 - alpha_m + alpha_f).powi(2), gamma: 0.5 - alpha_m + alpha_f }
    }
}

/// A section or rigid body that turns.
#[derive(Clone, Debug)]
struct Turning {
    body: usize,
    own: SpinInertia,
    first: u32,
    /// Rotation and angular velocity at the start of the increment.
    rotation: Matrix<3>,
    velocity: Vector<3>,
}

impl Turning {
    /// The numbers of its spins in the system.
    fn unknowns(&self) -> [u32; 3] {
        self.own.unknowns.map(|u| u + self.first)
    }

    fn inertia(&self, rotation: &Matrix<3>) -> Matrix<3> {
        rotation * self.own.inertia * rotation.transpose()
    }

    /// Rotation vector of the increment, and the rotation at its end.
    fn turned(&self, system: &System, state: &SystemState) -> (Vector<3>, Matrix<3>) {
        let now = system.bodies[self.body].orientation(&state.bodies[self.body], self.own.unknowns);
        let by = Rotation3::from_matrix_unchecked(now * self.rotation.transpose());
        (UnitQuaternion::from_rotation_matrix(&by).scaled_axis(), now)
    }

    /// The angular velocity at the end of an increment.
    fn velocity_after(&self, psi: &Vector<3>, size: f64) -> Vector<3> {
        psi * (2.0 / size) - rotation::turn(psi) * self.velocity
    }
}

/// An increment in time on its way.
#[derive(Clone, Debug)]
pub struct TimeStep {
    size: f64,
    weights: Weights,
    /// What the mass is multiplied by in the tangent.
    factor: f64,
    /// What forces of bodies without damping are multiplied by.
    pub(crate) share: f64,
    /// Known forces of all unknowns of bodies.
    known: Vec<f64>,
    turning: Vec<Turning>,
    velocities: Vec<f64>,
    accelerations: Vec<f64>,
    damping: [f64; 2],
}

impl System {
    /// Which unknowns of the bodies have a mass, or turn with one.
    fn has_mass(&self) -> Vec<bool> {
        let (first, count) = self.numbering();
        let mut out = vec![false; count];
        for (mass, first) in self.masses.iter().zip(first) {
            let Some(mass) = mass else { continue };
            for (unknowns, values) in &mass.blocks {
                let diagonal = values.iter().step_by(unknowns.len() + 1);
                unknowns
                    .iter()
                    .zip(diagonal)
                    .filter(|(_, m)| **m > 0.0)
                    .for_each(|(u, _)| out[(first + u) as usize] = true);
            }
            mass.spins.iter().flat_map(|s| s.unknowns).for_each(|u| out[(first + u) as usize] = true);
        }
        out
    }

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

    /// The residual of equilibrium of the unknowns of all bodies, with the reactions of supports that couple unknowns.
    fn forces(&self, state: &SystemState) -> Result<Vec<f64>, AssemblyError> {
        let (_, count) = self.numbering();
        let mut out = self.assemble(state, state.time, Order::First)?.residual;
        out.truncate(count);
        Ok(out)
    }

    /// Solves with the mass of all bodies; unknowns without one give zero.
    fn by_mass(&self, masses: &[Option<Mass>], right: &[f64]) -> Result<Vec<f64>, AssemblyError> {
        let (first, count) = self.numbering();
        let mut entries = Entries::default();
        let mut has = vec![false; count];
        for (mass, first) in masses.iter().zip(first) {
            for (unknowns, values) in mass.iter().flat_map(|m| &m.blocks) {
                let unknowns: Vec<u32> = unknowns.iter().map(|u| u + first).collect();
                unknowns.iter().for_each(|u| has[*u as usize] = true);
                entries.add_block(&unknowns, values);
            }
        }
        let mut right = right.to_vec();
        for k in (0..count).filter(|k| !has[*k]) {
            entries.add(k as u32, k as u32, 1.0);
            right[k] = 0.0;
        }
        let solved = Analysis::default().factor(entries.matrix(count)).and_then(|lu| lu.solve(&right));
        Ok(solved.unwrap_or_else(|_| vec![0.0; count]))
    }

    /// Velocities of all unknowns of bodies from momenta by their whole mass.
    ///
    /// # Errors
    /// Bodies whose mass is not known.
    pub fn velocities_of(&self, momenta: &[f64]) -> Result<Vec<f64>, AssemblyError> {
        self.by_mass(&self.whole_masses()?, momenta)
    }

    /// The masses of bodies with that of surfaces that may touch in its place.
    fn whole_masses(&self) -> Result<Vec<Option<Mass>>, AssemblyError> {
        Ok(self.bodies.iter().map(|b| b.mass(&[])).collect::<Result<_, _>>()?)
    }

    /// A state from which bodies begin to move: velocities as they are, and the accelerations that follow with what holds at a time
    /// right after; whether it is one of equilibrium.
    fn begin_to_move(&self, state: &mut SystemState, after: f64) -> Result<bool, AssemblyError> {
        let (_, count) = self.numbering();
        if state.velocities.is_empty() {
            state.velocities = vec![0.0; count];
        }
        let at = self.assemble(state, state.time, Order::First)?;
        let largest = at.sizes[..count].iter().copied().fold(0.0, f64::max);
        let mut forces = at.residual;
        forces.truncate(count);
        let (single, _) = self.held(&state.bodies, after)?;
        single.iter().for_each(|h| forces[h.constraint.terms[0].0 as usize] = 0.0);
        let right: Vec<f64> = forces.iter().map(|f| -f).collect();
        state.accelerations = self.by_mass(&self.masses, &right)?;
        state.balancing.clone_from(&state.accelerations);
        let is_balanced = forces.iter().all(|f| f.abs() <= UNBALANCED * largest);
        self.keep_forces(state, forces);
        Ok(is_balanced)
    }

    /// Keeps the residual of equilibrium of a state for the next increment, without that of unknowns without a mass, which are in
    /// equilibrium.
    fn keep_forces(&self, state: &mut SystemState, mut forces: Vec<f64>) {
        let has = self.has_mass();
        forces.iter_mut().zip(has).filter(|(_, has)| !has).for_each(|(f, _)| *f = 0.0);
        state.forces = forces;
    }

    /// Whether something touches in a state that begins to move. What it carries then is not known before it moves: the first
    /// increment takes all forces at its end.
    fn touches(&self, state: &SystemState) -> Result<bool, IncrementError> {
        let near = TOUCHES * self.size();
        for contact in 0..self.contacts.len() {
            let sites = self.sites_at_limit(contact, state)?;
            if sites.iter().any(|site| site.gap.is_some_and(|gap| gap < near)) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// What supports prescribe of single unknowns all along an increment, relative to a state: at its start, middle and end.
    fn prescribed(&self, at: &SystemState, start: f64, end: f64) -> Result<BTreeMap<usize, [f64; 3]>, AssemblyError> {
        let mut out: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        for time in [start, 0.5 * (start + end), end] {
            for held in self.held(&at.bodies, time)?.0 {
                let (unknown, factor) = held.constraint.terms[0];
                out.entry(unknown as usize).or_default().push(-held.constraint.violation / factor);
            }
        }
        Ok(out.into_iter().filter_map(|(unknown, values)| Some((unknown, values.try_into().ok()?))).collect())
    }

    /// The increment from a state to a time; `from` begins to move if it does not.
    pub(crate) fn time_step(
        &self,
        from: &mut SystemState,
        time: f64,
        dynamics: &Dynamics,
    ) -> Result<TimeStep, IncrementError> {
        let mut weights = Weights::of_radius(dynamics.spectral_radius);
        if from.forces.is_empty() {
            let is_balanced = self.begin_to_move(from, 0.5 * (from.time + time))?;
            if !is_balanced && self.touches(from)? {
                weights = Weights::BACKWARD;
            }
        }
        let (first, count) = self.numbering();
        let size = time - from.time;
        // What is held moves as it is told to, from now on.
        let [now, middle, end] = [from.time, from.time + 0.5 * size, time].map(|t| self.held(&from.bodies, t));
        for ((a, b), c) in now?.0.iter().zip(&middle?.0).zip(&end?.0) {
            let (unknown, factor) = a.constraint.terms[0];
            let [a, b, c] = [a, b, c].map(|h| -h.constraint.violation / factor);
            if a.is_finite() && b.is_finite() && c.is_finite() {
                from.velocities[unknown as usize] = (4.0 * b - 3.0 * a - c) / size;
            }
        }
        let Weights { alpha_m, alpha_f, beta, .. } = weights;
        let over = 1.0 / (1.0 - alpha_f);
        let factor = (1.0 - alpha_m) * over / (beta * size * size);
        let mut known: Vec<f64> = from.forces.iter().map(|f| f * alpha_f * over).collect();
        self.add_momenta(&from.velocities, -factor * size, &mut known);
        let of_acceleration = ((1.0 - alpha_m) * (1.0 - 2.0 * beta) / (2.0 * beta) - alpha_m) * over;
        self.add_momenta(&from.accelerations, -of_acceleration, &mut known);
        let mut turning = Vec::new();
        for (body, (mass, first)) in self.masses.iter().zip(&first).enumerate() {
            for own in mass.iter().flat_map(|m| &m.spins) {
                let at = own.unknowns.map(|u| from.velocities[(first + u) as usize]);
                let turns = Turning {
                    body,
                    own: own.clone(),
                    first: *first,
                    rotation: self.bodies[body].orientation(&from.bodies[body], own.unknowns),
                    velocity: Vector::<3>::from(at),
                };
                let momentum = turns.inertia(&turns.rotation) * turns.velocity * (-over / size);
                turns.unknowns().iter().zip(momentum.iter()).for_each(|(u, m)| known[*u as usize] += m);
                turning.push(turns);
            }
        }
        let [by_mass, by_stiffness] = dynamics.damping;
        let mut share = 1.0;
        if by_stiffness > 0.0 {
            share += by_stiffness * over / size;
            for (body, (state, first)) in self.bodies.iter().zip(from.bodies.iter().zip(&first)) {
                let mut out = Contribution::new(body.unknowns());
                body.internal(state, Order::First, &mut out).map_err(AssemblyError::from)?;
                let own = &mut known[*first as usize..*first as usize + body.unknowns()];
                own.iter_mut().zip(&out.forces).for_each(|(k, f)| *k -= (share - 1.0) * f);
            }
        }
        debug_assert_eq!(known.len(), count);
        Ok(TimeStep {
            size,
            weights,
            factor: factor + by_mass * over / size,
            share,
            known,
            turning,
            velocities: from.velocities.clone(),
            accelerations: from.accelerations.clone(),
            damping: dynamics.damping,
        })
    }

    /// A state that ends an increment in time, with the velocities that it has then.
    pub(crate) fn end_time_step(&self, step: &TimeStep, state: &mut SystemState) -> Result<(), AssemblyError> {
        let Weights { alpha_m, alpha_f, beta, gamma } = step.weights;
        let h = step.size;
        let u = &state.travel;
        let acceleration =
            |k: usize| (u[k] - h * step.velocities[k]) / (beta * h * h) - (0.5 / beta - 1.0) * step.accelerations[k];
        let accelerations: Vec<f64> = (0..u.len()).map(acceleration).collect();
        let balances = |k: usize| {
            let weighted = alpha_m * step.accelerations[k] + (1.0 - alpha_m) * accelerations[k];
            (weighted + step.damping[0] * u[k] / h - alpha_f * state.balancing[k]) / (1.0 - alpha_f)
        };
        let balancing: Vec<f64> = (0..u.len()).map(balances).collect();
        let velocity =
            |k: usize| step.velocities[k] + h * ((1.0 - gamma) * step.accelerations[k] + gamma * accelerations[k]);
        let mut velocities: Vec<f64> = (0..u.len()).map(velocity).collect();
        for turns in &step.turning {
            let (psi, _) = turns.turned(self, state);
            let after = turns.velocity_after(&psi, h);
            turns.unknowns().iter().zip(after.iter()).for_each(|(u, v)| velocities[*u as usize] = *v);
        }
        // Without a mass nothing tells but the way.
        for (k, _) in self.has_mass().iter().enumerate().filter(|(_, has)| !**has) {
            velocities[k] = u[k] / h;
        }
        for (unknown, [start, middle, end]) in self.prescribed(state, state.time - h, state.time)? {
            velocities[unknown] = (start - 4.0 * middle + 3.0 * end) / h;
        }
        (state.velocities, state.accelerations, state.balancing) = (velocities, accelerations, balancing);
        let forces = self.forces(state)?;
        self.keep_forces(state, forces);
        Ok(())
    }

    /// Momenta of all unknowns in a state with these velocities.
    fn momenta(&self, state: &SystemState, velocities: &[f64]) -> Vec<f64> {
        let (first, count) = self.numbering();
        let mut out = vec![0.0; count];
        self.add_momenta(velocities, 1.0, &mut out);
        for (body, (mass, first)) in self.masses.iter().zip(&first).enumerate() {
            for own in mass.iter().flat_map(|m| &m.spins) {
                let at = own.unknowns.map(|u| velocities[(first + u) as usize]);
                let rotation = self.bodies[body].orientation(&state.bodies[body], own.unknowns);
                let momentum = rotation * own.inertia * rotation.transpose() * Vector::<3>::from(at);
                own.unknowns.iter().zip(momentum.iter()).for_each(|(u, m)| out[(first + u) as usize] += m);
            }
        }
        out
    }

    /// Gives back to the velocities at the end of an increment the energy that contact took or gave as it closed or opened within
    /// it: surfaces that keep each other out do no work. What changes is the impulse of contact between the bodies, so momenta are
    /// conserved.
    pub(crate) fn restore_energy(
        &self,
        step: &TimeStep,
        start: &SystemState,
        state: &mut SystemState,
    ) -> Result<(), IncrementError> {
        let alpha_f = step.weights.alpha_f;
        let mut work = 0.0;
        for k in 0..self.contacts.len() {
            // What gives way stores or spends energy by its law.
            if self.contacts[k].law().friction.as_ref().is_some_and(|law| law.is_compliant() || law.is_bond()) {
                continue;
            }
            for (before, after) in self.sites(k, start)?.iter().zip(&self.sites(k, state)?) {
                let (Some(from), Some(to)) = (before.gap, after.gap) else { continue };
                let pressure = alpha_f * before.pressure + (1.0 - alpha_f) * after.pressure;
                work += pressure * after.weight * (to - from);
            }
        }
        let (first, count) = self.numbering();
        let kinetic = |v: &[f64], w: &[f64]| -> f64 { self.momenta(state, v).iter().zip(w).map(|(p, v)| p * v).sum() };
        let moving = kinetic(&state.velocities, &state.velocities);
        if work.abs() <= f64::EPSILON * moving {
            return Ok(());
        }
        // The velocities by an impulse like that of contact in the increment.
        let mut forces = vec![0.0; count];
        for at in [start, &*state] {
            for (contact, own) in self.contacts.iter().zip(self.own(at)) {
                let (mut residual, mut sizes) =
                    (vec![0.0; count + at.multipliers.len()], vec![0.0; count + at.multipliers.len()]);
                let mut target = Assembler { residual: &mut residual, sizes: &mut sizes, tangent: None };
                contact.add_to(self.bodies_in(at, &first), own, &mut target).map_err(AssemblyError::from)?;
                forces.iter_mut().zip(&residual).for_each(|(f, r)| *f -= r);
            }
        }
        let mut tangent = Entries::default();
        for (body, (own, first)) in self.bodies.iter().zip(state.bodies.iter().zip(&first)) {
            let mut out = Contribution::new(body.unknowns());
            body.internal(own, Order::Second, &mut out).map_err(AssemblyError::from)?;
            for (unknowns, values) in &out.blocks {
                let unknowns: Vec<u32> = unknowns.iter().map(|u| u + first).collect();
                tangent.add_block(&unknowns, values);
            }
        }
        let mut unused = [vec![0.0; count], vec![0.0; count]];
        let [residual, sizes] = &mut unused;
        step.add_to(self, state, (residual, sizes), Some(&mut tangent));
        let (single, _) = self.held(&state.bodies, state.time)?;
        let mut held = vec![false; count];
        single.iter().for_each(|h| held[h.constraint.terms[0].0 as usize] = true);
        tangent.without_rows(|row| held[row as usize]);
        for k in (0..count).filter(|k| held[*k]) {
            tangent.add(k as u32, k as u32, 1.0);
            forces[k] = 0.0;
        }
        let along = Analysis::default().factor(tangent.matrix(count)).and_then(|lu| lu.solve(&forces));
        let Ok(along) = along else { return Ok(()) };
        // ½ a s² + b s + work = 0, the smaller root; what cannot be given back stays.
        let (a, b) = (kinetic(&along, &along), kinetic(&state.velocities, &along));
        if a <= 0.0 {
            return Ok(());
        }
        let square = b * b - 2.0 * a * work;
        let share = if square < 0.0 { -b / a } else { -2.0 * work / (b + square.sqrt().copysign(b)) };
        state.velocities.iter_mut().zip(&along).for_each(|(v, w)| *v += share * w);
        Ok(())
    }

    /// What friction of each contact took in an increment, by its mean.
    pub(crate) fn rubbed(
        &self,
        step: &TimeStep,
        start: &SystemState,
        after: &[Vec<SiteResult>],
    ) -> Result<Vec<f64>, IncrementError> {
        let alpha_f = step.weights.alpha_f;
        let of = |(k, after): (usize, &Vec<SiteResult>)| {
            let before = self.sites(k, start)?;
            let one = |(a, b): (&SiteResult, &SiteResult)| {
                let mean = a.friction * alpha_f + b.friction * (1.0 - alpha_f);
                if b.status == Status::Open { 0.0 } else { -b.weight * mean.dot(&b.increment) }
            };
            Ok(before.iter().zip(after).map(one).sum())
        };
        after.iter().enumerate().map(of).collect()
    }

    /// The energy that damping, and the weights of the method, took from displacements in an increment, before energy is given back: of
    /// the equation times the displacements, all but the changes of the energies and the works of forces by their means.
    pub(crate) fn damped(
        &self,
        step: &TimeStep,
        start: &SystemState,
        state: &SystemState,
    ) -> Result<f64, IncrementError> {
        let Weights { alpha_m, alpha_f, .. } = step.weights;
        let u = &state.travel;
        let product = |v: &[f64]| -> f64 {
            let mut momenta = vec![0.0; v.len()];
            self.add_momenta(v, 1.0, &mut momenta);
            momenta.iter().zip(u).map(|(p, u)| p * u).sum()
        };
        let energy = |v: &[f64]| -> f64 {
            let mut momenta = vec![0.0; v.len()];
            self.add_momenta(v, 1.0, &mut momenta);
            0.5 * momenta.iter().zip(v).map(|(p, v)| p * v).sum::<f64>()
        };
        let ends = step.accelerations.iter().zip(&state.accelerations);
        let weighted: Vec<f64> = ends.map(|(a, b)| alpha_m * a + (1.0 - alpha_m) * b).collect();
        let mut damped = product(&weighted) - (energy(&state.velocities) - energy(&step.velocities));
        let uneven = 0.5 - alpha_f;
        if uneven != 0.0 {
            let change = state.forces.iter().zip(&start.forces).map(|(b, a)| b - a);
            damped += uneven * change.zip(u).map(|(f, u)| f * u).sum::<f64>();
            for k in 0..self.contacts.len() {
                for (before, after) in self.sites(k, start)?.iter().zip(&self.sites(k, state)?) {
                    if let (Some(from), Some(to)) = (before.gap, after.gap) {
                        damped += uneven * (after.pressure - before.pressure) * after.weight * (to - from);
                        damped += uneven * (after.friction - before.friction).dot(&after.increment) * after.weight;
                    }
                }
            }
        }
        let [by_mass, by_stiffness] = step.damping;
        damped += by_mass / step.size * product(u);
        if by_stiffness > 0.0 {
            let (first, _) = self.numbering();
            for (k, body) in self.bodies.iter().enumerate() {
                let mut out = [Contribution::new(body.unknowns()), Contribution::new(body.unknowns())];
                for (out, at) in out.iter_mut().zip([start, state]) {
                    body.internal(&at.bodies[k], Order::First, out).map_err(AssemblyError::from)?;
                }
                let own = &u[first[k] as usize..first[k] as usize + body.unknowns()];
                let change = out[1].forces.iter().zip(&out[0].forces).map(|(b, a)| b - a);
                damped += by_stiffness / step.size * change.zip(own).map(|(f, u)| f * u).sum::<f64>();
            }
        }
        Ok(damped)
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
            let twice: f64 = momenta[own.clone()].iter().zip(&state.velocities[own]).map(|(p, v)| p * v).sum();
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
            momenta.iter().zip(mode).map(|(p, v)| p * v).sum::<f64>()
        };
        modes[..3].iter().map(of).fold(0.0, f64::max)
    }

    /// The resultants of inertia at the end of an increment, by body.
    pub(crate) fn inertia(&self, state: &SystemState) -> Vec<(Vector<3>, Option<Vector<3>>)> {
        let (_, count) = self.numbering();
        let mut forces = vec![0.0; count];
        self.add_momenta(&state.balancing, -1.0, &mut forces);
        let turns = |body: usize| self.masses.get(body).and_then(Option::as_ref).is_some_and(|m| !m.spins.is_empty());
        let all = self.resultants_of(state, &forces).into_iter().enumerate();
        all.map(|(body, [force, moment])| (force, (!turns(body)).then_some(moment))).collect()
    }

    /// Resultants of what acts on the unknowns, and their moments about the origin, by body.
    fn resultants_of(&self, state: &SystemState, forces: &[f64]) -> Vec<[Vector<3>; 2]> {
        let (first, _) = self.numbering();
        let of = |body: usize| {
            let modes = self.bodies[body].rigid_modes(&state.bodies[body]);
            let own = first[body] as usize..first[body] as usize + self.bodies[body].unknowns();
            let along = |k: usize| modes[k].iter().zip(&forces[own.clone()]).map(|(m, p)| m * p).sum::<f64>();
            [Vector::<3>::from_fn(|i, _| along(i)), Vector::<3>::from_fn(|i, _| along(3 + i))]
        };
        (0..self.bodies.len()).map(of).collect()
    }
}

impl TimeStep {
    /// Adds inertia and damping by mass to the residual at a state, and to its tangent if there is one.
    pub(crate) fn add_to(
        &self,
        system: &System,
        state: &SystemState,
        (residual, sizes): (&mut [f64], &mut [f64]),
        tangent: Option<&mut Entries>,
    ) {
        let count = self.known.len();
        let mut own = self.known.clone();
        system.add_momenta(&state.travel, self.factor, &mut own);
        let mut blocks: Vec<([u32; 3], Matrix<3>)> = Vec::new();
        for turns in &self.turning {
            let (psi, now) = turns.turned(system, state);
            let inertia = turns.inertia(&now);
            let momentum = inertia * turns.velocity_after(&psi, self.size);
            let over = 1.0 / ((1.0 - self.weights.alpha_f) * self.size);
            turns.unknowns().iter().zip(momentum.iter()).for_each(|(u, m)| own[*u as usize] += over * m);
            if tangent.is_some() {
                let change =
                    inertia * rotation::of_spin(&psi).transpose() * (2.0 / self.size) - momentum.cross_matrix();
                blocks.push((turns.unknowns(), change * over));
            }
        }
        for k in 0..count {
            residual[k] += own[k];
            sizes[k] += own[k].abs();
        }
        let Some(tangent) = tangent else { return };
        let (first, _) = system.numbering();
        for (mass, first) in system.masses.iter().zip(first) {
            for (unknowns, values) in mass.iter().flat_map(|m| &m.blocks) {
                let unknowns: Vec<u32> = unknowns.iter().map(|u| u + first).collect();
                let values: Vec<f64> = values.iter().map(|v| v * self.factor).collect();
                tangent.add_block(&unknowns, &values);
            }
        }
        for (unknowns, change) in blocks {
            let values: Vec<f64> = (0..9).map(|k| change[(k / 3, k % 3)]).collect();
            tangent.add_block(&unknowns, &values);
        }
    }
}
