//! The traction of a site by the law.

use super::axes::{STEEP, axes};
use super::{Contact, MeasuredPair};
use crate::contact_law::{PointHistory, PointMeasure};
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
    /// What the site remembers of it.
    pub next: PointHistory,
}

impl Contact {
    /// The traction by the law; linearised, where it is, about a trial with as much more friction as is
    /// `redistributed` on to the site.
    pub(super) fn traction(
        &self,
        k: usize,
        touch: &MeasuredPair,
        unknown: [f64; 3],
        (redistributed, sticks_first): ([f64; 2], bool),
    ) -> Traction {
        let pair = &touch.pair;
        let has_friction = self.law.is_tangential();
        let (axes, d_axes) = if has_friction { axes(pair) } else { ([Vector::<3>::zeros(); 2], Vec::new()) };
        let slip = if has_friction { axes.map(|e| e.dot(&pair.elastic)) } else { [0.0; 2] };
        // In the plane nothing moves across it, and there is no friction that way.
        let most = pair.slip.iter().map(|s| s.norm()).fold(0.0, f64::max);
        let slides = axes.map(|e| pair.slip.iter().any(|s| e.dot(s).abs() > STEEP * most));
        let measure = PointMeasure {
            gap: pair.gap,
            slip,
            slipped: self.memory[k].slip,
            slides: Some(slides),
            base: touch.stress.as_ref().map(|s| s.base(&pair.normal, &axes)),
            besides: redistributed,
            sticks_first,
        };
        let (projected, trial) = self.law.traction(k, unknown, &measure);
        let next = self.law.remembered(k, Some((&measure, trial, &projected)));
        Traction { projected, axes, d_axes, slip, trial: [trial[1], trial[2]], next }
    }
}
