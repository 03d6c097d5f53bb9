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

use crate::body::{Contribution, PlaceError};
use crate::dynamics::{Dynamics, Mass, SpinInertia, angular_velocity_after, momentum_by_spin};
use crate::increment::UNBALANCED;
use crate::increment_error::IncrementError;
use crate::part::Part;
use crate::points::Order;
use crate::system::{Assembled, AssemblyError, System, SystemState};
use nalgebra::{Rotation3, UnitQuaternion};
use signorini_geometry::{Matrix, Vector};
use signorini_solve::general::{Analysis, Entries};
use std::collections::BTreeMap;

/// Way of a difference of forces, relative to the size of the bodies: the middle of what rounding and curvature leave.
const DIFFERENCE: f64 = 1e-5;
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

    /// Rotation vector of the increment, and the rotation at its end.
    fn turned(&self, system: &System, state: &SystemState) -> (Vector<3>, Matrix<3>) {
        let now = system.bodies[self.body].orientation(&state.bodies[self.body], self.own.unknowns);
        let by = Rotation3::from_matrix_unchecked(now * self.rotation.transpose());
        (UnitQuaternion::from_rotation_matrix(&by).scaled_axis(), now)
    }
}

/// An increment in time on its way.
#[derive(Clone, Debug)]
pub struct TimeStep {
    pub(crate) size: f64,
    pub(crate) weights: Weights,
    /// What the mass is multiplied by in the tangent.
    factor: f64,
    /// What forces of bodies without damping are multiplied by: of unknowns with a mass, whose equation is one of means, and of
    /// those without, which are in equilibrium at the end.
    shares: [f64; 2],
    /// Known forces of all unknowns of bodies.
    known: Vec<f64>,
    turning: Vec<Turning>,
    /// Of each unknown.
    pub(crate) has_mass: Vec<bool>,
    pub(crate) velocities: Vec<f64>,
    pub(crate) accelerations: Vec<f64>,
    pub(crate) damping: [f64; 2],
}

/// The residual of equilibrium for the next increment: unknowns without a mass are in equilibrium.
fn out_of_balance(mut forces: Vec<f64>, has_mass: &[bool]) -> Vec<f64> {
    forces.iter_mut().zip(has_mass).filter(|(_, has)| !**has).for_each(|(f, _)| *f = 0.0);
    forces
}

impl System {
    /// Takes the masses of all bodies. Where they are to move, sides that contacts name carry none of their own.
    ///
    /// # Errors
    /// Sides that a body does not have.
    pub fn weigh(&mut self, moves: bool) -> Result<(), AssemblyError> {
        let parts: Vec<Part> = self.contacts.iter().filter(|_| moves).flat_map(|c| c.parts()).cloned().collect();
        let sides = |k: usize| -> Vec<Option<&str>> {
            parts.iter().filter(|part| part.body == k).map(|part| part.group.as_deref()).collect()
        };
        self.masses =
            (self.bodies.iter().enumerate()).map(|(k, body)| body.mass(&sides(k))).collect::<Result<_, _>>()?;
        Ok(())
    }

    /// The blocks of masses in the numbers of the system.
    fn mass_blocks<'a>(&self, masses: &'a [Option<Mass>]) -> impl Iterator<Item = (Vec<u32>, &'a [f64])> {
        let (first, _) = self.numbering();
        let own = masses.iter().zip(first).filter_map(|(mass, first)| Some((mass.as_ref()?, first)));
        own.flat_map(|(mass, first)| {
            let placed = move |unknowns: &Vec<u32>| unknowns.iter().map(|u| u + first).collect();
            mass.blocks.iter().map(move |(unknowns, values)| (placed(unknowns), values.as_slice()))
        })
    }

    /// Which unknowns of the bodies have a mass, or turn with one.
    fn has_mass(&self) -> Vec<bool> {
        let (first, count) = self.numbering();
        let mut out = vec![false; count];
        for (unknowns, values) in self.mass_blocks(&self.masses) {
            let diagonal = values.iter().step_by(unknowns.len() + 1);
            unknowns.iter().zip(diagonal).filter(|(_, m)| **m > 0.0).for_each(|(u, _)| out[*u as usize] = true);
        }
        for (mass, first) in self.masses.iter().zip(first) {
            let spins = mass.iter().flat_map(|m| &m.spins);
            spins.flat_map(|s| s.unknowns).for_each(|u| out[(first + u) as usize] = true);
        }
        out
    }

    /// Solves with the mass of displacements; unknowns without one give zero.
    fn by_mass(&self, masses: &[Option<Mass>], right: &[f64]) -> Result<Vec<f64>, IncrementError> {
        let count = right.len();
        let mut entries = Entries::default();
        let mut has_none = vec![true; count];
        for (unknowns, values) in self.mass_blocks(masses) {
            unknowns.iter().for_each(|u| has_none[*u as usize] = false);
            entries.add_block(&unknowns, values);
        }
        entries.hold(&has_none);
        let right: Vec<f64> = right.iter().zip(&has_none).map(|(r, none)| if *none { 0.0 } else { *r }).collect();
        Ok(Analysis::default().factor(entries.matrix(count))?.solve(&right)?)
    }

    /// Velocities of all unknowns of bodies from momenta by their whole mass.
    ///
    /// # Errors
    /// A mass that does not determine them.
    pub fn velocities_of(&self, momenta: &[f64]) -> Result<Vec<f64>, IncrementError> {
        let whole: Result<Vec<Option<Mass>>, PlaceError> = self.bodies.iter().map(|b| b.mass(&[])).collect();
        self.by_mass(&whole.map_err(AssemblyError::from)?, momenta)
    }

    /// A state from which bodies begin to move: velocities as they are, and the accelerations that follow with what holds at a time
    /// right after; whether it is one of equilibrium.
    fn begin_to_move(
        &self,
        state: &mut SystemState,
        (after, has_mass): (f64, &[bool]),
        [by_mass, by_stiffness]: [f64; 2],
    ) -> Result<bool, IncrementError> {
        let (_, count) = self.numbering();
        if state.velocities.is_empty() {
            state.velocities = vec![0.0; count];
        }
        let at = self.assemble(state, state.time, Order::First)?;
        let largest = at.sizes[..count].iter().copied().fold(0.0, f64::max);
        let mut forces = at.residual;
        forces.truncate(count);
        let damping = self.change_of_internal(state, by_stiffness)?;
        let mut right: Vec<f64> = forces.iter().zip(&damping).map(|(f, d)| -f - d).collect();
        for unknown in self.held_unknowns(state, after)? {
            (forces[unknown], right[unknown]) = (0.0, 0.0);
        }
        state.balancing = self.by_mass(&self.masses, &right)?;
        state.accelerations = state.balancing.iter().zip(&state.velocities).map(|(b, v)| b - by_mass * v).collect();
        let is_balanced = forces.iter().all(|f| f.abs() <= UNBALANCED * largest);
        state.forces = out_of_balance(forces, has_mass);
        Ok(is_balanced)
    }

    /// What the internal forces change in a time by the velocities of a state.
    fn change_of_internal(&self, state: &SystemState, time: f64) -> Result<Vec<f64>, IncrementError> {
        let (first, count) = self.numbering();
        let mut out = vec![0.0; count];
        let fastest = state.velocities.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        if time == 0.0 || fastest == 0.0 {
            return Ok(out);
        }
        let little = DIFFERENCE * self.size() / fastest;
        let step: Vec<f64> = state.velocities.iter().map(|v| little * v).collect();
        for (k, body) in self.bodies.iter().enumerate() {
            let own = first[k] as usize..first[k] as usize + body.unknowns();
            for sign in [1.0, -1.0] {
                let mut at = Contribution::new(body.unknowns());
                let moved = body.advance(&state.bodies[k], &step[own.clone()], sign);
                body.internal(&moved, Order::First, &mut at).map_err(AssemblyError::from)?;
                let factor = 0.5 * sign * time / little;
                out[own.clone()].iter_mut().zip(&at.forces).for_each(|(o, f)| *o += factor * f);
            }
        }
        Ok(out)
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
        let has_mass = self.has_mass();
        let mut weights = Weights::of_radius(dynamics.spectral_radius);
        if from.forces.is_empty() {
            let is_balanced = self.begin_to_move(from, (0.5 * (from.time + time), &has_mass), dynamics.damping)?;
            if !is_balanced && self.touches(from)? {
                weights = Weights::BACKWARD;
            }
        }
        let (first, count) = self.numbering();
        let size = time - from.time;
        // What is held moves as it is told to, from now on.
        for (unknown, [start, middle, end]) in self.prescribed(from, from.time, time)? {
            from.velocities[unknown] = (4.0 * middle - 3.0 * start - end) / size;
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
                let momentum = own.after(&turns.rotation) * turns.velocity * (-over / size);
                turns.unknowns().iter().zip(momentum.iter()).for_each(|(u, m)| known[*u as usize] += m);
                turning.push(turns);
            }
        }
        let [by_mass, by_stiffness] = dynamics.damping;
        let shares = [over, 1.0].map(|over| 1.0 + by_stiffness * over / size);
        if by_stiffness > 0.0 {
            for (body, (state, first)) in self.bodies.iter().zip(from.bodies.iter().zip(&first)) {
                let mut out = Contribution::new(body.unknowns());
                body.internal(state, Order::First, &mut out).map_err(AssemblyError::from)?;
                for (k, f) in (*first as usize..).zip(&out.forces) {
                    known[k] -= (shares[usize::from(!has_mass[k])] - 1.0) * f;
                }
            }
        }
        debug_assert_eq!(known.len(), count);
        Ok(TimeStep {
            size,
            weights,
            factor: factor + by_mass * over / size,
            shares,
            known,
            turning,
            has_mass,
            velocities: from.velocities.clone(),
            accelerations: from.accelerations.clone(),
            damping: dynamics.damping,
        })
    }

    /// Gives the state that ends an increment in time the velocities that it has then; the system at it, without inertia.
    pub(crate) fn end_time_step(&self, step: &TimeStep, state: &mut SystemState) -> Result<Assembled, AssemblyError> {
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
            let after = angular_velocity_after(&psi, &turns.velocity, h);
            turns.unknowns().iter().zip(after.iter()).for_each(|(u, v)| velocities[*u as usize] = *v);
        }
        // Without a mass nothing tells but the way.
        for (k, _) in step.has_mass.iter().enumerate().filter(|(_, has)| !**has) {
            velocities[k] = u[k] / h;
        }
        for (unknown, [start, middle, end]) in self.prescribed(state, state.time - h, state.time)? {
            velocities[unknown] = (start - 4.0 * middle + 3.0 * end) / h;
        }
        let count = velocities.len();
        (state.velocities, state.accelerations, state.balancing) = (velocities, accelerations, balancing);
        let at = self.assemble(state, state.time, Order::First)?;
        state.forces = out_of_balance(at.residual[..count].to_vec(), &step.has_mass);
        Ok(at)
    }

    /// The mean forces that Newton's method left in the state that ends an increment.
    pub(crate) fn unbalanced(&self, state: &SystemState) -> Result<Vec<f64>, AssemblyError> {
        let Some(step) = self.step.as_ref().filter(|step| step.conserves()) else { return Ok(Vec::new()) };
        let at = self.assemble(state, state.time, Order::First)?;
        let mut out: Vec<f64> =
            at.residual[..step.known.len()].iter().map(|r| r * (1.0 - step.weights.alpha_f)).collect();
        self.held_unknowns(state, state.time)?.into_iter().for_each(|unknown| out[unknown] = 0.0);
        Ok(out)
    }

    /// The unknowns that supports hold by themselves at a time.
    pub(crate) fn held_unknowns(&self, state: &SystemState, time: f64) -> Result<Vec<usize>, AssemblyError> {
        let (single, _) = self.held(&state.bodies, time)?;
        Ok(single.iter().map(|held| held.constraint.terms[0].0 as usize).collect())
    }
}

impl TimeStep {
    /// Displacements, and rotation vectors of what turns, from the start of the increment to a state.
    pub(crate) fn motion(&self, system: &System, state: &SystemState) -> Vec<f64> {
        let mut out = state.travel.clone();
        for turns in &self.turning {
            let (psi, _) = turns.turned(system, state);
            turns.unknowns().iter().zip(psi.iter()).for_each(|(u, p)| out[*u as usize] = *p);
        }
        out
    }

    /// Whether the method conserves the energy of linear bodies: that of all elastic ones is to be conserved then.
    pub(crate) fn conserves(&self) -> bool {
        self.weights == Weights::of_radius(1.0)
    }

    /// Multiplies the internal forces of a body, of which the first unknown is told, as the method does.
    pub(crate) fn scale(&self, first: u32, out: &mut Contribution) {
        out.scale(self.shares[0]);
        if self.shares[1] != self.shares[0] {
            out.scale_rows(|k| !self.has_mass[(first + k) as usize], self.shares[1] / self.shares[0]);
        }
    }

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
            let inertia = turns.own.after(&now);
            let after = angular_velocity_after(&psi, &turns.velocity, self.size);
            let momentum = inertia * after;
            let over = 1.0 / ((1.0 - self.weights.alpha_f) * self.size);
            turns.unknowns().iter().zip(momentum.iter()).for_each(|(u, m)| own[*u as usize] += over * m);
            if tangent.is_some() {
                let change = momentum_by_spin(&psi, &inertia, &after, self.size);
                blocks.push((turns.unknowns(), change * over));
            }
        }
        for k in 0..count {
            residual[k] += own[k];
            sizes[k] += own[k].abs();
        }
        let Some(tangent) = tangent else { return };
        for (unknowns, values) in system.mass_blocks(&system.masses) {
            let values: Vec<f64> = values.iter().map(|v| v * self.factor).collect();
            tangent.add_block(&unknowns, &values);
        }
        for (unknowns, change) in blocks {
            let values: Vec<f64> = (0..9).map(|k| change[(k / 3, k % 3)]).collect();
            tangent.add_block(&unknowns, &values);
        }
    }
}
