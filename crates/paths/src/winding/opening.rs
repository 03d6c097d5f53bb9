//! The slippage with which a yarn turns at a wanted polar opening.

use super::{Ended, Mandrel, Slippage, Start, Until, WindingPoint, wind};
use crate::PathError;

/// A turn at a polar opening, and the constant slippage that leads to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opening {
    /// `λ`.
    pub slippage: f64,
    /// Where the middle of the yarn is along a parallel.
    pub turn: WindingPoint,
}

/// The constant slippage within a range with which the middle of a yarn turns at a distance `radius` from the axis: for an
/// opening up to the edge of a band add half its width. The radius grows with `λ`; a yarn that passes the pole or does not
/// turn within `longest` has none.
///
/// # Errors
/// No slippage within the range does; a start off the mandrel.
pub fn slippage_for_opening(
    mandrel: &Mandrel<'_>,
    start: &Start,
    radius: f64,
    range: [f64; 2],
    longest: f64,
) -> Result<Opening, PathError> {
    let turn = |lambda: f64| {
        let path = wind(mandrel, start, &Slippage::Constant(lambda), Until::Turn, longest, longest)?;
        Ok((path.ended == Ended::AsAsked).then(|| *path.end()))
    };
    // Too close to the pole the integration stalls.
    let reached = |lambda: f64| match turn(lambda) {
        Ok(point) => Ok(point.map_or(0.0, |p| p.radius)),
        Err(PathError::Stalled { .. }) => Ok(0.0),
        Err(error) => Err(error),
    };
    let found = [reached(range[0])?, reached(range[1])?];
    let wanted = format!("a turn at the radius {radius}");
    let between = (found[0] - radius) * (found[1] - radius) <= 0.0;
    if !between {
        return Err(PathError::NoSlippage { wanted, range, found });
    }
    let slippage = crate::root::bracketed(|l| reached(l).unwrap_or(f64::NAN) - radius, range);
    match turn(slippage)? {
        Some(turn) => Ok(Opening { slippage, turn }),
        None => Err(PathError::NoSlippage { wanted, range, found }),
    }
}
