//! Reads the membrane of a problem.

use super::{MembranePlan, PlannedSupport};
use crate::plan::domain;
use crate::plan::located::LocatedExpression;
use crate::plan::planner::Planner;
use crate::plan::surface::Contact;
use crate::problem::units::{FORCE_PER_LENGTH, LENGTH, PRESSURE};
use crate::problem::{self, Body, CaseError, Method};
use crate::report::Warning;
use signorini_fem::Grid;
use signorini_geometry::Point;
use signorini_membrane::domain::Domain;
use signorini_membrane::history::{MethodChoice, Statement};
use signorini_membrane::method::Formulation;
use signorini_membrane::obstacle::Side;
use signorini_membrane::refinement::Refinement;
use std::collections::BTreeMap;
use std::sync::Arc;

impl Planner<'_> {
    pub(crate) fn membrane<const D: usize>(&self) -> Result<MembranePlan<D>, CaseError>
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
                .error(&self.problem.space, "the case has no membrane")
                .help("add a body, for example  [bodies.film.membrane]"));
        };
        if let Some((_, second, _)) = films.next() {
            return Err(self.unavailable(second, "more than one membrane"));
        }
        for (name, b) in &self.problem.bodies {
            if !matches!(b, Body::Membrane(_) | Body::Rigid(_)) {
                return Err(self.unavailable(b, &format!("the body `{name}`: `{}`", b.kind())));
            }
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
                "the case has no contact, so rigid bodies are ignored (add [contacts.NAME] between = [film, floor])"
                    .into(),
            );
        }
        if method.formulation() != Formulation::OneSided {
            self.on_plain_cells(film, &mut on)?;
        }
        if let MethodChoice::ActiveSet(_) = method {
            if let problem::Mesh::Gmsh(key) = &film.mesh {
                return Err(problem
                    .error(&key.file, "method.active_set requires a grid")
                    .help("mesh.grid = { cells = [40, 40] }, or method.inequality_level_set = {}"));
            }
            if on.grid.degree() != 1 && film.degree.is_some() {
                warnings.push("method.active_set has degree 1; the given degree is not used".into());
            }
            on.refinement = Refinement::default();
            on.grid = Grid::new(*on.grid.bounds(), on.grid.cells(), 1);
            on.cells = on.grid.as_cells();
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
                .error(key, format!("`{name}` has several bodies, and `initial_zone` does not name one"))
                .help("give this body a contact of its own, with `between`"));
        };
        Ok(Some((contact.side, zone)))
    }

    #[allow(clippy::too_many_arguments)]
    fn finish<const D: usize>(
        &self,
        body: &str,
        on: domain::OnCells<D>,
        tension: LocatedExpression,
        loads: BTreeMap<String, LocatedExpression>,
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
        let membrane = plan.at(plan.increments[0].range[0]);
        for (name, x) in plan.probes.iter().filter(|(_, x)| !membrane.contains(x)) {
            let at: Vec<String> = x.iter().map(f64::to_string).collect();
            let message = format!("the probe `{name}` at ({}) lies outside `{body}` and has no values", at.join(", "));
            plan.head.warnings.push(message.into());
        }
        Ok(plan)
    }

    fn loads(&self, body: &str) -> Result<BTreeMap<String, LocatedExpression>, CaseError> {
        let mut loads = BTreeMap::new();
        for (name, key) in &self.problem.loads {
            self.check_place(&key.on, body, &[])?;
            let others = [
                ("traction", key.traction.as_ref().map(|v| self.key(v))),
                ("pressure", key.pressure.as_ref().map(|v| self.key(v))),
                ("force", key.force.as_ref().map(|v| self.key(v))),
                ("nodal_force", key.nodal_force.as_ref().map(|v| self.key(v))),
                ("body_force", key.body_force.as_ref().map(|v| self.key(v))),
            ];
            if let Some((what, at)) = others.iter().find_map(|(w, s)| s.clone().map(|s| (*w, s))) {
                return Err(self.problem.error(&at, format!("`{what}` is not a load of membranes")).help(
                    "the load of a membrane is  normal = …  : force per area along +z, negative for a downward load",
                ));
            }
            let Some(normal) = &key.normal else {
                return Err(self.problem.error(key, format!("the load `{name}` has no value")).help("add  normal = …"));
            };
            loads.insert(name.clone(), self.placed(normal, PRESSURE)?);
        }
        Ok(loads)
    }
}
