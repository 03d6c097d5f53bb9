//! Student's distribution.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

/// How far off its mean, in standard errors either way, an estimate lies with a probability, for so many degrees of freedom;
/// not a number without any.
pub fn bound(confidence: f64, freedom: usize) -> f64 {
    if freedom == 0 || !(0.0..1.0).contains(&confidence) {
        return f64::NAN;
    }
    let [mut low, mut high] = [0.0, FRAC_PI_2];
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle.tan() * (freedom as f64).sqrt();
        }
        if within(middle, freedom) < confidence { low = middle } else { high = middle }
    }
}

/// The probability to lie within `√freedom tan(angle)`: Abramowitz and Stegun, 26.7.3 and 26.7.4.
fn within(angle: f64, freedom: usize) -> f64 {
    let (sin, cos) = angle.sin_cos();
    let odd = freedom % 2;
    let mut term = if odd == 1 { sin * cos } else { sin };
    let mut sum = 0.0;
    for k in (2 + odd..=freedom).step_by(2) {
        sum += term;
        term *= cos * cos * (k - 1) as f64 / k as f64;
    }
    if odd == 1 { FRAC_2_PI * (angle + sum) } else { sum }
}
