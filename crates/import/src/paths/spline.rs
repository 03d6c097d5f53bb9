//! Cubic splines of OpenSim.

use nalgebra::{DMatrix, DVector};

/// What a spline does at its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ends {
    /// No curvature.
    Natural,
    /// The third derivative of the cubic through the four points at the end (Forsythe, Malcolm and Moler, Computer methods for
    /// mathematical computations, 1977).
    Fitted,
}

/// The value of the cubic spline through points at ascending places; beyond them it goes on along its tangent. `None` of less than
/// two points.
pub(super) fn value(x: &[f64], y: &[f64], ends: Ends, at: f64) -> Option<f64> {
    let n = x.len();
    if n < 2 || y.len() != n {
        return None;
    }
    let step = |k: usize| x[k + 1] - x[k];
    let slope = |k: usize| (y[k + 1] - y[k]) / step(k);
    // Sixths of the second derivatives at the points.
    let mut matrix = DMatrix::<f64>::identity(n, n);
    let mut right = DVector::<f64>::zeros(n);
    for k in 1..n - 1 {
        (matrix[(k, k - 1)], matrix[(k, k)], matrix[(k, k + 1)]) =
            (step(k - 1), 2.0 * (step(k - 1) + step(k)), step(k));
        right[k] = slope(k) - slope(k - 1);
    }
    if ends == Ends::Fitted && n > 2 {
        let third = |k: usize| -> f64 {
            let second = |k: usize| (slope(k + 1) - slope(k)) / (x[k + 2] - x[k]);
            if n == 3 { 0.0 } else { (second(k + 1) - second(k)) / (x[k + 3] - x[k]) }
        };
        (matrix[(0, 0)], matrix[(0, 1)], right[0]) = (-1.0, 1.0, step(0) * third(0));
        let last = n - 1;
        (matrix[(last, last)], matrix[(last, last - 1)]) = (1.0, -1.0);
        right[last] = step(last - 1) * third(n.saturating_sub(4));
    }
    let c = matrix.lu().solve(&right)?;
    let tangent = |k: usize| slope(k) - step(k) * (c[k + 1] + 2.0 * c[k]);
    if at <= x[0] {
        return Some(y[0] + tangent(0) * (at - x[0]));
    }
    if at >= x[n - 1] {
        let k = n - 2;
        let end = slope(k) + step(k) * (c[k] + 2.0 * c[k + 1]);
        return Some(y[n - 1] + end * (at - x[n - 1]));
    }
    let k = x.partition_point(|v| *v <= at).clamp(1, n - 1) - 1;
    let w = at - x[k];
    Some(y[k] + w * (tangent(k) + w * (3.0 * c[k] + w * (c[k + 1] - c[k]) / step(k))))
}
