//! From the statement to solids in contact.

mod contacts;
mod finer;
mod friction;
pub(super) mod loads;
mod material;
mod mesh;
mod statement;

pub use friction::PlannedFriction;
pub use statement::{Opposite, PlannedBody, SolidContact, SolidLoad, SolidPlan, SolidSupport};

use super::pieces::Apart;
use super::placed::Placed;
use super::placement::PlacementKeys;
use super::planner::Planner;
use crate::expression::Scope;
use crate::problem::units::LENGTH;
use crate::problem::{self, Body, CaseError, KeyPath, Problem, SolidMesh, Space};
use crate::report::Warning;
use loads::axis_supports;
use signorini_geometry::Point;
use std::collections::BTreeMap;

/// Cells up to which a mesh is made with curves of one degree more too: errors are estimated on no more.
const MOST_RAISED: usize = 30_000;

/// The value of an expression at a point and time, or an error that names it.
pub fn evaluate<const D: usize>(problem: &Problem, placed: &Placed, x: &Point<D>, time: f64) -> Result<f64, CaseError> {
    let position = std::array::from_fn(|k| if k < D { x[k] } else { 0.0 });
    let value = placed.expression.evaluate(&Scope { position, time });
    if value.is_finite() {
        return Ok(value);
    }
    let at: Vec<String> = x.iter().map(|v| format!("{v:.6}")).collect();
    Err(problem.error(
        &placed.key,
        format!("`{}` is {value} at ({}), t = {time}: not a finite number", placed.key, at.join(", ")),
    ))
}

impl Planner<'_> {
    pub(super) fn solids<const D: usize>(&self) -> Result<SolidPlan<D>, CaseError> {
        let problem = self.problem;

        let membrane = problem.bodies.values().any(|b| matches!(b, Body::Membrane(_)));
        if membrane && !problem.bodies.values().any(|b| matches!(b, Body::Solid(_))) {
            return Err(problem
                .error(&problem.space, "this space is for solids, but the case has a membrane")
                .help("for membranes: space = \"line\", \"axisymmetric\" or \"plane\""));
        }
        let mut bodies = Vec::new();
        let mut warnings = Vec::new();
        for (name, body) in &problem.bodies {
            match body {
                Body::Solid(key) => bodies.push(self.solid::<D>(name, key, self.key(body), &mut warnings)?),
                Body::Rigid(_) => {}
                _ => {
                    return Err(problem
                        .error(body, format!("the body `{name}` cannot be combined with solids in this version"))
                        .help("valid bodies here are `solid` and `rigid`"));
                }
            }
        }
        if bodies.is_empty() {
            return Err(problem
                .error(&problem.space, "there is no solid")
                .help("add a body, for example  [bodies.block.solid]"));
        }
        let mut supports = self.solid_supports(&bodies)?;
        let loads = self.solid_loads(&bodies)?;
        let contacts = self.solid_contacts(&bodies)?;
        if self.space == Space::Axisymmetric {
            supports.extend(axis_supports(&bodies));
        }
        let mut probes = BTreeMap::new();
        for (name, at) in &problem.output.probes {
            let x = self.reader.numbers::<D>(at, LENGTH)?;
            let x = Point::<D>::from_fn(|k, _| x[k]);
            // The vertex next to it.
            let nearest = (bodies.iter().enumerate())
                .map(|(k, b)| (b.mesh.nodes().iter().map(|n| (n - x).norm()).fold(f64::INFINITY, f64::min), k))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            let near = nearest.map_or(0, |n| n.1);
            let within = |b: &PlannedBody<D>| {
                let nodes = || b.mesh.nodes().iter();
                let low = nodes().fold(Point::<D>::repeat(f64::INFINITY), |l, n| l.inf(n));
                let high = nodes().fold(Point::<D>::repeat(f64::NEG_INFINITY), |h, n| h.sup(n));
                (0..D).all(|k| x[k] >= low[k] && x[k] <= high[k])
            };
            if !bodies.iter().any(within) {
                let at: Vec<String> = x.iter().map(f64::to_string).collect();
                warnings.push(
                    format!(
                        "the probe `{name}` at ({}) lies outside all bodies: the nearest point of `{}` is used",
                        at.join(", "),
                        bodies[near].name
                    )
                    .into(),
                );
            }
            probes.insert(name.clone(), (near, x));
        }
        if contacts.is_empty() && problem.bodies.len() > 1 {
            warnings.push("the case has no contact, so the bodies do not interact (add [contacts.NAME])".into());
        }
        if problem.steps.iter().any(|s| s.events.is_some()) {
            warnings.push("`events` are located for membranes only".into());
        }
        Ok(SolidPlan {
            head: self.head(warnings)?,
            space: self.space,
            bodies,
            supports,
            loads,
            contacts,
            times: self.times()?,
            probes,
        })
    }

    pub(super) fn solid<const D: usize>(
        &self,
        name: &str,
        key: &problem::Solid,
        at: KeyPath,
        warnings: &mut Vec<Warning>,
    ) -> Result<PlannedBody<D>, CaseError> {
        let problem = self.problem;
        let (material, _) = self.material(key)?;
        let stated = match &key.degree {
            None => None,
            Some(d) if (1..=8).contains(d) => Some(*d as usize),
            Some(d) => return Err(problem.error(d, format!("degree {} is not between 1 and 8", d))),
        };
        let mesh = match &key.mesh {
            SolidMesh::Box(b) => {
                let mesh = self.block::<D>(name, b, stated.unwrap_or(1))?;
                self.check_overlap(name, b, &mesh)?;
                mesh
            }
            SolidMesh::Gmsh(g) => {
                let placement = PlacementKeys { scale: &g.scale, turn: &g.turn, moved: &g.moved };
                self.gmsh::<D>(&g.file, g.group.as_deref(), &placement)?
            }
            SolidMesh::Arrays(arrays) => self.mesh_of_arrays::<D>(arrays)?,
            SolidMesh::Nurbs(_) => return Err(self.unavailable(&key.mesh, "a NURBS solid")),
        };
        let simplices = (0..mesh.cell_count()).any(|c| !mesh.shape(c).is_tensor());
        let order = (0..mesh.cell_count()).map(|c| mesh.map(c).order()).max().unwrap_or(1);
        let degree = stated.unwrap_or(order);
        if simplices && degree > 2 {
            let at = key.degree.as_ref().map_or(at, |d| self.key(d));
            return Err(problem
                .error(&at, format!("degree {degree} on a mesh with triangles, tetrahedra or wedges"))
                .help("these have degree 1 or 2; quadrilaterals and hexahedra have degree 1 to 8"));
        }
        let locks = |c: usize| signorini_solid::stiffness::locks(mesh.shape(c), degree, &material);
        if (0..mesh.cell_count()).any(locks) {
            warnings.push(
                format!(
                    "`{name}`: triangles or tetrahedra of degree 1 lock with Poisson's ratio {}: use degree 2",
                    material.poissons_ratio
                )
                .into(),
            );
        }
        warnings.extend(Apart::new(&mesh).and_then(|apart| apart.warning(name)).map(Warning::from));
        let raised = match &key.mesh {
            SolidMesh::Box(b) if b.map.is_some() && mesh.cell_count() <= MOST_RAISED => {
                self.block::<D>(name, b, degree + 1).ok()
            }
            _ => None,
        };
        Ok(PlannedBody { name: name.to_string(), mesh, raised, degree, material })
    }
}
