//! Motion with inertia: what bodies weigh, and how they move in each increment.

use crate::plan::planner::Planner;
use crate::problem::units::ACCELERATION;
use crate::problem::{self, CaseError};
use signorini_geometry::Point;
use signorini_mechanics::contact::Part;
use signorini_mechanics::{AssemblyError, Dynamics, PlacedLoad, System, TimedLoad};
use std::sync::Arc;

use super::Wrong;

/// The name of the load that gravity is.
pub const GRAVITY: &str = "gravity";

/// How a system moves.
#[derive(Default)]
pub struct Motion {
    /// Of each increment; none of those in equilibrium.
    pub dynamics: Vec<Option<Dynamics>>,
}

impl Planner<'_> {
    /// What bodies weigh, gravity as loads, and how they move.
    pub(super) fn motion(&self, system: &mut System, steps: &[usize], wrong: &Wrong) -> Result<Motion, CaseError> {
        let problem = self.problem;
        let moves = problem.steps.iter().any(|step| step.dynamics.is_some());
        if !moves && problem.gravity.is_none() {
            return Ok(Motion::default());
        }
        for body in &system.bodies {
            system.masses.push(body.mass(&[]).map_err(|e| self.unprepared(&AssemblyError::from(e).into()))?);
        }
        for (body, mass) in system.bodies.iter().zip(&system.masses).filter(|_| moves) {
            if body.unknowns() > 0 && mass.is_none() {
                let name = body.name();
                let message = format!("`{name}` has no mass, so it cannot move with inertia");
                return Err(problem
                    .error(&problem.bodies[name], message)
                    .help("motion.free = { density = \"7800 kg/m^3\" }, or its `mass`"));
            }
        }
        if let Some(stated) = &problem.gravity {
            let field = self.vector_field(stated, ACCELERATION, wrong)?;
            for (body, mass) in system.masses.iter().enumerate() {
                let Some(mass) = mass else { continue };
                let field = Arc::clone(&field);
                let load = TimedLoad::Weight(Arc::new(move |t| field(&Point::<3>::zeros(), t)), Arc::new(mass.clone()));
                system.loads.push(PlacedLoad { name: GRAVITY.into(), part: Part { body, group: None }, load });
            }
        }
        let dynamics = |step: &usize| {
            let key = problem.steps.get(*step).and_then(|s: &problem::Step| s.dynamics.as_ref());
            key.map(|_| Dynamics { spectral_radius: 1.0, damping: [0.0; 2] })
        };
        Ok(Motion { dynamics: steps.iter().map(dynamics).collect() })
    }
}
