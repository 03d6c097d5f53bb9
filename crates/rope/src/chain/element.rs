//! A straight element that carries tension only.
//!
//! With `l = |d|` and unstrained length `L`, the tension per current force is `T = EA ⟨l/L - 1⟩` and the energy
//! `W = ½ EA L ⟨l/L - 1⟩²`, a convex function of `d`. Of both variables
//!
//! - `∂W/∂d = T t`, `∂²W/∂d² = (EA/L) t tᵀ + (T/l)(I - t tᵀ)`, `t = d/l`;
//! - `∂W/∂L = -T - T²/(2 EA)`, `∂²W/∂L² = EA l²/L³`, `∂²W/∂d∂L = -(EA l/L²) t`.
//!
//! A rope that runs through a pulley without friction has `L_a - s` before and `L_b + s` behind it; the equation of `s`,
//! `∂W_a/∂L = ∂W_b/∂L`, holds where both tensions are the same.

use signorini_geometry::{Matrix, Vector};

/// Energy of an element and its derivatives in `d` and `L`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stretched {
    pub energy: f64,
    pub tension: f64,
    /// `∂W/∂d`: the force with which the element pulls its second end back.
    pub force: Vector<3>,
    pub stiffness: Matrix<3>,
    /// `∂W/∂L`, `∂²W/∂L²`, `∂²W/∂d∂L`.
    pub by_length: (f64, f64, Vector<3>),
}

/// How an element answers to its length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// A piece of rope of given unstrained length.
    Elastic,
    /// A winch that keeps this tension, whatever the length: `W = T l`.
    Tension(f64),
}

/// The element between two points at distance `d`; slack it has no energy at all.
pub fn stretched(d: &Vector<3>, stiffness: f64, unstrained: f64, drive: Drive) -> Stretched {
    let length = d.norm();
    let across = |t: &Vector<3>| Matrix::<3>::identity() - t * t.transpose();
    match drive {
        Drive::Tension(tension) if length > 0.0 => {
            let t = d / length;
            Stretched {
                energy: tension * length,
                tension,
                force: t * tension,
                stiffness: across(&t) * (tension / length),
                by_length: Default::default(),
            }
        }
        Drive::Elastic if length > unstrained => {
            let t = d / length;
            let strain = length / unstrained - 1.0;
            let tension = stiffness * strain;
            Stretched {
                energy: 0.5 * tension * strain * unstrained,
                tension,
                force: t * tension,
                stiffness: t * t.transpose() * (stiffness / unstrained) + across(&t) * (tension / length),
                by_length: (
                    -tension * (1.0 + 0.5 * strain),
                    stiffness * length * length / unstrained.powi(3),
                    t * (-stiffness * length / (unstrained * unstrained)),
                ),
            }
        }
        _ => Stretched::default(),
    }
}
