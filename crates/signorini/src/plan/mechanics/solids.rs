//! Solids of a system: finite elements at small or finite strain.

use crate::plan::pieces::Pieces;
use crate::plan::planner::Planner;
use crate::problem::units::LENGTH;
use crate::problem::{CaseError, Solid, SolidEdge, Space as Stated, suggestion};
use crate::report::Warning;
use signorini_fem::{Group, Halved, Side};
use signorini_mechanics::Body;
use signorini_solid::{EdgeError, EdgeOf, SolidBody, SolidError, Space};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// The group of what lies on the axis of an axisymmetric body.
pub(super) const AXIS: &str = "axis of rotation";

/// A solid body of a system.
pub(super) struct PlannedSolid {
    pub body: Box<dyn Body>,
    /// Whether a part of it lies on the axis of rotation.
    pub on_axis: bool,
    /// Of a mesh that does not hang together.
    pub pieces: Option<Pieces>,
}

impl Planner<'_> {
    /// A solid with what is known of its mesh.
    pub(super) fn system_solid(
        &self,
        name: &str,
        key: &Solid,
        warnings: &mut Vec<Warning>,
    ) -> Result<PlannedSolid, CaseError> {
        match self.space {
            Stated::ThreeD => self.solid_body::<3>(name, key, Space::Solid, warnings),
            Stated::PlaneStress => self.solid_body::<2>(name, key, Space::PlaneStress, warnings),
            Stated::Axisymmetric => self.solid_body::<2>(name, key, Space::Axisymmetric, warnings),
            _ => self.solid_body::<2>(name, key, Space::PlaneStrain, warnings),
        }
    }

    fn solid_body<const D: usize>(
        &self,
        name: &str,
        key: &Solid,
        space: Space,
        warnings: &mut Vec<Warning>,
    ) -> Result<PlannedSolid, CaseError> {
        let (mesh, degree, material) = self.solid::<D>(name, key, self.key(key), warnings)?;
        let pieces = Pieces::new(name, &mesh);
        let mut groups = mesh.groups().clone();
        let mut mesh = mesh;
        // The spans of splines are halved where their mesh is made.
        if self.halves && !mesh.is_spline() {
            let halved = Halved::new(&mesh);
            groups.values_mut().for_each(|group| *group = halved.group(group));
            mesh = halved.mesh;
        }
        let thermal = self.thermal_material(name, key, &mesh)?;
        let mut on_axis = false;
        if space == Space::Axisymmetric {
            let size = mesh.nodes().iter().map(|x| x.norm()).fold(0.0, f64::max);
            let lies = |v: u32| mesh.nodes()[v as usize][0].abs() <= 1e-12 * size;
            let sides: Vec<Side> =
                mesh.boundary().into_iter().filter(|s| mesh.side_vertices(*s).into_iter().all(lies)).collect();
            let vertices: BTreeSet<u32> =
                (0..mesh.cell_count()).flat_map(|c| mesh.vertices(c)).filter(|v| lies(*v)).collect();
            on_axis = !vertices.is_empty();
            let group = Group { sides, vertices: vertices.into_iter().collect(), ..Group::default() };
            groups.insert(AXIS.to_string(), group);
        }
        let body = SolidBody::<D>::new(name, Arc::new(mesh), degree, material, space, groups).map_err(|e| match e {
            SolidError::Material { .. } => self.problem.error(&key.material, e.to_string()),
            _ => self.problem.error(&key.mesh, e.to_string()),
        })?;
        let body = match self.density(key.density.as_ref())? {
            Some(density) => body.with_density(density),
            None => body,
        };
        let body = match thermal {
            Some(thermal) => body.with_heat(thermal),
            None => body,
        };
        let edges = self.edges(key)?;
        let body = body.with_edges(&edges).map_err(|e| self.wrong_edge(key, &e))?;
        Ok(PlannedSolid { body: body.into_body(), on_axis, pieces })
    }

    /// The edges of a solid as they are stated.
    fn edges(&self, key: &Solid) -> Result<BTreeMap<String, EdgeOf>, CaseError> {
        let edge = |(name, stated): (&String, &SolidEdge)| {
            let surfaces: [String; 2] = stated.between.to_vec().try_into().map_err(|list: Vec<String>| {
                self.problem
                    .error(&stated.between, format!("an edge is between 2 groups of sides, found {}", list.len()))
                    .help("between = [\"top\", \"left\"]")
            })?;
            let radius = stated.radius.as_ref().map_or(Ok(0.0), |r| self.reader.number(r, LENGTH))?;
            Ok((name.clone(), EdgeOf { surfaces, radius }))
        };
        key.edges.iter().map(edge).collect()
    }

    /// The error of an edge, at its key.
    fn wrong_edge(&self, key: &Solid, error: &EdgeError) -> CaseError {
        let told = error.to_string();
        let of = |edge: &String| &key.edges[edge];
        let problem = self.problem;
        match error {
            EdgeError::Plane => problem.error(&key.edges, told).help("space = \"3d\""),
            EdgeError::Taken { edge } => problem.error(of(edge), told).help("give the edge another name"),
            EdgeError::Unknown { edge, group, known } => {
                let known: Vec<&str> = known.iter().map(String::as_str).collect();
                let at = of(edge).between.iter().find(|g| *g == group);
                let told = format!("there is no group `{group}` of sides");
                at.map_or_else(|| problem.error(of(edge), told.clone()), |at| problem.error(at, told.clone()))
                    .help(suggestion(group, &known))
            }
            EdgeError::Radius { edge, .. } => {
                let remedy = "give the radius of the rounding, or 0 for a sharp edge";
                match &of(edge).radius {
                    Some(radius) => problem.error(radius, told).help(remedy),
                    None => problem.error(of(edge), told).help(remedy),
                }
            }
            EdgeError::Apart { edge, .. } => {
                problem.error(&of(edge).between, told).help("give two groups that have cell edges in common")
            }
            EdgeError::Branches { edge, .. } | EdgeError::Pieces { edge, .. } | EdgeError::Kink { edge, .. } => {
                problem.error(&of(edge).between, told).help("name each smooth part of the edge separately")
            }
            EdgeError::Reentrant { edge, .. } => {
                problem.error(&of(edge).between, told).help("name a convex edge, or use the faces themselves")
            }
        }
    }
}
