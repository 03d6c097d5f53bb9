//! Rigid bodies of a system, at rest, moved or free.

use super::{Kind, Wrong};
use crate::plan::planner::Planner;
use crate::plan::rigid as beside;
use crate::problem::units::LENGTH;
use crate::problem::{CaseError, Motion as Stated, Rigid, Shape, Side, Space};
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::{Aabb, Point, Vector};
use signorini_mechanics::{Motion, RigidBody, RigidSite};
use std::sync::Arc;

/// What is around no body at all.
const NOWHERE: f64 = 1.0;

impl Planner<'_> {
    /// A rigid body, and what it is for results. `around` are the corners of the box of the deformable bodies.
    pub(super) fn rigid_body(
        &self,
        name: &str,
        key: &Rigid,
        around: Option<[Point<3>; 2]>,
        wrong: &Wrong,
    ) -> Result<(RigidBody, Kind), CaseError> {
        let [low, high] = around.unwrap_or([Point::<3>::repeat(-NOWHERE), Point::<3>::repeat(NOWHERE)]);
        let pad = Vector::<3>::repeat(0.5 * (high - low).amax().max(f64::MIN_POSITIVE));
        let around = Aabb::new(low - pad, high + pad);
        let found = match self.space {
            Space::ThreeD => beside::read::<3>(self, name, key, &around)?,
            _ => beside::read::<2>(self, name, key, &around)?,
        };
        let shape = found.touched();
        let is_free = matches!(key.motion, Some(Stated::Free(_)));
        let mut centre = shape.centre();
        let motion = match &key.motion {
            Some(Stated::Free(free)) => {
                if let Some(stated) = &free.center {
                    centre = self.position(stated, LENGTH)?;
                }
                match self.space {
                    Space::Axisymmetric => Motion::FreeAlongAxis,
                    space => Motion::Free { plane: space != Space::ThreeD },
                }
            }
            _ => {
                let wrong = wrong.clone();
                let nowhere = Point::<3>::zeros();
                Motion::Prescribed(Arc::new(move |t| {
                    found.motion_by(&|placed| wrong.evaluate(&placed.expression, &placed.key, &nowhere, t))
                }))
            }
        };
        let (sites, size) = self.points_of(key, low, high)?;
        let body = RigidBody { name: name.to_string(), shape: Arc::clone(&shape), motion, centre, sites, size };
        Ok((body, Kind::Rigid { shape, centre, is_free }))
    }

    /// The points of a rigid body that are tested, and its size: a ball at its centre, a triangle mesh at its vertices.
    fn points_of(&self, key: &Rigid, low: Point<3>, high: Point<3>) -> Result<(Vec<RigidSite>, f64), CaseError> {
        let outside = key.side != Some(Side::Inside);
        Ok(match &key.shape {
            Shape::Sphere(sphere) => {
                let x = self.position(&sphere.center, LENGTH)?;
                let radius = self.reader.positive(&sphere.radius, LENGTH)?;
                let site = RigidSite { x, outward: None, radius, weight: 1.0 };
                (if outside { vec![site] } else { Vec::new() }, 2.0 * radius)
            }
            Shape::Stl(file) => of_mesh(&self.closed_mesh(file)?, outside),
            Shape::File(file) => of_mesh(&self.boundary_of_file(file)?, outside),
            Shape::Triangles(arrays) => of_mesh(&self.surface_of_arrays(arrays)?, outside),
            _ => (Vec::new(), (high - low).norm()),
        })
    }
}

/// Vertices with their share of the area, and the mean normal of the faces around them.
fn of_mesh(mesh: &TriangleMesh, outside: bool) -> (Vec<RigidSite>, f64) {
    let mut normals = vec![Vector::<3>::zeros(); mesh.vertices().len()];
    let mut areas = vec![0.0; mesh.vertices().len()];
    for (k, triangle) in mesh.triangles().iter().enumerate() {
        let [a, b, c] = mesh.corners(k);
        let normal = (b - a).cross(&(c - a)) * 0.5;
        for &v in triangle {
            normals[v as usize] += normal;
            areas[v as usize] += normal.norm() / 3.0;
        }
    }
    let sites = (mesh.vertices().iter().zip(normals).zip(areas))
        .filter(|(_, area)| *area > 0.0)
        .map(|((x, normal), weight)| RigidSite { x: *x, outward: normal.try_normalize(0.0), radius: 0.0, weight })
        .collect();
    (if outside { sites } else { Vec::new() }, mesh.bounds().size().norm())
}
