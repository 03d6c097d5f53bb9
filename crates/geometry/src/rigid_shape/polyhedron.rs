//! Closed triangle meshes as bodies with facets, edges and corners.

use super::{ClosestPoints, GapJet, Normals, RigidShape};
use crate::mass_properties::MassProperties;
use crate::mesh::TriangleMesh;
use crate::polyhedra::Features;
use crate::{Aabb, Looking, Point};

/// The body within a closed triangle mesh.
#[derive(Clone, Debug)]
pub struct Polyhedron {
    surface: ClosestPoints,
    features: Features,
}

impl Polyhedron {
    /// The body within a mesh whose normals point outwards; none if the mesh is not closed.
    pub fn new(mesh: TriangleMesh) -> Option<Self> {
        let features = Features::new(mesh.clone())?;
        Some(Polyhedron { surface: ClosestPoints { shape: mesh.into(), normals: Normals::Outward }, features })
    }

    /// The body within an upright prism, for contact in the plane `z = 0`, which it has to cross; none if the mesh is not closed.
    pub fn prism(mesh: TriangleMesh) -> Option<Self> {
        let features = Features::of_prism(mesh.clone())?;
        Some(Polyhedron { surface: ClosestPoints { shape: mesh.into(), normals: Normals::Outward }, features })
    }
}

impl RigidShape for Polyhedron {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        self.surface.gap(x)
    }

    fn facing(&self, x: &Point<3>, looking: &Looking) -> Option<GapJet<3>> {
        self.surface.facing(x, looking)
    }

    fn centre(&self) -> Point<3> {
        self.surface.centre()
    }

    fn bounds(&self) -> Option<Aabb<3>> {
        Some(*self.features.mesh().bounds())
    }

    fn mass_properties(&self) -> Option<MassProperties> {
        Some(MassProperties::polyhedron(self.features.mesh()))
    }

    fn features(&self) -> Option<&Features> {
        Some(&self.features)
    }
}
