//! A full circuit: from a height over one polar opening, back, over the other one, and up to the same height.
//!
//! A constant `λ` makes both halves mirror images of themselves: a yarn that leaves a height with `α_0` comes back to it with
//! `π - α_0`. On the way down the opposite sign does the same, so that on a mandrel with two equal ends the circuit closes.

use super::{Ended, Mandrel, Slippage, Start, Until, Way, WindingPath, WindingPoint, wind};
use crate::PathError;
use std::f64::consts::FRAC_PI_2;

/// A circuit of winding.
#[derive(Clone, Debug, PartialEq)]
pub struct Circuit {
    /// Over the upper opening and over the lower one.
    pub halves: [WindingPath; 2],
    /// The two turns.
    pub turns: [WindingPoint; 2],
    /// Angle around the axis of the whole circuit.
    pub angle: f64,
    pub length: f64,
    /// Angle from the meridian at the end less that at the start: zero where the next circuit is like this one.
    pub mismatch: f64,
}

/// The circuit from a start that goes up. `slippage` is that of the two halves; of the second one negative values hold it
/// away from the pole.
///
/// # Errors
/// A start that does not go up, a yarn that does not come back within `longest` each time.
pub fn circuit(
    mandrel: &Mandrel<'_>,
    start: &Start,
    slippage: &[Slippage; 2],
    longest: f64,
    spacing: f64,
) -> Result<Circuit, PathError> {
    if start.angle.abs() >= FRAC_PI_2 {
        let valid = "between -π/2 and π/2: a circuit starts up along the axis";
        return Err(PathError::Input { what: "angle of the yarn", value: start.angle, valid });
    }
    let height = mandrel.radius_and_height(&crate::surface::foot(mandrel.surface, &start.point)?.0).1;
    let half = |start: &Start, slippage: &Slippage, way: Way| {
        let path = wind(mandrel, start, slippage, Until::Height { height, way }, longest, spacing)?;
        match (path.ended, path.turns.first().copied()) {
            (Ended::AsAsked, Some(turn)) => Ok((path, turn)),
            _ => Err(PathError::NotReached { wanted: format!("the height {height} again"), at: path.end().frame.s }),
        }
    };
    let (upper, first) = half(start, &slippage[0], Way::Down)?;
    let middle = *upper.end();
    let (lower, second) = half(&Start { point: middle.frame.x, angle: middle.angle }, &slippage[1], Way::Up)?;
    let end = *lower.end();
    Ok(Circuit {
        turns: [first, second],
        angle: middle.theta + end.theta,
        length: middle.frame.s + end.frame.s,
        mismatch: end.angle - start.angle,
        halves: [upper, lower],
    })
}
