//! Points and directions on a surface.

use crate::PathError;
use crate::darboux::Along;
use signorini_geometry::rigid_shape::RigidShape;
use signorini_geometry::{Jet, Point, Vector};

/// Newton steps after which a point is taken to have no foot.
const ITERATIONS: usize = 50;

/// A point on the surface near another one, along the gradients of the level function, with the level there. Of a point
/// that is already near it is the closest one to second order.
///
/// # Errors
/// No point is found.
pub fn foot(surface: &dyn RigidShape, x: &Point<3>) -> Result<(Point<3>, Jet<3>), PathError> {
    let mut y = *x;
    let mut best = f64::INFINITY;
    for iterations in 0..ITERATIONS {
        let level = surface.level(&y);
        let step = level.gradient * (level.value / level.gradient.norm_squared());
        let distance = step.norm();
        let rounding = 4.0 * f64::EPSILON * (y.norm() + 1.0 / curvature(&level));
        // Done when rounding is reached, or a small distance does not shrink any more.
        if distance <= rounding || (distance >= best && best < 1e3 * rounding) {
            return Ok((y, level));
        }
        if !distance.is_finite() {
            return Err(PathError::NoFoot { at: *x, gap: best, iterations });
        }
        best = best.min(distance);
        y -= step;
    }
    Err(PathError::NoFoot { at: *x, gap: best, iterations: ITERATIONS })
}

/// A unit tangent from any direction.
///
/// # Errors
/// A direction along the normal.
pub fn tangent(level: &Jet<3>, x: &Point<3>, direction: &Vector<3>) -> Result<Vector<3>, PathError> {
    let n = level.gradient.normalize();
    let flat = direction - n * n.dot(direction);
    flat.try_normalize(1e-12 * direction.norm()).ok_or(PathError::NoTangent { at: *x })
}

/// A bound of the curvatures of a level surface.
pub(crate) fn curvature(level: &Jet<3>) -> f64 {
    let n = level.gradient;
    let inverse = 1.0 / n.norm();
    let flat = nalgebra::Matrix3::identity() - n * n.transpose() * (inverse * inverse);
    (flat * level.hessian * flat).norm() * inverse
}

/// One Newton step back to the surface and of the tangent to its plane; enough for states of an integration.
#[inline]
pub(crate) fn restore(surface: &dyn RigidShape, x: &mut Point<3>, tau: &mut Vector<3>) {
    let level = surface.level(x);
    let inverse = 1.0 / level.gradient.norm_squared();
    *x -= level.gradient * (level.value * inverse);
    *tau -= level.gradient * (level.gradient.dot(tau) * inverse);
    tau.normalize_mut();
}

/// The surface at a point along a unit tangent.
#[inline]
pub(crate) fn along(surface: &dyn RigidShape, x: &Point<3>, tau: &Vector<3>) -> Along {
    Along::new(&surface.level(x), tau)
}
