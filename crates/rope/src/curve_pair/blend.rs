//! From point contact of crossing curves to line contact of nearly parallel ones.
//!
//! With `z = cos² θ` of the angle between straight lines, the share of the point force is 1 for `θ ≥ θ_2`, 0 for `θ ≤ θ_1`, and
//! a cubic in `z` between, with a continuous derivative; line forces have the rest (Meier, Wall & Popp 2017, on the level of
//! forces). What counts is whether one point is nearer than its neighbours, by enough for points of a line to see it: of
//! curves `z = 1 - det A/(|c_1'|² |c_2'|²)` with the second derivatives `A` of half the squared distance, which is 1 along the
//! valley between the strands of a double helix although they cross.
//!
//! Straight tubes of radii `R` that cross at `θ` and penetrate by `δ` touch with `δ - x² sin²θ/(2(R_1 + R_2))`; line forces of
//! penalty `ε_l` add up to `(4/3) ε_l δ √(2(R_1 + R_2) δ)/sin θ`, and point forces to `ε δ`. [`Blend::line_penalty`] makes both
//! equal in the middle of the band at an expected force.

/// A band of angles, in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blend {
    theta_1: f64,
    theta_2: f64,
}

/// A band that is none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("angles {theta_1} and {theta_2} (radians): valid are 0 < theta_1 < theta_2 <= π/2")]
pub struct BlendError {
    pub theta_1: f64,
    pub theta_2: f64,
}

/// The least angle of a band, in radians: closer to parallel the foot points of a crossing move more than two hundred times
/// as far as the curves.
const LEAST: f64 = 5e-3;

impl Default for Blend {
    /// From 10 to 25 degrees: below, foot points of crossings move more than five times as far as the curves; above, the
    /// overlap of tubes is as short as a few of their penetrations are wide.
    fn default() -> Self {
        Blend { theta_1: 10f64.to_radians(), theta_2: 25f64.to_radians() }
    }
}

impl Blend {
    /// A band between two angles.
    ///
    /// # Errors
    /// Angles that are not in order.
    pub fn new(theta_1: f64, theta_2: f64) -> Result<Self, BlendError> {
        let is_valid = theta_1 > 0.0 && theta_1 < theta_2 && theta_2 <= std::f64::consts::FRAC_PI_2;
        if is_valid { Ok(Blend { theta_1, theta_2 }) } else { Err(BlendError { theta_1, theta_2 }) }
    }

    /// A band in which lines of points so far apart resolve where curves touch: the gap at the nearest point of a line is
    /// off by at most `s² sin²θ / (8 (R_1 + R_2))` at a spacing `s`, which is to be less than a ten-thousandth of the
    /// smaller radius at `θ_1`. `θ_2` is 2.5 times as large, and neither is beyond the default.
    pub fn resolved(spacing: f64, radii: [f64; 2]) -> Self {
        // Of a sharp edge that of the other curve counts.
        let smaller = if radii.contains(&0.0) { radii[0].max(radii[1]) } else { radii[0].min(radii[1]) };
        let sine = (8e-4 * smaller * (radii[0] + radii[1])).sqrt() / spacing;
        let theta_1 = sine.min(1.0).asin().clamp(LEAST, Self::default().theta_1);
        Blend { theta_1, theta_2: 2.5 * theta_1 }
    }

    /// Share of the point force for `z = cos² θ`, and its derivative in `z`.
    pub fn point_share(&self, z: f64) -> (f64, f64) {
        let [z_1, z_2] = [self.theta_1, self.theta_2].map(|t| t.cos().powi(2));
        let x = (z_1 - z) / (z_1 - z_2);
        match x {
            x if x <= 0.0 => (0.0, 0.0),
            x if x >= 1.0 => (1.0, 0.0),
            x => (x * x * (3.0 - 2.0 * x), -6.0 * x * (1.0 - x) / (z_1 - z_2)),
        }
    }

    /// The line penalty that gives the same force as a point penalty in the middle of the band, at the force expected there.
    pub fn line_penalty(&self, point_penalty: f64, force: f64, radii: [f64; 2]) -> f64 {
        let sine = (0.5 * (self.theta_1 + self.theta_2)).sin();
        let penetration = force / point_penalty;
        let half_width = (2.0 * (radii[0] + radii[1]) * penetration).sqrt() / sine;
        force / (4.0 / 3.0 * penetration * half_width)
    }
}
