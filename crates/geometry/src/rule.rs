//! Gauss-Legendre rules on the unit interval.

use std::sync::OnceLock;

/// The `n`-point Gauss-Legendre rule on `[0, 1]`: pairs (position, weight), exact for degree `2n - 1`.
///
/// Those of a few points are computed once.
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    static RULES: [OnceLock<Vec<(f64, f64)>>; 32] = [const { OnceLock::new() }; 32];
    match RULES.get(n) {
        Some(rule) => rule.get_or_init(|| by_newton(n)).clone(),
        None => by_newton(n),
    }
}

/// Newton on the Legendre polynomial from the Chebyshev-like starting points of Abramowitz & Stegun 22.16.6.
fn by_newton(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            for _ in 0..10 {
                let (p, dp) = legendre(n, x);
                let step = p / dp;
                x -= step;
                if step.abs() < 1e-16 {
                    break;
                }
            }
            let (_, dp) = legendre(n, x);
            (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * dp * dp))
        })
        .collect()
}

/// Legendre polynomial of degree `n` and its derivative at `x` in `(-1, 1)`.
pub fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut p) = (0.0, 1.0);
    for k in 0..n {
        let k = k as f64;
        (previous, p) = (p, ((2.0 * k + 1.0) * x * p - k * previous) / (k + 1.0));
    }
    (p, n as f64 * (previous - x * p) / (1.0 - x * x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_exact_to_their_degree_and_no_further() {
        for n in 1..=16 {
            let rule = gauss_legendre(n);
            let integral = |k: i32| rule.iter().map(|&(x, w)| w * x.powi(k)).sum::<f64>();
            for k in 0..2 * n as i32 {
                assert!((integral(k) - 1.0 / (k as f64 + 1.0)).abs() < 1e-14, "{n} points, x^{k}");
            }
            if n < 8 {
                assert!((integral(2 * n as i32) - 1.0 / (2.0 * n as f64 + 1.0)).abs() > 1e-12);
            }
        }
    }
}
