//! Orthotropic Coulomb friction between a rope and a surface.
//!
//! The reactions `T̃ τ + G g + N n` on a rope of tension `T` hold where `Φ = √(T̃²/μ_τ² + G²/μ_g²) <= N`. Without loads
//! `T̃ = -T'`, `G = -k_g T`, `N = -k_n T`, so that `T'/T` lies between the roots `x` of
//! `m_ττ x² + 2 m_τg k_g x + m_gg k_g² = k_n²`. Axes that the rope carries make `m` diagonal and the roots `±ω`,
//! `ω = μ_τ √(k_n² - k_g²/μ_g²)`; axes of the surface that are oblique to the rope do not.

use crate::PathError;
use crate::darboux::Darboux;
use signorini_geometry::{Point, Vector};
use std::sync::Arc;

/// A direction at every point of a surface; it is laid into the tangent plane.
pub type Direction = Arc<dyn Fn(&Point<3>) -> Vector<3> + Send + Sync>;

/// Coefficients of friction along two axes.
#[derive(Clone)]
pub enum Friction {
    /// Axes that go along with the rope.
    Carried {
        /// `μ_τ`, along the rope.
        along: f64,
        /// `μ_g`, across it.
        across: f64,
    },
    /// Axes of the surface.
    Attached {
        /// Along the axis and across it.
        coefficients: [f64; 2],
        axis: Direction,
    },
}

impl std::fmt::Debug for Friction {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Friction::Carried { along, across } => {
                f.debug_struct("Carried").field("along", along).field("across", across).finish()
            }
            Friction::Attached { coefficients, .. } => f.debug_tuple("Attached").field(coefficients).finish(),
        }
    }
}

impl Friction {
    /// The same in all directions.
    pub fn isotropic(coefficient: f64) -> Self {
        Friction::Carried { along: coefficient, across: coefficient }
    }

    /// # Errors
    /// A coefficient that is negative or not finite.
    pub fn check(&self) -> Result<(), PathError> {
        let pair = match self {
            Friction::Carried { along, across } => [*along, *across],
            Friction::Attached { coefficients, .. } => *coefficients,
        };
        for value in pair {
            if !(value.is_finite() && value >= 0.0) {
                return Err(PathError::Input { what: "coefficient of friction", value, valid: "a number from 0 on" });
            }
        }
        Ok(())
    }

    /// Half axes of the ellipse of friction per normal force, and the angle of the first from `τ` towards `g`.
    fn axes(&self, at: &Darboux) -> ([f64; 2], f64) {
        match self {
            Friction::Carried { along, across } => ([*along, *across], 0.0),
            Friction::Attached { coefficients, axis } => {
                let axis = axis(&at.x);
                (*coefficients, axis.dot(&at.g).atan2(axis.dot(&at.tau)))
            }
        }
    }

    /// The largest `|tan α|` that friction across the rope can hold.
    pub fn lateral(&self, at: &Darboux) -> f64 {
        let ([one, two], angle) = self.axes(at);
        // The extent of the ellipse along g.
        (one * angle.sin()).hypot(two * angle.cos())
    }

    /// The range of `-T̃` per tension for a normal reaction `-k_n` and a lateral one `-k_g`: of `T'/T` where there is no
    /// load. `None` where friction cannot hold `k_g`.
    pub fn range(&self, at: &Darboux, k_n: f64, k_g: f64) -> Option<[f64; 2]> {
        let ([one, two], angle) = self.axes(at);
        let (sin, cos) = angle.sin_cos();
        // Points of the ellipse `p = n (μ_1 cos φ e_1 + μ_2 sin φ e_2)` with `p·g = k_g`: of its extent `w` along g the
        // share `k_g/(n w)`.
        let n = k_n.abs();
        let (p, q) = (one * sin, two * cos);
        let w = p.hypot(q);
        if k_g.abs() > n * w * (1.0 + ROUNDING) {
            return None;
        }
        if n * w == 0.0 {
            let extent = n * (one * cos).hypot(two * sin);
            return Some([-extent, extent]);
        }
        let share = (k_g / (n * w)).clamp(-1.0, 1.0);
        let root = ((1.0 - share) * (1.0 + share)).sqrt();
        // p cos φ + q sin φ = w share; τ-component μ_1 cos cos φ - μ_2 sin sin φ.
        let (u, v) = (p / w, q / w);
        let along = |sign: f64| {
            let (c, s) = (u * share - sign * v * root, v * share + sign * u * root);
            n * (one * cos * c - two * sin * s)
        };
        let (a, b) = (along(1.0), along(-1.0));
        Some([a.min(b), a.max(b)])
    }
}

/// What rounding leaves of two numbers that are the same.
pub(crate) const ROUNDING: f64 = 1e-12;

/// The reactions of a surface on a rope, per length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reactions {
    pub s: f64,
    pub tension: f64,
    /// `T̃`, along `τ`.
    pub along: f64,
    /// `G`, along `g`.
    pub across: f64,
    /// `N`, along `n`.
    pub normal: f64,
    /// The share of friction that is used: `Φ/N`; above one the rope slips, infinite where it lifts off.
    pub utilisation: f64,
}

impl Reactions {
    /// Of a rope with a tension and its derivative by arc length.
    pub fn new(at: &Darboux, tension: f64, slope: f64, friction: &Friction) -> Self {
        let (normal, along, across) = (-at.k_n * tension, -slope, -at.k_g * tension);
        let ([one, two], angle) = friction.axes(at);
        let (sin, cos) = angle.sin_cos();
        let ratio = |force: f64, limit: f64| if force == 0.0 { 0.0 } else { force / limit };
        let first = ratio(along * cos + across * sin, one * normal);
        let second = ratio(across * cos - along * sin, two * normal);
        let utilisation = if normal > 0.0 { first.hypot(second) } else { f64::INFINITY };
        Reactions { s: at.s, tension, along, across, normal, utilisation }
    }
}
