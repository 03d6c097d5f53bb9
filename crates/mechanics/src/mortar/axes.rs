//! The axes of friction at a point of the slave side.

use crate::pair::axis;
use signorini_geometry::{Matrix, Vector};

/// Sine of the angle to the normal below which the projection of an axis tells no direction any more.
const STEEP: f64 = 1e-6;

/// Two unit vectors across the normal, and their derivatives in it.
#[derive(Clone, Copy)]
pub(super) struct Axes {
    pub e: [Vector<3>; 2],
    pub by_normal: [Matrix<3>; 2],
}

impl Axes {
    /// One axis lies in the plane, the other across it is the first or the second.
    pub fn in_plane(normal: &Vector<3>, across: usize) -> Axes {
        let z = Vector::<3>::z();
        let (own, turn) = (z.cross(normal), cross(&z));
        let zero = Matrix::<3>::zeros();
        match across {
            0 => Axes { e: [z, own], by_normal: [zero, turn] },
            _ => Axes { e: [own, z], by_normal: [turn, zero] },
        }
    }

    /// The first is the projection of a direction; none where that stands on the surface.
    pub fn in_space(normal: &Vector<3>, along: &Vector<3>) -> Option<Axes> {
        let lifted = normal.dot(along);
        let flat = along - normal * lifted;
        let length = flat.norm();
        if length <= STEEP * along.norm() {
            return None;
        }
        let first = flat / length;
        let across = (Matrix::<3>::identity() - first * first.transpose()) / length;
        let d_first = -(across * (Matrix::<3>::identity() * lifted + normal * along.transpose()));
        // E_2 = n × E_1.
        let d_second = cross(normal) * d_first - cross(&first);
        Some(Axes { e: [first, normal.cross(&first)], by_normal: [d_first, d_second] })
    }
}

/// The matrix of the product with a vector from the left.
fn cross(v: &Vector<3>) -> Matrix<3> {
    Matrix::<3>::from_fn(|i, j| v.cross(&axis(j))[i])
}
