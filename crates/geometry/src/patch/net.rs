//! Control nets of Bezier surfaces.

use super::bernstein::{Control, apply, binomials, combine, interpolation_matrix, powers};
use crate::Vector;

/// A tensor-product control net, `control[i * (q + 1) + j]` for degrees `(p, q)`.
#[derive(Clone, Debug)]
pub struct Net {
    pub degree: [usize; 2],
    pub control: Vec<Control>,
}

impl Net {
    pub fn row(&self, i: usize) -> &[Control] {
        let m = self.degree[1] + 1;
        &self.control[i * m..(i + 1) * m]
    }

    pub fn column(&self, j: usize) -> Vec<Control> {
        (0..=self.degree[0]).map(|i| self.control[i * (self.degree[1] + 1) + j]).collect()
    }

    /// The net of bidegree `degree` through the values of a function at equidistant points of the unit square.
    pub fn interpolating(degree: [usize; 2], f: impl Fn(f64, f64) -> Control) -> Net {
        let at = |i: usize, n: usize| if n == 0 { 0.5 } else { i as f64 / n as f64 };
        let values: Vec<Control> = (0..=degree[0])
            .flat_map(|i| (0..=degree[1]).map(move |j| (i, j)))
            .map(|(i, j)| f(at(i, degree[0]), at(j, degree[1])))
            .collect();
        let [along_u, along_v] = degree.map(interpolation_matrix);
        let net = Net { degree, control: values };
        net.map_columns(|c| apply(&along_u, c)).map_rows(|r| apply(&along_v, r))
    }

    /// Applies an operation on curves to every row (the second direction).
    pub fn map_rows(&self, f: impl Fn(&[Control]) -> Vec<Control>) -> Net {
        let rows: Vec<Vec<Control>> = (0..=self.degree[0]).map(|i| f(self.row(i))).collect();
        Net { degree: [self.degree[0], rows[0].len() - 1], control: rows.concat() }
    }

    /// Applies an operation on curves to every column (the first direction).
    pub fn map_columns(&self, f: impl Fn(&[Control]) -> Vec<Control>) -> Net {
        let columns: Vec<Vec<Control>> = (0..=self.degree[1]).map(|j| f(&self.column(j))).collect();
        let p = columns[0].len() - 1;
        let control = (0..=p).flat_map(|i| columns.iter().map(move |c| c[i])).collect();
        Net { degree: [p, self.degree[1]], control }
    }

    pub fn powers(&self) -> Net {
        self.map_columns(powers).map_rows(powers)
    }

    /// Distance of neighbours in one direction.
    fn step(&self, axis: usize) -> usize {
        if axis == 0 { self.degree[1] + 1 } else { 1 }
    }

    /// Where the lines in one direction begin.
    fn lines(&self, axis: usize) -> impl Iterator<Item = usize> + use<> {
        let step = self.step(1 - axis);
        (0..=self.degree[1 - axis]).map(move |k| k * step)
    }

    /// Both parts of the surface, cut at a parameter in `[0, 1]` (de Casteljau).
    pub fn cut(&self, axis: usize, t: f64) -> [Net; 2] {
        let (n, step) = (self.degree[axis], self.step(axis));
        let (mut left, mut right) = (self.clone(), self.clone());
        for start in self.lines(axis) {
            for r in 0..n {
                left.control[start + r * step] = right.control[start];
                for k in (start..).step_by(step).take(n - r) {
                    right.control[k] = combine(1.0 - t, &right.control[k], t, &right.control[k + step]);
                }
            }
            left.control[start + n * step] = right.control[start];
        }
        [left, right]
    }

    /// Takes the derivative with respect to one parameter in `[-1, 1]`; zero where the degree is.
    pub fn differentiate(&mut self, axis: usize) {
        let n = self.degree[axis];
        if n == 0 {
            self.control.fill([0.0; 4]);
            return;
        }
        let (factor, step) = (0.5 * n as f64, self.step(axis));
        // What is written lies before all that is still to be read.
        let mut next = 0;
        for k in 0..self.control.len() - step {
            if axis == 0 || k % (n + 1) < n {
                self.control[next] = combine(factor, &self.control[k + step], -factor, &self.control[k]);
                next += 1;
            }
        }
        self.control.truncate(next);
        self.degree[axis] -= 1;
    }

    /// The numerator, two degrees higher each way, of the function less the quadratic `Σ c[a][b] s^a t^b`, `a + b <= 2`:
    /// that of the function less the weight times the quadratic. The weight stays.
    pub fn less_quadratic(&self, c: &[[Vector<3>; 3]; 3]) -> Net {
        // Bernstein coefficients of 1, s and s² on [-1, 1].
        const POWERS: [[f64; 3]; 3] = [[1.0, 1.0, 1.0], [-1.0, 0.0, 1.0], [1.0, -1.0, 1.0]];
        let mut quadratic = [[Vector::<3>::zeros(); 3]; 3];
        for (k, l) in (0..9).map(|k| (k / 3, k % 3)) {
            for (a, b) in [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)] {
                quadratic[k][l] += c[a][b] * (POWERS[a][k] * POWERS[b][l]);
            }
        }
        let [along, across] = self.degree.map(quadratic_shares);
        let mut control = Vec::with_capacity(along.len() * across.len());
        for (i, p) in along.iter().enumerate() {
            for (j, q) in across.iter().enumerate() {
                let mut sum = [0.0; 4];
                for k in i.saturating_sub(self.degree[0])..=i.min(2) {
                    for l in j.saturating_sub(self.degree[1])..=j.min(2) {
                        let c = &self.control[(i - k) * (self.degree[1] + 1) + j - l];
                        let (share, less) = (p[k] * q[l], quadratic[k][l] * c[3]);
                        (0..3).for_each(|m| sum[m] += share * (c[m] - less[m]));
                        sum[3] += share * c[3];
                    }
                }
                control.push(sum);
            }
        }
        Net { degree: self.degree.map(|n| n + 2), control }
    }
}

/// `shares[i][k]` of the products of control value `i - k` of a polynomial of this degree and `k` of a quadratic in
/// control value `i` of their product.
fn quadratic_shares(degree: usize) -> Vec<[f64; 3]> {
    let (low, high) = (binomials(degree), binomials(degree + 2));
    let binomial = |i: usize, k: usize| i.checked_sub(k).and_then(|i| low.get(i)).copied().unwrap_or(0.0);
    (0..degree + 3).map(|i| [0, 1, 2].map(|k| binomial(i, k) * [1.0, 2.0, 1.0][k] / high[i])).collect()
}
