//! The surfaces of bodies, for pictures and files.

use super::case::PathCase;
use crate::output::level;
use crate::problem::CaseError;
use signorini_contact::GapJet;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::{Aabb, Point, Vector};

/// The surface of a body in a box.
pub struct Surface {
    pub points: Vec<Vector<3>>,
    pub normals: Vec<Vector<3>>,
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    pub fn new(gap: &(dyn Fn(&Vector<3>) -> GapJet<3> + Sync), corners: [Vector<3>; 2]) -> Self {
        let (points, normals, triangles) = level::surface(gap, corners, level::CUBES);
        Surface { points, normals, triangles }
    }

    /// The surface after a motion.
    pub fn moved(&self, motion: &RigidMotion) -> Self {
        Surface {
            points: self.points.iter().map(|x| motion.point(x)).collect(),
            normals: self.normals.iter().map(|n| motion.rotation * n).collect(),
            triangles: self.triangles.clone(),
        }
    }
}

/// The box of points, and beyond it by a part of its size.
pub fn box_around(points: impl Iterator<Item = Point<3>>, part: f64) -> Aabb<3> {
    let Aabb { min, max } = Aabb::around(points).expect("a path has points");
    let pad = Vector::<3>::repeat(part * (max - min).max().max(f64::MIN_POSITIVE));
    Aabb::new(min - pad, max + pad)
}

/// The surfaces of all bodies at all times: of those without an end the part in a box.
pub fn surfaces(case: &PathCase, times: &[f64], around: &Aabb<3>) -> Result<Vec<Vec<Surface>>, CaseError> {
    let mut frames: Vec<Vec<Surface>> = times.iter().map(|_| Vec::new()).collect();
    for body in &case.plan.bodies {
        let Some(bounds) = body.bounds.filter(|_| !body.is_at_rest()) else {
            for (frame, time) in frames.iter_mut().zip(times) {
                let bounds = body.bounds.map_or(*around, |b| box_around([b.min, b.max].into_iter(), 0.05));
                frame.push(Surface::new(&body.gap_at(case.problem(), *time)?, [bounds.min, bounds.max]));
            }
            continue;
        };
        // What moves is found once, and moved.
        let bounds = box_around([bounds.min, bounds.max].into_iter(), 0.05);
        let stated = Surface::new(&|x: &Point<3>| body.shape().gap(x), [bounds.min, bounds.max]);
        for (frame, time) in frames.iter_mut().zip(times) {
            frame.push(stated.moved(&body.motion(case.problem(), *time)?));
        }
    }
    Ok(frames)
}
