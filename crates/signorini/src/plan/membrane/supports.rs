//! Reads what holds a membrane.

use super::PlannedSupport;
use crate::plan::domain::Pieces;
use crate::plan::pieces::UNITE;
use crate::plan::planner::Planner;
use crate::problem::units::LENGTH;
use crate::problem::{CaseError, Components, Problem, Value, suggestion};
use crate::report::Warning;
use std::collections::BTreeSet;

/// The value of a key that could be a vector elsewhere.
fn one<'p>(problem: &Problem, key: &'p Components) -> Result<&'p Value, CaseError> {
    match &key.0[..] {
        [value] => Ok(value),
        _ => Err(problem
            .error(key, "the displacement of a membrane is one number")
            .help("write for example  displacement = 0.0")),
    }
}

impl Planner<'_> {
    pub(super) fn supports(&self, body: &str, pieces: &Pieces) -> Result<Vec<PlannedSupport>, CaseError> {
        let problem = self.problem;
        let mut supports: Vec<PlannedSupport> = Vec::new();
        let groups: Vec<&str> = pieces.groups.iter().map(|(n, _)| n.as_str()).collect();
        for (name, key) in &self.problem.supports {
            let group = self.check_place(&key.on, body, &groups)?;
            let Some(group) = group else {
                return Err(self
                    .problem
                    .error(&key.on, "a membrane is supported at its boundary")
                    .help(format!("write  on = \"{body}:boundary\"  or one of: {}", groups.join(", "))));
            };
            let others = [
                ("normal", key.normal.as_ref().map(|v| self.key(v))),
                ("axes", key.axes.as_ref().map(|v| self.key(v))),
                ("tied", key.tied.as_ref().map(|v| self.key(v))),
                ("spring", key.spring.as_ref().map(|v| self.key(v))),
                ("temperature", key.temperature.as_ref().map(|v| self.key(v))),
                ("from", key.from.as_ref().map(|v| self.key(v))),
                ("until", key.until.as_ref().map(|v| self.key(v))),
            ];
            if let Some((what, at)) = others.iter().find_map(|(w, s)| s.clone().map(|s| (*w, s))) {
                return Err(self.unavailable(&at, &format!("`{what}` in the support of a membrane")));
            }
            let Some(displacement) = &key.displacement else {
                return Err(self
                    .problem
                    .error(key, format!("the support `{name}` prescribes nothing"))
                    .help("add  displacement = 0.0"));
            };
            let held = pieces.groups.iter().find(|(n, _)| *n == group).map(|(_, p)| p.clone()).unwrap_or_default();
            if let Some(other) = supports.iter().find(|s| s.pieces.iter().any(|p| held.contains(p))) {
                return Err(self
                    .problem
                    .error(&key.on, format!("`{}` already has the support `{}`", key.on, other.name))
                    .help("each part of the boundary has at most one support"));
            }
            supports.push(PlannedSupport {
                name: name.clone(),
                displacement: self.placed(one(problem, displacement)?, LENGTH)?,
                pieces: held,
            });
        }
        if supports.is_empty() {
            return Err(self
                .problem
                .error(&self.problem.space, "the membrane has no support")
                .help(format!("add  [supports.rim]  on = \"{body}:boundary\"  displacement = 0.0")));
        }
        if let Some((apart, rims)) = &pieces.apart {
            let held = |rim: &BTreeSet<usize>| supports.iter().any(|s| s.pieces.iter().any(|p| rim.contains(p)));
            if let Some(loose) = rims.iter().position(|rim| !held(rim)) {
                let place = problem.bodies.get(body).map_or_else(|| self.key(&problem.space), |b| self.key(b));
                return Err(problem.error(&place, apart.held_by_nothing(body, loose as u32)).help(UNITE));
            }
            self.warnings.borrow_mut().extend(apart.warning(body).map(Warning::from));
        }
        Ok(supports)
    }

    /// Checks a `BODY` or `BODY:GROUP` and returns the group.
    pub(super) fn check_place(&self, on: &String, body: &str, groups: &[&str]) -> Result<Option<String>, CaseError> {
        let (name, group) = match on.split_once(':') {
            Some((name, group)) => (name, Some(group)),
            None => (on.as_str(), None),
        };
        let bodies: Vec<&str> = self.problem.bodies.keys().map(String::as_str).collect();
        if !bodies.contains(&name) {
            return Err(self.problem.error(on, format!("there is no body `{name}`")).help(suggestion(name, &bodies)));
        }
        if name != body {
            return Err(self
                .problem
                .error(on, format!("`{name}` is rigid: only `{body}` can have supports and loads")));
        }
        match group {
            Some(g) if !groups.contains(&g) => {
                Err(self.problem.error(on, format!("`{name}` has no group `{g}` here")).help(suggestion(g, groups)))
            }
            group => Ok(group.map(str::to_string)),
        }
    }
}
