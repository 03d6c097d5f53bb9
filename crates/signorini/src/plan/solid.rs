//! From the statement to solids in contact.

mod finer;
mod friction;
mod mesh;

pub use friction::PlannedFriction;

use super::head::Head;
use super::pieces::Apart;
use super::placed::Placed;
use super::placement::PlacementKeys;
use super::planner::Planner;
use super::rigid::{self, RigidBody};
use crate::expression::Scope;
use crate::problem::units::{FORCE_PER_LENGTH, LENGTH, NONE, PRESSURE};
use crate::problem::{self, Body, Enforcement, List, Material, Method, SolidMesh, Space};
use crate::problem::{CaseError, KeyPath, Location, Problem, ProblemPart, Value, suggestion};
use crate::relief::{MovedHeight, Sampled};
use crate::report::Warning;
use signorini_fem::{Group, Mesh, Side};
use signorini_geometry::Point;
use signorini_geometry::mesh::TriangleMesh;
use signorini_solid::{Elastic, LoadKind, Method as ContactMethod, StressLaw, SupportKind, Volumetric};
use std::collections::{BTreeMap, BTreeSet};

/// Cells up to which a mesh is made with curves of one degree more too: errors are estimated on no more.
const MOST_RAISED: usize = 30_000;

/// A solid body.
#[derive(Clone)]
pub struct PlannedBody<const D: usize> {
    pub name: String,
    pub mesh: Mesh<D>,
    /// The same cells with curves of one degree more, where the mesh follows a map: for estimates of errors.
    pub raised: Option<Mesh<D>>,
    pub degree: usize,
    pub material: Elastic,
}

/// A support: where, what, and the expressions it prescribes.
#[derive(Clone)]
pub struct SolidSupport {
    pub name: String,
    pub body: usize,
    pub group: Group,
    pub kind: SupportKind,
    /// By component, or along the normal.
    pub values: Vec<Option<Placed>>,
}

/// A load: where, what, and its expressions.
#[derive(Clone)]
pub struct SolidLoad {
    pub name: String,
    pub body: usize,
    pub group: Group,
    pub kind: LoadKind,
    pub values: Vec<Placed>,
}

/// The other side of a contact.
#[derive(Clone)]
pub enum Opposite {
    Body { body: usize, sides: Vec<Side>, whole: bool },
    Rigid(RigidBody),
}

/// Two sides that may touch.
#[derive(Clone)]
pub struct SolidContact<const D: usize> {
    pub name: String,
    pub body: usize,
    pub sides: Vec<Side>,
    /// Whether `sides` are all of the body: only those that look at the other body count then.
    pub whole: bool,
    pub opposite: Opposite,
    pub method: ContactMethod,
    pub enforcement: signorini_solid::Enforcement,
    pub friction: Option<PlannedFriction<D>>,
}

/// Solids, what holds and pushes them, and who may touch whom.
#[derive(Clone)]
pub struct SolidPlan<const D: usize> {
    pub head: Head,
    pub space: Space,
    pub bodies: Vec<PlannedBody<D>>,
    pub supports: Vec<SolidSupport>,
    pub loads: Vec<SolidLoad>,
    pub contacts: Vec<SolidContact<D>>,
    pub times: Vec<f64>,
    pub probes: BTreeMap<String, (usize, Point<D>)>,
}

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
    /// A file named in the case, beside the case; the files of the gallery are carried in the program.
    pub(super) fn read_file(&self, name: &String) -> Result<(std::path::PathBuf, Vec<u8>), CaseError> {
        let path = self.problem.source.folder().join(name);
        match (std::fs::read(&path), crate::gallery::asset(name)) {
            (Ok(bytes), _) => Ok((path, bytes)),
            (Err(_), Some(bytes)) => Ok((path, bytes.to_vec())),
            (Err(e), None) => Err(self.problem.error(name, format!("`{}`: cannot be read: {e}", path.display()))),
        }
    }

    /// The heights of a map.
    pub(super) fn height_map(&self, key: &problem::HeightMap) -> Result<MovedHeight<Sampled>, CaseError> {
        let (path, bytes) = self.read_file(&key.file)?;
        let spacing = self.reader.numbers::<2>(&key.spacing, LENGTH)?;
        if spacing.iter().any(|h| *h <= 0.0) {
            return Err(self.problem.error(&key.spacing, format!("the spacing {spacing:?} is not positive")));
        }
        let origin = key.origin.as_ref().map(|o| self.reader.numbers::<2>(o, LENGTH)).transpose()?.unwrap_or_default();
        let scale = key.scale.as_ref().map(|s| self.reader.number(s, LENGTH)).transpose()?.unwrap_or(1.0);
        let angle = key.turn.as_ref().map(|t| self.reader.number(t, NONE)).transpose()?.unwrap_or(0.0);
        let moved = key.moved.as_ref().map(|m| self.reader.numbers::<3>(m, LENGTH)).transpose()?.unwrap_or_default();
        let height = crate::height_map::read(&path, &bytes, [0.0; 2], spacing, scale)
            .map_err(|message| self.problem.error(&key.file, format!("`{}`: {message}", path.display())))?;
        Ok(MovedHeight { height, angle, shift: [origin[0] + moved[0], origin[1] + moved[1], moved[2]] })
    }

    /// A triangle mesh that bounds a body.
    pub(super) fn closed_mesh(&self, key: &problem::SurfaceFile) -> Result<TriangleMesh, CaseError> {
        let (path, bytes) = self.read_file(&key.file)?;
        let mut mesh =
            crate::mesh_file::parse(&path, &bytes).map_err(|e| self.problem.error(&key.file, e.to_string()))?;
        let keys = PlacementKeys { scale: &key.scale, turn: &key.turn, moved: &key.moved };
        if let Some(placement) = self.placement::<3>(&keys)? {
            let placed = mesh.vertices().iter().map(|x| placement.point(x)).collect();
            mesh = TriangleMesh::new(placed, mesh.triangles())
                .map_err(|e| self.problem.error(&key.file, e.to_string()))?;
        }
        if mesh.quality().has_inside() {
            return self.turned_outwards(mesh, &key.file, &format!("the surface in `{}`", key.file));
        }
        Err(self
            .problem
            .error(&key.file, format!("the surface in `{}` is not closed", key.file))
            .help("a rigid body needs an inside: close the holes, or model it by another shape"))
    }

    /// A closed surface with its normals outwards: one whose volume is negative is turned round, and that is said.
    pub(super) fn turned_outwards(
        &self,
        mesh: TriangleMesh,
        at: &impl Location,
        what: &str,
    ) -> Result<TriangleMesh, CaseError> {
        let centre = mesh.bounds().center();
        let signed = |triangle: usize| {
            let [a, b, c] = mesh.corners(triangle).map(|x| x - centre);
            a.dot(&b.cross(&c)) / 6.0
        };
        let volume: f64 = (0..mesh.triangles().len()).map(signed).sum();
        if volume >= 0.0 {
            return Ok(mesh);
        }
        let warning = format!("{what} is inside out, its volume is {volume:.4e}: it is turned round");
        let warning = Warning::from(warning);
        let mut warnings = self.warnings.borrow_mut();
        if !warnings.contains(&warning) {
            warnings.push(warning);
        }
        let turned: Vec<[u32; 3]> = mesh.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
        TriangleMesh::new(mesh.vertices().to_vec(), &turned).map_err(|e| self.problem.error(at, e.to_string()))
    }

    fn coordinates<const D: usize>(&self) -> &'static [&'static str] {
        if D == 2 { &["x", "y", "t"] } else { &["x", "y", "z", "t"] }
    }

    pub(super) fn solids<const D: usize>(&self) -> Result<SolidPlan<D>, CaseError> {
        let problem = self.problem;

        let membrane = problem.bodies.values().any(|b| matches!(b, Body::Membrane(_)));
        if membrane && !problem.bodies.values().any(|b| matches!(b, Body::Solid(_))) {
            return Err(problem
                .error(&problem.space, "this space is one of solids, and there is a membrane")
                .help("of membranes: space = \"line\", \"axisymmetric\" or \"plane\""));
        }
        let mut bodies = Vec::new();
        let mut warnings = Vec::new();
        for (name, body) in &problem.bodies {
            match body {
                Body::Solid(key) => bodies.push(self.solid::<D>(name, key, self.key(body), &mut warnings)?),
                Body::Rigid(_) => {}
                _ => {
                    return Err(problem
                        .error(body, format!("the body `{name}` cannot stand beside solids in this version"))
                        .help("bodies here are `solid` or `rigid`"));
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
                        "the probe `{name}` at ({}) lies outside all bodies: it tells of the nearest point of `{}`",
                        at.join(", "),
                        bodies[near].name
                    )
                    .into(),
                );
            }
            probes.insert(name.clone(), (near, x));
        }
        if contacts.is_empty() && problem.bodies.len() > 1 {
            warnings.push("no contact is stated: the bodies do not see each other (add [contacts.NAME])".into());
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

    /// What a solid is made of, and how its stress follows from its strain.
    pub(super) fn material(&self, key: &problem::Solid) -> Result<(Elastic, StressLaw), CaseError> {
        let problem = self.problem;
        let finite = match key.strain.as_ref().map(|strain| (strain, strain.as_str())) {
            None | Some((_, "small")) => false,
            Some((_, "finite")) => true,
            Some((strain, other)) => {
                return Err(problem.error(strain, format!("unknown word `{other}`")).help("known here: small, finite"));
            }
        };
        let (constants, law) = match &key.material {
            Material::LinearElastic(m) => (m, StressLaw::LinearElastic),
            Material::NeoHooke(m) => (m, StressLaw::NeoHooke(Volumetric::default())),
            Material::SaintVenantKirchhoff(m) => (m, StressLaw::SaintVenantKirchhoff),
        };
        if finite && law == StressLaw::LinearElastic {
            return Err(problem.error(&key.material, "`linear_elastic` is a material of small strains").help(
                "with strain = \"finite\":  material.neo_hooke = {…}  or  material.saint_venant_kirchhoff = {…}",
            ));
        }
        if !finite && law != StressLaw::LinearElastic {
            return Err(problem
                .error(&key.material, "this material is one of finite strain")
                .help("strain = \"finite\""));
        }
        let youngs_modulus = self.reader.positive(&constants.youngs_modulus, PRESSURE)?;
        let poissons_ratio = self.reader.number(&constants.poissons_ratio, NONE)?;
        if !(poissons_ratio > -1.0 && poissons_ratio < 0.5) {
            return Err(problem
                .error(&constants.poissons_ratio, format!("Poisson's ratio is {poissons_ratio}"))
                .help("above -1 and below 0.5; nearly incompressible is for example 0.4999"));
        }
        Ok((Elastic { youngs_modulus, poissons_ratio }, law))
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
                .help("these have degree 1 or 2; quadrilaterals and hexahedra 1 to 8"));
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

    /// Looks up `BODY` or `BODY:GROUP`.
    fn solid_place<const D: usize>(
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
                return Err(self.problem.error(on, format!("`{name}` is rigid: its motion is stated with it")));
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

    fn solid_supports<const D: usize>(&self, bodies: &[PlannedBody<D>]) -> Result<Vec<SolidSupport>, CaseError> {
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
                    return Err(problem.error(&key.on, "`normal` needs a part of the boundary"));
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

    fn solid_loads<const D: usize>(&self, bodies: &[PlannedBody<D>]) -> Result<Vec<SolidLoad>, CaseError> {
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
                    .help("solids take pressure (positive pushes inwards), traction, force, body_force"));
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
                    .error(key, format!("the load `{name}` says {} things", list.len()))
                    .help("exactly one of pressure, traction, force, body_force")
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
                    return Err(problem.error(&key.on, format!("this load acts on {wanted}")).help(format!(
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

    /// The penetration that a penalty may leave; none where it is left to the program.
    pub(super) fn wanted_penetration(&self, key: &problem::Penalty) -> Result<Option<f64>, CaseError> {
        key.wanted_penetration.as_ref().map(|v| self.reader.positive(v, LENGTH)).transpose()
    }

    fn solid_method(&self, key: &problem::Contact) -> Result<(ContactMethod, signorini_solid::Enforcement), CaseError> {
        use signorini_solid::Enforcement as Kept;
        let Some(method) = &key.method else { return Ok((ContactMethod::Mortar, Kept::Multiplier)) };
        let (which, stated) = match method {
            Method::Mortar(k) => (ContactMethod::Mortar, &k.enforcement),
            Method::Node(k) => (ContactMethod::Node, &k.enforcement),
            Method::GaussPoint(k) => (ContactMethod::GaussPoint, &k.enforcement),
            _ => {
                return Err(self
                    .problem
                    .error(method, "this method is for membranes")
                    .help("solids have  method.mortar = {},  method.node = {}  and  method.gauss_point = {}"));
            }
        };
        let kept = match stated {
            None if which == ContactMethod::GaussPoint => Kept::Penalty { wanted_penetration: None },
            None => Kept::Multiplier,
            Some(multiplier @ Enforcement::Multiplier(_)) if which == ContactMethod::GaussPoint => {
                return Err(self
                    .problem
                    .error(multiplier, "a multiplier at every quadrature point holds the surface too tightly")
                    .help("enforcement.penalty = {}, or method.mortar = {}"));
            }
            Some(Enforcement::Multiplier(_)) => Kept::Multiplier,
            Some(Enforcement::AugmentedLagrangian(_)) => Kept::AugmentedLagrangian,
            Some(Enforcement::Penalty(k)) => Kept::Penalty { wanted_penetration: self.wanted_penetration(k)? },
            Some(nitsche @ Enforcement::Nitsche(_)) => {
                if which == ContactMethod::Node {
                    return Err(self
                        .problem
                        .error(nitsche, "Nitsche's method is in the mean or at quadrature points")
                        .help("method.mortar = { enforcement.nitsche = {} }"));
                }
                Kept::Nitsche
            }
        };
        Ok((which, kept))
    }

    /// The sides of a place, and whether they are all of the body.
    fn contact_side<const D: usize>(
        &self,
        on: &String,
        bodies: &[PlannedBody<D>],
    ) -> Result<(usize, Vec<Side>, bool), CaseError> {
        let (body, group) = self.solid_place(on, bodies)?;
        let whole = group.is_none();
        let sides = group.map_or_else(|| bodies[body].mesh.boundary(), |g| g.sides);
        if sides.is_empty() {
            return Err(self.problem.error(on, "there are no sides of cells in this group"));
        }
        Ok((body, sides, whole))
    }

    fn solid_contacts<const D: usize>(&self, bodies: &[PlannedBody<D>]) -> Result<Vec<SolidContact<D>>, CaseError> {
        let problem = self.problem;
        let around = around(bodies);
        let mut out = Vec::new();
        for (name, key) in &problem.contacts {
            if let Some(within) = &key.within {
                return Err(self.unavailable(within, "contact of a body with itself"));
            }
            if let Some(adhesion) = &key.adhesion
                && self.reader.number(&adhesion.energy, [-1, 1, 0])? != 0.0
            {
                return Err(self.unavailable(&adhesion.energy, "adhesion of solids"));
            }
            let (method, enforcement) = self.solid_method(key)?;
            let friction = key.friction.as_ref().map(|friction| self.friction::<D>(friction)).transpose()?;
            let mut add = |name: String, (body, sides, whole): (usize, Vec<Side>, bool), opposite| {
                out.push(SolidContact { name, body, sides, whole, opposite, method, enforcement, friction });
            };
            match (&key.between, &key.all) {
                (Some(pair), None) if pair.len() == 2 => {
                    let rigid = |on: &String| match problem.bodies.get(on)? {
                        Body::Rigid(rigid) => Some(rigid),
                        _ => None,
                    };
                    let [first, second] = [&pair[0], &pair[1]];
                    // The slave is the solid, in whichever order they are named.
                    let [first, second] = if rigid(first).is_some() { [second, first] } else { [first, second] };
                    if rigid(first).is_some() {
                        return Err(problem.error(pair, "both bodies of this contact are rigid").help(format!(
                            "a contact is between solids, or a solid and a rigid body: `{}`, for example",
                            bodies[0].name
                        )));
                    }
                    let opposite = match rigid(second) {
                        Some(body) => Opposite::Rigid(rigid::read::<D>(self, second, body, &around)?),
                        None => {
                            let (body, sides, whole) = self.contact_side(second, bodies)?;
                            Opposite::Body { body, sides, whole }
                        }
                    };
                    add(name.clone(), self.contact_side(first, bodies)?, opposite);
                }
                (None, Some(all)) if *all => {
                    let side = |k: usize| (k, bodies[k].mesh.boundary(), true);
                    for slave in 0..bodies.len() {
                        for master in slave + 1..bodies.len() {
                            let (body, sides, whole) = side(master);
                            let name = format!("{name}_{}_{}", bodies[slave].name, bodies[master].name);
                            add(name, side(slave), Opposite::Body { body, sides, whole });
                        }
                        for (other, body) in &problem.bodies {
                            if let Body::Rigid(rigid) = body {
                                let rigid = Opposite::Rigid(rigid::read::<D>(self, other, rigid, &around)?);
                                add(format!("{name}_{}_{other}", bodies[slave].name), side(slave), rigid);
                            }
                        }
                    }
                }
                _ => {
                    return Err(problem.error(key, "who touches whom is not said").help(
                        "between = [\"BODY:GROUP\", \"BODY:GROUP\"], the slave first where both are solids; or  all = true",
                    ));
                }
            }
        }
        Ok(out)
    }
}

/// The box around all bodies, twice as long.
fn around<const D: usize>(bodies: &[PlannedBody<D>]) -> signorini_geometry::Aabb<3> {
    let all = || bodies.iter().flat_map(|b| b.mesh.nodes());
    let low = all().fold(Point::<D>::repeat(f64::INFINITY), |l, x| l.inf(x));
    let high = all().fold(Point::<D>::repeat(f64::NEG_INFINITY), |h, x| h.sup(x));
    let pad = 0.5 * (high - low).amax();
    let spatial = |x: &Point<D>, by: f64| Point::<3>::from_fn(|k, _| if k < D { x[k] + by } else { 0.0 });
    rigid::flat_box::<D>(spatial(&low, -pad), spatial(&high, pad))
}

/// On the axis the radial displacement vanishes.
fn axis_supports<const D: usize>(bodies: &[PlannedBody<D>]) -> Vec<SolidSupport> {
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
pub(super) fn no_spring(problem: &problem::Problem, at: &impl ProblemPart) -> CaseError {
    problem
        .error(at, "a spring without stiffness holds nothing")
        .help("a positive stiffness along what is to be held; or leave `spring` out")
}
