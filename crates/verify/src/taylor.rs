//! Derivatives checked by differences.

/// The relative difference between a predicted derivative and the central difference of a function of one step.
///
/// `f` is evaluated at `-step` and `step`; the result is `|prediction - difference| / |difference|` in the norm of the
/// largest entry.
pub fn central_difference_error(prediction: &[f64], step: f64, mut f: impl FnMut(f64) -> Vec<f64>) -> f64 {
    let (plus, minus) = (f(step), f(-step));
    let norm = |v: &[f64]| v.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let difference: Vec<f64> = plus.iter().zip(&minus).map(|(p, m)| (p - m) / (2.0 * step)).collect();
    let error: Vec<f64> = difference.iter().zip(prediction).map(|(d, p)| d - p).collect();
    norm(&error) / norm(&difference).max(f64::MIN_POSITIVE)
}
