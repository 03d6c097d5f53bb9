//! Finite-element solids as bodies of a system: unknowns `D f + i` for the hierarchic function `f` in direction `i`.
//!
//! The stiffness of linear elasticity is that of [`stiffness`](crate::stiffness), added up once; for all other laws forces and
//! tangent are integrated from a [`StressLaw`], with the same projection of the dilatation where low degrees or a material
//! that hardly compresses would lock. Contact is tested and met where the body is now, also at small strain.

mod at_point;
mod axes;
mod border;
mod cells;
mod edge;
mod edges;
mod faces;
mod fields;
mod heat;
mod history;
mod hold;
mod loads;
mod mass;
mod master;
mod moments;
mod pieces;
mod projection;
mod spatial;
mod surface;
mod thermal_strain;
mod traction;

pub use edge::{EdgeError, EdgeOf};
pub use heat::{Constant, ThermalMaterial};

use crate::body::Bodies;
use crate::stiffness::{Table, stiffness};
use edge::EdgeCurve;
use faces::Faces;
use pieces::Pieces;
use rayon::prelude::*;
use signorini_fem::{DofMap, Group, Mesh, MeshError};
use signorini_geometry::{Aabb, Point};
use signorini_material::{History, SolidMaterial, Space, StrainError, StressLaw};
use signorini_mechanics::curve::CurveMaster;
use signorini_mechanics::pair::axis;
use signorini_mechanics::{
    Body, BodyError, BodyFields, BodyState, BoxOfMaterial, Constraint, ContactSides, Contribution, Curve, Direction,
    Elimination, Hold, Inertial, Kinematics, Load, Mass, Master, Order, PlaceError, Sampling, Site, Slack, SlavePoint,
    Surface,
};
use spatial::spatial;
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// A solid that cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolidError {
    #[error(transparent)]
    Mesh(#[from] MeshError),
    #[error(transparent)]
    Strain(#[from] StrainError),
    #[error("degree {degree} on a {shape}: valid are 1 to {most}")]
    Degree { degree: usize, shape: &'static str, most: usize },
    #[error("degree {degree} on a spline of degree {of_mesh}: the mesh has to be raised to the degree of the body")]
    Spline { degree: usize, of_mesh: usize },
    #[error("Young's modulus {youngs_modulus} and Poisson's ratio {poissons_ratio}: valid are > 0, and > -1 and < 0.5")]
    Material { youngs_modulus: f64, poissons_ratio: f64 },
    #[error("{space:?} is not a space for bodies in {dimension} dimensions")]
    Space { dimension: usize, space: Space },
}

/// A solid of finite elements.
pub struct SolidBody<const D: usize> {
    /// The body by itself, as the linear model knows it.
    bodies: Bodies<D>,
    material: SolidMaterial,
    groups: BTreeMap<String, Group>,
    faces: Faces<D>,
    /// Edges that may touch as curves.
    edges: BTreeMap<String, EdgeCurve>,
    /// Quadrature tables by the kinds of map and basis of a cell.
    tables: HashMap<(usize, usize), Table>,
    pieces: Pieces,
    /// The pieces whose forces it adds: all, but where other processes have the others.
    kept: Vec<usize>,
    /// Unknowns and stiffness of each of them, of linear laws.
    stiffness: Vec<(Vec<u32>, Vec<f64>)>,
    /// Coefficients of the reference position.
    position: Vec<Point<D>>,
    size: f64,
    history: History,
    /// Mass per volume.
    density: Option<f64>,
    /// Its temperature, where it has one.
    heated: Option<heat::Heated>,
}

impl<const D: usize> SolidBody<D> {
    /// A solid at rest. `groups` are its places: for supports and loads sides, vertices or cells, for contact sides; the
    /// whole boundary is always there as `boundary`.
    ///
    /// # Errors
    /// Meshes, degrees and constants that nothing can be computed with.
    #[inline(never)]
    pub fn new(
        name: &str,
        mesh: Arc<Mesh<D>>,
        degree: usize,
        material: impl Into<SolidMaterial>,
        space: Space,
        groups: BTreeMap<String, Group>,
    ) -> Result<Self, SolidError> {
        let material = material.into();
        let elastic = *material.elastic();
        mesh.check()?;
        let (e, nu) = (elastic.youngs_modulus, elastic.poissons_ratio);
        if !(e > 0.0 && e.is_finite() && nu > -1.0 && nu < 0.5) {
            return Err(SolidError::Material { youngs_modulus: e, poissons_ratio: nu });
        }
        if (D == 3) != (space == Space::Solid) {
            return Err(SolidError::Space { dimension: D, space });
        }
        for cell in 0..mesh.cell_count() {
            let shape = mesh.shape(cell);
            if mesh.map(cell).rational().is_some_and(|basis| basis.degree() != degree) {
                return Err(SolidError::Spline { degree, of_mesh: mesh.map(cell).order() });
            }
            let most = if shape.is_tensor() { signorini_fem::hierarchic::MAX_DEGREE } else { 2 };
            if !(1..=most).contains(&degree) {
                return Err(SolidError::Degree { degree, shape: shape.name(), most });
            }
        }
        let dofs = Arc::new(DofMap::new(&mesh, degree));
        let mut groups = groups;
        groups.entry("boundary".into()).or_insert_with(|| Group { sides: mesh.boundary(), ..Group::default() });
        let mut bodies = Bodies::new(space);
        let body = crate::body::Body { name: name.into(), mesh, dofs, degree, material: elastic, first: 0 };
        bodies.list.push(body);
        let body = &bodies.list[0];
        let mut tables: HashMap<(usize, usize), Table> = HashMap::new();
        for cell in 0..body.mesh.cell_count() {
            tables
                .entry((body.mesh.map_number(cell), body.dofs.basis_number(cell)))
                .or_insert_with(|| Table::new(&body.mesh, &body.dofs, cell));
        }
        check_material(body, &tables, &material)?;
        let pieces = Pieces::new(&body.mesh, &body.dofs, &elastic, space);
        let position = hold::position(&bodies);
        let faces = Faces::new(&bodies, &groups);
        let bounds = Aabb::around(body.mesh.nodes().iter().copied()).expect("a mesh has nodes");
        let size = bounds.size().max();
        let mut out = SolidBody {
            bodies,
            material,
            groups,
            faces,
            edges: BTreeMap::new(),
            tables,
            pieces,
            kept: Vec::new(),
            stiffness: Vec::new(),
            position,
            size,
            history: History::default(),
            density: None,
            heated: None,
        };
        out.kept = (0..out.pieces.count()).collect();
        let points = (0..out.mesh().cell_count()).map(|cell| out.table(cell).points.len());
        out.history = History::new(out.law(), points);
        if out.law().is_linear() {
            out.stiffness = out.linear_stiffness()?;
        }
        Ok(out)
    }

    /// The solid as a body of a system.
    #[inline(never)]
    pub fn into_body(self) -> Box<dyn Body> {
        Box::new(self)
    }

    fn body(&self) -> &crate::body::Body<D> {
        &self.bodies.list[0]
    }

    fn table(&self, cell: usize) -> &Table {
        let body = self.body();
        &self.tables[&(body.mesh.map_number(cell), body.dofs.basis_number(cell))]
    }

    pub fn space(&self) -> Space {
        self.bodies.space
    }

    /// The stress law; of a material that varies a typical one.
    pub fn law(&self) -> &StressLaw {
        self.material.law()
    }

    pub fn mesh(&self) -> &Mesh<D> {
        &self.body().mesh
    }

    pub fn dofs(&self) -> &DofMap {
        &self.body().dofs
    }

    /// The unknowns of the functions of a cell, in their order, and the sign of each function.
    fn unknowns_of(&self, cell: usize) -> (Vec<u32>, Vec<f64>) {
        let list: Vec<(u32, f64)> = self.body().dofs.cell(cell).collect();
        let unknowns = list.iter().flat_map(|(f, _)| (0..D as u32).map(move |i| D as u32 * f + i)).collect();
        let signs = list.iter().flat_map(|(_, s)| [*s; D]).collect();
        (unknowns, signs)
    }

    /// The stiffness of all pieces of a linear law.
    fn linear_stiffness(&self) -> Result<Vec<(Vec<u32>, Vec<f64>)>, SolidError> {
        let body = self.body();
        let rest = self.start();
        let of = |number: usize| {
            let piece = self.piece(number);
            let matrix = match *piece.cells {
                [(cell, _)] if self.material.is_uniform_hooke() => {
                    let (cell, space) = (cell as usize, self.bodies.space);
                    stiffness(&body.mesh, cell, self.table(cell), body.dofs.basis(cell), &body.material, space)
                }
                _ => self.tangent_of(&piece, &rest)?,
            };
            Ok(piece.block(&matrix))
        };
        (0..self.pieces.count()).into_par_iter().map(of).collect()
    }

    fn group(&self, on: Option<&str>) -> Result<&Group, PlaceError> {
        let name = on.unwrap_or("boundary");
        if self.edges.contains_key(name) {
            return Err(self
                .unsuitable(format!("`{name}` is an edge, which is only for contact: name sides, vertices or cells")));
        }
        self.groups.get(name).ok_or_else(|| PlaceError::Unknown {
            body: self.name().to_string(),
            group: name.to_string(),
            known: self.groups.keys().chain(self.edges.keys()).cloned().collect(),
        })
    }

    fn unsuitable(&self, message: impl Into<String>) -> PlaceError {
        PlaceError::Unsuitable { body: self.name().to_string(), message: message.into() }
    }

    /// Displacement coefficients of a function.
    fn coefficients(u: &[f64], f: u32) -> Point<D> {
        Point::<D>::from_fn(|i, _| u[D * f as usize + i])
    }
}

/// Whether the constants of a material that varies make sense at all quadrature points.
fn check_material<const D: usize>(
    body: &crate::body::Body<D>,
    tables: &HashMap<(usize, usize), Table>,
    material: &SolidMaterial,
) -> Result<(), SolidError> {
    if !material.varies() {
        return Ok(());
    }
    for cell in 0..body.mesh.cell_count() {
        for at in &tables[&(body.mesh.map_number(cell), body.dofs.basis_number(cell))].map {
            let (here, law) = material.at(&spatial(&body.mesh.position(cell, at)));
            let (youngs_modulus, poissons_ratio) = (here.youngs_modulus, here.poissons_ratio);
            let is_direction = law.fibre_direction().is_none_or(|a| a.iter().all(|v| v.is_finite()));
            if !(youngs_modulus > 0.0
                && youngs_modulus.is_finite()
                && poissons_ratio > -1.0
                && poissons_ratio < 0.5
                && is_direction)
            {
                return Err(SolidError::Material { youngs_modulus, poissons_ratio });
            }
        }
    }
    Ok(())
}

impl<const D: usize> Body for SolidBody<D> {
    fn name(&self) -> &str {
        &self.body().name
    }

    fn unknowns(&self) -> usize {
        self.body().unknowns()
    }

    fn start(&self) -> BodyState {
        self.start_with_temperature(self.history.start(self.law()))
    }

    fn advance(&self, state: &BodyState, step: &[f64], share: f64) -> BodyState {
        let configuration = state.configuration.iter().zip(step).map(|(u, s)| u + share * s).collect();
        BodyState { configuration, internal: state.internal.clone() }
    }

    fn internal(&self, state: &BodyState, order: Order, out: &mut Contribution) -> Result<f64, BodyError> {
        let u = &state.configuration;
        if !self.law().is_linear() {
            return self.integrated(state, order, out);
        }
        let product = |(unknowns, values): &(Vec<u32>, Vec<f64>)| -> Vec<f64> {
            let own: Vec<f64> = unknowns.iter().map(|k| u[*k as usize]).collect();
            values.chunks(own.len()).map(|row| row.iter().zip(&own).map(|(k, u)| k * u).sum()).collect()
        };
        let forces: Vec<Vec<f64>> = self.stiffness.par_iter().map(product).collect();
        let mut energy = 0.0;
        for ((unknowns, _), forces) in self.stiffness.iter().zip(&forces) {
            for (k, f) in unknowns.iter().zip(forces) {
                out.forces[*k as usize] += f;
                energy += 0.5 * f * u[*k as usize];
            }
        }
        if let Some((forces, at_rest)) = self.thermal_forces(state) {
            for ((out, f), u) in out.forces.iter_mut().zip(forces).zip(u) {
                *out += f;
                energy += f * u;
            }
            energy += at_rest;
        }
        if order == Order::Second {
            out.blocks.extend_from_slice(&self.stiffness);
        }
        Ok(energy)
    }

    /// Rows in the unknowns, one for each function on the place and component that is held. Components across the plane
    /// are never free.
    fn hold(&self, on: Option<&str>, hold: &Hold<'_>, state: &BodyState) -> Result<Vec<Constraint>, PlaceError> {
        self.constraints(on, hold, &state.configuration)
    }

    fn load(
        &self,
        on: Option<&str>,
        load: &Load<'_>,
        state: &BodyState,
        order: Order,
        out: &mut Contribution,
    ) -> Result<(), PlaceError> {
        self.add_load(on, load, &state.configuration, order, out)
    }

    fn sites(&self, on: Option<&str>, sampling: Sampling) -> Result<Vec<Site>, PlaceError> {
        if let Some(edge) = on.and_then(|name| self.edges.get(name)) {
            return Ok(edge.sites(sampling));
        }
        let group = self.group(on)?;
        if group.sides.is_empty() {
            return Err(self.unsuitable(format!("`{}` has no sides for contact", on.unwrap_or("boundary"))));
        }
        Ok(self.faces.sites(on.unwrap_or("boundary"), sampling))
    }

    fn placed(&self, state: &BodyState, site: &Site) -> SlavePoint {
        match self.edge_at(site) {
            Some((edge, element)) => edge.placed(element, site, &state.configuration),
            None => self.faces.placed(site, &state.configuration),
        }
    }

    fn master<'a>(&'a self, on: Option<&str>, state: &'a BodyState) -> Result<Box<dyn Master + 'a>, PlaceError> {
        if let Some(curve) = self.curve(on) {
            return Ok(Box::new(CurveMaster::new(curve, &state.configuration)));
        }
        let group = self.group(on)?;
        if group.sides.is_empty() {
            return Err(self.unsuitable(format!("`{}` has no sides for contact", on.unwrap_or("boundary"))));
        }
        let master = self.faces.master(on.unwrap_or("boundary"), &state.configuration);
        Ok(Box::new(master.map_err(|e| self.unsuitable(e.to_string()))?))
    }

    /// Young's modulus times the area of the site over the depth of its cell, in parts of its degree; of an edge times the
    /// length of the site.
    fn site_stiffness(&self, site: &Site) -> f64 {
        if let Some((edge, element)) = self.edge_at(site) {
            return edge.site_stiffness(element, site);
        }
        let body = self.body();
        body.material.youngs_modulus * site.weight * body.degree as f64 / self.faces.depth(site)
    }

    fn rigid_modes(&self, state: &BodyState) -> [Vec<f64>; 6] {
        let body = self.body();
        let mut is_vertex = vec![false; body.dofs.count()];
        body.unity_unknowns().for_each(|k| is_vertex[k / D] = true);
        std::array::from_fn(|mode| {
            let mut out = vec![0.0; self.unknowns()];
            for (f, position) in self.position.iter().enumerate() {
                let e = axis(mode % 3);
                let motion = match mode {
                    0..3 if is_vertex[f] => e,
                    0..3 => continue,
                    _ => e.cross(&spatial(&(position + Self::coefficients(&state.configuration, f as u32)))),
                };
                (0..D).for_each(|i| out[D * f + i] = motion[i]);
            }
            if self.bodies.space == Space::Axisymmetric && mode != 1 {
                out.iter_mut().for_each(|m| *m = 0.0);
            }
            out
        })
    }

    fn size(&self) -> f64 {
        self.size
    }

    fn fields(&self, state: &BodyState) -> BodyFields {
        self.shown(state)
    }
}

impl<const D: usize> Kinematics for SolidBody<D> {}

impl<const D: usize> Inertial for SolidBody<D> {
    fn mass(&self, touching: &[Option<&str>]) -> Result<Option<Mass>, PlaceError> {
        self.density.map(|density| self.mass_with(density, touching)).transpose()
    }
}

impl<const D: usize> Elimination for SolidBody<D> {
    fn cliques(&self) -> Vec<Vec<u32>> {
        (0..self.pieces.count()).map(|number| self.piece(number).unknowns).collect()
    }

    fn places(&self) -> Vec<[f64; 3]> {
        let positions = self.body().function_positions();
        positions.iter().flat_map(|x| [spatial(x).into(); D]).collect()
    }

    fn is_linear(&self) -> bool {
        self.law().is_linear()
    }

    fn keep_cells(&mut self, keep: &[bool]) -> bool {
        let mut kept = self.kept.iter().map(|piece| keep[*piece]);
        self.stiffness.retain(|_| kept.next().unwrap_or_default());
        self.stiffness.shrink_to_fit();
        self.kept.retain(|piece| keep[*piece]);
        true
    }
}

impl<const D: usize> ContactSides for SolidBody<D> {
    fn surface<'a>(&'a self, on: Option<&str>, state: &'a BodyState) -> Option<Box<dyn Surface + 'a>> {
        let group = on.unwrap_or("boundary");
        let has_sides = self.groups.get(group).is_some_and(|g| !g.sides.is_empty());
        has_sides.then(|| Box::new(self.placed_surface(group, &state.configuration)) as _)
    }

    fn curve<'a>(&'a self, on: Option<&str>) -> Option<Box<dyn Curve + 'a>> {
        Some(Box::new(self.edge(on?)?))
    }

    fn traction(&self, state: &BodyState, site: &Site) -> Option<Direction> {
        self.traction_at(state, site)
    }

    /// `E p²/h`.
    fn stabilisation(&self, site: &Site) -> Option<f64> {
        Some(self.body().degree as f64 * self.site_stiffness(site) / site.weight)
    }
}

impl<const D: usize> Slack for SolidBody<D> {}

impl<const D: usize> BoxOfMaterial for SolidBody<D> {}
