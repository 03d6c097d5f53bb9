//! Linear constraints of a system: which nodes, and by which factors.

use super::{Numbers, Wrong};
use crate::plan::planner::Planner;
use crate::problem::units::{LENGTH, NONE};
use crate::problem::{Body, CaseError, Space};
use crate::report::Warning;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::system::OfTime;
use signorini_mechanics::{ConstraintTerm, LinearConstraint, System};
use std::sync::Arc;

impl Planner<'_> {
    /// The constraints of the case.
    pub(super) fn linear_constraints(
        &self,
        numbers: &Numbers,
        system: &System,
        wrong: &Wrong,
    ) -> Result<Vec<LinearConstraint>, CaseError> {
        let problem = self.problem;
        let dimension = if self.space == Space::ThreeD { 3 } else { 2 };
        let mut out = Vec::new();
        for (name, key) in &problem.constraints {
            if key.terms.is_empty() {
                return Err(problem
                    .error(key, format!("the constraint `{name}` has no terms"))
                    .help("terms = [{ on = \"BODY:GROUP\", factor = [1, 0] }, …]"));
            }
            let mut terms = Vec::new();
            for term in &key.terms {
                let part = self.part(&term.on, numbers)?;
                let body = &system.bodies[part.body];
                if !matches!(problem.bodies.get(body.name()), Some(Body::Solid(_))) {
                    let message = format!("`{}` is no solid: constraints are between nodes of solids", body.name());
                    return Err(problem.error(&term.on, message));
                }
                let factor = if dimension == 3 {
                    Vector::<3>::from(self.reader.numbers::<3>(&term.factor, NONE)?)
                } else {
                    let [x, y] = self.reader.numbers::<2>(&term.factor, NONE)?;
                    Vector::<3>::new(x, y, 0.0)
                };
                if factor == Vector::<3>::zeros() {
                    return Err(problem.error(&term.factor, "all coefficients of the term are zero"));
                }
                let own = ConstraintTerm { part, factor };
                let zero: OfTime = Arc::new(|_| 0.0);
                let alone = LinearConstraint { name: name.clone(), terms: vec![own.clone()], value: zero };
                let first = vec![0; system.bodies.len()];
                alone
                    .equation((&system.bodies, &first), &system.start().bodies, 0.0)
                    .map_err(|error| self.misplaced(&term.on, &error))?;
                terms.push(own);
            }
            let value: OfTime = match &key.value {
                Some(value) => {
                    let (expression, _) = self.reader.any(value, self.variables())?;
                    if (0..3).any(|axis| expression.uses_position(axis)) {
                        let message = "the value of a constraint has no place";
                        return Err(problem.error(value, message).help("give a number, or an expression of t alone"));
                    }
                    let field = self.field(value, LENGTH, wrong)?;
                    Arc::new(move |t| field(&Point::<3>::zeros(), t))
                }
                None => Arc::new(|_| 0.0),
            };
            out.push(LinearConstraint { name: name.clone(), terms, value });
        }
        Ok(out)
    }

    /// Warns of constraints that follow from supports and other constraints.
    pub(super) fn tell_idle(&self, system: &System, warnings: &mut Vec<Warning>) -> Result<(), CaseError> {
        let idle = system.idle_constraints(0.0).map_err(|e| self.unprepared(&e.into()))?;
        for k in idle {
            let name = &system.constraints[k].name;
            let message =
                format!("the constraint `{name}` follows from supports and other constraints: it has no force");
            warnings.push(message.as_str().into());
        }
        Ok(())
    }
}
