//! The traction of a site by the law, and the axes of its friction.

use super::{Contact, MeasuredPair};
use crate::contact_law::PointMeasure;
use crate::pair::{Pair, any_tangent};
use signorini_contact::law::Projected;
use signorini_geometry::Vector;

/// A traction with its derivatives in the unknowns of the pair.
pub(super) struct Traction {
    pub projected: Projected,
    pub axes: [Vector<3>; 2],
    pub d_axes: Vec<[Vector<3>; 2]>,
    pub slip: [f64; 2],
    /// Of friction.
    pub trial: [f64; 2],
}

impl Contact {
    /// The traction by the law; linearised about a trial with as much more friction as is `redistributed` on to the site.
    pub(super) fn traction(
        &self,
        k: usize,
        touch: &MeasuredPair,
        unknown: [f64; 3],
        redistributed: [f64; 2],
    ) -> Traction {
        let pair = &touch.pair;
        let has_friction = self.law.friction.is_some();
        let (axes, d_axes) = if has_friction { axes(pair) } else { ([Vector::<3>::zeros(); 2], Vec::new()) };
        let slip = if has_friction { axes.map(|e| e.dot(&pair.elastic)) } else { [0.0; 2] };
        // In the plane nothing moves across it, and there is no friction that way.
        let most = pair.slip.iter().map(|s| s.norm()).fold(0.0, f64::max);
        let slides = axes.map(|e| pair.slip.iter().any(|s| e.dot(s).abs() > STEEP * most));
        let measure = PointMeasure {
            gap: pair.gap,
            slip,
            slides: Some(slides),
            base: touch.stress.as_ref().map(|s| s.base(&pair.normal, &axes)),
            besides: redistributed,
        };
        let (projected, trial) = self.law.traction(k, unknown, &measure);
        Traction { projected, axes, d_axes, slip, trial }
    }
}

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
