//! Closed solutions with Coulomb's friction: Cattaneo and Mindlin's problem in the plane and in space, a wedge, an
//! orthotropic incline.

use std::f64::consts::PI;

/// Alike elastic half planes, one of them rounded, pressed together and then sheared: they stick in the middle and slip
/// beside it (Cattaneo 1938, Mindlin 1949; paths by Ciavarella 1998 and Jäger 1998). Forces are per thickness; a line force
/// displaces the surface by `2/(π E*) ln(L/|x|)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfPlanes {
    /// `E*`, with `1/E*` the sum of `(1 - ν²)/E` of both.
    pub modulus: f64,
    /// Radius at the crown.
    pub radius: f64,
    /// Coefficient of friction.
    pub friction: f64,
    /// Where the displacement counts from: `L`.
    pub length: f64,
    /// Normal force.
    pub force: f64,
}

impl HalfPlanes {
    /// Half the width of the contact (Hertz 1882).
    pub fn half_width(&self) -> f64 {
        (4.0 * self.force * self.radius / (PI * self.modulus)).sqrt()
    }

    /// The largest pressure.
    pub fn peak_pressure(&self) -> f64 {
        2.0 * self.force / (PI * self.half_width())
    }

    /// The largest tangential force.
    pub fn limit(&self) -> f64 {
        self.friction * self.force
    }

    /// The approach under a normal force.
    pub fn approach(&self, force: f64) -> f64 {
        if force <= 0.0 {
            return 0.0;
        }
        let a = HalfPlanes { force, ..*self }.half_width();
        2.0 * force / (PI * self.modulus) * ((2.0 * self.length / a).ln() + 0.5)
    }

    /// The shift under a tangential force that only grew, at most to the limit; odd.
    pub fn shift(&self, tangential: f64) -> f64 {
        let left = self.force - tangential.abs() / self.friction;
        tangential.signum() * self.friction * (self.approach(self.force) - self.approach(left))
    }

    /// How the shift changes after a reversal, under a change of the tangential force.
    pub fn reversed_shift(&self, change: f64) -> f64 {
        2.0 * self.shift(0.5 * change)
    }

    /// Half the width that sticks under a tangential force that only grew.
    pub fn stick_half_width(&self, tangential: f64) -> f64 {
        self.half_width() * (1.0 - tangential.abs() / self.limit()).max(0.0).sqrt()
    }

    /// The pressure at a distance from the middle.
    pub fn pressure(&self, x: f64) -> f64 {
        self.peak_pressure() * (1.0 - (x / self.half_width()).powi(2)).max(0.0).sqrt()
    }

    /// The size of the friction at a distance from the middle, under a tangential force that only grew.
    pub fn traction(&self, x: f64, tangential: f64) -> f64 {
        let (a, c) = (self.half_width(), self.stick_half_width(tangential));
        let within = if x.abs() < c { c / a * (1.0 - (x / c).powi(2)).sqrt() } else { 0.0 };
        self.friction * (self.pressure(x) - self.peak_pressure() * within)
    }

    /// The energy that a cycle between a tangential force and its opposite takes; it does not depend on `length`.
    pub fn dissipation(&self, peak: f64) -> f64 {
        // ∫ approach dP: the approach is k P (c - ln(P)/2).
        let integral = |p: f64| {
            if p <= 0.0 {
                return 0.0;
            }
            let k = 2.0 / (PI * self.modulus);
            let c = (2.0 * self.length).ln() - 0.5 * (4.0 * self.radius / (PI * self.modulus)).ln() + 0.5;
            k * 0.5 * p * p * (c - 0.5 * p.ln() + 0.25)
        };
        let mu = self.friction;
        let under =
            mu * (self.approach(self.force) * peak - mu * (integral(self.force) - integral(self.force - peak / mu)));
        4.0 * peak * self.shift(peak) - 8.0 * under
    }
}

/// Alike elastic half spaces, one of them a sphere, pressed together and then sheared (Mindlin 1949; Mindlin & Deresiewicz
/// 1953). Slip across the force is neglected: there is none where Poisson's ratio is zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spheres {
    /// `E*`, with `1/E*` the sum of `(1 - ν²)/E` of both.
    pub modulus: f64,
    pub poissons_ratio: f64,
    pub radius: f64,
    /// Coefficient of friction.
    pub friction: f64,
    /// Normal force.
    pub force: f64,
}

impl Spheres {
    /// Radius of the contact (Hertz 1882).
    pub fn contact_radius(&self) -> f64 {
        (0.75 * self.force * self.radius / self.modulus).cbrt()
    }

    /// The largest tangential force.
    pub fn limit(&self) -> f64 {
        self.friction * self.force
    }

    /// The approach under a normal force.
    pub fn approach(&self, force: f64) -> f64 {
        (0.5625 * force.max(0.0).powi(2) / (self.modulus.powi(2) * self.radius)).cbrt()
    }

    /// Tangential compliance over normal compliance.
    fn ratio(&self) -> f64 {
        (1.0 - 0.5 * self.poissons_ratio) / (1.0 - self.poissons_ratio)
    }

    /// The shift under a tangential force that only grew, at most to the limit; odd.
    pub fn shift(&self, tangential: f64) -> f64 {
        let left = self.force - tangential.abs() / self.friction;
        tangential.signum() * self.ratio() * self.friction * (self.approach(self.force) - self.approach(left))
    }

    /// How the shift changes after a reversal, under a change of the tangential force.
    pub fn reversed_shift(&self, change: f64) -> f64 {
        2.0 * self.shift(0.5 * change)
    }

    /// Radius of the circle that sticks under a tangential force that only grew.
    pub fn stick_radius(&self, tangential: f64) -> f64 {
        self.contact_radius() * (1.0 - tangential.abs() / self.limit()).max(0.0).cbrt()
    }

    /// The energy that a cycle between a tangential force and its opposite takes.
    pub fn dissipation(&self, peak: f64) -> f64 {
        // The approach grows with the power 2/3 of the force.
        let integral = |p: f64| 0.6 * p * self.approach(p);
        let (mu, left) = (self.friction, self.force - peak / self.friction);
        let under =
            mu * self.ratio() * (self.approach(self.force) * peak - mu * (integral(self.force) - integral(left)));
        4.0 * peak * self.shift(peak) - 8.0 * under
    }
}

/// Push over weight of a block that slides up a slope under a dead weight.
pub fn wedge(slope: f64, friction: f64) -> f64 {
    (slope + friction) / (1.0 - friction * slope)
}

/// Slope, in radians, at which a block begins to slide towards `psi` from the first axis, with associated friction of
/// these coefficients along the axes; and the direction that it takes from there.
pub fn orthotropic_incline(psi: f64, friction: [f64; 2]) -> (f64, f64) {
    let [along, across] = [psi.cos() / friction[0], psi.sin() / friction[1]];
    let critical = (1.0 / along.hypot(across)).atan();
    (critical, (across / friction[1]).atan2(along / friction[0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers from an independent program with 30 digits.
    #[test]
    fn half_planes() {
        let of = HalfPlanes { modulus: 1.3, radius: 2.0, friction: 0.35, length: 40.0, force: 0.5105088062083414 };
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-13, "{a} {b}");
        near(of.half_width(), 1.0);
        near(of.peak_pressure(), 0.325);
        near(of.approach(of.force), 1.2205066586684703);
        for (share, c, shift, traction) in [
            (0.25, 0.8660254037844386, 0.09735476463116705, 0.20424089149500668),
            (0.5, std::f64::consts::FRAC_1_SQRT_2, 0.19842607069223347, 0.614142842854284),
            (0.75, 0.5, 0.30522040332572464, 0.714142842854285),
        ] {
            let q = share * of.limit();
            near(of.stick_half_width(q), c);
            near(of.shift(q), shift);
            near(of.traction(0.7, q) / (0.35 * 0.325), traction);
        }
        let peak = 0.85 * of.limit();
        near(of.shift(peak) + of.reversed_shift(-1.7 * of.limit()), -of.shift(peak));
        near(of.shift(peak) + of.reversed_shift(-peak), 0.015392344895358456);
        near(of.dissipation(peak), 0.006384498501380206);
        near(HalfPlanes { length: 1.0, ..of }.dissipation(peak), of.dissipation(peak));
        // The traction sums up to the force.
        let n = 20000;
        let at = |k: usize| of.traction(-1.0 + (k as f64 + 0.5) * 2.0 / n as f64, 0.6 * of.limit());
        let sum = (0..n).map(at).sum::<f64>() * 2.0 / n as f64;
        assert!((sum / of.limit() - 0.6).abs() < 1e-5);
    }

    #[test]
    fn spheres() {
        let of = Spheres { modulus: 1.0, poissons_ratio: 0.3, radius: 2.0, friction: 0.3, force: 0.5 };
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-14, "{a} {b}");
        near(of.contact_radius(), 0.9085602964160698);
        for (share, c, shift) in [
            (0.25, 0.9085602964160698, 0.026239789591042208),
            (0.5, 0.7937005259840998, 0.055637513141052544),
            (0.75, 0.6299605249474366, 0.0906869501261599),
        ] {
            near(of.stick_radius(share * of.limit()) / of.contact_radius(), c);
            near(of.shift(share * of.limit()), shift);
        }
        near(of.dissipation(0.8 * of.limit()), 0.003998707881016442);
        near(of.shift(0.1) + of.reversed_shift(-0.2), -of.shift(0.1));
    }

    #[test]
    fn wedges_and_inclines() {
        assert!((wedge(0.1, 0.3) - 0.4123711340206186).abs() < 1e-15);
        let (critical, onset) = orthotropic_incline(35f64.to_radians(), [0.3, 0.6]);
        assert!((critical.to_degrees() - 19.06823601287956).abs() < 1e-12);
        assert!((onset.to_degrees() - 9.929129911438796).abs() < 1e-12);
    }
}
