//! Patterns: in which order the circuits lie side by side, and how well they cover the mandrel.
//!
//! A circuit turns by `Φ`; with a dwell `d` per circuit `n` circuits close evenly where `Φ + d = 2π (m + k/n)` with `k` and
//! `n` coprime. The next band to the side of the first is laid after `j` circuits, `j k ≡ ±1 (mod n)`: the pattern leads
//! where it is on the side in which the mandrel turns, and lags where it is on the other.

use crate::PathError;
use std::f64::consts::TAU;

/// On which side of the first band its neighbour is laid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lead {
    Leading,
    Lagging,
}

/// A pattern of winding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pattern {
    /// Circuits, of which each lies beside another.
    pub n: u32,
    /// Places of a band by which a circuit goes on, beside the full turns.
    pub k: u32,
    /// Full turns of a circuit.
    pub m: u32,
    /// Angle that each circuit is to turn more, in radians: as a dwell at the turns where it is positive.
    pub dwell: f64,
    /// Circuits after which the first neighbour is laid.
    pub neighbour_after: u32,
    pub lead: Lead,
}

/// The patterns for numbers of circuits in a range, those of the smallest dwell first, for circuits that turn by `angle`.
///
/// # Errors
/// An angle that is not positive, a range without a number.
pub fn patterns(angle: f64, circuits: std::ops::RangeInclusive<u32>) -> Result<Vec<Pattern>, PathError> {
    if !(angle.is_finite() && angle > 0.0) {
        let valid = "a number greater than zero";
        return Err(PathError::Input { what: "angle of a circuit", value: angle, valid });
    }
    let mut out = Vec::new();
    for n in circuits.clone().filter(|n| *n > 0) {
        let places = angle / TAU * f64::from(n);
        // The whole numbers on both sides with no common divisor.
        let coprime = |k: &i64| *k > 0 && gcd(*k as u64, u64::from(n)) == 1;
        let below = (0..i64::from(n)).map(|j| places.floor() as i64 - j).find(coprime);
        let above = (1..=i64::from(n)).map(|j| places.floor() as i64 + j).find(coprime);
        for total in [below, above].into_iter().flatten() {
            let dwell = TAU * total as f64 / f64::from(n) - angle;
            let (m, k) = ((total / i64::from(n)) as u32, (total % i64::from(n)) as u32);
            let (neighbour_after, lead) = neighbour(k, n);
            out.push(Pattern { n, k, m, dwell, neighbour_after, lead });
        }
    }
    if out.is_empty() {
        return Err(PathError::NoPattern { reason: format!("no number of circuits between {circuits:?} is possible") });
    }
    out.sort_by(|a, b| a.dwell.abs().total_cmp(&b.dwell.abs()).then(a.n.cmp(&b.n)));
    Ok(out)
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// After how many circuits a band comes to lie beside the first, and on which side.
fn neighbour(k: u32, n: u32) -> (u32, Lead) {
    let place = |j: &u32| (u64::from(*j) * u64::from(k)) % u64::from(n);
    let leading = (1..=n).find(|j| place(j) == 1 % u64::from(n)).unwrap_or(n);
    if 2 * leading <= n { (leading, Lead::Leading) } else { ((n - leading).max(1), Lead::Lagging) }
}

/// How bands lie around a parallel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coverage {
    /// Width of a band along the parallel, `b/cos α`, as an angle around the axis.
    pub width: f64,
    /// Circuits that cover it without gaps where they lie evenly.
    pub circuits: u32,
    /// Share of the parallel that is covered.
    pub covered: f64,
    /// The widest gap, as an angle.
    pub gap: f64,
    /// The widest overlap of neighbours, as an angle.
    pub overlap: f64,
}

/// Bands of a width at an angle from the meridian on a parallel of a radius, laid by `circuits` circuits that each turn by
/// `angle`.
///
/// # Errors
/// Numbers that are not positive.
pub fn coverage(band: f64, winding_angle: f64, radius: f64, angle: f64, circuits: u32) -> Result<Coverage, PathError> {
    for (what, value) in [("band", band), ("radius", radius), ("cosine of the angle", winding_angle.cos().abs())] {
        if !(value.is_finite() && value > 0.0) {
            return Err(PathError::Input { what, value, valid: "a number greater than zero" });
        }
    }
    let width = band / winding_angle.cos().abs() / radius;
    let mut places: Vec<f64> = (0..circuits).map(|i| (f64::from(i) * angle).rem_euclid(TAU)).collect();
    places.sort_by(f64::total_cmp);
    let count = places.len();
    let spaces =
        (0..count).map(|i| if i + 1 < count { places[i + 1] - places[i] } else { places[0] + TAU - places[i] });
    let gaps: Vec<f64> = spaces.map(|space| space - width).collect();
    let open: f64 = gaps.iter().filter(|g| **g > 0.0).sum();
    Ok(Coverage {
        width,
        circuits: (TAU / width).ceil() as u32,
        covered: if count == 0 { 0.0 } else { 1.0 - open / TAU },
        gap: gaps.iter().copied().fold(0.0, f64::max),
        overlap: gaps.iter().map(|g| -g).fold(0.0, f64::max),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_close() {
        let found = patterns(9.05, 36..=42).unwrap();
        for p in &found {
            let turned = f64::from(p.n) * (9.05 + p.dwell) / TAU;
            assert!((turned - turned.round()).abs() < 1e-9 && gcd(u64::from(p.k), u64::from(p.n)) == 1, "{p:?}");
            let place = u64::from(p.neighbour_after) * u64::from(p.k) % u64::from(p.n);
            let side = if p.lead == Lead::Leading { 1 } else { u64::from(p.n) - 1 };
            assert_eq!(place, side, "{p:?}");
            let full = coverage(TAU / f64::from(p.n), 0.0, 1.0, 9.05 + p.dwell, p.n).unwrap();
            assert!((full.covered - 1.0).abs() < 1e-9 && full.gap < 1e-9 && full.overlap < 1e-9, "{full:?}");
        }
        assert!(found.windows(2).all(|w| w[0].dwell.abs() <= w[1].dwell.abs()));
        assert!(patterns(-1.0, 3..=4).is_err());
        let half = coverage(TAU / 8.0, 0.0, 1.0, TAU / 4.0, 4).unwrap();
        assert!((half.covered - 0.5).abs() < 1e-12 && half.circuits == 8, "{half:?}");
    }
}
