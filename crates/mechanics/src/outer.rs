//! Outer iterations: of augmented Lagrangians, and of penalties that are to leave a given penetration.

use crate::site_result::SiteResult;
use signorini_contact::Status;

/// What an outer iteration knows.
#[derive(Clone, Copy, Debug)]
pub struct OuterIteration {
    /// Rounding of positions.
    pub known: f64,
    /// The change of the iteration before, if there was one.
    pub before: Option<f64>,
}

/// The part of a change that the next outer iteration may leave.
const SLOW: f64 = 0.25;
/// The part of its compliance that a contact keeps then, and the least.
const HARDER: f64 = 0.1;
const HARDEST: f64 = 1e-6;

/// Takes the tractions found as those to give way from, beside the pressure per gap of each: the largest change, relative to
/// the largest pressure. `softness` is what they give way over what trials do.
pub(crate) fn take_over<'a>(
    kept: impl Iterator<Item = (&'a mut [f64; 3], &'a f64)>,
    found: &[[f64; 3]],
    (around, softness): (&OuterIteration, f64),
) -> f64 {
    let most = found.iter().map(|f| f[0]).fold(0.0f64, f64::max);
    let mut change = 0.0f64;
    for ((kept, stiffness), traction) in kept.zip(found) {
        let changed = (0..3).map(|i| (kept[i] - traction[i]).abs()).fold(0.0, f64::max);
        // Gaps are known to the rounding of positions only; what gives way little makes more of that.
        change = change.max(if changed > around.known * stiffness / softness { changed / most } else { 0.0 });
        *kept = *traction;
    }
    change
}

/// The compliance to go on with: where a step leaves more than a quarter of the error, the next ones are to leave less
/// (Bertsekas 1982). What enforces has tractions as unknowns, so that Newton's method suffers no harm.
pub(crate) fn hardened(softness: f64, change: f64, around: &OuterIteration) -> f64 {
    if around.before.is_some_and(|before| change > SLOW * before) { (HARDER * softness).max(HARDEST) } else { softness }
}

/// Changes penalties so that the penetration becomes the wanted one: by how much, relative.
pub(crate) fn towards(wanted: f64, found: &[SiteResult], penalties: &mut [f64]) -> f64 {
    let Some(factor) = penalty_factor(found, wanted) else { return 0.0 };
    penalties.iter_mut().for_each(|c| *c *= factor);
    (factor - 1.0).abs()
}

/// Penetration that an outer iteration leaves, relative to the one that is wanted.
pub const NEAR_WANTED: f64 = 1e-2;

/// The factor by which penalties change to leave the penetration that is wanted; none if they leave it.
pub fn penalty_factor(found: &[SiteResult], wanted: f64) -> Option<f64> {
    let depth = found.iter().filter(|s| s.status != Status::Open).filter_map(|s| s.gap);
    let depth = depth.fold(0.0f64, |m, g| m.max(-g));
    // The penetration is inverse to the penalty but for what the bodies give way.
    (depth > 0.0 && (depth / wanted - 1.0).abs() > NEAR_WANTED).then_some(depth / wanted)
}
