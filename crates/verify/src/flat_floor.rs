//! A membrane on a flat floor: the string and the round membrane have closed solutions.
//!
//! Graveleau, Chevaugeon & Moës, *The inequality level-set approach to handle contact: membrane case* (2015).

/// A membrane held at height zero, of half-length or radius `radius`, under a load `load` per area downwards, over a
/// floor at depth `depth`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatFloor {
    pub tension: f64,
    pub load: f64,
    pub depth: f64,
    pub radius: f64,
    pub kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A string between `-radius` and `radius`.
    String,
    /// A round membrane.
    Round,
}

impl FlatFloor {
    /// Radius, or half-length, of the zone of contact; none where the floor is not reached.
    pub fn contact_radius(&self) -> Option<f64> {
        let Self { tension: t, load: f, depth: d, radius: r, kind } = *self;
        match kind {
            Kind::String => {
                let free = (2.0 * t * d / f).sqrt();
                (f > 0.0 && free < r).then_some(r - free)
            }
            Kind::Round => {
                let kappa = 4.0 * d * t / (f * r * r);
                if !(f > 0.0 && kappa < 1.0) {
                    return None;
                }
                let w = lambert_w_minus_one((kappa - 1.0) / std::f64::consts::E);
                Some(r * (0.5 * (1.0 + w)).exp())
            }
        }
    }

    /// The floor carries the load above it.
    pub fn contact_force(&self) -> f64 {
        let c = self.contact_radius().unwrap_or(0.0);
        match self.kind {
            Kind::String => 2.0 * c * self.load,
            Kind::Round => std::f64::consts::PI * c * c * self.load,
        }
    }

    /// Displacement at a distance from the centre.
    pub fn displacement(&self, x: f64) -> f64 {
        let Self { tension: t, load: f, depth: d, radius: r, kind } = *self;
        let x = x.abs();
        match (self.contact_radius(), kind) {
            (Some(c), _) if x <= c => -d,
            (Some(c), Kind::String) => -d + f * (x - c).powi(2) / (2.0 * t),
            (None, Kind::String) => -f * (r * r - x * x) / (2.0 * t),
            (Some(c), Kind::Round) => f * (x * x - r * r) / (4.0 * t) - f * c * c / (2.0 * t) * (x / r).ln(),
            (None, Kind::Round) => f * (x * x - r * r) / (4.0 * t),
        }
    }
}

/// The lower real branch of Lambert's function: `w e^w = x` with `w <= -1`, for `-1/e < x < 0`.
pub fn lambert_w_minus_one(x: f64) -> f64 {
    // Near the branch point a series, far from it the logarithm; Halley's iteration does the rest.
    let p = (2.0 * (1.0 + std::f64::consts::E * x)).max(0.0).sqrt();
    let mut w = if p < 0.5 { -1.0 - p - p * p / 3.0 } else { (-x).ln() - (-(-x).ln()).ln() };
    for _ in 0..50 {
        let e = w.exp();
        let f = w * e - x;
        let step = f / (e * (w + 1.0) - (w + 2.0) * f / (2.0 * w + 2.0));
        if !step.is_finite() {
            break;
        }
        w -= step;
        if step.abs() < 1e-16 * w.abs() {
            break;
        }
    }
    w
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Benchmark values computed independently with 20 digits.
    #[test]
    fn radii_of_the_published_problem() {
        for (load, radius) in [
            (0.41, 0.0607870716444372),
            (0.5, 0.223766054263894),
            (1.0, 0.502474357083085),
            (2.0, 0.662195695285216),
            (5.0, 0.792254262181059),
            (10.0, 0.854886736990740),
        ] {
            let exact = FlatFloor { tension: 1.0, load, depth: 0.1, radius: 1.0, kind: Kind::Round };
            assert!((exact.contact_radius().unwrap() - radius).abs() < 1e-14, "{load}");
            // The gap opens without a slope.
            let (c, e) = (radius, 1e-5);
            assert!((exact.displacement(c + e) + 0.1).abs() < 2.0 * load * e * e);
        }
        let string = FlatFloor { tension: 1.0, load: 1.0, depth: 0.1, radius: 1.0, kind: Kind::String };
        assert!((string.contact_radius().unwrap() - 0.552786404500042).abs() < 1e-14);
        assert!(FlatFloor { load: 0.4, kind: Kind::Round, ..string }.contact_radius().is_none());
    }
}
