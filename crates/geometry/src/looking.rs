//! Which face of a body with edges a point of another surface looks at.

use crate::Vector;

/// How far off a face, relative to [`Looking::within`], a foot on it may be, and a point may lie before it: rounding.
const ROUNDING: f64 = 1e-6;

/// How a point of a surface looks at a body that it is in.
#[derive(Clone, Copy, Debug)]
pub struct Looking {
    /// Outward unit normal of the surface.
    pub outward: Vector<3>,
    /// The least cosine between that and the direction into a face.
    pub least: f64,
    /// The greatest depth of the point under a face.
    pub within: f64,
}

impl Looking {
    /// The direction looks into a face with this outward unit normal.
    pub fn sees(&self, normal: &Vector<3>) -> bool {
        -self.outward.dot(normal) >= self.least
    }

    /// Whether a foot is under a point along the normal of its face: `apart` leads from the foot to the point.
    pub fn is_under(&self, apart: &Vector<3>, normal: &Vector<3>) -> bool {
        let gap = apart.dot(normal);
        gap <= self.rounding() && gap >= -self.within && (apart - normal * gap).norm() <= self.rounding()
    }

    pub fn rounding(&self) -> f64 {
        ROUNDING * self.within
    }
}
