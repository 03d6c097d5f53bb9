//! How far a rope slips on its curve when its ends are loaded and unloaded.
//!
//! With `ξ = ∫ω ds` the tension of a rope that holds lies between `T_e e^{±(ξ - ξ_e)}` from either end `e`; what slips is at
//! one of these limits, the rest keeps the tension it had. A change of an end tension therefore cuts `ln T(ξ)` off by lines
//! of slope one: the slipped length after a first loading is `∫ω = ln(T_1/T_i)`, after a reversal `½ ln(T_1/T_2)`. An
//! extensible rope moves by `∫(T - T_i)/EA ds`.

use crate::PathError;
use crate::theorem::Towards;

/// A point of the tension: between points `ω` is constant and `ln T` straight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TensionPoint {
    pub s: f64,
    /// `∫ω ds` from the start.
    pub xi: f64,
    pub log_tension: f64,
}

/// The tension of a rope and what became of it.
#[derive(Clone, Debug, PartialEq)]
pub struct PartialSlip {
    /// Axial stiffness `EA`, a force.
    stiffness: f64,
    initial: Vec<TensionPoint>,
    points: Vec<TensionPoint>,
}

/// What a change of an end tension did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slip {
    /// Length that slipped, from the loaded end; the whole rope where the slip reaches the other end.
    pub length: f64,
    /// How far the loaded end stands from where it was in the beginning, outwards.
    pub displacement: f64,
    /// Tension at the other end.
    pub other_tension: f64,
}

impl PartialSlip {
    /// A rope of constant `ω` and tension.
    ///
    /// # Errors
    /// Numbers that are not positive.
    pub fn uniform(omega: f64, length: f64, tension: f64, stiffness: f64) -> Result<Self, PathError> {
        Self::new(&[0.0, length], &[omega], &[tension, tension], stiffness)
    }

    /// A rope of any `ω`, constant between places `s` that increase, with tensions at the places.
    ///
    /// # Errors
    /// Places that do not increase, lengths of arrays that do not fit, tensions or stiffness that are not positive, `ω` that is
    /// negative.
    pub fn new(s: &[f64], omega: &[f64], tension: &[f64], stiffness: f64) -> Result<Self, PathError> {
        let positive = |what, value: f64| {
            let valid = "a number greater than zero";
            if value.is_finite() && value > 0.0 { Ok(value) } else { Err(PathError::Input { what, value, valid }) }
        };
        positive("axial stiffness", stiffness)?;
        if s.len() < 2 || tension.len() != s.len() {
            let valid = "at least two, as many as tensions";
            return Err(PathError::Count { what: "positions along a rope", given: s.len(), valid });
        }
        if omega.len() + 1 != s.len() {
            return Err(PathError::Count {
                what: "values of ω",
                given: omega.len(),
                valid: "one between two positions",
            });
        }
        let mut points = Vec::with_capacity(s.len());
        let mut xi = 0.0;
        for k in 0..s.len() {
            if k > 0 {
                let step = positive("the distance of two positions", s[k] - s[k - 1])?;
                let rate = omega[k - 1];
                if !(rate.is_finite() && rate >= 0.0) {
                    return Err(PathError::Input { what: "ω", value: rate, valid: "a number from 0 on" });
                }
                xi += rate * step;
            }
            points.push(TensionPoint { s: s[k], xi, log_tension: positive("tension", tension[k])?.ln() });
        }
        Ok(PartialSlip { stiffness, initial: points.clone(), points })
    }

    /// The tension now.
    pub fn tensions(&self) -> &[TensionPoint] {
        &self.points
    }

    /// Brings the tension of an end to a value.
    ///
    /// # Errors
    /// A tension that is not positive.
    pub fn pull(&mut self, end: Towards, tension: f64) -> Result<Slip, PathError> {
        if !(tension.is_finite() && tension > 0.0) {
            return Err(PathError::Input { what: "tension", value: tension, valid: "a number greater than zero" });
        }
        let last = self.points.len() - 1;
        let (here, there) = match end {
            Towards::Start => (self.points[0], last),
            Towards::End => (self.points[last], 0),
        };
        let log = tension.ln();
        let rises = log >= here.log_tension;
        // How far the tension lies beyond the limit from the end: what does slips.
        let excess = |p: &TensionPoint| {
            let far = (p.xi - here.xi).abs();
            if rises { log - far - p.log_tension } else { p.log_tension - log - far }
        };
        let mut next = Vec::with_capacity(self.points.len() + 1);
        let mut front = here.s;
        for (k, p) in self.points.iter().enumerate() {
            let e = excess(p);
            if k > 0 {
                let q = &self.points[k - 1];
                let before = excess(q);
                if before * e < 0.0 {
                    let share = before / (before - e);
                    let between = |a: f64, b: f64| a + share * (b - a);
                    let at = TensionPoint {
                        s: between(q.s, p.s),
                        xi: between(q.xi, p.xi),
                        log_tension: between(q.log_tension, p.log_tension),
                    };
                    if (at.s - here.s).abs() > (front - here.s).abs() {
                        front = at.s;
                    }
                    next.push(at);
                }
            }
            if e >= 0.0 && (p.s - here.s).abs() > (front - here.s).abs() {
                front = p.s;
            }
            let far = (p.xi - here.xi).abs();
            let cut = if rises { p.log_tension.max(log - far) } else { p.log_tension.min(log + far) };
            next.push(TensionPoint { log_tension: cut, ..*p });
        }
        self.points = next;
        // Where nothing changes nothing slips.
        let length = if log == here.log_tension { 0.0 } else { (front - here.s).abs() };
        let there = if there == 0 { 0 } else { self.points.len() - 1 };
        Ok(Slip { length, displacement: self.elongation(), other_tension: self.points[there].log_tension.exp() })
    }

    /// `∫(T - T_i)/EA ds`.
    pub fn elongation(&self) -> f64 {
        let integral = |points: &[TensionPoint]| -> f64 {
            let piece = |w: &[TensionPoint]| {
                let (length, change) = (w[1].s - w[0].s, w[1].log_tension - w[0].log_tension);
                // ∫ e^{cx} dx over an interval: length e^{a} (e^{c} - 1)/c.
                let mean = if change.abs() < 1e-8 { 1.0 + 0.5 * change } else { change.exp_m1() / change };
                length * w[0].log_tension.exp() * mean
            };
            points.windows(2).map(piece).sum()
        };
        (integral(&self.points) - integral(&self.initial)) / self.stiffness
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loading_beyond_the_rope_and_back() {
        let (omega, length, tension, stiffness) = (0.4, 2.0, 1.0, 50.0);
        let mut rope = PartialSlip::uniform(omega, length, tension, stiffness).unwrap();
        let slip = rope.pull(Towards::End, 1.5).unwrap();
        let l1 = 1.5f64.ln() / omega;
        assert!((slip.length - l1).abs() < 1e-14);
        let u1 = (1.5 * (1.0 - (-omega * l1).exp()) / omega - l1) / stiffness;
        assert!((slip.displacement - u1).abs() < 1e-15 && slip.other_tension == 1.0);
        let back = rope.pull(Towards::End, 1.1).unwrap();
        assert!((back.length - 0.5 * (1.5f64 / 1.1).ln() / omega).abs() < 1e-14);
        // Below the initial tension the reverse slip overtakes the first one.
        let low = rope.pull(Towards::End, 0.6).unwrap();
        assert!((low.length - (1.0f64 / 0.6).ln() / omega).abs() < 1e-14);
        // The whole rope slips.
        let whole = rope.pull(Towards::End, 5.0).unwrap();
        assert!((whole.length - length).abs() < 1e-14 && (whole.other_tension - 5.0 * (-0.8f64).exp()).abs() < 1e-13);
        assert!(rope.pull(Towards::End, 0.0).is_err());
    }

    #[test]
    fn both_ends_and_a_rope_of_two_rates() {
        let mut rope = PartialSlip::new(&[0.0, 1.0, 3.0], &[0.5, 0.2], &[1.0, 1.0, 1.0], 10.0).unwrap();
        rope.pull(Towards::Start, 1.4).unwrap();
        rope.pull(Towards::End, 1.3).unwrap();
        // The larger of the two slopes, as long as both stay above the initial tension.
        for p in rope.tensions() {
            let expected = (1.4f64.ln() - p.xi).max(1.3f64.ln() - (0.9 - p.xi)).max(0.0);
            assert!((p.log_tension - expected).abs() < 1e-14, "{p:?}");
        }
        let total = rope.elongation();
        let fine: f64 = (0..30000)
            .map(|k| {
                let s = (f64::from(k) + 0.5) * 1e-4;
                let xi = if s < 1.0 { 0.5 * s } else { 0.5 + 0.2 * (s - 1.0) };
                let log = (1.4f64.ln() - xi).max(1.3f64.ln() - (0.9 - xi)).max(0.0);
                (log.exp() - 1.0) * 1e-4 / 10.0
            })
            .sum();
        assert!((total - fine).abs() < 1e-9, "{total} {fine}");
    }
}
