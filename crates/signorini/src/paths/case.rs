//! A problem of paths that was read.

use crate::plan::paths::{PathPlan, Task, plan_paths};
use crate::problem::{CaseError, KeyPath, Problem};
use signorini_paths::PathError;

/// A problem of paths that was read.
pub struct PathCase {
    #[doc(hidden)]
    pub plan: PathPlan,
}

impl PathCase {
    /// # Errors
    /// What is wrong with the problem, and where.
    pub fn new(problem: &Problem) -> Result<Self, CaseError> {
        Ok(PathCase { plan: plan_paths(problem)? })
    }

    /// Reads a case from a text; files that its bodies name are looked for beside the file `name`. `overrides` are
    /// `KEY=VALUE` pairs.
    ///
    /// # Errors
    /// What is wrong with it, and where.
    pub fn parse(name: &str, text: &str, overrides: &[String]) -> Result<Self, CaseError> {
        Self::new(&crate::case::read(name, text, overrides)?)
    }

    /// Its title, or the name of its file.
    pub fn name(&self) -> &str {
        self.plan.head.problem.name()
    }

    /// How many paths it states.
    pub fn paths(&self) -> usize {
        match &self.plan.task {
            Task::Wrapping { paths, .. } => paths.len(),
            Task::Winding(list) => list.len(),
            Task::EulerEytelwein(list) => list.len(),
        }
    }

    pub(super) fn problem(&self) -> &Problem {
        &self.plan.head.problem
    }

    /// An error of a path at its table.
    pub(super) fn failed(&self, key: &KeyPath, name: &str, error: &PathError) -> CaseError {
        if let PathError::Inside { place, body, depth } = error
            && let Some(body) = self.plan.bodies.get(*body)
        {
            let message = format!("the {place} of the path `{name}` lies inside `{}`, {depth:.4e} deep", body.name);
            return self.problem().error(key, message).help("give a point outside of the body");
        }
        if let PathError::Crosses { body, depth, at } = error
            && let Some(body) = self.plan.bodies.get(*body)
        {
            let at = at.iter().map(|v| format!("{v:.4}")).collect::<Vec<_>>().join(", ");
            let message = format!("the path `{name}` passes through `{}`, {depth:.4e} deep at ({at})", body.name);
            return self.problem().error(key, message).help("`around` must name bodies in the order of the path");
        }
        self.problem().error(key, format!("the path `{name}`: {error}"))
    }
}
