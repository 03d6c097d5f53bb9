//! The axes of friction of a pair.

use crate::pair::{Pair, any_tangent};
use signorini_geometry::Vector;

/// Sine of the angle to the normal below which the projection of an axis tells no direction any more.
pub(super) const STEEP: f64 = 1e-8;

/// The axes of friction of a pair, and their variations.
pub(crate) fn axes(pair: &Pair) -> ([Vector<3>; 2], Vec<[Vector<3>; 2]>) {
    let normal = pair.normal;
    let along = pair.axis.direction - normal * normal.dot(&pair.axis.direction);
    let length = along.norm();
    if length <= STEEP * pair.axis.direction.norm() {
        // The axis stands on the surface: without one, any will do.
        let first = any_tangent(&normal);
        return ([first, normal.cross(&first)], vec![[Vector::<3>::zeros(); 2]; pair.unknowns.len()]);
    }
    let first = along / length;
    let second = normal.cross(&first);
    let variations = (pair.d_normal.iter().zip(&pair.axis.variation))
        .map(|(dn, da)| {
            let d = da
                - normal * normal.dot(da)
                - dn * normal.dot(&pair.axis.direction)
                - normal * dn.dot(&pair.axis.direction);
            let d_first = (d - first * first.dot(&d)) / length;
            [d_first, dn.cross(&first) + normal.cross(&d_first)]
        })
        .collect();
    ([first, second], variations)
}
