//! The gap of a point with its derivatives.

use crate::{Matrix, Point, Vector};

/// The gap of a point to a rigid body, negative inside, its gradient (the outward normal) and its Hessian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapJet<const D: usize> {
    pub gap: f64,
    pub normal: Vector<D>,
    pub hessian: Matrix<D>,
}

impl<const D: usize> GapJet<D> {
    /// A flat boundary; or one whose curvature is not needed, as with small sliding.
    pub fn flat(gap: f64, normal: Vector<D>) -> Self {
        GapJet { gap, normal, hessian: Matrix::<D>::zeros() }
    }

    /// A ball, or in the plane a disc. At its centre the normal is that along the last axis, without curvature.
    pub fn ball(x: &Point<D>, centre: &Point<D>, radius: f64) -> Self {
        let d = x - centre;
        let distance = d.norm();
        let last = Vector::<D>::from_fn(|k, _| f64::from(u8::from(k + 1 == D)));
        let normal = d.try_normalize(0.0).unwrap_or(last);
        let across = Matrix::<D>::identity() - normal * normal.transpose();
        let curvature = if distance > 0.0 { 1.0 / distance } else { 0.0 };
        GapJet { gap: distance - radius, normal, hessian: across * curvature }
    }
}
