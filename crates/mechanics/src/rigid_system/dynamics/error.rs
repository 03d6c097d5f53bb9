//! The error of an increment in time: from the same increment in two halves.
//!
//! Positions after an increment have an error `C h³`, after its halves a quarter of that: the error of the halves is a third of
//! the difference (Richardson 1911). The size of the difference is that in the norm of the masses, as of all errors in time.

use super::masses::Masses;
use crate::body::BodyState;
use crate::rigid_body::Pose;
use crate::rotation;
use crate::system::System;
use nalgebra::DVector;

/// The error that an increment in halves added to positions, in the norm of the masses: root of mass times length.
pub fn error_of_halves(system: &System, masses: &Masses, [whole, halves]: [&[BodyState]; 2]) -> f64 {
    let mut between = Vec::new();
    for ((body, a), b) in system.bodies.iter().zip(whole).zip(halves) {
        if body.unknowns() == 0 {
            continue;
        }
        let (from, to) = (Pose::of(a), Pose::of(b));
        let turn = rotation::between(&from.turn, &to.turn);
        // Modes turn about the origin.
        let moved = to.centre - from.centre - turn.cross(&to.centre);
        let modes = body.rigid_modes(b);
        between.extend((0..body.unknowns()).map(|unknown| {
            (0..3).map(|i| moved[i] * modes[i][unknown] + turn[i] * modes[3 + i][unknown]).sum::<f64>()
        }));
    }
    let between = DVector::from_vec(between);
    between.dot(&(masses.matrix(system, halves) * &between)).max(0.0).sqrt() / 3.0
}
