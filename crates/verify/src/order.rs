//! Observed orders of convergence.

/// The exponent `q` of `error = C h^q`, by least squares over the logarithms.
///
/// ```
/// let h = [0.1, 0.05, 0.025];
/// let error: Vec<f64> = h.iter().map(|h: &f64| 3.0 * h.powi(4)).collect();
/// assert!((signorini_verify::order::fitted(&h, &error) - 4.0).abs() < 1e-12);
/// ```
pub fn fitted(h: &[f64], error: &[f64]) -> f64 {
    let n = h.len() as f64;
    let x: Vec<f64> = h.iter().map(|v| v.ln()).collect();
    let y: Vec<f64> = error.iter().map(|v| v.abs().max(f64::MIN_POSITIVE).ln()).collect();
    let (mx, my) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let covariance: f64 = x.iter().zip(&y).map(|(x, y)| (x - mx) * (y - my)).sum();
    covariance / x.iter().map(|x| (x - mx) * (x - mx)).sum::<f64>()
}
