//! The membrane of which the iteration on the shape is shown.

use crate::plan::{Plan, plan};
use crate::problem::Problem;
use signorini_membrane::problem::Membrane;

/// The membrane of a case in the plane.
pub fn membrane(problem: &Problem) -> Result<Membrane<2>, String> {
    match plan(problem).map_err(|e| e.one_line())? {
        Plan::Plane(plan) => Ok(plan.at(0.0)),
        _ => Err("a membrane in the plane is wanted".into()),
    }
}
