//! Tangents of contact against differences; free rigid bodies.

use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::{Plane, RigidShape, Sphere};
use signorini_geometry::{Point, Vector};
use signorini_mechanics::rigid_body::{Motion, RigidBody, RigidSite};
use std::sync::Arc;

pub fn v(x: f64, y: f64, z: f64) -> Vector<3> {
    Vector::<3>::new(x, y, z)
}

pub fn at_rest() -> Motion {
    let zero = Vector::<3>::zeros();
    Motion::Prescribed(Arc::new(move |_| RigidMotion::new(zero, zero, zero)))
}

pub fn rigid(name: &str, shape: impl RigidShape + 'static, motion: Motion, sites: Vec<RigidSite>) -> RigidBody {
    let centre = shape.centre();
    RigidBody { name: name.to_string(), shape: Arc::new(shape), motion, centre, sites, size: 1.0, mass: None }
}

pub fn plane(point: Point<3>, normal: Vector<3>) -> RigidBody {
    rigid("floor", Plane { point, normal }, at_rest(), Vec::new())
}

/// A ball that is tested at its centre.
pub fn ball(centre: Point<3>, radius: f64, motion: Motion) -> RigidBody {
    let site = RigidSite { x: centre, outward: None, radius, weight: 1.0 };
    rigid("ball", Sphere { center: centre, radius }, motion, vec![site])
}
