//! From the statement to the model: every key looked up, every value read, every contradiction named.

mod arrays;
mod domain;
mod files;
mod head;
mod height;
pub(crate) mod history;
pub(crate) mod located;
pub mod mechanics;
pub mod membrane;
mod memory;
pub mod paths;
pub(crate) mod pieces;
mod placement;
pub(crate) mod planner;
pub mod reader;
pub(crate) mod rigid;
mod rigid_shape;
pub mod solid;
mod step;
mod surface;

use crate::problem::{Analysis, Body, CaseError, Problem, Space};
use planner::Planner;

pub use domain::Pieces;
pub use head::{Head, Size};
pub use located::LocatedExpression;
pub use membrane::MembranePlan;
pub use memory::{check_memory, memory_at_hand, memory_estimate, mesh_multigrid_estimate, multigrid_estimate};
pub use rigid::RigidBody;
pub use signorini_membrane::history::{Control, MethodChoice, PlannedIncrement};
pub use surface::Contact;

/// A problem that is ready to be solved.
pub enum Plan {
    Line(MembranePlan<1>),
    Plane(MembranePlan<2>),
    Mechanics(Box<mechanics::MechanicsPlan>),
}

/// Reads a problem into a plan.
///
/// # Errors
/// What is wrong with the problem, with its key.
pub fn plan(problem: &Problem) -> Result<Plan, CaseError> {
    if let Some(analysis) = problem.analysis.as_ref().filter(|a| **a != Analysis::Equilibrium) {
        return Err(problem.error(analysis, "paths are not solved for equilibrium"));
    }
    paths::none_of_paths(problem)?;
    if mechanics::is_system(problem) {
        return Ok(Plan::Mechanics(Box::new(Planner::new(problem)?.mechanics()?)));
    }
    if let Some(stability) = &problem.stability {
        return Err(problem.error(stability, "`stability` is not for membranes"));
    }
    if let Some(dynamics) = problem.steps.iter().find_map(|step| step.dynamics.as_ref()) {
        return Err(problem
            .error(dynamics, "membranes have no mass: they are solved for equilibrium")
            .help("leave `dynamics` out"));
    }
    if let Some(gravity) = &problem.gravity {
        return Err(problem
            .error(gravity, "membranes have no mass on which gravity could act")
            .help("state the weight as a load per area"));
    }
    match problem.space {
        Space::PlaneStrain | Space::PlaneStress | Space::ThreeD => Err(no_body_here(problem)),
        Space::Line | Space::Axisymmetric => Ok(Plan::Line(Planner::new(problem)?.membrane::<1>()?)),
        Space::Plane => Ok(Plan::Plane(Planner::new(problem)?.membrane::<2>()?)),
    }
}

/// Bodies with the cells of all solids halved, to estimate errors.
///
/// # Errors
/// Those of [`plan`].
pub(crate) fn halved(problem: &Problem) -> Result<Plan, CaseError> {
    let planner = Planner { halves: true, ..Planner::new(problem)? };
    Ok(Plan::Mechanics(Box::new(planner.mechanics()?)))
}

/// A case for bodies in space or in a plane that has none.
fn no_body_here(problem: &Problem) -> CaseError {
    if problem.bodies.values().any(|b| matches!(b, Body::Membrane(_))) {
        return problem
            .error(&problem.space, "this space is for solids, but the case has a membrane")
            .help("for membranes: space = \"line\", \"axisymmetric\" or \"plane\"");
    }
    problem.error(&problem.space, "no body deforms or moves").help("add a body, for example  [bodies.block.solid]")
}
