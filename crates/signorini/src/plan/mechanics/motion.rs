//! Motion with inertia: what bodies weigh, how fast they start, and how they move in each increment.

use super::{Numbers, Wrong};
use crate::plan::planner::Planner;
use crate::problem::units::{ACCELERATION, DENSITY, FREQUENCY, MASS_PER_LENGTH, TIME, VELOCITY};
use crate::problem::{self, Body, CaseError, List, Rope, Value};
use crate::report::Warning;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::contact::Part;
use signorini_mechanics::{AssemblyError, Contribution, Dynamics, Load, Order, PlacedLoad, System, TimedLoad};
use std::sync::Arc;

/// The name of the load that gravity is.
pub const GRAVITY: &str = "gravity";

/// How a system moves.
#[derive(Default)]
pub struct Motion {
    /// Of each increment; none of those in equilibrium.
    pub dynamics: Vec<Option<Dynamics>>,
    /// The error in time that each increment may add, where it is controlled.
    pub tolerance: Vec<Option<f64>>,
    /// Of all unknowns of the bodies where they begin to move.
    pub velocities: Vec<f64>,
}

/// The density of a body, where its key gives one, and its velocity.
fn stated(body: &Body) -> (Option<&Value>, Option<&List<Value>>) {
    match body {
        Body::Solid(own) => (own.density.as_ref(), own.velocity.as_ref()),
        Body::Cells(own) => (own.density.as_ref(), own.velocity.as_ref()),
        Body::Beam(own) => (own.density.as_ref(), own.velocity.as_ref()),
        Body::Rope(own) => (own.mass_per_length.as_ref(), own.velocity.as_ref()),
        Body::Membrane(_) | Body::Rigid(_) => (None, None),
    }
}

/// Distance relative to the size of a body over which velocities are compared: with it the error of a smooth field and rounding are
/// about the same.
const BESIDE: f64 = 1e-5;

/// How fast a field of velocities turns about a point, by central differences; not at all where it has no values beside it.
fn half_of_curl(field: &dyn Fn(&Point<3>) -> Vector<3>, x: &Point<3>, beside: f64) -> Vector<3> {
    let change = |along: usize| {
        let step = Vector::<3>::ith(along, beside);
        (field(&(x + step)) - field(&(x - step))) / (2.0 * beside)
    };
    let [x, y, z] = [0, 1, 2].map(change);
    let turning = Vector::<3>::new(y[2] - z[1], z[0] - x[2], x[1] - y[0]) * 0.5;
    if turning.iter().all(|v| v.is_finite()) { turning } else { Vector::<3>::zeros() }
}

impl Planner<'_> {
    /// The density of a body, if it has one.
    pub(super) fn density(&self, stated: Option<&Value>) -> Result<Option<f64>, CaseError> {
        stated.map(|value| self.reader.positive(value, DENSITY)).transpose()
    }

    /// The mass per length of a rope, if it has one.
    pub(super) fn mass_per_length(&self, key: &Rope) -> Result<Option<f64>, CaseError> {
        let mass =
            key.mass_per_length.as_ref().map(|value| self.reader.positive(value, MASS_PER_LENGTH)).transpose()?;
        if let Some(winch) = key.winch.as_ref().filter(|_| self.moves()) {
            let message = "a rope whose length changes cannot move with inertia";
            return Err(self.problem.error(winch, message).help("move a support of the rope in place of the winch"));
        }
        if let Some(pulleys) = key.pulleys.as_ref().filter(|_| self.moves()) {
            let message = "a rope that runs through points cannot move with inertia";
            return Err(self.problem.error(pulleys, message).help("let the rope run over rigid bodies"));
        }
        Ok(mass)
    }

    /// Whether a step moves with inertia.
    pub(super) fn moves(&self) -> bool {
        self.problem.steps.iter().any(|step| step.dynamics.is_some())
    }

    /// What bodies weigh, gravity as loads, and how they move.
    pub(super) fn motion(
        &self,
        numbers: &Numbers,
        system: &mut System,
        steps: &[usize],
        wrong: &Wrong,
        warnings: &mut Vec<Warning>,
    ) -> Result<Motion, CaseError> {
        let problem = self.problem;
        if !self.moves() {
            self.tell_unused(warnings);
            if problem.gravity.is_none() {
                return Ok(Motion::default());
            }
        }
        system.weigh(self.moves()).map_err(|e| self.unprepared(&e.into()))?;
        self.check_masses(numbers, system)?;
        self.add_gravity(system, wrong)?;
        let dynamics: Vec<Option<Dynamics>> =
            steps.iter().map(|step| self.dynamics(problem.steps.get(*step), system)).collect::<Result<_, _>>()?;
        let tolerance = steps.iter().map(|step| self.tolerance(problem.steps.get(*step))).collect::<Result<_, _>>()?;
        let velocities = if self.moves() { self.velocities(numbers, system, wrong)? } else { Vec::new() };
        Ok(Motion { dynamics, tolerance, velocities })
    }

    /// Every body that moves has a mass.
    fn check_masses(&self, numbers: &Numbers, system: &System) -> Result<(), CaseError> {
        let problem = self.problem;
        for (name, body) in problem.bodies.iter().filter(|_| self.moves()) {
            let Some(&k) = numbers.get(name) else { continue };
            if system.bodies[k].unknowns() == 0 || system.masses[k].is_some() {
                continue;
            }
            let (key, help) = match body {
                Body::Rope(_) => ("mass per length", "mass_per_length = \"0.1 kg/m\""),
                Body::Rigid(_) => ("mass", "motion.free = { density = \"7800 kg/m^3\" }, or its `mass`"),
                Body::Beam(beam) if matches!(beam.section, problem::Section::Stiffness(_)) => {
                    let message =
                        format!("`{name}` has no shape of its section, so it has no mass with which it could move");
                    return Err(problem
                        .error(body, message)
                        .help("section.circle or section.rectangle, with a material and a density"));
                }
                _ => ("density", "density = \"7800 kg/m^3\""),
            };
            let message = format!("`{name}` has no {key}, so it cannot move with inertia");
            return Err(problem.error(body, message).help(help));
        }
        Ok(())
    }

    /// Gravity as a load on each body with a mass.
    fn add_gravity(&self, system: &mut System, wrong: &Wrong) -> Result<(), CaseError> {
        let problem = self.problem;
        let Some(stated) = &problem.gravity else { return Ok(()) };
        let field = self.vector_field(stated, ACCELERATION, wrong)?;
        if system.masses.iter().all(Option::is_none) {
            return Err(problem
                .error(stated, "no body has a mass on which gravity could act")
                .help("give a body a `density` or `mass`"));
        }
        for (body, mass) in system.masses.iter().enumerate() {
            let Some(mass) = mass else { continue };
            let field = Arc::clone(&field);
            let at = Point::<3>::zeros();
            let load = TimedLoad::Weight(Arc::new(move |t| field(&at, t)), Arc::new(mass.clone()));
            system.loads.push(PlacedLoad { name: GRAVITY.into(), part: Part { body, group: None }, load });
        }
        Ok(())
    }

    /// The error in time that the increments of a step may add; none where it is not controlled.
    fn tolerance(&self, step: Option<&problem::Step>) -> Result<Option<f64>, CaseError> {
        let Some(stated) = step.and_then(|s| s.dynamics.as_ref()?.tolerance.as_ref()) else { return Ok(None) };
        if !(*stated > 0.0 && *stated < 1.0) {
            return Err(self
                .problem
                .error(stated, format!("a tolerance of {stated} is not between 0 and 1"))
                .help("0.01 is a good start: displacements are right to about a hundredth of the way"));
        }
        Ok(Some(*stated))
    }

    /// How bodies move in a step; none where it is one of equilibria.
    fn dynamics(&self, step: Option<&problem::Step>, system: &System) -> Result<Option<Dynamics>, CaseError> {
        let problem = self.problem;
        let Some(key) = step.and_then(|s| s.dynamics.as_ref()) else { return Ok(None) };
        if let Some(control) = step.and_then(|s| s.control.as_ref()).filter(|c| !matches!(c, problem::Control::Time(_)))
        {
            return Err(problem
                .error(control, "bodies that move with inertia move in time")
                .help("leave out `control`, or `dynamics`"));
        }
        let spectral_radius = key.spectral_radius.unwrap_or(1.0);
        if let Some(stated) = key.spectral_radius.as_ref().filter(|rho| !(0.0..=1.0).contains(*rho)) {
            return Err(problem
                .error(stated, format!("a spectral radius of {stated} is not between 0 and 1"))
                .help("1 damps nothing, 0.8 damps high frequencies a little, 0 at once"));
        }
        if !system.is_rigid() && system.bodies.iter().all(|body| body.is_rigid()) {
            return Err(problem
                .error(key, "a contact has a law or a method that rigid bodies in motion do not have")
                .help("Coulomb's friction without a viscous part, no compliance, no wear, and `method` left out"));
        }
        // Free flight has nothing to damp, and impacts have their restitution.
        if system.is_rigid()
            && let Some(stated) = &key.damping
        {
            return Err(problem
                .error(stated, "rigid bodies have no damping")
                .help("leave `damping` out; give contacts a `restitution` below 1"));
        }
        if let Some(stated) = key.spectral_radius.as_ref().filter(|rho| **rho < 1.0 && system.is_rigid()) {
            return Err(problem
                .error(stated, "rigid bodies move by the midpoint rule, which damps nothing")
                .help("leave it out"));
        }
        let turns = |k: &usize| system.masses[*k].as_ref().is_some_and(|m| !m.spins.is_empty());
        if let Some(stated) = key.spectral_radius.as_ref().filter(|rho| **rho < 1.0)
            && let Some(body) = (0..system.bodies.len()).find(turns)
        {
            let name = system.bodies[body].name();
            return Err(problem
                .error(stated, format!("`{name}` turns, and rotations are not damped by the method"))
                .help("spectral_radius = 1, or leave it out"));
        }
        let mut damping = [0.0; 2];
        if let Some(stated) = &key.damping {
            let one = |value: &Option<Value>, dimension| -> Result<f64, CaseError> {
                let Some(value) = value else { return Ok(0.0) };
                let found = self.reader.number(value, dimension)?;
                if !(found >= 0.0 && found.is_finite()) {
                    return Err(problem
                        .error(value, format!("damping of {found} is not possible"))
                        .help("give 0 or more"));
                }
                Ok(found)
            };
            damping = [one(&stated.mass, FREQUENCY)?, one(&stated.stiffness, TIME)?];
            // The rate of a force that turns with its body is no rate of strain.
            if let Some(value) = stated.stiffness.as_ref().filter(|_| damping[1] > 0.0)
                && let Some(body) = system.bodies.iter().find(|b| b.unknowns() > 0 && !b.is_linear())
            {
                let message = format!("`{}` is not linear, and its forces turn with it", body.name());
                return Err(problem.error(value, message).help("damp by `mass`, or by `spectral_radius` below 1"));
            }
        }
        Ok(Some(Dynamics { spectral_radius, damping, tells_error: key.tolerance.is_some() }))
    }

    /// The velocities of all unknowns with which bodies begin to move: the best fit of those that are stated.
    fn velocities(&self, numbers: &Numbers, system: &System, wrong: &Wrong) -> Result<Vec<f64>, CaseError> {
        let problem = self.problem;
        let mut momenta = Vec::new();
        for body in &system.bodies {
            let mut out = Contribution::new(body.unknowns());
            let name = body.name();
            if let Some(key) = problem.bodies.get(name).filter(|_| numbers.contains_key(name))
                && let (Some(density), Some(velocity)) = stated(key)
            {
                // Per volume, or per length of curves.
                let density = match key {
                    Body::Rope(rope) => self.mass_per_length(rope)?.unwrap_or_default(),
                    Body::Beam(beam) => self.section(beam)?.2.map_or(0.0, |mass| mass.mass),
                    _ => self.reader.positive(density, DENSITY)?,
                };
                let field = self.vector_field(velocity, VELOCITY, wrong)?;
                let load = Load::BodyForce(&|x| field(x, 0.0) * -density);
                body.load(None, &load, &body.start(), Order::First, &mut out)
                    .map_err(|e| self.unprepared(&AssemblyError::from(e).into()))?;
            }
            momenta.extend(out.forces);
        }
        if let Some(error) = wrong.take(self.problem) {
            return Err(error);
        }
        let mut out = if momenta.iter().all(|p| *p == 0.0) {
            momenta
        } else {
            system.velocities_of(&momenta).map_err(|e| self.unprepared(&e))?
        };
        let mut first = 0;
        for body in &system.bodies {
            // Rigid bodies know their velocities.
            out[first..].iter_mut().zip(body.initial_velocity()).for_each(|(v, own)| *v = own);
            let key = problem.bodies.get(body.name()).filter(|_| numbers.contains_key(body.name()));
            if let Some(velocity) = key.and_then(|key| stated(key).1) {
                let field = self.vector_field(velocity, VELOCITY, &Wrong::default())?;
                let beside = BESIDE * body.size();
                let turning = |x: &Point<3>| half_of_curl(&|x| field(x, 0.0), x, beside);
                body.turn_sections(&mut out[first..first + body.unknowns()], &turning);
            }
            first += body.unknowns();
        }
        Ok(out)
    }

    /// Says of keys of motion that nothing moves.
    fn tell_unused(&self, warnings: &mut Vec<Warning>) {
        for (name, body) in &self.problem.bodies {
            if stated(body).1.is_some() {
                let message = format!("the velocity of `{name}` has no effect: no step has `dynamics`");
                warnings.push(Warning::from(message));
            }
        }
    }
}
