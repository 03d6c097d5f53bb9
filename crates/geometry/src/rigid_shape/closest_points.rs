//! Surfaces and triangle meshes, through their certified closest points.

use super::{GapJet, RigidShape, unit};
use crate::closest::{Query, closest, gap_hessian, signed_gap};
use crate::frame::SurfaceFrame;
use crate::shape::Shape;
use crate::{Looking, Point, Vector};

/// Whether the normals of a surface point out of the body or into it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Normals {
    Outward,
    Inward,
}

/// The body beside a surface, or within a closed triangle mesh.
#[derive(Clone, Debug)]
pub struct ClosestPoints {
    pub shape: Shape,
    pub normals: Normals,
}

impl RigidShape for ClosestPoints {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        let shape = &self.shape;
        let found = closest(&Shape::Point(*x), shape, &Query::default()).closest;
        let d = found.a.point - found.b.point;
        let sign = if self.normals == Normals::Outward { 1.0 } else { -1.0 };
        let gap = sign * signed_gap(&found, shape).unwrap_or(found.distance);
        let frame = || match (shape, found.b.parameters()) {
            (Shape::Surface(s), &[u, v]) => SurfaceFrame::new(&s.jet(u, v)).map(|f| f.normal * sign),
            (Shape::Mesh(m), _) => Some(m.normal_at(found.b.element, found.b.feature)),
            _ => None,
        };
        // On the surface itself the way to the closest point has no direction.
        let scale = 1e-9 * shape.size();
        let along = (gap.abs() > scale).then(|| d * (1.0 / gap));
        let normal = along.or_else(frame).unwrap_or_else(|| unit(d, Vector::<3>::z()));
        GapJet { gap, normal, hessian: gap_hessian(&found, shape, &normal) }
    }

    /// Of a triangle mesh.
    fn facing(&self, x: &Point<3>, looking: &Looking) -> Option<GapJet<3>> {
        let Shape::Mesh(mesh) = &self.shape else { return None };
        if self.normals == Normals::Inward {
            return None;
        }
        mesh.facing(x, looking).map(|(gap, normal)| GapJet::flat(gap, normal))
    }

    /// The origin: the file of a surface says no other.
    fn centre(&self) -> Point<3> {
        Point::<3>::zeros()
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing;
    use super::*;
    use crate::mesh::TriangleMesh;
    use crate::rigid::RigidMotion;

    #[test]
    fn the_gap_of_a_mesh() {
        let corners = [[0.0, 0.0, 0.0], [0.4, 0.0, 0.1], [0.0, 0.3, 0.0], [0.1, 0.1, 0.5]].map(Point::<3>::from);
        let tetrahedron = |motion: Option<&RigidMotion>| {
            let corners = corners.iter().map(|x| motion.map_or(*x, |m| m.point(x))).collect();
            let mesh = TriangleMesh::new(corners, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap();
            ClosestPoints { shape: mesh.into(), normals: Normals::Outward }
        };
        let mesh = tetrahedron(None);
        testing::check(
            &mesh,
            &[corners[0], (corners[1] + corners[3]) * 0.5, (corners[0] + corners[1] + corners[2]) / 3.0],
        );
        testing::check_moved(&mesh, |m| tetrahedron(Some(m)));
    }
}
