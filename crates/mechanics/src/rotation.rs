//! Rotation vectors of any size, whole turns included, and how they change with spins.

use nalgebra::{Rotation3, UnitQuaternion};
use signorini_geometry::{Matrix, Vector};
use std::f64::consts::TAU;

/// Below this angle a rotation does not tell its axis any more.
const SMALL: f64 = 1e-6;

/// The rotation vector of a rotation with as many whole turns as bring it nearest to another one.
pub fn unwrapped(rotation: &UnitQuaternion<f64>, near: &Vector<3>) -> Vector<3> {
    let principal = rotation.scaled_axis();
    let about = if principal.norm() > SMALL { principal } else { *near };
    let Some(axis) = about.try_normalize(0.0) else { return principal };
    let turns = ((near - principal).dot(&axis) / TAU).round();
    principal + axis * (turns * TAU)
}

/// The rotation vector that leads from one to another, whole turns included where the axis stays.
pub fn between(from: &Vector<3>, to: &Vector<3>) -> Vector<3> {
    unwrapped(&(turn(to) * turn(from).inverse()), &(to - from))
}

/// The rotation of a vector.
pub fn turn(by: &Vector<3>) -> UnitQuaternion<f64> {
    UnitQuaternion::from_rotation_matrix(&Rotation3::new(*by))
}

/// The whole turns of a rotation vector.
pub fn whole_turns(psi: &Vector<3>) -> Vector<3> {
    let turns = (psi.norm() / TAU).round();
    if turns == 0.0 { Vector::<3>::zeros() } else { psi.normalize() * (turns * TAU) }
}

/// The derivative of the rotation vector `ψ` of `exp(ψ)` in the spin `θ` of `exp(θ) exp(ψ)`:
/// `1 - ψ×/2 + f ψ×ψ×` with `f = (1 - (ψ/2) cot(ψ/2)) / ψ²`.
pub fn of_spin(psi: &Vector<3>) -> Matrix<3> {
    let cross = psi.cross_matrix();
    Matrix::<3>::identity() - cross * 0.5 + cross * cross * factor(psi.norm_squared()).0
}

/// How `of_spin(ψ) v` changes with `ψ`.
pub fn of_spin_change(psi: &Vector<3>, change: &Vector<3>, v: &Vector<3>) -> Vector<3> {
    let (f, slope) = factor(psi.norm_squared());
    let once = psi.cross(v);
    (change.cross(&once) + psi.cross(&change.cross(v))) * f - change.cross(v) * 0.5
        + psi.cross(&once) * (2.0 * slope * psi.dot(change))
}

/// The spin of `exp(ψ)` in a change of `ψ`: the inverse of [`of_spin`].
pub fn spin(psi: &Vector<3>) -> Matrix<3> {
    let square = psi.norm_squared();
    let angle = square.sqrt();
    let (first, second) = if square < 1e-4 {
        (0.5 - square / 24.0 + square * square / 720.0, 1.0 / 6.0 - square / 120.0 + square * square / 5040.0)
    } else {
        ((1.0 - angle.cos()) / square, (angle - angle.sin()) / (square * angle))
    };
    let cross = psi.cross_matrix();
    Matrix::<3>::identity() + cross * first + cross * cross * second
}

/// `(1 - (ψ/2) cot(ψ/2)) / ψ²` and its derivative in `ψ²`, by series where differences cancel.
fn factor(square: f64) -> (f64, f64) {
    if square < 1e-2 {
        let value = 1.0 / 12.0 + square * (1.0 / 720.0 + square * (1.0 / 30240.0 + square / 1_209_600.0));
        return (value, 1.0 / 720.0 + square * (1.0 / 15120.0 + square / 403_200.0));
    }
    let half = 0.5 * square.sqrt();
    let inner = half / half.tan();
    let slope = 0.125 * (1.0 / half.tan() / half - 1.0 / half.sin().powi(2));
    ((1.0 - inner) / square, -(slope + (1.0 - inner) / square) / square)
}
