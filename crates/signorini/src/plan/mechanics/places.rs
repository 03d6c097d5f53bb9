//! Supports and loads of a system: on which part of which body, and what.

use super::{Kind, Numbers, Wrong};
use crate::plan::planner::Planner;
use crate::problem::units::{ENERGY, FORCE, FORCE_PER_LENGTH, LENGTH, NONE, PER_VOLUME, PRESSURE, TIME};
use crate::problem::{Body, CaseError, List, Problem, ProblemPart, Space, Tied, Value, suggestion};
use signorini_contact::ContactSurface;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::contact::Part;
use signorini_mechanics::surface::{Faces, Surface};
use signorini_mechanics::system::{AssemblyError, TimeField};
use signorini_mechanics::{
    Contribution, Hold, IncrementError, Load, Order, PlaceError, PlacedLoad, Sampling, Support, System, TimedLoad,
};
use std::sync::Arc;

/// Springs that a support states: its name, its place, and the load that they are.
pub(super) type Springs = Vec<(String, Part, TimedLoad)>;

/// The outward normal of a flat part of a surface; along an axis its component and sign.
enum Normal {
    Axis(usize, f64),
    Inclined(Vector<3>),
}

fn normal_of(system: &System, part: &Part) -> Result<Normal, String> {
    let body = system.bodies[part.body].as_ref();
    let start = body.start();
    let surface = body.surface(part.group.as_deref(), &start).filter(|_| part.group.is_some());
    let surface = surface.ok_or("`normal` requires a part of the boundary of a solid")?;
    let normals = normals_of(surface.as_ref());
    let first = normals.first().ok_or("`normal` requires a part of the boundary of a solid")?;
    let farthest = normals.iter().map(|n| n.dot(first)).fold(1.0, f64::min);
    if farthest < FLAT {
        let degrees = farthest.clamp(-1.0, 1.0).acos().to_degrees();
        return Err(format!(
            "`normal` requires a flat group: the normals of its sides differ by up to {degrees:.2} degrees"
        ));
    }
    let component = first.iamax();
    Ok(match first[component].abs() > FLAT {
        true => Normal::Axis(component, first[component].signum()),
        false => Normal::Inclined(*first),
    })
}

/// Cosine of the angle between normals that are the same but for rounding.
const FLAT: f64 = 1.0 - 1e-9;

/// Unit normals at the vertices of all faces of a surface.
pub(super) fn normals_of(surface: &dyn Surface) -> Vec<Vector<3>> {
    match surface.faces().0 {
        Faces::Plane(faces) => normals(faces),
        Faces::Space(faces) => normals(faces),
    }
}

/// Unit normals at the vertices of all faces.
fn normals<const D: usize>(faces: &dyn ContactSurface<D>) -> Vec<Vector<3>> {
    let of_face = |face: usize| {
        faces.shape(face).vertices().iter().map(move |s| {
            let normal = faces.at(face, s).area_normal().normalize();
            Vector::<3>::from_fn(|k, _| if k < D { normal[k] } else { 0.0 })
        })
    };
    (0..faces.face_count()).flat_map(of_face).collect()
}

impl Planner<'_> {
    /// A place as it is stated: a body, or a group of one.
    pub(super) fn part(&self, on: &String, numbers: &Numbers) -> Result<Part, CaseError> {
        let (body, group) = match on.split_once(':') {
            Some((body, group)) => (body.trim(), Some(group.trim().to_string())),
            None => (on.as_str(), None),
        };
        let known: Vec<&str> = numbers.keys().map(String::as_str).collect();
        let body = *numbers.get(body).ok_or_else(|| {
            self.problem.error(on, format!("there is no body `{body}`")).help(suggestion(body, &known))
        })?;
        Ok(Part { body, group })
    }

    /// The error of a place, at its key.
    pub(super) fn misplaced(&self, on: &String, error: &PlaceError) -> CaseError {
        let PlaceError::Unknown { body, group, known } = error else {
            return self.problem.error(on, error.to_string());
        };
        let mut known = known.clone();
        if matches!(self.problem.bodies.get(body), Some(Body::Cells(_))) {
            // Sides of grids are made where they are named.
            let sides = ["left", "right", "front", "back", "bottom", "top"].into_iter();
            known.extend(sides.filter(|side| self.side_of_cells(side).is_some()).map(String::from));
            known.sort();
            known.dedup();
        }
        let nearest = suggestion(group, &known.iter().map(String::as_str).collect::<Vec<_>>());
        let all = PlaceError::Unknown { body: body.clone(), group: group.clone(), known };
        let told = self.problem.error(on, all.to_string());
        // The message lists them all.
        if nearest.starts_with("did you mean") { told.help(nearest) } else { told }
    }

    /// Whether a body has the place that is stated.
    pub(super) fn check_group(&self, part: &Part, on: &String, system: &System) -> Result<(), CaseError> {
        match system.bodies[part.body].sites(part.group.as_deref(), Sampling::Nodes) {
            Err(error @ PlaceError::Unknown { .. }) => Err(self.misplaced(on, &error)),
            _ => Ok(()),
        }
    }

    /// Why a system cannot be assembled at its start, at the key that is to be changed.
    pub(super) fn unprepared(&self, error: &IncrementError) -> CaseError {
        let problem = self.problem;
        if let IncrementError::Assembly(AssemblyError::ContradictedConstraint { constraint, .. }) = error
            && let Some(key) = problem.constraints.get(constraint)
        {
            return problem
                .error(key, error.to_string())
                .help("leave it out, or give the value that follows from the others");
        }
        let IncrementError::Assembly(AssemblyError::Contradiction { second, .. }) = error else {
            return problem.error(&problem.space, error.to_string());
        };
        match problem.supports.get(second) {
            Some(support) => problem.error(support, error.to_string()),
            None => problem.error(&problem.space, error.to_string()),
        }
        .help("give the same displacement in both supports, or \"free\" in one of them")
    }

    /// The times between which a support holds.
    fn check_times(
        &self,
        key: &crate::problem::Support,
        [from, until]: [Option<f64>; 2],
        body: &str,
    ) -> Result<(), CaseError> {
        let Some(at) = key.until.as_ref().or(key.from.as_ref()) else { return Ok(()) };
        if matches!(self.problem.bodies.get(body), Some(Body::Cells(_))) {
            let message = format!("`{body}` is a body of finite cells: its supports hold at all times");
            return Err(self.problem.error(at, message).help("leave `from` and `until` out"));
        }
        if key.spring.is_some() {
            return Err(self
                .problem
                .error(at, "springs hold at all times")
                .help("state them in a support of their own"));
        }
        match (from, until) {
            (Some(from), Some(until)) if from >= until => {
                let message = format!("the support holds from {from} until {until}: at no time");
                Err(self.problem.error(at, message).help("from < until"))
            }
            _ => Ok(()),
        }
    }

    pub(super) fn system_supports(
        &self,
        numbers: &Numbers,
        system: &System,
        wrong: &Wrong,
    ) -> Result<Vec<Support>, CaseError> {
        let problem = self.problem;
        let mut out = Vec::new();
        for (name, key) in &problem.supports {
            let part = self.part(&key.on, numbers)?;
            let is_solid = matches!(problem.bodies.get(system.bodies[part.body].name()), Some(Body::Solid(_)));
            if let Some(tied) = key.tied.as_ref().filter(|_| !is_solid) {
                return Err(problem.error(tied, "`tied` is only for solids"));
            }
            let mut displacement = match &key.displacement {
                Some(values) => self.held_components(&values.0, self.dimension(), LENGTH, wrong)?,
                None => [None, None, None],
            };
            let axes = self.support_axes(key, is_solid)?;
            let mut along: Option<(Vector<3>, TimeField)> = None;
            if let Some(normal) = &key.normal {
                let of_cells = match problem.bodies.get(system.bodies[part.body].name()) {
                    Some(Body::Cells(cells)) => (part.group.as_deref())
                        .filter(|side| !cells.groups.contains_key(*side))
                        .and_then(|side| self.side_of_cells(side))
                        .map(|(axis, end)| Normal::Axis(axis, end.sign())),
                    _ => None,
                };
                let value = self.field(normal, LENGTH, wrong)?;
                let direction = of_cells
                    .map_or_else(|| normal_of(system, &part), Ok)
                    .map_err(|message| problem.error(normal, message).help("displacement = [0, \"free\", 0]"))?;
                match direction {
                    Normal::Axis(component, _) if displacement[component].is_some() => {
                        return Err(problem.error(normal, "`displacement` prescribes this direction too"));
                    }
                    Normal::Axis(component, sign) => {
                        displacement[component] = Some(Arc::new(move |x, t| sign * value(x, t)));
                    }
                    Normal::Inclined(direction) => along = Some((direction, value)),
                }
            }
            let mut uniform = [false; 3];
            match &key.tied {
                Some(Tied::All(true)) => {
                    (0..self.dimension()).for_each(|k| uniform[k] = displacement[k].is_none());
                }
                Some(Tied::Components(list)) => {
                    if list.len() != self.dimension() {
                        let message = format!("expected {} components, found {}", self.dimension(), list.len());
                        return Err(problem
                            .error(list, message)
                            .help("true where all points move alike, false elsewhere"));
                    }
                    if let Some(k) = (0..list.len()).find(|k| list[*k] && displacement[*k].is_some()) {
                        return Err(problem.error(list, format!("`displacement` prescribes component {k} too")));
                    }
                    list.iter().enumerate().for_each(|(k, tied)| uniform[k] = *tied);
                }
                Some(Tied::All(false)) | None => {}
            }
            let rotation = match &key.rotation {
                Some(values) if self.space == Space::ThreeD => self.held_components(values, 3, NONE, wrong)?,
                Some(values) => {
                    let [about_z, _, _] = self.held_components(values, 1, NONE, wrong)?;
                    [None, None, about_z]
                }
                None => [None, None, None],
            };
            let holds =
                along.is_some() || uniform != [false; 3] || displacement.iter().chain(&rotation).any(Option::is_some);
            if !holds && key.spring.is_none() && key.temperature.is_none() {
                return Err(problem
                    .error(key, format!("the support `{name}` prescribes nothing"))
                    .help("add  displacement = [0, 0, 0]  or  normal = 0  or  tied = true  or  rotation = [0, 0, 0]  or  spring = […]"));
            }
            if holds {
                let time = |value: &Option<Value>| value.as_ref().map(|v| self.reader.number(v, TIME)).transpose();
                let (from, until) = (time(&key.from)?, time(&key.until)?);
                self.check_times(key, [from, until], system.bodies[part.body].name())?;
                let support =
                    Support { name: name.clone(), part, displacement, axes, rotation, along, uniform, from, until };
                let body = &system.bodies[support.part.body];
                let hold = at_start(&support);
                let none: [Option<&dyn Fn(&Point<3>) -> f64>; 3] = [None; 3];
                let zero = |_: &Point<3>| 0.0;
                let filled = |list: &[bool; 3]| {
                    let mut out = none;
                    (0..3).filter(|k| list[*k]).for_each(|k| out[k] = Some(&zero));
                    out
                };
                let direction = support.along.as_ref().map(|(n, _)| (*n, &zero as &dyn Fn(&Point<3>) -> f64));
                let hold = Hold {
                    displacement: filled(&hold[0]),
                    axes,
                    rotation: filled(&hold[1]),
                    along: direction,
                    uniform: support.uniform,
                };
                let (on, start) = (support.part.group.as_deref(), body.start());
                let misplaced = |error: PlaceError| self.misplaced(&key.on, &error);
                let found = body.hold(on, &hold, &start).map_err(misplaced)?;
                let mut forces = Contribution::new(body.unknowns());
                let weakly = body.hold_weakly(on, &hold, &start, Order::First, &mut forces).map_err(misplaced)?;
                if found.is_empty() && weakly.is_none() {
                    let message = format!("the support `{name}` restrains no unknown of `{}`", body.name());
                    let wrong = problem.error(&key.on, message);
                    return Err(if self.space == Space::Axisymmetric {
                        wrong.help("on the axis the radial displacement is zero by symmetry: leave this support out")
                    } else {
                        wrong
                    });
                }
                out.push(support);
            }
        }
        Ok(out)
    }

    fn dimension(&self) -> usize {
        if self.space == Space::ThreeD { 3 } else { 2 }
    }

    /// Components that are prescribed, and `"free"` ones.
    fn held_components(
        &self,
        values: &List<Value>,
        wanted: usize,
        dimension: crate::problem::units::Dimension,
        wrong: &Wrong,
    ) -> Result<[Option<TimeField>; 3], CaseError> {
        if values.len() != wanted {
            return Err(self
                .problem
                .error(values, format!("expected {wanted} components, found {}", values.len()))
                .help("give numbers, expressions, or \"free\""));
        }
        let mut out = [None, None, None];
        for (component, value) in out.iter_mut().zip(values) {
            if !matches!(value, Value::Text(text) if text.trim() == "free") {
                *component = Some(self.field(value, dimension, wrong)?);
            }
        }
        Ok(out)
    }

    pub(super) fn system_loads(
        &self,
        numbers: &Numbers,
        system: &System,
        kinds: &[Kind],
        wrong: &Wrong,
    ) -> Result<(Vec<PlacedLoad>, Springs), CaseError> {
        let problem = self.problem;
        let plane = self.space != Space::ThreeD;
        let force = if plane { FORCE_PER_LENGTH } else { FORCE };
        let moment = if plane { FORCE } else { ENERGY };
        let mut out = Vec::new();
        for (name, key) in &problem.loads {
            let part = self.part(&key.on, numbers)?;
            if let Some(normal) = &key.normal {
                return Err(problem
                    .error(normal, "`normal` is the load of a membrane")
                    .help("loads of solids are pressure (positive pushes inwards), traction, force and body_force"));
            }
            let heat = [key.heat_flux.is_some(), key.heat_source.is_some(), key.convection.is_some()];
            let of_heat = heat.iter().filter(|is| **is).count();
            let mut list = Vec::new();
            if let Some(v) = &key.pressure {
                list.push(TimedLoad::Pressure(self.field(v, PRESSURE, wrong)?));
            }
            if let Some(v) = &key.traction {
                list.push(TimedLoad::Traction(self.vector_field(v, PRESSURE, wrong)?));
            }
            if let Some(v) = &key.force {
                self.check_resultant(v, &part, system)?;
                list.push(TimedLoad::Force(self.vector_field(v, force, wrong)?));
            }
            if let Some(v) = &key.nodal_force {
                if !matches!(kinds[part.body], Kind::Solid) {
                    return Err(problem.error(v, "`nodal_force` is only for solids").help("force = […]"));
                }
                self.check_resultant(v, &part, system)?;
                list.push(TimedLoad::NodalForce(self.vector_field(v, force, wrong)?));
            }
            if let Some(v) = &key.body_force {
                let per =
                    if matches!(kinds[part.body], Kind::Solid | Kind::Cells) { PER_VOLUME } else { FORCE_PER_LENGTH };
                list.push(TimedLoad::BodyForce(self.vector_field(v, per, wrong)?));
            }
            if let Some(v) = &key.moment {
                self.check_resultant(v, &part, system)?;
                list.push(TimedLoad::Moment(self.moment_field(v, moment, wrong)?));
            }
            if let Some(v) = &key.tension {
                self.check_resultant(std::slice::from_ref(v), &part, system)?;
                let is_rope = matches!(problem.bodies.get(system.bodies[part.body].name()), Some(Body::Rope(_)));
                let pull = if is_rope { self.pull(v, force, wrong)? } else { self.field(v, force, wrong)? };
                list.push(TimedLoad::Tension(pull));
            }
            if list.is_empty() && of_heat == 1 {
                continue;
            }
            if of_heat > 0 {
                let message = format!("the load `{name}` has {} values", list.len() + of_heat);
                return Err(problem.error(key, message).help("state heat and forces as loads of their own"));
            }
            let [load] = <[_; 1]>::try_from(list).map_err(|list: Vec<_>| {
                problem
                    .error(key, format!("the load `{name}` has {} values", list.len()))
                    .help("give exactly one of force, nodal_force, moment, tension, body_force (per volume, or per length of curves), traction, pressure, heat_flux, heat_source, convection")
            })?;
            self.check_load(&part, &key.on, system)(&load)?;
            out.push(PlacedLoad { name: name.clone(), part, load });
        }
        let mut springs = Vec::new();
        for (name, key) in &problem.supports {
            let Some(spring) = &key.spring else { continue };
            let part = self.part(&key.on, numbers)?;
            let per = if matches!(kinds[part.body], Kind::Solid | Kind::Cells) { PER_VOLUME } else { FORCE_PER_LENGTH };
            let stiffness = if plane {
                let [x, y] = self.reader.numbers::<2>(spring, per)?;
                Vector::<3>::new(x, y, 0.0)
            } else {
                Vector::<3>::from(self.reader.numbers::<3>(spring, per)?)
            };
            if let Some(k) = stiffness.iter().position(|s| *s < 0.0) {
                return Err(problem.error(spring, format!("component {k} is negative: {}", stiffness[k])));
            }
            if stiffness == Vector::<3>::zeros() {
                return Err(no_spring(problem, spring));
            }
            let load = TimedLoad::Springs(stiffness);
            self.check_load(&part, &key.on, system)(&load)?;
            springs.push((name.clone(), part, load));
        }
        Ok((out, springs))
    }

    /// Whether a resultant varies in space: it may where its place is a point, such as the end of a rope.
    fn check_resultant(&self, values: &[Value], part: &Part, system: &System) -> Result<(), CaseError> {
        let body = &system.bodies[part.body];
        if body.point(part.group.as_deref()).is_some() {
            return Ok(());
        }
        for value in values {
            if !matches!(value, Value::Text(_)) {
                continue;
            }
            let (expression, _) = self.reader.any(value, self.variables())?;
            if let Some(axis) = (0..3).find(|axis| expression.uses_position(*axis)) {
                let name = ["x", "y", "z"][axis];
                let message = format!("`{name}` in a resultant, which has one value for all of `{}`", body.name());
                return Err(self.problem.error(value, message).help("give an expression of t alone"));
            }
        }
        Ok(())
    }

    /// Whether a load can act where it is stated.
    fn check_load<'s>(
        &'s self,
        part: &'s Part,
        on: &'s String,
        system: &'s System,
    ) -> impl Fn(&TimedLoad) -> Result<(), CaseError> + 's {
        move |load| {
            let body = &system.bodies[part.body];
            let mut out = Contribution::new(body.unknowns());
            let zero = |_: &Point<3>| 0.0;
            let none = |_: &Point<3>| Vector::<3>::zeros();
            let what = match load {
                TimedLoad::BodyForce(_) => Load::BodyForce(&none),
                TimedLoad::Traction(_) => Load::Traction(&none),
                TimedLoad::Pressure(_) => Load::Pressure(&zero),
                TimedLoad::Force(_) => Load::Force(Vector::<3>::zeros()),
                TimedLoad::NodalForce(_) => Load::NodalForce(Vector::<3>::zeros()),
                TimedLoad::Moment(_) => Load::Moment(Vector::<3>::zeros()),
                TimedLoad::FollowerMoment(_) => Load::FollowerMoment(Vector::<3>::zeros()),
                TimedLoad::Tension(_) => Load::Tension(0.0),
                TimedLoad::Springs(k) => Load::Springs(*k),
                // It acts on any body with a mass.
                TimedLoad::Weight(..) => return Ok(()),
            };
            body.load(part.group.as_deref(), &what, &body.start(), Order::First, &mut out)
                .map_err(|error| self.misplaced(on, &error))
        }
    }
}

/// Which components a support prescribes.
fn at_start(support: &Support) -> [[bool; 3]; 2] {
    [support.displacement.each_ref().map(Option::is_some), support.rotation.each_ref().map(Option::is_some)]
}

/// A spring that is none.
fn no_spring(problem: &Problem, at: &impl ProblemPart) -> CaseError {
    problem
        .error(at, "all stiffnesses of the spring are zero")
        .help("give a positive stiffness in the supported directions, or leave `spring` out")
}
