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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_exact_and_slack_is_nothing() {
        let (ea, l) = (70.0, 1.1);
        let d = Vector::<3>::new(0.9, -0.7, 0.6);
        for drive in [Drive::Elastic, Drive::Tension(3.0)] {
            let at = |d: &Vector<3>, l: f64| stretched(d, ea, l, drive);
            let now = at(&d, l);
            let e = 1e-5;
            for k in 0..3 {
                let step = Vector::<3>::from_fn(|i, _| if i == k { e } else { 0.0 });
                let (p, m) = (at(&(d + step), l), at(&(d - step), l));
                assert!(((p.energy - m.energy) / (2.0 * e) - now.force[k]).abs() < 1e-8);
                assert!(((p.force - m.force) / (2.0 * e) - now.stiffness.column(k)).norm() < 1e-6);
            }
            let (p, m) = (at(&d, l + e), at(&d, l - e));
            assert!(((p.energy - m.energy) / (2.0 * e) - now.by_length.0).abs() < 1e-7);
            assert!(((p.by_length.0 - m.by_length.0) / (2.0 * e) - now.by_length.1).abs() < 1e-5);
            assert!(((p.force - m.force) / (2.0 * e) - now.by_length.2).norm() < 1e-5);
        }
        assert_eq!(stretched(&d, ea, 1.5, Drive::Elastic), Stretched::default());
    }
}
