//! From the statement to the model: every key looked up, every value read, every contradiction named.

mod arrays;
mod domain;
mod head;
mod height;
mod history;
pub mod mechanics;
pub mod paths;
pub(crate) mod pieces;
mod placement;
pub mod reader;
mod rigid;
mod rigid_shape;
pub mod solid;
mod surface;

use crate::expression::{Definition, Expression, Names, Scope};
use crate::plan::reader::Reader;
use crate::problem::units::{FORCE_PER_LENGTH, LENGTH, PRESSURE, Units};
use crate::problem::{self, Analysis, Body, FormulationKey, Method, Space, TransportKey, ZoneMultiplierKey};
use crate::problem::{CaseError, Components, KeyPath, Location, Problem, ProblemPart, Value, suggestion};
use crate::report::Warning;
use signorini_fem::cut::QuadraturePoint;
use signorini_fem::{Cells, Grid};
use signorini_geometry::{Jet, Point, Real, Vector};
use signorini_membrane::active_set::NodalStart;
use signorini_membrane::domain::{Domain, DomainOnCells};
use signorini_membrane::field::{Constant, Field, SharedField, Sum};
use signorini_membrane::history::Statement;
use signorini_membrane::kernel::Kernel;
use signorini_membrane::method::{Formulation, Modes, Published, Transport, ZoneMultiplier};
use signorini_membrane::obstacle::{Obstacles, Side};
use signorini_membrane::problem::{Measure, Membrane, Support};
use signorini_membrane::refinement::Refinement;
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

pub use domain::{Pieces, memory_at_hand, memory_estimate, mesh_multigrid_estimate, multigrid_estimate};
pub use head::Head;
use pieces::UNITE;
pub use rigid::RigidBody;
pub use signorini_membrane::history::{Control, MethodChoice, PlannedIncrement};
pub use surface::Contact;

/// A problem that is ready to be solved.
pub enum Plan {
    Line(MembranePlan<1>),
    Plane(MembranePlan<2>),
    PlaneSolids(Box<solid::SolidPlan<2>>),
    Solids(Box<solid::SolidPlan<3>>),
    Mechanics(Box<mechanics::MechanicsPlan>),
}

/// An expression and the key it comes from.
#[derive(Clone)]
pub struct Placed {
    pub expression: Expression,
    pub key: KeyPath,
}

/// A support: its name and the displacement it prescribes.
#[derive(Clone)]
pub struct PlannedSupport {
    pub name: String,
    pub displacement: Placed,
    pub pieces: Vec<usize>,
}

/// A membrane, what it may touch, and its history.
pub struct MembranePlan<const D: usize> {
    pub head: Head,
    pub space: Space,
    /// What the displacement is computed on.
    pub cells: Arc<dyn Cells<D>>,
    /// Where zones are told apart.
    pub grid: Grid<D>,
    pub domain: DomainOnCells<D>,
    /// Where cells are divided.
    pub refinement: Refinement<D>,
    pub tension: Placed,
    pub loads: BTreeMap<String, Placed>,
    pub supports: Vec<PlannedSupport>,
    pub body: String,
    /// What it may touch, in the order of the membrane's obstacles.
    pub contacts: Vec<Contact>,
    pub method: MethodChoice,
    /// The zone that the first increment starts from, where the case asks for one.
    pub initial_zone: Option<(Side, Arc<dyn Domain<D>>)>,
    pub increments: Vec<PlannedIncrement>,
    /// What solves for it.
    pub kernel: Kernel<D>,
    pub probes: BTreeMap<String, Point<D>>,
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
    match problem.space {
        Space::PlaneStrain | Space::PlaneStress => {
            Ok(Plan::PlaneSolids(Box::new(Planner::new(problem)?.solids::<2>()?)))
        }
        Space::ThreeD => Ok(Plan::Solids(Box::new(Planner::new(problem)?.solids::<3>()?))),
        Space::Axisymmetric if problem.bodies.values().any(|b| matches!(b, Body::Solid(_))) => {
            Ok(Plan::PlaneSolids(Box::new(Planner::new(problem)?.solids::<2>()?)))
        }
        Space::Line | Space::Axisymmetric => Ok(Plan::Line(Planner::new(problem)?.membrane::<1>()?)),
        Space::Plane => Ok(Plan::Plane(Planner::new(problem)?.membrane::<2>()?)),
    }
}

/// Reads values in the context of one problem.
pub(crate) struct Planner<'a> {
    pub problem: &'a Problem,
    pub reader: Reader<'a>,
    pub space: Space,
    /// What looks wrong in files that were read.
    pub warnings: RefCell<Vec<Warning>>,
}

/// The value of a key that could be a vector elsewhere.
fn one<'p>(problem: &Problem, key: &'p Components) -> Result<&'p Value, CaseError> {
    match &key.0[..] {
        [value] => Ok(value),
        _ => Err(problem
            .error(key, "the displacement of a membrane is one number")
            .help("write for example  displacement = 0.0")),
    }
}

/// Names of the position's coordinates, by space.
fn coordinates(space: Space) -> &'static [&'static str] {
    match space {
        Space::Line | Space::Axisymmetric => &["x", "t"],
        _ => &["x", "y", "t"],
    }
}

impl<'a> Planner<'a> {
    fn new(problem: &'a Problem) -> Result<Self, CaseError> {
        let units = match &problem.units {
            None => None,
            Some(key) => Some(match key {
                problem::UnitSystem::System(name) => Units::system(name).ok_or_else(|| {
                    problem
                        .error(key, format!("unknown system of units `{name}`"))
                        .help(suggestion(name, &["m-N-Pa", "mm-N-MPa", "um-uN-MPa"]))
                })?,
                problem::UnitSystem::Base(b) => {
                    Units::from_names(&b.length, &b.force, &b.time).map_err(|message| problem.error(key, message))?
                }
            }),
        };
        let mut planner = Self {
            problem,
            reader: Reader { problem, units, names: Names::default(), interpreted: RefCell::default() },
            space: problem.space,
            warnings: RefCell::default(),
        };
        planner.define_constants()?;
        planner.define_functions()?;
        Ok(planner)
    }

    /// Constants may use each other in any order, but not in a circle.
    fn define_constants(&mut self) -> Result<(), CaseError> {
        let mut open: Vec<(&String, &Value)> = self.problem.constants.iter().collect();
        for (name, value) in &open {
            self.check_name(name, self.key(*value))?;
        }
        while !open.is_empty() {
            let before = open.len();
            let mut first_error = None;
            let mut left = Vec::new();
            for (name, value) in open {
                match self.reader.any(value, &[]) {
                    Ok((e, _)) => {
                        let v = e.constant().unwrap_or(f64::NAN);
                        if !v.is_finite() {
                            return Err(self
                                .problem
                                .error(value, format!("the constant `{name}` is {v}, not a finite number")));
                        }
                        self.reader.names.constants.insert(name.clone(), v);
                    }
                    Err(error) => {
                        first_error.get_or_insert(error);
                        left.push((name, value));
                    }
                }
            }
            open = left;
            if open.len() == before {
                let circle = open.iter().all(|(_, v)| self.mentions(v, open.iter().map(|(n, _)| n.as_str())));
                return Err(match first_error {
                    Some(_) if circle => self
                        .problem
                        .error(open[0].1, format!("the constant `{}` is defined in a circle", open[0].0))
                        .help("a constant may use others, but not itself by way of them"),
                    Some(error) => error,
                    None => CaseError::new("constants"),
                });
            }
        }
        Ok(())
    }

    /// Functions may use each other in any order, but not in a circle.
    fn define_functions(&mut self) -> Result<(), CaseError> {
        let problem = self.problem;
        let mut open: Vec<_> = problem.functions.iter().collect();
        for (name, key) in &open {
            self.check_name(name, self.key(*key))?;
            if self.reader.names.constants.contains_key(*name) {
                return Err(problem.error(*key, format!("`{name}` is both a constant and a function")));
            }
        }
        while !open.is_empty() {
            let before = open.len();
            let mut first_error = None;
            let mut left = Vec::new();
            for (name, key) in open {
                match self.function(name, key) {
                    Ok(definition) => {
                        self.reader.names.functions.insert(name.clone(), Arc::new(definition));
                    }
                    Err(error) => {
                        first_error.get_or_insert(error);
                        left.push((name, key));
                    }
                }
            }
            open = left;
            if open.len() == before {
                let names: Vec<&str> = open.iter().map(|(n, _)| n.as_str()).collect();
                let circle = open
                    .iter()
                    .find(|(_, k)| k.expression.as_ref().is_some_and(|v| self.mentions(v, names.iter().copied())));
                return Err(match (circle, first_error) {
                    (Some((name, key)), _) => problem
                        .error(*key, format!("the function `{name}` calls itself, directly or by way of others"))
                        .help("functions may use each other, but not in a circle"),
                    (None, Some(error)) => error,
                    (None, None) => CaseError::new("functions"),
                });
            }
        }
        Ok(())
    }

    fn function(&self, name: &str, key: &problem::TimeFunction) -> Result<Definition, CaseError> {
        let error = |at: &KeyPath, message: String| self.problem.error(at, message);
        match (&key.table, &key.expression) {
            (Some(table), None) => {
                let (t, value) = (&table.t, &table.value);
                if t.is_empty() || t.len() != value.len() {
                    return Err(error(
                        &self.key(table),
                        format!("`t` has {} entries and `value` {}", t.len(), value.len()),
                    )
                    .help("both need the same number of entries, at least one"));
                }
                if t.iter().chain(value).any(|v| !v.is_finite()) {
                    return Err(error(&self.key(table), "the table holds a number that is not finite".into()));
                }
                if let Some(i) = (1..t.len()).find(|&i| t[i] <= t[i - 1]) {
                    return Err(error(
                        &self.key(table),
                        format!("`t` does not increase: {} follows {}", t[i], t[i - 1]),
                    ));
                }
                Ok(Definition::Table { t: t.0.clone(), value: value.0.clone() })
            }
            (None, Some(value)) => Ok(Definition::Formula(self.reader.any(value, &["t"])?.0)),
            _ => Err(error(&self.key(key), format!("the function `{name}` needs either `table` or `expression`"))),
        }
    }

    /// Whether a value's text uses one of the names as a word.
    fn mentions<'b>(&self, value: &Value, mut names: impl Iterator<Item = &'b str>) -> bool {
        let Value::Text(text) = value else { return false };
        let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
        names.any(|n| words.contains(&n))
    }

    fn check_name(&self, name: &str, at: KeyPath) -> Result<(), CaseError> {
        let word =
            name.chars().all(|c| c.is_alphanumeric() || c == '_') && !name.starts_with(|c: char| c.is_ascii_digit());
        let taken = ["x", "y", "z", "t", "pi", "e", "if"].contains(&name);
        match (word, taken) {
            (true, false) => Ok(()),
            (true, true) => Err(self.problem.error(&at, format!("`{name}` already has a meaning in expressions"))),
            (false, _) => Err(self
                .problem
                .error(&at, format!("`{name}` cannot be used in an expression"))
                .help("a name consists of letters, digits and _, and does not begin with a digit")),
        }
    }

    fn unavailable(&self, at: &impl Location, what: &str) -> CaseError {
        self.problem.error(at, format!("{what} is not available in this version"))
    }

    /// The way to a part of the problem.
    fn key<T: ProblemPart>(&self, part: &T) -> KeyPath {
        self.problem.key(part)
    }

    fn placed(&self, value: &Value, dimension: [i32; 3]) -> Result<Placed, CaseError> {
        let expression = self.reader.expression(value, dimension, coordinates(self.space))?;
        Ok(Placed { expression, key: self.key(value) })
    }

    fn membrane<const D: usize>(&self) -> Result<MembranePlan<D>, CaseError>
    where
        Self: domain::ReadDomain<D>,
    {
        let problem = self.problem;
        let mut films = self.problem.bodies.iter().filter_map(|(name, b)| match b {
            Body::Membrane(film) => Some((name, b, film)),
            _ => None,
        });
        let Some((body, _, film)) = films.next() else {
            return Err(problem
                .error(&self.problem.space, "there is no membrane")
                .help("add a body, for example  [bodies.film.membrane]"));
        };
        if let Some((_, second, _)) = films.next() {
            return Err(self.unavailable(second, "more than one membrane"));
        }
        for (name, b) in &self.problem.bodies {
            let what = match b {
                Body::Membrane(_) | Body::Rigid(_) => continue,
                Body::Solid(_) => "solid",
                Body::Cells(_) => "cells",
                Body::Rope(_) => "rope",
                Body::Beam(_) => "beam",
            };
            return Err(self.unavailable(b, &format!("the body `{name}`: `{what}`")));
        }
        let mut on = domain::ReadDomain::<D>::domain(self, film)?;
        let tension = self.placed(&film.tension, FORCE_PER_LENGTH)?;
        let loads = self.loads(body)?;
        let supports = self.supports(body, &on.pieces)?;
        let mut warnings = Vec::new();
        let (contacts, method) = self.contacts(body, &supports, &on.grid, &mut warnings)?;
        if !matches!(method, MethodChoice::InequalityLevelSet { .. })
            && self.problem.steps.iter().any(|s| s.events.is_some())
        {
            warnings.push("`events` are located by method.inequality_level_set only".into());
        }
        if contacts.is_empty() && self.problem.bodies.len() > 1 {
            warnings.push(
                "no contact is stated: rigid bodies are ignored (add [contacts.NAME] between = [film, floor])".into(),
            );
        }
        if method.formulation() != Formulation::OneSided {
            self.on_plain_cells(film, &mut on)?;
        }
        if let MethodChoice::ActiveSet(_) = method {
            if let problem::Mesh::Gmsh(key) = &film.mesh {
                return Err(problem
                    .error(&key.file, "method.active_set works on a grid")
                    .help("mesh.grid = { cells = [40, 40] }, or method.inequality_level_set = {}"));
            }
            if on.grid.degree() != 1 && film.degree.is_some() {
                warnings.push("method.active_set works with degree 1; the stated degree is not used".into());
            }
            on.refinement = Refinement::default();
            on.grid = Grid::new(*on.grid.bounds(), on.grid.cells(), 1);
            on.cells = Arc::new(on.grid.clone());
        }
        let plan = self.finish(body, on, tension, loads, supports, contacts, method, warnings)?;
        let start = plan.increments.first().map_or(0.0, |i| i.range[0]);
        if !plan.by_multigrid(&plan.at(start)) {
            let unknowns = plan.cells.function_count() as f64;
            self.check_unknowns::<D>(unknowns, plan.cells.degree(), &film.mesh)?;
        }
        Ok(plan)
    }

    /// The zone that a contact asks to start from, and the side that it touches.
    fn initial_zone<const D: usize>(
        &self,
        contacts: &[Contact],
        grid: &Grid<D>,
    ) -> Result<Option<(Side, Arc<dyn Domain<D>>)>, CaseError>
    where
        Self: domain::ReadDomain<D>,
    {
        let mut asked = self.problem.contacts.iter().filter_map(|(name, c)| match c.method.as_ref()? {
            Method::InequalityLevelSet(k) => Some((name, k.initial_zone.as_ref()?)),
            _ => None,
        });
        let Some((name, key)) = asked.next() else { return Ok(None) };
        if let Some((_, second)) = asked.next() {
            return Err(self.unavailable(second, "more than one `initial_zone`"));
        }
        let zone = domain::ReadDomain::<D>::initial_zone(self, key, grid)?;
        // A contact with several bodies has a name for each of them.
        let Some(contact) = contacts.iter().find(|c| c.name == *name) else {
            return Err(self
                .problem
                .error(key, format!("`{name}` has several bodies: which of them the zone touches is not said"))
                .help("give the body a contact of its own, with `between`"));
        };
        Ok(Some((contact.side, zone)))
    }

    #[allow(clippy::too_many_arguments)]
    fn finish<const D: usize>(
        &self,
        body: &str,
        on: domain::OnCells<D>,
        tension: Placed,
        loads: BTreeMap<String, Placed>,
        supports: Vec<PlannedSupport>,
        contacts: Vec<Contact>,
        method: MethodChoice,
        warnings: Vec<Warning>,
    ) -> Result<MembranePlan<D>, CaseError>
    where
        Self: domain::ReadDomain<D>,
    {
        let mut probes = BTreeMap::new();
        for (name, at) in &self.problem.output.probes {
            let x = if D == 1 && at.len() == 2 {
                self.reader.numbers::<2>(at, LENGTH)?.to_vec()
            } else {
                self.reader.numbers::<D>(at, LENGTH)?.to_vec()
            };
            probes.insert(name.clone(), Point::<D>::from_fn(|k, _| x[k]));
        }
        let initial_zone = self.initial_zone(&contacts, &on.grid)?;
        let names: Vec<&str> = contacts.iter().map(|c| c.name.as_str()).collect();
        let increments = self.increments(D, &names)?;
        let mut plan = MembranePlan {
            head: self.head(warnings)?,
            space: self.space,
            cells: on.cells,
            grid: on.grid,
            domain: on.domain,
            refinement: on.refinement,
            tension,
            loads,
            supports,
            body: body.to_string(),
            contacts,
            method,
            initial_zone,
            increments,
            kernel: <Self as domain::ReadDomain<D>>::KERNEL,
            probes,
        };
        plan.check_time()?;
        let membrane = plan.at(plan.increments[0].range[0]);
        for (name, x) in plan.probes.iter().filter(|(_, x)| !membrane.contains(x)) {
            let at: Vec<String> = x.iter().map(f64::to_string).collect();
            let message = format!("the probe `{name}` at ({}) lies outside `{body}`: it tells nothing", at.join(", "));
            plan.head.warnings.push(message.into());
        }
        Ok(plan)
    }

    fn loads(&self, body: &str) -> Result<BTreeMap<String, Placed>, CaseError> {
        let mut loads = BTreeMap::new();
        for (name, key) in &self.problem.loads {
            self.check_place(&key.on, body, &[])?;
            let others = [
                ("traction", key.traction.as_ref().map(|v| self.key(v))),
                ("pressure", key.pressure.as_ref().map(|v| self.key(v))),
                ("force", key.force.as_ref().map(|v| self.key(v))),
                ("body_force", key.body_force.as_ref().map(|v| self.key(v))),
            ];
            if let Some((what, at)) = others.iter().find_map(|(w, s)| s.clone().map(|s| (*w, s))) {
                return Err(self
                    .problem
                    .error(&at, format!("a membrane has no `{what}`"))
                    .help("its load is  normal = …  : force per area along +z, negative where it presses downwards"));
            }
            let Some(normal) = &key.normal else {
                return Err(self.problem.error(key, format!("the load `{name}` says nothing")).help("add  normal = …"));
            };
            loads.insert(name.clone(), self.placed(normal, PRESSURE)?);
        }
        Ok(loads)
    }

    fn supports(&self, body: &str, pieces: &Pieces) -> Result<Vec<PlannedSupport>, CaseError> {
        let problem = self.problem;
        let mut supports: Vec<PlannedSupport> = Vec::new();
        let groups: Vec<&str> = pieces.groups.iter().map(|(n, _)| n.as_str()).collect();
        for (name, key) in &self.problem.supports {
            let group = self.check_place(&key.on, body, &groups)?;
            let Some(group) = group else {
                return Err(self
                    .problem
                    .error(&key.on, "a membrane is held at its boundary")
                    .help(format!("write  on = \"{body}:boundary\"  or one of: {}", groups.join(", "))));
            };
            let others = [
                ("normal", key.normal.as_ref().map(|v| self.key(v))),
                ("uniform", key.uniform.as_ref().map(|v| self.key(v))),
                ("spring", key.spring.as_ref().map(|v| self.key(v))),
            ];
            if let Some((what, at)) = others.iter().find_map(|(w, s)| s.clone().map(|s| (*w, s))) {
                return Err(self.unavailable(&at, &format!("`{what}` on the support of a membrane")));
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
                    .error(&key.on, format!("`{}` is already held by the support `{}`", key.on, other.name))
                    .help("a part of the boundary has one support"));
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
                .error(&self.problem.space, "nothing holds the membrane")
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
    fn check_place(&self, on: &String, body: &str, groups: &[&str]) -> Result<Option<String>, CaseError> {
        let (name, group) = match on.split_once(':') {
            Some((name, group)) => (name, Some(group)),
            None => (on.as_str(), None),
        };
        let bodies: Vec<&str> = self.problem.bodies.keys().map(String::as_str).collect();
        if !bodies.contains(&name) {
            return Err(self.problem.error(on, format!("there is no body `{name}`")).help(suggestion(name, &bodies)));
        }
        if name != body {
            return Err(self.problem.error(on, format!("`{name}` is rigid: only `{body}` can be held or loaded")));
        }
        match group {
            Some(g) if !groups.contains(&g) => {
                Err(self.problem.error(on, format!("`{name}` has no group `{g}` here")).help(suggestion(g, groups)))
            }
            group => Ok(group.map(str::to_string)),
        }
    }

    /// All contacts of the membrane, which have one method.
    fn contacts<const D: usize>(
        &self,
        body: &str,
        supports: &[PlannedSupport],
        grid: &Grid<D>,
        warnings: &mut Vec<Warning>,
    ) -> Result<(Vec<Contact>, MethodChoice), CaseError> {
        let problem = self.problem;
        let levels: Option<Vec<f64>> = supports.iter().map(|s| s.displacement.expression.constant()).collect();
        let corner = |x: Point<D>| Vector::<2>::new(x[0], if D == 2 { x[D - 1] } else { 0.0 });
        let mut scene = surface::Scene {
            level: levels.and_then(|l| l.into_iter().reduce(f64::max)),
            around: [corner(grid.bounds().min), corner(grid.bounds().max)],
            resolution: 0.5 * grid.h(),
            warnings,
        };
        let mut out: Vec<Contact> = Vec::new();
        let stated = problem.contacts.values().find(|c| c.method.is_some());
        let size = grid.bounds().size().max();
        let method = stated.map_or(Ok(MethodChoice::default()), |c| self.method(c, size))?;
        for (name, key) in &problem.contacts {
            let contact = key;
            if let Some(friction) = &contact.friction {
                return Err(self.unavailable(friction, "friction of a membrane").help(
                    "leave `friction` out: a membrane slides along bodies without resistance; it may have `adhesion`",
                ));
            }
            if let Some(own) = &contact.method
                && self.method(contact, size)? != method
            {
                return Err(problem
                    .error(own, format!("`{name}` has another method than the contact before"))
                    .help("all contacts of a membrane are solved together: state the method once"));
            }
            let adhesion = match &contact.adhesion {
                None => None,
                Some(adhesion) => {
                    let placed = self.placed(&adhesion.energy, FORCE_PER_LENGTH)?;
                    (placed.expression.constant() != Some(0.0)).then_some(placed)
                }
            };
            if let (Some(adhesion), MethodChoice::ActiveSet(_)) = (&adhesion, method) {
                return Err(problem
                    .error(&adhesion.key, "method.active_set knows no adhesion")
                    .help("method.inequality_level_set = {}"));
            }
            let touched = self.touched(body, key)?;
            for other in &touched {
                if let Some(before) = out.iter().find(|c| c.body == *other) {
                    let message = format!("`{other}` is already touched by the contact `{}`", before.name);
                    return Err(problem.error(key, message).help("a body has one contact with the membrane"));
                }
                let Some(Body::Rigid(rigid)) = problem.bodies.get(other) else {
                    return Err(problem.error(key, format!("`{other}` is not rigid")));
                };
                let name = if touched.len() == 1 { name.clone() } else { format!("{name}:{other}") };
                let contact = surface::read(self, &name, other, rigid, &mut scene)?;
                out.push(Contact { adhesion: adhesion.clone(), ..contact });
            }
        }
        Ok((out, method))
    }

    /// The rigid bodies that a contact names.
    fn touched(&self, body: &str, key: &problem::Contact) -> Result<Vec<String>, CaseError> {
        let problem = self.problem;
        let rigid: Vec<&str> =
            problem.bodies.iter().filter(|(_, b)| matches!(b, Body::Rigid(_))).map(|(n, _)| n.as_str()).collect();
        match (&key.between, &key.within, &key.all) {
            (Some(pair), None, None) => {
                let bodies: Vec<&str> = problem.bodies.keys().map(String::as_str).collect();
                for b in pair {
                    let plain = b.split(':').next().unwrap_or("");
                    if !bodies.contains(&plain) {
                        return Err(problem
                            .error(b, format!("there is no body `{plain}`"))
                            .help(suggestion(plain, &bodies)));
                    }
                }
                let others: Vec<&String> = pair.iter().filter(|b| *b != body).collect();
                let known = others.iter().all(|b| rigid.contains(&b.as_str()));
                match known && others.len() + 1 == pair.len() && !others.is_empty() {
                    true => Ok(others.into_iter().cloned().collect()),
                    false => Err(problem
                        .error(pair, "a contact is between the membrane and a rigid body")
                        .help(format!("between = [\"{body}\", \"{}\"]", rigid.first().unwrap_or(&"floor")))),
                }
            }
            (None, None, Some(all)) if *all => match rigid.is_empty() {
                false => Ok(rigid.into_iter().map(str::to_string).collect()),
                true => Err(problem
                    .error(all, "there is no rigid body to touch")
                    .help("add for example  [bodies.floor.rigid]  shape.height = \"-0.1\"")),
            },
            _ => Err(problem
                .error(key, "who touches whom is not said, or said twice")
                .help(format!("between = [\"{body}\", \"{}\"]", rigid.first().unwrap_or(&"floor")))),
        }
    }

    /// The formulation that a contact asks for, of a membrane of a certain extent.
    fn formulation(&self, key: &problem::LevelSetMethod, size: f64) -> Result<Formulation, CaseError> {
        let published = key.formulation.as_ref().is_some_and(|f| *f == FormulationKey::Published);
        let kind = key.multiplier.as_ref();
        if !published {
            let spans = [
                kind.map(|m| self.key(m)),
                key.multiplier_length.as_ref().map(|l| self.key(l)),
                key.transport.as_ref().map(|t| self.key(t)),
            ];
            return match spans.into_iter().flatten().next() {
                None => Ok(Formulation::OneSided),
                Some(at) => Err(self
                    .problem
                    .error(&at, "this key belongs to the published formulation")
                    .help("formulation = \"published\"")),
            };
        }
        let multiplier = match (kind.copied(), &key.multiplier_length) {
            (Some(ZoneMultiplierKey::L2), None) => ZoneMultiplier::L2,
            (Some(ZoneMultiplierKey::L2), Some(length)) => {
                return Err(self
                    .problem
                    .error(length, "a multiplier without gradients has no length")
                    .help("multiplier = \"h1\""));
            }
            (_, None) => ZoneMultiplier::H1 { length: size },
            (_, Some(length)) => ZoneMultiplier::H1 { length: self.reader.positive(length, LENGTH)? },
        };
        let transport = match key.transport {
            None | Some(TransportKey::Exact) => Transport::Exact,
            Some(TransportKey::Redistancing) => Transport::Redistancing,
            Some(TransportKey::HamiltonJacobi) => Transport::HamiltonJacobi,
        };
        Ok(Formulation::Published(Published { multiplier, transport }))
    }

    /// The cells of a membrane in the published formulation, which knows neither divided cells nor, in the plane, degrees.
    fn on_plain_cells<const D: usize>(
        &self,
        film: &problem::Membrane,
        on: &mut domain::OnCells<D>,
    ) -> Result<(), CaseError> {
        if let (2, Some(degree)) = (D, film.degree.as_ref().filter(|d| **d != 1)) {
            return Err(self
                .problem
                .error(degree, format!("the published formulation has degree 1 in the plane, not {}", degree))
                .help("degree = 1, or  formulation = \"one_sided\""));
        }
        let refine = match &film.mesh {
            problem::Mesh::Grid(key) => &key.refine,
            problem::Mesh::Gmsh(key) => &key.refine,
            problem::Mesh::Arrays(_) => &None,
        };
        if let Some(refine) = refine {
            return Err(self
                .problem
                .error(refine, "the published formulation works on cells that are not divided")
                .help("more cells, or  formulation = \"one_sided\""));
        }
        if let problem::Mesh::Grid(_) = &film.mesh {
            if D == 2 {
                on.grid = Grid::new(*on.grid.bounds(), on.grid.cells(), 1);
                on.cells = Arc::new(on.grid.clone());
            }
        } else if on.cells.degree() != 1 {
            return Err(self
                .problem
                .error(&film.mesh, "the published formulation has degree 1 in the plane")
                .help("degree = 1, or  formulation = \"one_sided\""));
        }
        let mut controls = self.problem.steps.iter().filter_map(|s| s.control.as_ref());
        if let Some(control) = controls.find(|c| !matches!(c, problem::Control::Time(_))) {
            return Err(self
                .problem
                .error(control, "the published formulation follows time only")
                .help("control.time = {}, or  formulation = \"one_sided\""));
        }
        on.refinement = Refinement::default();
        Ok(())
    }

    /// How many modes a front may have.
    fn mode_count(&self, key: &problem::LevelSetMethod) -> Result<Option<usize>, CaseError> {
        let Some(count) = &key.mode_count else { return Ok(None) };
        match usize::try_from(*count) {
            Ok(most @ 1..) => Ok(Some(most)),
            _ => Err(self
                .problem
                .error(count, format!("a front has one mode at least, not {}", count))
                .help("mode_count = 21")),
        }
    }

    fn method(&self, key: &problem::Contact, size: f64) -> Result<MethodChoice, CaseError> {
        let Some(method) = &key.method else { return Ok(MethodChoice::default()) };
        match method {
            Method::InequalityLevelSet(k) => {
                if let Some(v) = &k.front_degree {
                    return Err(self.unavailable(v, "`front_degree`"));
                }
                let formulation = self.formulation(k, size)?;
                let modes = match (k.modes, formulation) {
                    (Some(problem::FrontModes::Fourier), _) | (None, Formulation::Published(_)) => {
                        Modes::Fourier { most: self.mode_count(k)?.unwrap_or(usize::MAX) }
                    }
                    _ => match &k.mode_count {
                        Some(count) => {
                            return Err(self
                                .problem
                                .error(count, "splines along a front are as many as its cells can tell apart")
                                .help("modes = \"fourier\", or no `mode_count`"));
                        }
                        None => Modes::Local,
                    },
                };
                Ok(MethodChoice::InequalityLevelSet { modes, formulation })
            }
            Method::ActiveSet(k) => Ok(MethodChoice::ActiveSet(match k.start {
                Some(problem::ActiveSetStart::Cold) => NodalStart::Cold,
                _ => NodalStart::Nested,
            })),
            _ => Err(self
                .problem
                .error(method, "this method is for solids")
                .help("membranes have  method.inequality_level_set = {}  and  method.active_set = {}")),
        }
    }
}

/// An expression as a field, at a fixed time.
struct ExpressionField(Expression);

impl<const D: usize> Field<D> for ExpressionField {
    fn value(&self, x: &Point<D>) -> f64 {
        let position = std::array::from_fn(|k| if k < D { x[k] } else { 0.0 });
        self.0.evaluate(&Scope { position, time: f64::NAN })
    }
    fn jet(&self, x: &Point<D>) -> Jet<D> {
        let position = std::array::from_fn(|k| if k < D { Jet::variable(x[k], k) } else { Jet::constant(0.0) });
        self.0.evaluate(&Scope { position, time: Jet::constant(f64::NAN) })
    }
    fn constant(&self) -> Option<f64> {
        self.0.constant()
    }
}

/// An expression at a time, as a field.
pub(crate) fn field<const D: usize>(expression: &Expression, time: f64) -> SharedField<D> {
    let fixed = expression.at_time(time);
    match fixed.constant() {
        Some(v) => Arc::new(Constant(v)),
        None => Arc::new(ExpressionField(fixed)),
    }
}

impl<const D: usize> MembranePlan<D> {
    fn expressions(&self) -> impl Iterator<Item = &Placed> {
        let touched =
            self.contacts.iter().flat_map(|c| std::iter::once(&c.height).chain(&c.displacement).chain(&c.adhesion));
        std::iter::once(&self.tension)
            .chain(self.loads.values())
            .chain(self.supports.iter().map(|s| &s.displacement))
            .chain(touched)
    }

    /// Something that depends on time needs steps.
    fn check_time(&self) -> Result<(), CaseError> {
        if !self.head.problem.steps.is_empty() {
            return Ok(());
        }
        match self.expressions().find(|p| p.expression.uses_time()) {
            None => Ok(()),
            Some(p) => Err(self
                .head
                .problem
                .error(&p.key, format!("`{}` depends on t, but there are no steps", p.key))
                .help("add for example  [[steps]]  to = 1.0  increments = 10")),
        }
    }

    /// The membrane at one time.
    pub fn at(&self, time: f64) -> Membrane<D> {
        let mut supports: Vec<Option<Support<D>>> = vec![None; self.domain.domain.pieces()];
        for (index, support) in self.supports.iter().enumerate() {
            for &piece in &support.pieces {
                let displacement = field(&support.displacement.expression, time);
                supports[piece] = Some(Support { index, displacement });
            }
        }
        let loads: Vec<SharedField<D>> = self.loads.values().map(|l| field(&l.expression, time)).collect();
        let load: SharedField<D> = match loads.as_slice() {
            [one] => one.clone(),
            _ => Arc::new(Sum(loads)),
        };
        Membrane {
            cells: self.cells.clone(),
            grid: self.grid.clone(),
            domain: self.domain.clone(),
            sizing: None,
            measure: if self.space == Space::Axisymmetric { Measure::Axisymmetric } else { Measure::Plain },
            tension: field(&self.tension.expression, time),
            load,
            obstacles: Obstacles(self.contacts.iter().map(|c| c.at(time)).collect()),
            supports,
            support_count: self.supports.len(),
            modes: self.method.modes(),
            formulation: self.method.formulation(),
        }
    }

    /// The radius of a membrane that is stated as a disc.
    pub fn disc_radius(&self) -> Option<f64> {
        let Body::Membrane(film) = self.head.problem.bodies.get(&self.body)? else { return None };
        let problem::Domain::Disc(_) = film.domain.as_ref()? else { return None };
        Some(0.5 * self.grid.bounds().size()[0] / domain::MARGIN)
    }

    /// The resultant of each load along z.
    pub fn load_resultants(&self, membrane: &Membrane<D>, time: f64) -> BTreeMap<String, f64> {
        let quadrature = (self.kernel.quadrature)(membrane);
        let fields: Vec<SharedField<D>> = self.loads.values().map(|l| field(&l.expression, time)).collect();
        let mut sums = vec![0.0; fields.len()];
        for cell in 0..quadrature.cells.len() {
            for (_, points) in quadrature.volumes(membrane, cell) {
                for p in points.iter() {
                    for (sum, f) in sums.iter_mut().zip(&fields) {
                        *sum += p.weight * f.value(&p.x);
                    }
                }
            }
        }
        self.loads.keys().cloned().zip(sums).collect()
    }

    /// What to say where a factorisation needs more memory than there is.
    pub fn lacks_memory(&self) -> Option<String> {
        let unknowns = self.cells.function_count() as f64;
        let bytes = memory_estimate(unknowns, self.cells.degree(), D);
        (bytes > memory_at_hand()).then(|| {
            format!(
                "multigrid did not find the state, and a factorisation of {unknowns:.1e} unknowns needs about {:.1} GiB: \
                 more than are free; try fewer cells first, to see what makes the state hard to find",
                bytes / f64::from(1u32 << 30)
            )
        })
    }

    /// Checks the fields of a membrane where they will be used: finite values, positive tension, a floor below the
    /// supports.
    pub fn check_fields(&self, membrane: &Membrane<D>, time: f64) -> Result<(), CaseError> {
        let quadrature = (self.kernel.quadrature)(membrane);
        let mut failure: Option<CaseError> = None;
        let wrong = |p: &Placed, x: &Point<D>, v: f64, what: &str| {
            let at: Vec<String> = x.iter().map(|c| format!("{c:.6}")).collect();
            self.head.problem.error(&p.key, format!("`{}` is {v} at ({}), t = {time}: {what}", p.key, at.join(", ")))
        };
        let finite = "it must be a finite number everywhere in the membrane";
        let fields: Vec<(&Placed, SharedField<D>, bool)> =
            std::iter::once((&self.tension, membrane.tension.clone(), true))
                .chain(self.loads.values().map(|l| (l, field(&l.expression, time), false)))
                .chain(self.contacts.iter().zip(&membrane.obstacles.0).flat_map(|(c, o)| {
                    let adhesion = c.adhesion.iter().zip(&o.adhesion).map(|(placed, e)| (placed, e.clone(), true));
                    std::iter::once((&c.height, o.height.clone(), true)).chain(adhesion)
                }))
                .collect();
        for cell in 0..quadrature.cells.len() {
            for (_, points) in quadrature.volumes(membrane, cell) {
                for p in points.iter() {
                    for (i, (placed, f, derivatives)) in fields.iter().enumerate() {
                        let jet = if *derivatives { f.jet(&p.x) } else { Jet::constant(f.value(&p.x)) };
                        if !jet.value.is_finite() {
                            failure.get_or_insert_with(|| wrong(placed, &p.x, jet.value, finite));
                        } else if !jet.is_finite() {
                            failure.get_or_insert_with(|| {
                                wrong(placed, &p.x, jet.value, "its derivatives are not finite there")
                            });
                        } else if i == 0 && jet.value <= 0.0 {
                            failure
                                .get_or_insert_with(|| wrong(placed, &p.x, jet.value, "the tension must be positive"));
                        } else if jet.value < 0.0 && placed.key.ends_with("energy") {
                            failure.get_or_insert_with(|| {
                                wrong(placed, &p.x, jet.value, "the energy that adhesion gives is not negative")
                            });
                        }
                    }
                }
            }
            if let Some(error) = failure {
                return Err(error);
            }
        }
        for contact in &self.contacts {
            let Some([low, high]) = contact.height.expression.as_height().and_then(|r| r.known_within()) else {
                continue;
            };
            let shift = contact.displacement_at(time);
            let slack = 1e-9 * (high - low).max();
            for cell in 0..quadrature.cells.len() {
                for (_, points) in quadrature.volumes(membrane, cell) {
                    let beyond = |p: &&QuadraturePoint<D>| {
                        (0..D).any(|k| p.x[k] - shift[k] < low[k] - slack || p.x[k] - shift[k] > high[k] + slack)
                    };
                    if let Some(p) = points.iter().find(beyond) {
                        let at: Vec<String> = p.x.iter().map(|c| format!("{c:.6}")).collect();
                        let message = format!(
                            "the height map does not reach the membrane at ({}), t = {time}: it covers x from {:.6} to {:.6}, y \
                             from {:.6} to {:.6}",
                            at.join(", "),
                            low[0] + shift[0],
                            high[0] + shift[0],
                            low[1] + shift[1],
                            high[1] + shift[1]
                        );
                        return Err(self
                            .head
                            .problem
                            .error(&contact.height.key, message)
                            .help("give a larger map, see `origin` and `spacing`, or move it less"));
                    }
                }
            }
        }
        if membrane.obstacles.sides().count() == 2 {
            for cell in 0..quadrature.cells.len() {
                for (_, points) in quadrature.volumes(membrane, cell) {
                    for p in points.iter() {
                        let [low, high] = Side::BOTH.map(|side| membrane.obstacles.height(side, &p.x));
                        let ceiling = membrane.obstacles.index_at(Side::Above, &p.x).map(|i| &self.contacts[i]);
                        if let (true, Some(ceiling)) = (low >= high, ceiling) {
                            let what =
                                format!("what lies below reaches up to {low} there: no room is left for the membrane");
                            return Err(wrong(&ceiling.height, &p.x, high, &what).help("lift it"));
                        }
                    }
                }
            }
        }
        for p in &quadrature.rim {
            let Some(support) = &membrane.supports[p.piece] else { continue };
            let planned = &self.supports[support.index];
            let held = support.displacement.value(&p.x);
            if !held.is_finite() {
                return Err(wrong(&planned.displacement, &p.x, held, finite));
            }
            for (contact, obstacle) in self.contacts.iter().zip(&membrane.obstacles.0) {
                let height = obstacle.height.value(&p.x);
                let slack = 1e-9 * (height.abs() + held.abs() + membrane.size() * 1e-6);
                if obstacle.side.sign() * (held - height) < -slack {
                    let (place, help) = match obstacle.side {
                        Side::Below => (
                            "above",
                            "lower it there, or raise the support; a body over the membrane:  lies = \"above\"",
                        ),
                        Side::Above => (
                            "below",
                            "raise it there, or lower the support; a body under the membrane:  lies = \"below\"",
                        ),
                    };
                    let what = format!(
                        "`{}` lies {place} the displacement {held} prescribed by the support `{}`",
                        contact.body, planned.name
                    );
                    return Err(wrong(&contact.height, &p.x, height, &what).help(help));
                }
            }
        }
        Ok(())
    }
}

impl<const D: usize> Statement<D> for MembranePlan<D> {
    fn method(&self) -> MethodChoice {
        self.method
    }
    fn grid(&self) -> &Grid<D> {
        &self.grid
    }
    fn refinement(&self) -> &Refinement<D> {
        &self.refinement
    }
    fn initial_zone(&self) -> Option<&(Side, Arc<dyn Domain<D>>)> {
        self.initial_zone.as_ref()
    }
    fn increments(&self) -> &[PlannedIncrement] {
        &self.increments
    }
    fn has_units(&self) -> bool {
        self.head.problem.units.is_some()
    }
    fn at(&self, time: f64) -> Membrane<D> {
        self.at(time)
    }
    fn check(&self, membrane: &Membrane<D>, time: f64) -> Result<(), String> {
        self.check_fields(membrane, time).map_err(|error| error.one_line())
    }
    fn places(&self, times: &[f64]) -> Vec<f64> {
        self.places(times)
    }
    fn lacks_memory(&self) -> Option<String> {
        self.lacks_memory()
    }
}
