//! Solids of a system: finite elements at small or finite strain.

use crate::plan::planner::Planner;
use crate::problem::{CaseError, Solid, Space as Stated};
use crate::report::Warning;
use signorini_fem::{Group, Side};
use signorini_mechanics::Body;
use signorini_solid::{SolidBody, Space};
use std::collections::BTreeSet;
use std::sync::Arc;

/// The group of what lies on the axis of an axisymmetric body.
pub(super) const AXIS: &str = "axis of rotation";

impl Planner<'_> {
    /// A solid, and whether a part of it lies on the axis of rotation.
    pub(super) fn system_solid(
        &self,
        name: &str,
        key: &Solid,
        warnings: &mut Vec<Warning>,
    ) -> Result<(Box<dyn Body>, bool), CaseError> {
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
    ) -> Result<(Box<dyn Body>, bool), CaseError> {
        let planned = self.solid::<D>(name, key, self.key(key), warnings)?;
        let law = self.material(key)?;
        let mesh = planned.mesh;
        let mut groups = mesh.groups().clone();
        let mut on_axis = false;
        if space == Space::Axisymmetric {
            let size = mesh.nodes().iter().map(|x| x.norm()).fold(0.0, f64::max);
            let lies = |v: u32| mesh.nodes()[v as usize][0].abs() <= 1e-12 * size;
            let sides: Vec<Side> =
                mesh.boundary().into_iter().filter(|s| mesh.side_vertices(*s).into_iter().all(lies)).collect();
            let vertices: BTreeSet<u32> =
                (0..mesh.cell_count()).flat_map(|c| mesh.vertices(c)).filter(|v| lies(*v)).collect();
            on_axis = !vertices.is_empty();
            let group = Group { cells: Vec::new(), sides, vertices: vertices.into_iter().collect() };
            groups.insert(AXIS.to_string(), group);
        }
        let body = SolidBody::<D>::new(name, Arc::new(mesh), planned.degree, law, space, groups)
            .map_err(|e| self.problem.error(&key.mesh, e.to_string()))?;
        Ok((Box::new(body), on_axis))
    }
}
