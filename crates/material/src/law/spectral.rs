//! Functions of symmetric tensors, with first and second derivatives.
//!
//! With the eigenvalues `c_a` and the divided differences `f[a, b]`, `f[a, b, c]` of a function of one variable, in the axes of
//! the eigenvectors (Daleckii & Krein; Higham, *Functions of matrices*, 2008, sect. 3.2)
//!
//! ```text
//! Df(C)[A]_ab = f[a, b] A_ab,    D²f(C)[A, B]_ab = Σ_c f[a, c, b] (A_ac B_cb + B_ac A_cb)
//! ```
//!
//! Differences of neighbouring values are sums of Taylor's series, so that no digits are lost where eigenvalues agree.

use nalgebra::Matrix3;

/// A function of one variable: values, and `f⁽ⁿ⁾(m)/n!`.
#[derive(Clone, Copy, Debug)]
pub(super) enum Scalar {
    /// `ln(x)/2`.
    HalfLogarithm,
    /// `e^(-x)`.
    FallingExponential,
}

/// Distance of values, relative to the length over which the function changes, below which differences are sums of the series.
const NEAR: f64 = 0.2;
/// Terms of the series: the rest is below `(NEAR/2)^16`, which is rounding.
const TERMS: usize = 16;

impl Scalar {
    fn value(self, x: f64) -> f64 {
        match self {
            Scalar::HalfLogarithm => 0.5 * x.ln(),
            Scalar::FallingExponential => (-x).exp(),
        }
    }

    fn taylor(self, n: usize, m: f64) -> f64 {
        let sign = if n.is_multiple_of(2) { 1.0 } else { -1.0 };
        match self {
            Scalar::HalfLogarithm => -0.5 * sign / (n as f64 * m.powi(n as i32)),
            Scalar::FallingExponential => sign * (-m).exp() / (1..=n).map(|k| k as f64).product::<f64>(),
        }
    }

    /// The divided difference at two or three values.
    fn divided(self, values: &mut [f64]) -> f64 {
        values.sort_by(f64::total_cmp);
        let n = values.len();
        let mean = values.iter().sum::<f64>() / n as f64;
        let scale = match self {
            Scalar::HalfLogarithm => mean,
            Scalar::FallingExponential => 1.0,
        };
        let spread = values[n - 1] - values[0];
        if spread > NEAR * scale {
            let (high, low) = match n {
                2 => (self.value(values[1]), self.value(values[0])),
                _ => (self.divided(&mut [values[1], values[2]]), self.divided(&mut [values[0], values[1]])),
            };
            return (high - low) / spread;
        }
        // Complete homogeneous polynomials of the distances from the mean, one variable after the other.
        let mut homogeneous = [0.0; TERMS];
        homogeneous[0] = 1.0;
        for x in values.iter().map(|x| x - mean) {
            for k in 1..TERMS {
                homogeneous[k] += x * homogeneous[k - 1];
            }
        }
        (0..TERMS).rev().map(|k| self.taylor(k + n - 1, mean) * homogeneous[k]).sum()
    }
}

/// A function at a symmetric tensor.
pub(super) struct Spectral {
    axes: Matrix3<f64>,
    pub value: Matrix3<f64>,
    first: [[f64; 3]; 3],
    second: [[[f64; 3]; 3]; 3],
}

impl Spectral {
    pub(super) fn new(f: Scalar, at: &Matrix3<f64>) -> Self {
        let found = at.symmetric_eigen();
        let (c, axes) = (found.eigenvalues, found.eigenvectors);
        let value = axes * Matrix3::from_diagonal(&c.map(|c| f.value(c))) * axes.transpose();
        let first = std::array::from_fn(|a| std::array::from_fn(|b| f.divided(&mut [c[a], c[b]])));
        let second = std::array::from_fn(|a| {
            std::array::from_fn(|b| std::array::from_fn(|r| f.divided(&mut [c[a], c[b], c[r]])))
        });
        Spectral { axes, value, first, second }
    }

    fn seen(&self, of: &Matrix3<f64>) -> Matrix3<f64> {
        self.axes.transpose() * of * self.axes
    }

    fn back(&self, of: &Matrix3<f64>) -> Matrix3<f64> {
        self.axes * of * self.axes.transpose()
    }

    /// The derivative along a symmetric tensor.
    pub(super) fn first(&self, along: &Matrix3<f64>) -> Matrix3<f64> {
        let own = self.seen(along);
        self.back(&Matrix3::from_fn(|a, b| self.first[a][b] * own[(a, b)]))
    }

    /// The second derivative along two symmetric tensors.
    pub(super) fn second(&self, along: &Matrix3<f64>, other: &Matrix3<f64>) -> Matrix3<f64> {
        let (u, v) = (self.seen(along), self.seen(other));
        let entry = |a: usize, b: usize| -> f64 {
            (0..3).map(|c| self.second[a][c][b] * (u[(a, c)] * v[(c, b)] + v[(a, c)] * u[(c, b)])).sum()
        };
        self.back(&Matrix3::from_fn(entry))
    }
}
