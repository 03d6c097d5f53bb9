//! Supports and loads of solids.

use super::statement::{PlannedBody, SolidLoad, SolidSupport};
use crate::plan::placed::Placed;
use crate::plan::planner::Planner;
use crate::problem::units::{FORCE_PER_LENGTH, LENGTH, PRESSURE};
use crate::problem::{CaseError, KeyPath, List, Problem, ProblemPart, Space, Value, suggestion};
use signorini_fem::{Group, Side};
use signorini_solid::{LoadKind, SupportKind};
use std::collections::BTreeSet;

impl Planner<'_> {
    pub(super) fn coordinates<const D: usize>(&self) -> &'static [&'static str] {
        if D == 2 { &["x", "y", "t"] } else { &["x", "y", "z", "t"] }
    }

    /// Looks up `BODY` or `BODY:GROUP`.
    pub(super) fn solid_place<const D: usize>(
        &self,
        on: &String,
        bodies: &[PlannedBody<D>],
    ) -> Result<(usize, Option<Group>), CaseError> {
        let (name, group) = match on.split_once(':') {
            Some((name, group)) => (name, Some(group)),
            None => (on.as_str(), None),
        };
        let all: Vec<&str> = self.problem.bodies.keys().map(String::as_str).collect();
        let Some(body) = bodies.iter().position(|b| b.name == name) else {
            if all.contains(&name) {
                return Err(self.problem.error(on, format!("`{name}` is rigid: give its motion in the body")));
            }
            return Err(self.problem.error(on, format!("there is no body `{name}`")).help(suggestion(name, &all)));
        };
        let Some(group) = group else { return Ok((body, None)) };
        let groups = bodies[body].mesh.groups();
        match groups.get(group) {
            Some(found) => Ok((body, Some(found.clone()))),
            None => {
                let names: Vec<&str> = groups.keys().map(String::as_str).collect();
                Err(self.problem.error(on, format!("`{name}` has no group `{group}`")).help(suggestion(group, &names)))
            }
        }
    }

    fn solid_value<const D: usize>(&self, v: &Value, dimension: [i32; 3]) -> Result<Placed, CaseError> {
        let expression = self.reader.expression(v, dimension, self.coordinates::<D>())?;
        Ok(Placed { expression, key: self.key(v) })
    }

    fn vector<const D: usize>(&self, list: &List<Value>, dimension: [i32; 3]) -> Result<Vec<Placed>, CaseError> {
        if list.len() != D {
            return Err(self.problem.error(list, format!("expected {D} components, found {}", list.len())));
        }
        list.iter().map(|v| self.solid_value::<D>(v, dimension)).collect()
    }

    pub(super) fn solid_supports<const D: usize>(
        &self,
        bodies: &[PlannedBody<D>],
    ) -> Result<Vec<SolidSupport>, CaseError> {
        let problem = self.problem;
        let mut out = Vec::new();
        for (name, key) in &problem.supports {
            let (body, group) = self.solid_place(&key.on, bodies)?;
            let group = group.unwrap_or_else(|| Group {
                cells: (0..bodies[body].mesh.cell_count() as u32).collect(),
                ..Group::default()
            });
            let mut add =
                |kind, values| out.push(SolidSupport { name: name.clone(), body, group: group.clone(), kind, values });
            let mut said = false;
            let mut prescribed = vec![false; D];
            if let Some(displacement) = &key.displacement {
                said = true;
                let values = &displacement.0;
                if values.len() != D {
                    let found = values.len();
                    let message =
                        format!("the displacement of a solid is a vector: expected {D} components, found {found}");
                    let help = if D == 2 { "[0, \"free\"]" } else { "[0, \"free\", 0]" };
                    return Err(problem
                        .error(displacement, message)
                        .help(format!("for example  displacement = {help}")));
                }
                let mut list = Vec::new();
                for (k, v) in values.iter().enumerate() {
                    let free = matches!(v, Value::Text(text) if text.trim() == "free");
                    prescribed[k] = !free;
                    list.push(if free { None } else { Some(self.solid_value::<D>(v, LENGTH)?) });
                }
                if prescribed.iter().any(|p| *p) {
                    add(SupportKind::Components(prescribed.clone()), list);
                }
            }
            if let Some(normal) = &key.normal {
                said = true;
                if group.sides.is_empty() {
                    return Err(problem.error(&key.on, "`normal` requires a part of the boundary"));
                }
                let value = self.solid_value::<D>(normal, LENGTH)?;
                add(SupportKind::Normal, vec![Some(value)]);
            }
            if key.uniform.as_ref().is_some_and(|u| *u) {
                said = true;
                add(SupportKind::Uniform(prescribed.iter().map(|p| !p).collect()), Vec::new());
            }
            if let Some(spring) = &key.spring {
                said = true;
                let stiffness = self.reader.numbers::<D>(spring, [-3, 1, 0])?;
                if let Some(k) = stiffness.iter().position(|s| *s < 0.0) {
                    return Err(problem.error(spring, format!("component {k} is negative: {}", stiffness[k])));
                }
                if stiffness.iter().all(|s| *s == 0.0) {
                    return Err(no_spring(problem, spring));
                }
                add(SupportKind::Spring(stiffness.to_vec()), Vec::new());
            }
            if !said {
                return Err(problem
                    .error(key, format!("the support `{name}` prescribes nothing"))
                    .help("add  displacement = [0, 0]  or  normal = 0  or  uniform = true  or  spring = […]"));
            }
        }
        Ok(out)
    }

    pub(super) fn solid_loads<const D: usize>(&self, bodies: &[PlannedBody<D>]) -> Result<Vec<SolidLoad>, CaseError> {
        let problem = self.problem;
        let force: [i32; 3] = if self.space == Space::PlaneStrain || self.space == Space::PlaneStress {
            FORCE_PER_LENGTH
        } else {
            [0, 1, 0]
        };
        let mut out = Vec::new();
        for (name, key) in &problem.loads {
            let (body, group) = self.solid_place(&key.on, bodies)?;
            if let Some(normal) = &key.normal {
                return Err(problem
                    .error(normal, "`normal` is the load of a membrane")
                    .help("loads of solids are pressure (positive pushes inwards), traction, force and body_force"));
            }
            let mut list: Vec<(LoadKind, Vec<Placed>)> = Vec::new();
            if let Some(v) = &key.pressure {
                list.push((LoadKind::Pressure, vec![self.solid_value::<D>(v, PRESSURE)?]));
            }
            if let Some(v) = &key.traction {
                list.push((LoadKind::Traction, self.vector::<D>(v, PRESSURE)?));
            }
            if let Some(v) = &key.force {
                list.push((LoadKind::Force, self.vector::<D>(v, force)?));
            }
            if let Some(v) = &key.body_force {
                list.push((LoadKind::BodyForce, self.vector::<D>(v, [-3, 1, 0])?));
            }
            let [(kind, values)] = <[_; 1]>::try_from(list).map_err(|list| {
                problem
                    .error(key, format!("the load `{name}` has {} values", list.len()))
                    .help("give exactly one of pressure, traction, force, body_force")
            })?;
            let group = match (group, kind) {
                (Some(group), LoadKind::BodyForce) if !group.cells.is_empty() => group,
                (None, LoadKind::BodyForce) => {
                    Group { cells: (0..bodies[body].mesh.cell_count() as u32).collect(), ..Group::default() }
                }
                (Some(group), _) if kind != LoadKind::BodyForce && !group.sides.is_empty() => group,
                _ => {
                    let wanted = if kind == LoadKind::BodyForce { "cells" } else { "a part of the boundary" };
                    let names: Vec<&str> = bodies[body].mesh.groups().keys().map(String::as_str).collect();
                    return Err(problem.error(&key.on, format!("this load requires {wanted}")).help(format!(
                        "`{}` has the groups {}",
                        bodies[body].name,
                        names.join(", ")
                    )));
                }
            };
            out.push(SolidLoad { name: name.clone(), body, group, kind, values });
        }
        Ok(out)
    }
}

/// On the axis the radial displacement vanishes.
pub(super) fn axis_supports<const D: usize>(bodies: &[PlannedBody<D>]) -> Vec<SolidSupport> {
    let mut out = Vec::new();
    for (number, body) in bodies.iter().enumerate() {
        let size = body.mesh.nodes().iter().map(|x| x.norm()).fold(0.0, f64::max);
        let on_axis = |v: u32| body.mesh.nodes()[v as usize][0].abs() <= 1e-12 * size;
        let sides: Vec<Side> = (body.mesh.boundary().into_iter())
            .filter(|s| body.mesh.side_vertices(*s).into_iter().all(on_axis))
            .collect();
        let vertices: BTreeSet<u32> =
            (0..body.mesh.cell_count()).flat_map(|c| body.mesh.vertices(c)).filter(|v| on_axis(*v)).collect();
        if !vertices.is_empty() {
            let zero =
                Placed { expression: crate::expression::Expression::number(0.0), key: KeyPath::of_keys(&["space"]) };
            out.push(SolidSupport {
                name: "axis".into(),
                body: number,
                group: Group { cells: Vec::new(), sides, vertices: vertices.into_iter().collect() },
                kind: SupportKind::Components((0..D).map(|k| k == 0).collect()),
                values: (0..D).map(|k| (k == 0).then(|| zero.clone())).collect(),
            });
        }
    }
    out
}

/// A spring that is none.
pub(in crate::plan) fn no_spring(problem: &Problem, at: &impl ProblemPart) -> CaseError {
    problem
        .error(at, "all stiffnesses of the spring are zero")
        .help("give a positive stiffness in the supported directions, or leave `spring` out")
}
