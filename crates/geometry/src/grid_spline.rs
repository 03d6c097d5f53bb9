//! Functions given by their values on a regular grid: images, height maps, sampled level sets.

use crate::implicit::ImplicitShape;
use crate::jet::Jet;
use crate::shape::ShapeError;
use crate::{Aabb, Matrix, Vector};

/// Values on a regular grid joined by a cubic spline in every direction: twice continuously differentiable, and exact at
/// the points of the grid.
#[derive(Clone, Debug)]
pub struct GridSpline<const N: usize> {
    origin: Vector<N>,
    spacing: [f64; N],
    count: [usize; N],
    coefficients: Vec<f64>,
}

/// Values, first and second derivatives of the four splines on a cell, and their places.
type Weights = ([[f64; 4]; 3], [usize; 4]);

impl<const N: usize> GridSpline<N> {
    /// The spline through values at `origin + index * spacing`, the last index running fastest. Beyond the grid it goes
    /// on as at the nearest point inside.
    ///
    /// # Errors
    /// Fewer than four values in a direction, another number of values than the grid has, values that are not finite,
    /// a spacing that is not positive.
    pub fn new(origin: Vector<N>, spacing: [f64; N], count: [usize; N], values: Vec<f64>) -> Result<Self, ShapeError> {
        if let Some(x) = origin.iter().find(|x| !x.is_finite()) {
            return Err(ShapeError::new("origin", format!("{x} is not a finite number")));
        }
        if spacing.iter().any(|h| !(h.is_finite() && *h > 0.0)) {
            return Err(ShapeError::new("spacing", format!("{spacing:?} must be greater than zero")));
        }
        if count.iter().any(|&n| n < 4) {
            return Err(ShapeError::new("count", format!("{count:?}: a spline needs four values in each direction")));
        }
        let expected = count.iter().try_fold(1usize, |p, n| p.checked_mul(*n));
        if expected != Some(values.len()) {
            return Err(ShapeError::new("values", format!("{} numbers for a grid of {count:?}", values.len())));
        }
        if let Some(value) = values.iter().find(|v| !v.is_finite()) {
            return Err(ShapeError::new("values", format!("{value} is not a finite number")));
        }
        let mut coefficients = values;
        for axis in 0..N {
            let n = count[axis];
            let stride: usize = count[axis + 1..].iter().product();
            let mut line = vec![0.0; n];
            for start in (0..coefficients.len()).filter(|k| (k / stride).is_multiple_of(n)) {
                for (m, value) in line.iter_mut().enumerate() {
                    *value = coefficients[start + m * stride];
                }
                prefilter(&mut line);
                for (m, value) in line.iter().enumerate() {
                    coefficients[start + m * stride] = *value;
                }
            }
        }
        Ok(GridSpline { origin, spacing, count, coefficients })
    }

    /// Value, gradient and Hessian.
    pub fn jet(&self, x: &Vector<N>) -> Jet<N> {
        self.summed::<2>(x)
    }

    /// Value and gradient, without the second derivatives.
    pub fn value_and_gradient(&self, x: &Vector<N>) -> (f64, Vector<N>) {
        let jet = self.summed::<1>(x);
        (jet.value, jet.gradient)
    }

    pub fn value(&self, x: &Vector<N>) -> f64 {
        self.summed::<0>(x).value
    }

    /// Value and derivatives up to an order, one direction summed after the other.
    fn summed<const ORDER: usize>(&self, x: &Vector<N>) -> Jet<N> {
        let axes: [Weights; N] =
            std::array::from_fn(|a| weights((x[a] - self.origin[a]) / self.spacing[a], self.count[a], self.spacing[a]));
        self.summed_from::<ORDER>(0, 0, &axes)
    }

    /// The sum over the directions from `axis` on, of the coefficients that begin at `place`.
    fn summed_from<const ORDER: usize>(&self, axis: usize, place: usize, axes: &[Weights; N]) -> Jet<N> {
        let mut sum = Jet { value: 0.0, gradient: Vector::<N>::zeros(), hessian: Matrix::<N>::zeros() };
        let ([w, d, dd], index) = &axes[axis];
        for m in 0..4 {
            let place = place * self.count[axis] + index[m];
            if axis + 1 == N {
                let c = self.coefficients[place];
                sum.value += w[m] * c;
                if ORDER > 0 {
                    sum.gradient[axis] += d[m] * c;
                }
                if ORDER > 1 {
                    sum.hessian[(axis, axis)] += dd[m] * c;
                }
                continue;
            }
            let rest = self.summed_from::<ORDER>(axis + 1, place, axes);
            sum.value += w[m] * rest.value;
            if ORDER > 0 {
                sum.gradient[axis] += d[m] * rest.value;
                (axis + 1..N).for_each(|p| sum.gradient[p] += w[m] * rest.gradient[p]);
            }
            if ORDER > 1 {
                sum.hessian[(axis, axis)] += dd[m] * rest.value;
                for p in axis + 1..N {
                    sum.hessian[(axis, p)] += d[m] * rest.gradient[p];
                    (p..N).for_each(|q| sum.hessian[(p, q)] += w[m] * rest.hessian[(p, q)]);
                }
            }
        }
        if ORDER > 1 && axis == 0 {
            for p in 0..N {
                (0..p).for_each(|q| sum.hessian[(p, q)] = sum.hessian[(q, p)]);
            }
        }
        sum
    }

    /// Bounds of the values in a box: those of the coefficients of the splines that do not vanish there.
    pub fn range(&self, low: &Vector<N>, high: &Vector<N>) -> [f64; 2] {
        let window: [(usize, usize); N] = std::array::from_fn(|a| {
            let cell = |x: f64| {
                let t = ((x - self.origin[a]) / self.spacing[a]).clamp(0.0, (self.count[a] - 1) as f64);
                (t.floor() as usize).min(self.count[a] - 2)
            };
            // The coefficient beyond an end is no further away than the two that it is made of make it.
            (cell(low[a]).saturating_sub(1), (cell(high[a]) + 2).min(self.count[a] - 1))
        });
        let sizes: [usize; N] = std::array::from_fn(|a| window[a].1 - window[a].0 + 1);
        let mut bounds = [f64::INFINITY, f64::NEG_INFINITY];
        for number in 0..sizes.iter().product() {
            let (mut rest, mut place, mut index) = (number, 0, [0; N]);
            for a in (0..N).rev() {
                index[a] = window[a].0 + rest % sizes[a];
                rest /= sizes[a];
            }
            for a in 0..N {
                place = place * self.count[a] + index[a];
            }
            let c = self.coefficients[place];
            bounds = [bounds[0].min(c), bounds[1].max(c)];
        }
        let at_an_end = (0..N).any(|a| window[a].0 == 0 || window[a].1 == self.count[a] - 1);
        if at_an_end {
            // Extrapolated coefficients `2 c_0 - c_1` reach at most once as far again in each direction.
            let reach = f64::from((1u32 << N) - 1) * (bounds[1] - bounds[0]);
            bounds = [bounds[0] - reach, bounds[1] + reach];
        }
        bounds
    }

    /// The smallest and the largest corner of the grid.
    pub fn bounds(&self) -> [Vector<N>; 2] {
        let far = Vector::<N>::from_fn(|a, _| self.origin[a] + self.spacing[a] * (self.count[a] - 1) as f64);
        [self.origin, far]
    }
}

/// The splines that do not vanish at `t` cells from the start of `n` values `h` apart.
fn weights(t: f64, n: usize, h: f64) -> Weights {
    let t = t.clamp(0.0, (n - 1) as f64);
    let cell = (t.floor() as usize).min(n - 2);
    let s = t - cell as f64;
    let mut weights = [
        [
            (1.0 - s).powi(3) / 6.0,
            (4.0 - 6.0 * s * s + 3.0 * s.powi(3)) / 6.0,
            (1.0 + 3.0 * s + 3.0 * s * s - 3.0 * s.powi(3)) / 6.0,
            s.powi(3) / 6.0,
        ],
        [-0.5 * (1.0 - s).powi(2) / h, (-2.0 * s + 1.5 * s * s) / h, (0.5 + s - 1.5 * s * s) / h, 0.5 * s * s / h],
        [(1.0 - s) / (h * h), (3.0 * s - 2.0) / (h * h), (1.0 - 3.0 * s) / (h * h), s / (h * h)],
    ];
    let mut index = [0; 4];
    for (m, index) in index.iter_mut().enumerate() {
        *index = (cell + m).saturating_sub(1).min(n - 1);
    }
    // Beyond the ends the coefficients go on in a straight line, `2 c_0 - c_1`: what lies there is folded into the two
    // outermost ones.
    for order in &mut weights {
        if cell == 0 {
            let beyond = std::mem::take(&mut order[0]);
            order[1] += 2.0 * beyond;
            order[2] -= beyond;
        }
        if cell == n - 2 {
            let beyond = std::mem::take(&mut order[3]);
            order[2] += 2.0 * beyond;
            order[1] -= beyond;
        }
    }
    (weights, index)
}

/// Coefficients of the cubic spline with natural ends through values: `(c_{i-1} + 4 c_i + c_{i+1}) / 6 = f_i`, with
/// `c_{-1} = 2 c_0 - c_1` at both ends, so that the end coefficients are the end values.
fn prefilter(f: &mut [f64]) {
    let n = f.len();
    let inner = n - 2;
    // Thomas on the inner unknowns, the ends being known.
    let mut diagonal = vec![4.0; inner];
    let mut rhs: Vec<f64> = (1..=inner).map(|i| 6.0 * f[i]).collect();
    rhs[0] -= f[0];
    rhs[inner - 1] -= f[n - 1];
    for i in 1..inner {
        let factor = 1.0 / diagonal[i - 1];
        diagonal[i] -= factor;
        rhs[i] -= factor * rhs[i - 1];
    }
    for i in (0..inner).rev() {
        let above = if i + 1 < inner { f[i + 2] } else { 0.0 };
        f[i + 1] = (rhs[i] - above) / diagonal[i];
    }
}

/// What lies where the function is negative.
impl<const N: usize> ImplicitShape<N> for GridSpline<N> {
    fn value(&self, x: &Vector<N>) -> f64 {
        GridSpline::value(self, x)
    }
    fn gradient(&self, x: &Vector<N>) -> Vector<N> {
        GridSpline::value_and_gradient(self, x).1
    }
    fn value_and_gradient(&self, x: &Vector<N>) -> (f64, Vector<N>) {
        GridSpline::value_and_gradient(self, x)
    }
    fn hessian(&self, x: &Vector<N>) -> Matrix<N> {
        GridSpline::jet(self, x).hessian
    }
    fn jet(&self, x: &Vector<N>) -> Jet<N> {
        GridSpline::jet(self, x)
    }
    fn range(&self, b: &Aabb<N>) -> Option<[f64; 2]> {
        Some(GridSpline::range(self, &b.min, &b.max))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubic_splines_meet_their_values_and_are_smooth() {
        let f = |x: f64, y: f64| (1.3 * x).sin() * (0.7 * y).cos() + 0.2 * x * y;
        let (n, m) = (41, 31);
        let h = [0.05, 0.07];
        let values =
            (0..n).flat_map(|i| (0..m).map(move |j| f(0.3 + h[0] * i as f64, h[1] * j as f64 - 1.0))).collect();
        let spline = GridSpline::<2>::new(Vector::<2>::new(0.3, -1.0), h, [n, m], values).unwrap();
        for (i, j) in [(0, 0), (7, 30), (40, 3), (20, 15)] {
            let (x, y) = (0.3 + h[0] * i as f64, h[1] * j as f64 - 1.0);
            assert!((spline.jet(&Vector::<2>::new(x, y)).value - f(x, y)).abs() < 1e-13);
        }
        for x in [Vector::<2>::new(1.234, 0.1), Vector::<2>::new(0.31, -0.98)] {
            let (value, gradient) = spline.value_and_gradient(&x);
            let jet = spline.jet(&x);
            assert!((value - jet.value).abs() < 1e-14 && (gradient - jet.gradient).norm() < 1e-13);
            let [low, high] = spline.range(&x, &(x + Vector::<2>::repeat(0.2)));
            for t in [0.0, 0.05, 0.1, 0.2] {
                let value = spline.jet(&(x + Vector::<2>::new(t, 0.2 - t))).value;
                assert!(low <= value && value <= high);
            }
        }
        let x = Vector::<2>::new(1.234, 0.1);
        assert!((spline.jet(&x).value - f(x[0], x[1])).abs() < 1e-6);
        for a in 0..2 {
            let mut step = Vector::<2>::zeros();
            step[a] = 1e-6;
            let [up, down] = [spline.jet(&(x + step)), spline.jet(&(x - step))];
            assert!(((up.value - down.value) / 2e-6 - spline.jet(&x).gradient[a]).abs() < 1e-8);
            assert!(((up.gradient - down.gradient) / 2e-6 - spline.jet(&x).hessian.column(a)).norm() < 1e-7);
        }
    }
}
