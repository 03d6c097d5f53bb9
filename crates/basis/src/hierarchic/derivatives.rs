//! Derivatives of hierarchic functions up to third order along two directions, such as the coordinates of a side.
//!
//! Functions are products of polynomials of one linear function each; `(f g)^(i,j) = Σ C(i,p) C(j,q) f^(p,q) g^(i-p,j-q)`.

use super::{Factors, HierarchicBasis, MAX_DEGREE, ROOT_6, barycentric};
use crate::reference::Local;

/// Value and derivatives along two directions `a`, `b`: `1, a, b, aa, ab, bb, aaa, aab, abb, bbb`.
pub type Derivatives = [f64; 10];

/// How often each of [`Derivatives`] is taken along `a` and `b`.
pub(crate) const TIMES: [[usize; 2]; 10] =
    [[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2], [3, 0], [2, 1], [1, 2], [0, 3]];
const BINOMIAL: [[f64; 4]; 4] =
    [[1.0, 0.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0], [1.0, 2.0, 1.0, 0.0], [1.0, 3.0, 3.0, 1.0]];

/// Place in [`Derivatives`] of those taken `i` and `j` times.
pub(crate) fn place(i: usize, j: usize) -> usize {
    (i + j) * (i + j + 1) / 2 + j
}

/// The product of two functions, with derivatives up to an order.
pub(crate) fn product(f: &Derivatives, g: &Derivatives, order: usize) -> Derivatives {
    let mut out = [0.0; 10];
    for (sum, [i, j]) in out.iter_mut().zip(TIMES).take(place(0, order) + 1) {
        for p in 0..=i {
            for q in 0..=j {
                *sum += BINOMIAL[i][p] * BINOMIAL[j][q] * f[place(p, q)] * g[place(i - p, j - q)];
            }
        }
    }
    out
}

/// A function with given derivatives of a linear function with these slopes, up to an order.
pub(crate) fn along(f: &[f64; 4], slopes: [f64; 2], order: usize) -> Derivatives {
    let powers = slopes.map(|s| [1.0, s, s * s, s * s * s]);
    let mut out = [0.0; 10];
    for (d, [i, j]) in out.iter_mut().zip(TIMES).take(place(0, order) + 1) {
        *d = f[i + j] * powers[0][i] * powers[1][j];
    }
    out
}

/// The functions of one direction with three derivatives.
fn line(degree: usize, x: f64) -> [[f64; 4]; MAX_DEGREE + 1] {
    let mut out = [[0.0; 4]; MAX_DEGREE + 1];
    out[0] = [0.5 * (1.0 - x), -0.5, 0.0, 0.0];
    out[1] = [0.5 * (1.0 + x), 0.5, 0.0, 0.0];
    // Legendre polynomials with two derivatives.
    let (mut before, mut last) = ([1.0, 0.0, 0.0], [x, 1.0, 0.0]);
    for (k, out) in out.iter_mut().enumerate().take(degree + 1).skip(2) {
        let n = k as f64;
        let odd = 2.0 * n - 1.0;
        let next =
            [(odd * x * last[0] - (n - 1.0) * before[0]) / n, before[1] + odd * last[0], before[2] + odd * last[1]];
        let root = (n - 0.5).sqrt();
        *out = [(next[0] - before[0]) / (4.0 * n - 2.0).sqrt(), root * last[0], root * last[1], root * last[2]];
        (before, last) = (last, next);
    }
    out
}

impl HierarchicBasis {
    /// Values and derivatives of the functions at these places at a point of the reference cell, along two directions and up
    /// to an order of three at most; zeros stand for those beyond it.
    pub fn derivatives(
        &self,
        functions: &[usize],
        x: &Local,
        directions: &[Local; 2],
        order: usize,
    ) -> Vec<Derivatives> {
        let slopes = |g: &Local| [0, 1].map(|a| (0..3).map(|k| g[k] * directions[a][k]).sum::<f64>());
        let lines: [_; 3] = std::array::from_fn(|k| line(self.degree.max(2), x[k]));
        let axis = |k: usize, f: u8| along(&lines[k][f as usize], [directions[0][k], directions[1][k]], order);
        let (lambda, gradients) = barycentric(self.shape, x);
        let corner = |a: u8| along(&[lambda[a as usize], 1.0, 0.0, 0.0], slopes(&gradients[a as usize]), order);
        (functions.iter())
            .map(|k| match self.factors[*k] {
                Factors::Tensor(index) => {
                    (1..self.shape.dimension()).fold(axis(0, index[0]), |f, k| product(&f, &axis(k, index[k]), order))
                }
                Factors::Simplex { first, second, along } => {
                    let mut f = corner(first);
                    if let Some(b) = second {
                        f = product(&f, &corner(b), order).map(|v| -ROOT_6 * v);
                    }
                    along.map_or(f, |k| product(&f, &axis(2, k), order))
                }
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hierarchic::Values;
    use crate::reference::CellShape::*;

    #[test]
    fn each_derivative_is_the_difference_of_the_one_before() {
        let directions = [[0.7, -0.3, 0.2], [-0.2, 0.5, 0.9]];
        let x = [0.21, 0.33, 0.14];
        for (shape, degree) in [(Quadrilateral, 5), (Hexahedron, 4), (Triangle, 2), (Tetrahedron, 2), (Wedge, 2)] {
            let basis = HierarchicBasis::new(shape, degree);
            let directions = directions.map(|mut d| {
                (shape.dimension()..3).for_each(|k| d[k] = 0.0);
                d
            });
            let all: Vec<usize> = (0..basis.len()).collect();
            let at = basis.derivatives(&all, &x, &directions, 3);
            let mut values = Values::default();
            basis.tabulate(&x, &mut values);
            let h = 1e-5;
            let moved = |a: usize, h: f64| {
                basis.derivatives(&all, &std::array::from_fn(|k| x[k] + h * directions[a][k]), &directions, 3)
            };
            for a in 0..2 {
                let (plus, minus) = (moved(a, h), moved(a, -h));
                for (n, f) in at.iter().enumerate() {
                    assert!((f[0] - values.value[n]).abs() < 1e-14);
                    for [i, j] in TIMES.into_iter().filter(|t| t[0] + t[1] < 3) {
                        let difference = (plus[n][place(i, j)] - minus[n][place(i, j)]) / (2.0 * h);
                        let next = f[if a == 0 { place(i + 1, j) } else { place(i, j + 1) }];
                        assert!((difference - next).abs() < 1e-7, "{shape:?} {n} {i} {j}: {difference} {next}");
                    }
                }
            }
        }
    }
}
