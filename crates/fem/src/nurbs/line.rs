//! Knots of one direction: spans, the functions on them, and the same splines on more knots or of a higher degree.

use nalgebra::DMatrix;
use signorini_basis::SpanFunctions;

/// The degree and the knots of one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct KnotLine {
    pub degree: usize,
    pub knots: Vec<f64>,
}

/// Knots closer than this part of the whole range are one.
const SAME: f64 = 1e-12;

impl KnotLine {
    /// Number of functions.
    pub fn len(&self) -> usize {
        self.knots.len() - self.degree - 1
    }

    pub fn is_empty(&self) -> bool {
        self.knots.len() <= self.degree + 1
    }

    /// Start and end of the spline.
    pub fn range(&self) -> [f64; 2] {
        [self.knots[self.degree], self.knots[self.len()]]
    }

    /// The ends of the spans, ascending.
    pub fn breaks(&self) -> Vec<f64> {
        let [from, to] = self.range();
        let mut out = self.knots[self.degree..=self.len()].to_vec();
        out.dedup_by(|b, a| (*b - *a).abs() <= SAME * (to - from));
        out
    }

    /// How often a value is a knot.
    pub(super) fn multiplicity(&self, t: f64) -> usize {
        let [from, to] = self.range();
        self.knots.iter().filter(|k| (*k - t).abs() <= SAME * (to - from)).count()
    }

    /// Place of the last knot that is not beyond a value, so that the interval after it is not empty.
    fn interval(&self, t: f64) -> usize {
        let below = self.knots[..=self.len()].partition_point(|k| *k <= t);
        let mut at = below.clamp(self.degree + 1, self.len()) - 1;
        while self.knots[at + 1] <= self.knots[at] {
            at -= 1;
        }
        at
    }

    /// The functions that do not vanish at a value: the number of the first, and their values (de Boor).
    pub fn values(&self, t: f64) -> (usize, Vec<f64>) {
        let at = self.interval(t);
        let mut basis = vec![1.0];
        for p in 1..=self.degree {
            let mut next = vec![0.0; p + 1];
            for (r, value) in basis.iter().enumerate() {
                let (low, high) = (self.knots[at + 1 + r - p], self.knots[at + 1 + r]);
                let share = (t - low) / (high - low);
                next[r] += (1.0 - share) * value;
                next[r + 1] += share * value;
            }
            basis = next;
        }
        (at - self.degree, basis)
    }

    /// The mean of the inner knots of a function.
    pub fn greville(&self, function: usize) -> f64 {
        self.knots[function + 1..=function + self.degree].iter().sum::<f64>() / self.degree as f64
    }

    /// Every span: the number of its first function, and the Bernstein coefficients of all that do not vanish there.
    pub fn spans(&self) -> Vec<(usize, SpanFunctions)> {
        let p = self.degree;
        (self.breaks().windows(2))
            .map(|ends| {
                let [from, to] = [ends[0], ends[1]];
                let at = self.interval(0.5 * (from + to));
                // The coefficient of each function in the i-th Bernstein polynomial is its polar form at `p - i` times the start
                // and `i` times the end.
                let mut coefficients = vec![vec![0.0; p + 1]; p + 1];
                for i in 0..=p {
                    for (a, row) in coefficients.iter_mut().enumerate() {
                        let mut d: Vec<f64> = (0..=p).map(|j| f64::from(u8::from(j == a))).collect();
                        for r in 1..=p {
                            let u = if r <= i { to } else { from };
                            for j in (r..=p).rev() {
                                let (low, high) = (self.knots[at - p + j], self.knots[at + 1 + j - r]);
                                let share = (u - low) / (high - low);
                                d[j] = (1.0 - share) * d[j - 1] + share * d[j];
                            }
                        }
                        row[i] = d[p];
                    }
                }
                let local = |g: f64| (2.0 * g - from - to) / (to - from);
                let greville = (0..=p).map(|a| local(self.greville(at - p + a))).collect();
                (at - p, SpanFunctions { coefficients, greville })
            })
            .collect()
    }

    /// The knots of a higher degree, each span divided evenly into so many, with which the same functions can be written: where
    /// the spline has as many derivatives as before, and at new knots all but the last.
    pub fn raised(&self, degree: usize, parts: usize) -> KnotLine {
        let breaks = self.breaks();
        let more = degree - self.degree;
        let mut knots = vec![breaks[0]; degree + 1];
        for (k, ends) in breaks.windows(2).enumerate() {
            for i in 1..parts {
                knots.push(ends[0] + (ends[1] - ends[0]) * i as f64 / parts as f64);
            }
            let last = k + 2 == breaks.len();
            let times = if last { degree + 1 } else { self.multiplicity(ends[1]) + more };
            knots.extend(std::iter::repeat_n(ends[1], times));
        }
        KnotLine { degree, knots }
    }

    /// The coefficients on other knots, whose splines contain those on these: a row for each new function.
    pub fn change(&self, to: &KnotLine) -> Option<DMatrix<f64>> {
        let table = |line: &KnotLine| {
            let mut out = DMatrix::<f64>::zeros(to.len(), line.len());
            for i in 0..to.len() {
                let (first, values) = line.values(to.greville(i));
                values.iter().enumerate().for_each(|(k, v)| out[(i, first + k)] = *v);
            }
            out
        };
        let own = table(to);
        let lu = own.clone().lu();
        let mut out = lu.solve(&table(self))?;
        // One step of refinement takes the rounding of the factors away.
        let left = table(self) - &own * &out;
        out += lu.solve(&left)?;
        Some(out)
    }
}
