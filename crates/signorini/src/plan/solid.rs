//! From the statement to the cells of solids, their materials and laws of friction.

mod elastic_plastic;
mod file;
mod friction;
mod interface;
mod material;
mod mesh;
mod nurbs;
mod orthotropic;
mod rubber;

use super::mechanics::odd_modulus;
use super::pieces::Apart;
use super::placement::PlacementKeys;
use super::planner::Planner;
use crate::problem::{self, CaseError, KeyPath, SolidMesh};
use crate::report::Warning;
use signorini_fem::Mesh;
use signorini_material::SolidMaterial;

impl Planner<'_> {
    /// The cells of a solid, the degree of its functions, and what it is made of.
    pub(super) fn solid<const D: usize>(
        &self,
        name: &str,
        key: &problem::Solid,
        at: KeyPath,
        warnings: &mut Vec<Warning>,
    ) -> Result<(Mesh<D>, usize, SolidMaterial), CaseError> {
        let problem = self.problem;
        let material = self.material(key.strain.as_ref(), &key.material)?;
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
                let placement = PlacementKeys { scale: &g.scale, rotate: &g.rotate, translate: &g.translate };
                self.gmsh::<D>(&g.file, g.group.as_deref(), &placement)?
            }
            SolidMesh::File(file) => self.mesh_of_file::<D>(file)?,
            SolidMesh::Arrays(arrays) => self.mesh_of_arrays::<D>(arrays)?,
            SolidMesh::Nurbs(patches) => self.nurbs::<D>(name, patches, key.degree.as_ref())?,
        };
        let material = self.typical(key, material, &mesh)?;
        let elastic = material.elastic();
        if let Some(units) = self.reader.units {
            warnings.extend(odd_modulus(units, elastic.youngs_modulus, name).map(Warning::from));
        }
        let simplices = (0..mesh.cell_count()).any(|c| !mesh.shape(c).is_tensor());
        let order = (0..mesh.cell_count()).map(|c| mesh.map(c).order()).max().unwrap_or(1);
        let degree = stated.unwrap_or(order);
        if simplices && degree > 2 {
            let at = key.degree.as_ref().map_or(at, |d| self.key(d));
            return Err(problem
                .error(&at, format!("degree {degree} on a mesh with triangles, tetrahedra or wedges"))
                .help("these have degree 1 or 2; quadrilaterals and hexahedra have degree 1 to 8"));
        }
        let locks = |c: usize| signorini_solid::stiffness::locks(mesh.shape(c), degree, elastic);
        if (0..mesh.cell_count()).any(locks) {
            warnings.push(
                format!(
                    "`{name}`: triangles or tetrahedra of degree 1 lock with Poisson's ratio {}: use degree 2",
                    elastic.poissons_ratio
                )
                .into(),
            );
        }
        warnings.extend(Apart::new(&mesh).and_then(|apart| apart.warning(name)).map(Warning::from));
        Ok((mesh, degree, material))
    }
}
