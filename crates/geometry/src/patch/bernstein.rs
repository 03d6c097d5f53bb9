//! Bernstein polynomials at construction time: Bezier extraction, interpolation, bounds from control nets.
//!
//! A control value is homogeneous, `[w x, w y, w z, w]`; for polynomial shapes the last number is one (of a position)
//! or zero (of a derivative). Kernels do not work in this form: see [`super::chart`].

use crate::Point;
use nalgebra::DMatrix;

/// A control value in homogeneous coordinates.
pub type Control = [f64; 4];

/// The highest degree in one direction; higher ones are refused at construction.
pub const MAX_DEGREE: usize = 15;

pub fn combine(a: f64, x: &Control, b: f64, y: &Control) -> Control {
    std::array::from_fn(|k| a * x[k] + b * y[k])
}

/// A piece of a B-spline between two distinct knots, in Bezier form.
pub struct BezierSpan {
    pub from: f64,
    pub to: f64,
    /// How often the knot at `to` is repeated; `degree` or more leaves only continuity.
    pub multiplicity_at_end: usize,
    pub control: Vec<Control>,
}

/// Bezier form of every non-empty knot span, by blossoming (Ramshaw 1989): no knot is inserted, clamped and periodic
/// knot vectors are alike. Expects `knots.len() == control.len() + degree + 1`, not decreasing.
pub fn bezier_spans(degree: usize, knots: &[f64], control: &[Control]) -> Vec<BezierSpan> {
    let mut spans = Vec::new();
    for k in degree..control.len() {
        let (from, to) = (knots[k], knots[k + 1]);
        if to <= from {
            continue;
        }
        let bezier = (0..=degree).map(|i| blossom(degree, knots, control, k, from, to, i)).collect();
        let multiplicity_at_end = knots.iter().filter(|&&t| t == to).count();
        spans.push(BezierSpan { from, to, multiplicity_at_end, control: bezier });
    }
    spans
}

/// The polar form of span `k` at `degree - count` times `from` and `count` times `to`.
fn blossom(degree: usize, knots: &[f64], control: &[Control], k: usize, from: f64, to: f64, count: usize) -> Control {
    let mut d: Vec<Control> = control[k - degree..=k].to_vec();
    for r in 1..=degree {
        let u = if r <= count { to } else { from };
        for j in (r..=degree).rev() {
            let (low, high) = (knots[k - degree + j], knots[k + 1 + j - r]);
            let alpha = (u - low) / (high - low);
            d[j] = combine(1.0 - alpha, &d[j - 1], alpha, &d[j]);
        }
    }
    d[degree]
}

/// Binomial coefficients of one row of Pascal's triangle.
pub fn binomials(n: usize) -> Vec<f64> {
    let mut row = vec![1.0; n + 1];
    for k in 1..=n {
        row[k] = row[k - 1] * (n + 1 - k) as f64 / k as f64;
    }
    row
}

/// The matrix that takes values at `degree + 1` equidistant points of `[0, 1]` to Bernstein coefficients.
pub fn interpolation_matrix(degree: usize) -> DMatrix<f64> {
    let n = degree + 1;
    let row = binomials(degree);
    let collocation = DMatrix::from_fn(n, n, |i, j| {
        let t = if degree == 0 { 0.5 } else { i as f64 / degree as f64 };
        row[j] * t.powi(j as i32) * (1.0 - t).powi((degree - j) as i32)
    });
    collocation.try_inverse().expect("Bernstein polynomials are independent")
}

/// Control points of the curve of this degree through values at equidistant points.
pub fn interpolate(degree: usize, values: &[Control]) -> Vec<Control> {
    let matrix = interpolation_matrix(degree);
    apply(&matrix, values)
}

pub fn apply(matrix: &DMatrix<f64>, values: &[Control]) -> Vec<Control> {
    (0..matrix.nrows())
        .map(|i| {
            let mut sum = [0.0; 4];
            for (j, value) in values.iter().enumerate() {
                sum = combine(1.0, &sum, matrix[(i, j)], value);
            }
            sum
        })
        .collect()
}

/// Both parts of a Bezier curve that is cut at a parameter in `[0, 1]` (de Casteljau).
pub fn cut(control: &[Control], t: f64) -> [Vec<Control>; 2] {
    let n = control.len();
    let mut work = control.to_vec();
    let mut left = Vec::with_capacity(n);
    let mut right = vec![[0.0; 4]; n];
    for r in 0..n {
        left.push(work[0]);
        right[n - 1 - r] = work[n - 1 - r];
        for j in 0..n - 1 - r {
            work[j] = combine(1.0 - t, &work[j], t, &work[j + 1]);
        }
    }
    [left, right]
}

/// Derivative with respect to `s` in `[-1, 1]`, one degree lower.
pub fn derivative(control: &[Control]) -> Vec<Control> {
    let factor = 0.5 * (control.len() - 1) as f64;
    control.windows(2).map(|w| combine(factor, &w[1], -factor, &w[0])).collect()
}

/// Product with the linear function that is `at_start` at `s = -1` and `at_end` at `s = 1`, one degree higher.
pub fn times_linear(control: &[Control], at_start: f64, at_end: f64) -> Vec<Control> {
    let n = control.len();
    (0..=n)
        .map(|i| {
            let low = if i < n { control[i] } else { [0.0; 4] };
            let high = if i > 0 { control[i - 1] } else { [0.0; 4] };
            combine((n - i) as f64 / n as f64 * at_start, &low, i as f64 / n as f64 * at_end, &high)
        })
        .collect()
}

/// Product with `s^power`, two degrees higher, for `power` up to 2.
pub fn times_power(control: &[Control], power: usize) -> Vec<Control> {
    let once = times_linear(control, if power > 0 { -1.0 } else { 1.0 }, 1.0);
    times_linear(&once, if power > 1 { -1.0 } else { 1.0 }, 1.0)
}

/// Coefficients of the powers of `s` in `[-1, 1]`: the Taylor series about the middle.
pub fn powers(control: &[Control]) -> Vec<Control> {
    let mut current = control.to_vec();
    let mut coefficients = Vec::with_capacity(control.len());
    let mut factorial = 1.0;
    for order in 0..control.len() {
        if order > 0 {
            current = derivative(&current);
            factorial *= order as f64;
        }
        let middle = middle(&current);
        coefficients.push(middle.map(|c| c / factorial));
    }
    coefficients
}

fn middle(control: &[Control]) -> Control {
    let mut work = control.to_vec();
    for r in (1..work.len()).rev() {
        for j in 0..r {
            work[j] = combine(0.5, &work[j], 0.5, &work[j + 1]);
        }
    }
    work[0]
}

/// The box around the control points, which holds the piece where the weights are positive.
pub fn hull(control: &[Control]) -> [Point<3>; 2] {
    let mut low = Point::<3>::repeat(f64::INFINITY);
    let mut high = -low;
    for c in control {
        let x = Point::<3>::new(c[0], c[1], c[2]) / c[3];
        (low, high) = (low.inf(&x), high.sup(&x));
    }
    [low, high]
}

/// The largest length of the first three components: bounds a vector-valued polynomial (convex hull property).
pub fn largest(control: &[Control]) -> f64 {
    control.iter().map(|c| c[0] * c[0] + c[1] * c[1] + c[2] * c[2]).fold(0.0, f64::max).sqrt()
}

/// The largest magnitude of the last component.
pub fn largest_weight(control: &[Control]) -> f64 {
    control.iter().map(|c| c[3].abs()).fold(0.0, f64::max)
}
