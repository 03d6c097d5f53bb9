//! Uniform periodic B-splines: the space in which contact fronts and their modes live.

/// The periodic B-splines of one degree on a uniform division of `[0, 1)`.
///
/// Basis function `k` is a bump centred at `k / count` for odd degrees, so a curve interpolates at the knots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PeriodicBasis {
    pub degree: usize,
    pub count: usize,
}

/// Highest degree supported: a membrane of degree 6 has a front of degree 13.
pub const MAX_DEGREE: usize = 15;

/// Knots, for each degree, beyond half of which interpolation does not feel a value: its weight there is below 1e-17.
const FELT: usize = 20;

/// Values and first two derivatives, with respect to the parameter, of the `degree + 1` functions that live at a point.
#[derive(Clone, Copy, Debug)]
pub struct Bumps {
    /// Index of the first function, to be taken modulo the count.
    pub first: isize,
    pub len: usize,
    pub value: [f64; MAX_DEGREE + 1],
    pub d1: [f64; MAX_DEGREE + 1],
    pub d2: [f64; MAX_DEGREE + 1],
}

impl PeriodicBasis {
    /// Evaluates the functions that do not vanish at `s` (any real number; the period is one).
    pub fn bumps(&self, s: f64) -> Bumps {
        let (p, n) = (self.degree, self.count as f64);
        debug_assert!(p <= MAX_DEGREE);
        let (cell, x) = self.cell(s);
        let (mut d1, mut d2) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
        let mut value = [0.0; MAX_DEGREE + 1];
        value[0] = 1.0;
        for q in 1..=p {
            // On the way up, the derivatives from the lower degrees.
            if q + 1 == p {
                let mut lower = [0.0; MAX_DEGREE + 1];
                difference(&value, q, n, &mut lower);
                difference(&lower, p, n, &mut d2);
            }
            if q == p {
                difference(&value, p, n, &mut d1);
            }
            raise(&mut value, q, x);
        }
        Bumps { first: cell as isize - (p as isize) / 2, len: p + 1, value, d1, d2 }
    }

    /// The knot interval that a parameter lies in, up to the count where it is the first again, and where within it.
    fn cell(&self, s: f64) -> (f64, f64) {
        // For even degrees the bumps are centred between the knots; a shift of half a cell keeps them at k / count.
        let shift = if self.degree.is_multiple_of(2) { 0.5 } else { 0.0 };
        let u = (s - s.floor()) * self.count as f64 + shift;
        (u.floor(), u - u.floor())
    }

    /// The knot interval that a parameter lies in, and the distance from its middle as a part of it.
    pub fn interval(&self, s: f64) -> (usize, f64) {
        let (cell, x) = self.cell(s);
        (cell as usize % self.count, x - 0.5)
    }

    /// Index of the `i`-th function that does not vanish in a knot interval.
    pub fn bump_at(&self, cell: usize, i: usize) -> usize {
        self.wrapped(cell as isize - (self.degree as isize) / 2 + i as isize)
    }

    /// The functions of a knot interval as polynomials in the distance from its middle: for each power, from the lowest,
    /// its coefficient in each function.
    pub fn powers(&self) -> Vec<Vec<f64>> {
        let p = self.degree;
        // Of every function its coefficients, raised from degree to degree as values are.
        let mut functions = vec![vec![1.0]];
        for q in 1..=p {
            let mut raised = vec![vec![0.0; q + 1]; q + 1];
            for (r, f) in functions.iter().enumerate() {
                // Right of its middle a function falls by what the next one rises.
                let (right, left) = (r as f64 + 0.5, (q - 1 - r) as f64 + 0.5);
                for (k, c) in f.iter().map(|c| c / q as f64).enumerate() {
                    raised[r][k] += right * c;
                    raised[r][k + 1] -= c;
                    raised[r + 1][k] += left * c;
                    raised[r + 1][k + 1] += c;
                }
            }
            functions = raised;
        }
        (0..=p).map(|k| functions.iter().map(|f| f[k]).collect()).collect()
    }

    /// Index of the `i`-th function of [`Bumps`], brought into `0..count`.
    pub fn index(&self, bumps: &Bumps, i: usize) -> usize {
        self.wrapped(bumps.first + i as isize)
    }

    fn wrapped(&self, index: isize) -> usize {
        index.rem_euclid(self.count as isize) as usize
    }

    /// Coefficients of the spline that takes `values[k]` at `k / count`.
    ///
    /// The interpolation matrix is circulant; it is solved by a real discrete Fourier sum, exact to round-off. Its
    /// symbol is positive for every degree (Schoenberg), so the problem always has one solution.
    pub fn interpolate<const M: usize>(&self, values: &[[f64; M]]) -> Vec<[f64; M]> {
        let n = self.count;
        debug_assert_eq!(values.len(), n);
        // Beyond some knots the entries of the inverse are round-off: with more knots than these they are the same.
        let few = n.min(FELT * self.degree);
        let felt = Self { degree: self.degree, count: few }.inverse();
        // The inverse is even; of an even number of knots the farthest one is met only once.
        let reach = (few - 1) / 2;
        let last = if few.is_multiple_of(2) && few == n { Some(few / 2) } else { None };
        (0..n)
            .map(|i| {
                let mut c = values[i].map(|v| felt[0] * v);
                let mut add = |a: f64, v: &[f64; M]| c.iter_mut().zip(v).for_each(|(c, v)| *c += a * v);
                for k in 1..=reach {
                    add(felt[k], &values[(i + k) % n]);
                    add(felt[k], &values[(i + n - k) % n]);
                }
                if let Some(k) = last {
                    add(felt[k], &values[(i + k) % n]);
                }
                c
            })
            .collect()
    }

    /// The first row of the inverse of the interpolation matrix, which is the circulant of the inverse symbol.
    fn inverse(&self) -> Vec<f64> {
        let n = self.count;
        let bumps = self.bumps(0.0);
        let mut row = vec![0.0; n];
        for i in 0..bumps.len {
            row[self.index(&bumps, i)] += bumps.value[i];
        }
        let cosines: Vec<f64> = (0..n).map(|k| (2.0 * std::f64::consts::PI * k as f64 / n as f64).cos()).collect();
        let transform = |v: &[f64]| -> Vec<f64> {
            (0..n).map(|k| v.iter().enumerate().map(|(j, v)| v * cosines[k * j % n]).sum()).collect()
        };
        let symbol: Vec<f64> = transform(&row).iter().map(|v| 1.0 / v).collect();
        transform(&symbol).iter().map(|v| v / n as f64).collect()
    }
}

/// From the values of the cardinal B-splines of degree `q - 1` at `x` in `[0, 1)` of one knot cell to those of degree `q`
/// (de Boor's recurrence).
fn raise(b: &mut [f64; MAX_DEGREE + 1], q: usize, x: f64) {
    let inv = 1.0 / q as f64;
    let mut carried = 0.0;
    for (r, b) in b.iter_mut().enumerate().take(q) {
        // Function r of the level below is split between functions r and r + 1 of this one.
        let right = (r + 1) as f64 - x;
        let left = x + (q - 1 - r) as f64;
        let value = *b * inv;
        *b = carried + right * value;
        carried = left * value;
    }
    b[q] = carried;
}

/// Derivatives of degree-`p` bumps from values of degree `p - 1`: `B_p' = n (B_{p-1}(· ) - B_{p-1}(· - 1))`.
fn difference(lower: &[f64; MAX_DEGREE + 1], p: usize, n: f64, out: &mut [f64; MAX_DEGREE + 1]) {
    for i in 0..=p {
        let from_left = if i > 0 { lower[i - 1] } else { 0.0 };
        let from_right = if i < p { lower[i] } else { 0.0 };
        out[i] = n * (from_left - from_right);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bumps_sum_to_one_and_their_derivatives_to_zero() {
        for degree in 1..=13 {
            let basis = PeriodicBasis { degree, count: 16 };
            for i in 0..40 {
                let b = basis.bumps(i as f64 * 0.0371 - 0.4);
                assert!((b.value[..b.len].iter().sum::<f64>() - 1.0).abs() < 1e-13);
                assert!(b.d1[..b.len].iter().sum::<f64>().abs() < 1e-11);
                assert!(b.d2[..b.len].iter().sum::<f64>().abs() < 1e-9);
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_the_values() {
        let eval = |basis: &PeriodicBasis, c: &[f64], s: f64| {
            let b = basis.bumps(s);
            let sum = |v: &[f64]| (0..b.len).map(|i| v[i] * c[basis.index(&b, i)]).sum::<f64>();
            (sum(&b.value), sum(&b.d1), sum(&b.d2))
        };
        for degree in [3, 4, 5, 9, 13] {
            let basis = PeriodicBasis { degree, count: 20 };
            let c: Vec<f64> = (0..20).map(|k| ((k * k) as f64 * 0.7).sin()).collect();
            let e = 1e-5;
            for i in 0..11 {
                let s = 0.0917 * i as f64 + 0.003;
                let (_, d1, d2) = eval(&basis, &c, s);
                let (plus, minus) = (eval(&basis, &c, s + e), eval(&basis, &c, s - e));
                assert!((d1 - (plus.0 - minus.0) / (2.0 * e)).abs() < 1e-5 * 20.0);
                let fd = (plus.1 - minus.1) / (2.0 * e);
                assert!((d2 - fd).abs() < 1e-4 * 400.0, "degree {degree}, s {s}: {d2} {fd}");
            }
        }
    }

    #[test]
    fn powers_are_the_functions() {
        for degree in 1..=MAX_DEGREE {
            let basis = PeriodicBasis { degree, count: 17 };
            let powers = basis.powers();
            for s in [0.0, 0.03, 0.3141, 0.5, 0.777, 0.999] {
                let b = basis.bumps(s);
                let (cell, t) = basis.interval(s);
                for i in 0..b.len {
                    assert_eq!(basis.index(&b, i), basis.bump_at(cell, i));
                    let value = powers.iter().rev().fold(0.0, |v, of_bumps| v * t + of_bumps[i]);
                    assert!((value - b.value[i]).abs() < 1e-14, "degree {degree}: {value} {}", b.value[i]);
                }
            }
        }
    }

    #[test]
    fn interpolation_meets_its_values_however_many() {
        for degree in 1..=MAX_DEGREE {
            for count in [3, 4, 19, 20 * degree, 20 * degree + 1, 700] {
                let basis = PeriodicBasis { degree, count };
                let values: Vec<[f64; 1]> = (0..count).map(|k| [((k * k) as f64 * 0.7).sin()]).collect();
                let c = basis.interpolate(&values);
                for (k, v) in values.iter().enumerate() {
                    let b = basis.bumps(k as f64 / count as f64);
                    let sum: f64 = (0..b.len).map(|i| b.value[i] * c[basis.index(&b, i)][0]).sum();
                    assert!((sum - v[0]).abs() < 1e-11, "degree {degree}, {count} knots: {sum} {}", v[0]);
                }
            }
        }
    }

    #[test]
    fn interpolation_has_the_order_degree_plus_one() {
        let f = |s: f64| (2.0 * std::f64::consts::PI * s).sin().exp();
        let error = |degree: usize, count: usize| {
            let basis = PeriodicBasis { degree, count };
            let values: Vec<[f64; 1]> = (0..count).map(|k| [f(k as f64 / count as f64)]).collect();
            let c = basis.interpolate(&values);
            (0..200)
                .map(|i| {
                    let s = i as f64 / 200.0 + 0.001;
                    let b = basis.bumps(s);
                    ((0..b.len).map(|j| b.value[j] * c[basis.index(&b, j)][0]).sum::<f64>() - f(s)).abs()
                })
                .fold(0.0, f64::max)
        };
        for degree in [3, 5, 7] {
            let order = (error(degree, 32) / error(degree, 64)).log2();
            assert!((order - (degree as f64 + 1.0)).abs() < 0.6, "degree {degree}: order {order}");
        }
    }
}
