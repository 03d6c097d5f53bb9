//! Points of a slave face and the master points opposite them.

use super::Sight;
use crate::multiplier::PressureNodes;
use crate::surface::ContactSurface;
use signorini_basis::Local;
use signorini_basis::hierarchic::Values;
use signorini_geometry::{Matrix, Point, Vector};

/// A quadrature point of a slave face.
#[derive(Clone, Debug)]
pub struct GapPoint<const D: usize> {
    pub s: Local,
    /// Area that the point stands for.
    pub weight: f64,
    /// Face and point of the master; none of a rigid one.
    pub master: Option<(u32, Local)>,
    /// The way from the master to the slave, of unit length; zero of a rigid one, as is the gap.
    pub direction: Point<D>,
    pub gap: f64,
}

/// Two sides whose faces are cut by each other.
#[derive(Clone, Copy)]
pub(super) struct Cut<'a, const D: usize> {
    pub slave: &'a dyn ContactSurface<D>,
    pub master: &'a dyn ContactSurface<D>,
    /// The nodes of the slave, along whose normals points lie opposite each other.
    pub nodes: &'a PressureNodes<D>,
    pub sight: Sight<'a>,
    /// Further points of the rule of a piece, for each direction.
    pub extra: usize,
}

/// Breakpoints closer than this, in coordinates of the face, are one.
pub(super) const SNAP: f64 = 1e-13;

/// Faces whose normals enclose less than 120 degrees do not face each other.
pub(super) const FACING: f64 = -0.5;

fn cross2<const D: usize>(a: &Point<D>, b: &Point<D>) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The coordinate of the slave face from whose point the normal passes through `x`.
pub(super) fn onto_slave<const D: usize>(
    slave: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    face: usize,
    x: &Point<D>,
    at: &mut Values,
) -> Option<f64> {
    let mut xi: f64 = 0.0;
    for _ in 0..60 {
        // Beyond its ends the face goes on straight, with the normal of the end: polynomials would swing.
        let inside = xi.clamp(-1.0, 1.0);
        let s = [inside, 0.0, 0.0];
        let point = slave.at(face, &s);
        let (normal, mut slopes) = nodes.normal(face, &s, at);
        if inside != xi {
            slopes[0] = Point::<D>::zeros();
        }
        let d = x - (point.x + point.tangents[0] * (xi - inside));
        let value = cross2(&d, &normal);
        let slope = -cross2(&point.tangents[0], &normal) + cross2(&d, &slopes[0]);
        let step = value / slope;
        if !step.is_finite() {
            return None;
        }
        let next = (xi - step).clamp(-3.0, 3.0);
        let moved = (next - xi).abs();
        xi = next;
        if moved < 1e-14 {
            break;
        }
    }
    Some(xi)
}

/// The point of a master face on the line through `x` along `normal`, and the distance along it.
pub(super) fn onto_master<const D: usize>(
    master: &dyn ContactSurface<D>,
    face: usize,
    x: &Point<D>,
    normal: &Point<D>,
    start: Local,
) -> Option<(Local, f64)> {
    let mut eta = start;
    for _ in 0..60 {
        let point = master.at(face, &eta);
        let d = point.x - x;
        // Components across the normal vanish.
        let moved = if D == 2 {
            let step = cross2(&d, normal) / cross2(&point.tangents[0], normal);
            let next = (eta[0] - step).clamp(-3.0, 3.0);
            let moved = (next - eta[0]).abs();
            eta[0] = next;
            moved
        } else {
            let jacobian = Matrix::<3>::from_columns(&[
                Vector::<3>::from_fn(|k, _| point.tangents[0][k]),
                Vector::<3>::from_fn(|k, _| point.tangents[1][k]),
                Vector::<3>::from_fn(|k, _| -normal[k]),
            ]);
            let step = signorini_basis::small::inverse(&jacobian) * Vector::<3>::from_fn(|k, _| d[k]);
            let mut moved = 0.0f64;
            for k in 0..2 {
                let next = (eta[k] - step[k]).clamp(-3.0, 3.0);
                moved = moved.max((next - eta[k]).abs());
                eta[k] = next;
            }
            moved
        };
        if moved.is_nan() {
            return None;
        }
        if moved < 1e-14 {
            break;
        }
    }
    Some((eta, (master.at(face, &eta).x - x).dot(normal)))
}

/// Both gaps are differences of coordinates: what rounding leaves of a closed gap is none.
pub(super) fn snapped(gap: f64, magnitude: f64) -> f64 {
    if gap.abs() <= 64.0 * f64::EPSILON * magnitude { 0.0 } else { gap }
}
