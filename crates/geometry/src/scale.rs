//! Lengths and directions at any scale: nothing here leaves the range of doubles before its result does.

use crate::Vector;

/// The power of two that brings coordinates near one where products of four to eight of them would leave the range of
/// doubles; one elsewhere, where it would change nothing. A power of two changes no digit.
pub fn unit_for(magnitude: f64) -> f64 {
    let safe = magnitude == 0.0 || (1e-30..=1e30).contains(&magnitude);
    if safe { 1.0 } else { 2f64.powi(-(magnitude.log2().round() as i32)) }
}

/// The length of a vector.
pub fn length(d: &Vector<3>) -> f64 {
    let largest = d.amax();
    if largest == 0.0 || !largest.is_finite() { largest } else { largest * (d / largest).norm() }
}

/// The direction of a vector; `None` where it has none.
pub fn direction(d: &Vector<3>) -> Option<Vector<3>> {
    let largest = d.amax();
    (largest > 0.0).then(|| (d / largest).normalize())
}

/// Whether two vectors point the same way, as far as shapes are told smooth.
pub fn same_direction(a: &Vector<3>, b: &Vector<3>) -> bool {
    let (Some(a), Some(b)) = (direction(a), direction(b)) else { return false };
    a.dot(&b) > 0.0 && a.cross(&b).norm() <= 1e-8
}
