//! Several solids as one body.

use super::TrimmedSolid;
use crate::mass_properties::MassProperties;
use crate::mesh::TriangleMesh;
use crate::rigid_shape::{GapJet, RigidShape};
use crate::{Aabb, Matrix, Point, Vector};

/// Solids that are apart.
#[derive(Debug)]
pub struct TrimmedSolids {
    solids: Vec<TrimmedSolid>,
    bounds: Aabb<3>,
    mesh: Option<TriangleMesh>,
}

/// Sizes of a body by which a point of another is beyond it.
const APART: f64 = 1e-9;

impl TrimmedSolids {
    /// # Errors
    /// The numbers of two that touch or overlap: faces between them would count as surface. None at all.
    pub fn new(solids: Vec<TrimmedSolid>) -> Result<Self, [usize; 2]> {
        let Some(bounds) = solids.iter().map(|s| s.bounds).reduce(|a, b| a.joined(&b)) else { return Err([0, 0]) };
        for i in 0..solids.len() {
            for j in (0..solids.len()).filter(|j| *j != i) {
                let (a, b) = (&solids[i], &solids[j]);
                if a.bounds.is_apart(&b.bounds) {
                    continue;
                }
                let corners = a.mesh().map_or(&a.vertices[..], TriangleMesh::vertices);
                if corners.iter().any(|x| b.gap(x).gap <= APART * b.size) {
                    return Err([i, j]);
                }
            }
        }
        let meshes: Option<Vec<&TriangleMesh>> = solids.iter().map(TrimmedSolid::mesh).collect();
        let mesh = meshes.and_then(|list| {
            let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
            for mesh in list {
                let first = vertices.len() as u32;
                vertices.extend_from_slice(mesh.vertices());
                triangles.extend(mesh.triangles().iter().map(|t| t.map(|v| v + first)));
            }
            TriangleMesh::new(vertices, &triangles).ok()
        });
        Ok(TrimmedSolids { solids, bounds, mesh })
    }
}

impl RigidShape for TrimmedSolids {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        let first = self.solids[0].gap(x);
        self.solids[1..].iter().map(|s| s.gap(x)).fold(first, |a, b| if b.gap < a.gap { b } else { a })
    }

    /// The origin: the file of a body says no other.
    fn centre(&self) -> Point<3> {
        Point::<3>::zeros()
    }

    fn bounds(&self) -> Option<Aabb<3>> {
        Some(self.bounds)
    }

    fn mass_properties(&self) -> Option<MassProperties> {
        let all: Vec<MassProperties> = self.solids.iter().map(|s| s.mass).collect::<Option<_>>()?;
        let volume = all.iter().map(|m| m.volume).sum::<f64>();
        let centre = all.iter().map(|m| m.centre * m.volume).sum::<Vector<3>>() / volume;
        let about = |m: &MassProperties| {
            let d = m.centre - centre;
            m.inertia + (Matrix::<3>::identity() * d.norm_squared() - d * d.transpose()) * m.volume
        };
        Some(MassProperties { volume, centre, inertia: all.iter().map(about).sum() })
    }

    fn mesh(&self) -> Option<&TriangleMesh> {
        self.mesh.as_ref()
    }
}
