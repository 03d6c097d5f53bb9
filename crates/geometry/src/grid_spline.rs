//! Functions given by their values on a regular grid: images, height maps, sampled level sets.

use crate::implicit::{ImplicitShape, OnLine};
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
    /// Of the splines on the grid and one beyond each of its ends, where they go on in a straight line, `2 c_0 - c_1`: every
    /// point sees four in each direction.
    coefficients: Vec<f64>,
    /// Steps in `coefficients` from one to the next in each direction.
    stride: [usize; N],
}

/// Values, first and second derivatives of the four splines on an interval.
type Weights = [[f64; 4]; 3];

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
        // One axis after the other gets its coefficients, and two more of them than values; the last one runs fastest still.
        let mut sizes = count;
        for axis in 0..N {
            let n = count[axis];
            let inner: usize = sizes[axis + 1..].iter().product();
            let outer: usize = sizes[..axis].iter().product();
            let mut wider = vec![0.0; outer * (n + 2) * inner];
            let mut line = vec![0.0; n];
            for (from, to) in coefficients.chunks_exact(n * inner).zip(wider.chunks_exact_mut((n + 2) * inner)) {
                for k in 0..inner {
                    line.iter_mut().enumerate().for_each(|(m, value)| *value = from[m * inner + k]);
                    prefilter(&mut line);
                    to[k] = 2.0 * line[0] - line[1];
                    line.iter().enumerate().for_each(|(m, value)| to[(m + 1) * inner + k] = *value);
                    to[(n + 1) * inner + k] = 2.0 * line[n - 1] - line[n - 2];
                }
            }
            coefficients = wider;
            sizes[axis] = n + 2;
        }
        let stride = std::array::from_fn(|a| sizes[a + 1..].iter().product());
        Ok(GridSpline { origin, spacing, count, coefficients, stride })
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

    /// The interval of an axis in which a coordinate lies, and where in it, from 0 to 1.
    #[inline]
    fn interval(&self, a: usize, x: f64) -> (usize, f64) {
        let t = ((x - self.origin[a]) / self.spacing[a]).clamp(0.0, (self.count[a] - 1) as f64);
        let cell = (t as usize).min(self.count[a] - 2);
        (cell, t - cell as f64)
    }

    /// Value and derivatives up to an order: sums of rows of four coefficients along the last axis, then along it.
    fn summed<const ORDER: usize>(&self, x: &Vector<N>) -> Jet<N> {
        let mut first = 0;
        let axes: [Weights; N] = std::array::from_fn(|a| {
            let (cell, s) = self.interval(a, x[a]);
            first += cell * self.stride[a];
            weights::<ORDER>(s, 1.0 / self.spacing[a])
        });
        let last = N - 1;
        let (mut value, mut slope, mut curvature) = ([0.0; 4], [[0.0; 4]; N], [[[0.0; 4]; N]; N]);
        for row in 0..1usize << (2 * last) {
            let m: [usize; N] = std::array::from_fn(|a| if a < last { (row >> (2 * (last - 1 - a))) & 3 } else { 0 });
            let start = first + (0..last).map(|a| m[a] * self.stride[a]).sum::<usize>();
            let c = &self.coefficients[start..start + 4];
            // The product over the axes before the last, of derivatives along two of them or none.
            let product = |order: [usize; N]| (0..last).map(|a| axes[a][order[a]][m[a]]).product::<f64>();
            add(&mut value, product([0; N]), c);
            for p in 0..if ORDER > 0 { last } else { 0 } {
                let along = |p: usize| std::array::from_fn::<usize, N, _>(|a| usize::from(a == p));
                add(&mut slope[p], product(along(p)), c);
                for q in p..if ORDER > 1 { last } else { 0 } {
                    let (p_order, q_order) = (along(p), along(q));
                    add(&mut curvature[p][q], product(std::array::from_fn(|a| p_order[a] + q_order[a])), c);
                }
            }
        }
        let [w, d, dd] = &axes[last];
        let mut jet = Jet { value: dot(w, &value), gradient: Vector::<N>::zeros(), hessian: Matrix::<N>::zeros() };
        if ORDER > 0 {
            (0..last).for_each(|p| jet.gradient[p] = dot(w, &slope[p]));
            jet.gradient[last] = dot(d, &value);
        }
        if ORDER > 1 {
            for p in 0..last {
                for q in p..last {
                    jet.hessian[(p, q)] = dot(w, &curvature[p][q]);
                    jet.hessian[(q, p)] = jet.hessian[(p, q)];
                }
                jet.hessian[(p, last)] = dot(d, &slope[p]);
                jet.hessian[(last, p)] = jet.hessian[(p, last)];
            }
            jet.hessian[(last, last)] = dot(dd, &value);
        }
        jet
    }

    /// Bounds of the values in a box: those of the coefficients of the splines that do not vanish there and, where these
    /// leave a zero possible, of the Bézier points of the polynomials.
    pub fn range(&self, low: &Vector<N>, high: &Vector<N>) -> [f64; 2] {
        let ends: [[(usize, f64); 2]; N] =
            std::array::from_fn(|a| [self.interval(a, low[a]), self.interval(a, high[a])]);
        let sizes: [usize; N] = std::array::from_fn(|a| ends[a][1].0 - ends[a][0].0 + 4);
        let first: usize = (0..N).map(|a| ends[a][0].0 * self.stride[a]).sum();
        let mut window = Vec::with_capacity(sizes.iter().product());
        for mut row in 0..sizes[..N - 1].iter().product() {
            let mut start = first;
            for a in (0..N - 1).rev() {
                start += row % sizes[a] * self.stride[a];
                row /= sizes[a];
            }
            window.extend_from_slice(&self.coefficients[start..start + sizes[N - 1]]);
        }
        let bounds = bounds_of(&window);
        if bounds[0] > 0.0 || bounds[1] < 0.0 {
            return bounds;
        }
        // The axis that runs slowest is replaced and runs fastest then, N times.
        for [(from, s), (to, e)] in ends {
            window = if from == to && s == e {
                contracted(&window, to - from + 4, &[(0, weights::<0>(s, 1.0)[0])])
            } else {
                let mut points = Vec::with_capacity(3 * (to - from) + 4);
                for cell in from..=to {
                    let low = if cell == from { s } else { 0.0 };
                    let high = if cell == to { e } else { 1.0 };
                    // The first point of an interval is the last one of that before.
                    for j in usize::from(cell > from)..4 {
                        let at = |i: usize| if i < j { high } else { low };
                        points.push((cell - from, polar([at(0), at(1), at(2)])));
                    }
                }
                contracted(&window, to - from + 4, &points)
            };
        }
        bounds_of(&window)
    }

    /// Coefficients of the cubic spline along a line in direction `axis` through `x`, of the intervals between two
    /// coordinates.
    fn line(&self, x: &Vector<N>, axis: usize, ends: [f64; 2]) -> GridLine {
        let [from, to] = ends.map(|t| self.interval(axis, t).0);
        let mut first = from * self.stride[axis];
        let across: [[f64; 4]; N] = std::array::from_fn(|a| {
            if a == axis {
                return [1.0, 0.0, 0.0, 0.0];
            }
            let (cell, s) = self.interval(a, x[a]);
            first += cell * self.stride[a];
            weights::<0>(s, 1.0)[0]
        });
        let mut coefficients = vec![0.0; to - from + 4];
        for row in 0..1usize << (2 * (N - 1)) {
            let (mut start, mut weight, mut rest) = (first, 1.0, row);
            for a in (0..N).filter(|a| *a != axis) {
                start += (rest & 3) * self.stride[a];
                weight *= across[a][rest & 3];
                rest >>= 2;
            }
            let along = self.coefficients[start..].iter().step_by(self.stride[axis]);
            coefficients.iter_mut().zip(along).for_each(|(sum, c)| *sum += weight * c);
        }
        GridLine { origin: self.origin[axis], spacing: self.spacing[axis], first: from, coefficients }
    }

    /// The smallest and the largest corner of the grid.
    pub fn bounds(&self) -> [Vector<N>; 2] {
        let far = Vector::<N>::from_fn(|a, _| self.origin[a] + self.spacing[a] * (self.count[a] - 1) as f64);
        [self.origin, far]
    }
}

/// A spline along a line.
struct GridLine {
    origin: f64,
    spacing: f64,
    /// The interval that the first four coefficients belong to.
    first: usize,
    coefficients: Vec<f64>,
}

impl GridLine {
    /// Value and slope at a coordinate; beyond the ends of the grid the spline goes on as at them, with the slope there.
    #[inline]
    fn value_and_slope(&self, x: f64) -> (f64, f64) {
        let intervals = self.coefficients.len() - 3;
        let t = ((x - self.origin) / self.spacing - self.first as f64).clamp(0.0, intervals as f64);
        let cell = (t as usize).min(intervals - 1);
        let [w, d, _] = weights::<1>(t - cell as f64, 1.0 / self.spacing);
        let c = &self.coefficients[cell..cell + 4];
        (dot(&w, c), dot(&d, c))
    }
}

#[inline]
fn add(sum: &mut [f64; 4], factor: f64, c: &[f64]) {
    sum.iter_mut().zip(c).for_each(|(sum, c)| *sum += factor * c);
}

#[inline]
fn dot(w: &[f64; 4], c: &[f64]) -> f64 {
    w.iter().zip(c).map(|(w, c)| w * c).sum()
}

fn bounds_of(values: &[f64]) -> [f64; 2] {
    values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(*v), high.max(*v)])
}

/// A tensor whose slowest index, of `size` values, is replaced by one over sums of four, each from a place on; that index
/// runs fastest then.
fn contracted(tensor: &[f64], size: usize, sums: &[(usize, [f64; 4])]) -> Vec<f64> {
    let inner = tensor.len() / size;
    let mut out = Vec::with_capacity(inner * sums.len());
    for k in 0..inner {
        for (place, w) in sums {
            let at = place * inner + k;
            out.push((0..4).map(|m| w[m] * tensor[at + m * inner]).sum());
        }
    }
    out
}

/// The splines that do not vanish on an interval, at `s` from 0 to 1, and their derivatives up to an order by a variable
/// that grows by `1 / rate` along the interval.
#[inline]
fn weights<const ORDER: usize>(s: f64, rate: f64) -> Weights {
    let r = 1.0 - s;
    let mut out = [[0.0; 4]; 3];
    out[0] = [
        r * r * r / 6.0,
        (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0,
        (4.0 - 6.0 * r * r + 3.0 * r * r * r) / 6.0,
        s * s * s / 6.0,
    ];
    if ORDER > 0 {
        let half = 0.5 * rate;
        out[1] = [-half * r * r, half * s * (3.0 * s - 4.0), half * r * (4.0 - 3.0 * r), half * s * s];
    }
    if ORDER > 1 {
        let square = rate * rate;
        out[2] = [square * r, square * (3.0 * s - 2.0), square * (3.0 * r - 2.0), square * s];
    }
    out
}

/// The polar form of the cubic on an interval as a sum of the four coefficients: its values at `[s, s, s]` are those of the
/// cubic, and those at `low` and `high` alone the Bézier points of the part between them.
fn polar([u, v, w]: [f64; 3]) -> [f64; 4] {
    // De Boor's algorithm with another argument in each stage.
    let d = [[1.0 - u, 2.0 + u], [2.0 - u, 1.0 + u], [3.0 - u, u]].map(|d| d.map(|x| x / 3.0));
    let e = [[1.0 - v, 1.0 + v], [2.0 - v, v]].map(|e| e.map(|x| x / 2.0));
    let f = [(1.0 - w) * e[0][0], (1.0 - w) * e[0][1] + w * e[1][0], w * e[1][1]];
    [f[0] * d[0][0], f[0] * d[0][1] + f[1] * d[1][0], f[1] * d[1][1] + f[2] * d[2][0], f[2] * d[2][1]]
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
    fn on_line(&self, x: &Vector<N>, axis: usize, ends: [f64; 2], find: &mut OnLine<'_>) {
        let line = self.line(x, axis, ends);
        find(&|t| line.value_and_slope(t));
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
