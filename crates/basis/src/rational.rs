//! Rational spline functions on one cell, a span of knots, by their Bernstein coefficients.
//!
//! `R_a = w_a N_a / Σ w_b N_b` with `N_a` a product of B-splines, one for each direction, and of each of these the Bernstein
//! coefficients on the span: the Bézier extraction of Borden, Scott, Evans & Hughes (2011). The functions of the first
//! direction run fastest. All directions have the same degree.

use crate::hierarchic::{Derivatives, TIMES, Values, along, place, product};
use crate::reference::{CellShape, Local};
use std::sync::Arc;

/// B-splines of one direction on a span.
#[derive(Clone, Debug)]
pub struct SpanFunctions {
    /// Bernstein coefficients of each function.
    pub coefficients: Vec<Vec<f64>>,
    /// The mean of the inner knots of each function, its Greville abscissa, in the coordinate of the span.
    pub greville: Vec<f64>,
}

impl SpanFunctions {
    /// The same from the other end.
    fn reversed(&self) -> Self {
        let turned = |c: &Vec<f64>| c.iter().rev().copied().collect();
        SpanFunctions {
            coefficients: self.coefficients.iter().rev().map(turned).collect(),
            greville: self.greville.iter().rev().map(|g| -g).collect(),
        }
    }

    /// Value and the first three derivatives of each function in the coordinate from -1 to 1.
    fn values(&self, x: f64, order: usize) -> Vec<[f64; 4]> {
        let t = 0.5 * (1.0 + x);
        (self.coefficients.iter())
            .map(|c| {
                let mut out = [0.0; 4];
                let mut differences = c.clone();
                let mut factor = 1.0;
                for (k, value) in out.iter_mut().enumerate().take(order + 1) {
                    *value = factor * de_casteljau(&differences, t);
                    factor *= 0.5 * (c.len() - 1).saturating_sub(k) as f64;
                    differences = differences.windows(2).map(|d| d[1] - d[0]).collect();
                    if differences.is_empty() {
                        break;
                    }
                }
                out
            })
            .collect()
    }
}

/// The value of a polynomial with these Bernstein coefficients.
fn de_casteljau(coefficients: &[f64], t: f64) -> f64 {
    let mut b = [0.0; crate::hierarchic::MAX_DEGREE + 1];
    let n = coefficients.len();
    b[..n].copy_from_slice(coefficients);
    for r in 1..n {
        for i in 0..n - r {
            b[i] = (1.0 - t) * b[i] + t * b[i + 1];
        }
    }
    b[0]
}

/// Coefficients below this do not reach an end of the span.
const NOTHING: f64 = 1e-12;

/// The functions of a cell, or of a face of one.
#[derive(Clone, Debug)]
pub struct RationalBasis {
    shape: CellShape,
    degree: usize,
    lines: Vec<Arc<SpanFunctions>>,
    weights: Vec<f64>,
}

impl RationalBasis {
    /// One direction for each dimension, one weight for each function.
    pub fn new(lines: Vec<Arc<SpanFunctions>>, weights: Vec<f64>) -> Self {
        let shape = [CellShape::Line, CellShape::Quadrilateral, CellShape::Hexahedron][lines.len() - 1];
        let degree = lines[0].coefficients.len() - 1;
        debug_assert_eq!(weights.len(), (degree + 1).pow(lines.len() as u32));
        RationalBasis { shape, degree, lines, weights }
    }

    pub fn shape(&self) -> CellShape {
        self.shape
    }

    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Number of functions.
    pub fn len(&self) -> usize {
        self.weights.len()
    }

    pub fn is_empty(&self) -> bool {
        false
    }

    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Whether the functions are polynomials: all weights are the same.
    pub fn is_polynomial(&self) -> bool {
        self.weights.iter().all(|w| (w - self.weights[0]).abs() <= 1e-14 * self.weights[0])
    }

    /// The place of a function in each direction.
    fn index(&self, function: usize) -> [usize; 3] {
        let n = self.degree + 1;
        [function % n, function / n % n, function / n / n]
    }

    /// The Greville abscissae of a function, which may lie beyond the cell.
    pub fn greville(&self, function: usize) -> Local {
        let index = self.index(function);
        std::array::from_fn(|k| self.lines.get(k).map_or(0.0, |line| line.greville[index[k]]))
    }

    /// Values and gradients at a point of the cell, or near it.
    pub fn tabulate(&self, x: &Local, out: &mut Values) {
        out.value.clear();
        out.gradient.clear();
        let at: Vec<Vec<[f64; 4]>> = self.lines.iter().zip(x).map(|(line, x)| line.values(*x, 1)).collect();
        let mut sum = [0.0; 4];
        for (f, w) in self.weights.iter().enumerate() {
            let index = self.index(f);
            let v: [[f64; 4]; 3] = std::array::from_fn(|k| at.get(k).map_or([1.0, 0.0, 0.0, 0.0], |l| l[index[k]]));
            let n = w * v[0][0] * v[1][0] * v[2][0];
            let gradient =
                [w * v[0][1] * v[1][0] * v[2][0], w * v[0][0] * v[1][1] * v[2][0], w * v[0][0] * v[1][0] * v[2][1]];
            sum[0] += n;
            (0..3).for_each(|k| sum[1 + k] += gradient[k]);
            out.value.push(n);
            out.gradient.push(gradient);
        }
        for (value, gradient) in out.value.iter_mut().zip(&mut out.gradient) {
            *value /= sum[0];
            (0..3).for_each(|k| gradient[k] = (gradient[k] - *value * sum[1 + k]) / sum[0]);
        }
    }

    /// Values and derivatives of the functions at these places along two directions, up to an order of three at most.
    pub fn derivatives(
        &self,
        functions: &[usize],
        x: &Local,
        directions: &[Local; 2],
        order: usize,
    ) -> Vec<Derivatives> {
        let at: Vec<Vec<[f64; 4]>> = self.lines.iter().zip(x).map(|(line, x)| line.values(*x, order)).collect();
        let of = |f: usize| {
            let index = self.index(f);
            let axis = |k: usize| along(&at[k][index[k]], [directions[0][k], directions[1][k]], order);
            (1..self.lines.len()).fold(axis(0), |f, k| product(&f, &axis(k), order)).map(|v| v * self.weights[f])
        };
        let mut sum: Derivatives = [0.0; 10];
        let all: Vec<Derivatives> = (0..self.len()).map(of).collect();
        all.iter().for_each(|f| sum.iter_mut().zip(f).for_each(|(s, v)| *s += v));
        functions.iter().map(|f| quotient(&all[*f], &sum, order)).collect()
    }

    /// The places of the functions that do not vanish on a side.
    pub fn on_side(&self, side: usize) -> Vec<usize> {
        let (axis, end) = self.normal(side);
        let reaches = |f: &usize| {
            let c = &self.lines[axis].coefficients[self.index(*f)[axis]];
            c[if end { self.degree } else { 0 }].abs() > NOTHING
        };
        (0..self.len()).filter(reaches).collect()
    }

    /// The axis across a side, and whether the side is at its upper end.
    fn normal(&self, side: usize) -> (usize, bool) {
        let vertices = self.shape.vertices();
        let corners = self.shape.sides()[side];
        let across = |k: &usize| corners.iter().all(|&c| vertices[c][*k] == vertices[corners[0]][*k]);
        let axis = (0..self.lines.len()).find(across).unwrap_or(0);
        (axis, vertices[corners[0]][axis] > 0.0)
    }

    /// A side as a cell of its own, in the coordinates of the side, and the places of its functions in those of the cell; none
    /// where more than one layer of functions reaches it, as between the spans of a smooth spline.
    pub fn side(&self, side: usize) -> Option<(RationalBasis, Vec<usize>)> {
        let (axis, _) = self.normal(side);
        let layers: Vec<usize> = self.on_side(side).iter().map(|f| self.index(*f)[axis]).collect();
        if layers.iter().any(|l| *l != layers[0]) {
            return None;
        }
        let (_, tangents) = self.shape.on_side(side, &[0.0; 3]);
        let axes: Vec<(usize, bool)> = (tangents.iter().take(self.lines.len() - 1))
            .map(|t| {
                let k = (0..3).find(|k| t[*k] != 0.0).unwrap_or(0);
                (k, t[k] < 0.0)
            })
            .collect();
        let lines = axes.iter().map(|(k, turned)| match turned {
            true => Arc::new(self.lines[*k].reversed()),
            false => Arc::clone(&self.lines[*k]),
        });
        let n = self.degree + 1;
        let place = |f: usize| {
            let mut index = [0; 3];
            index[axis] = layers[0];
            for (a, (k, turned)) in axes.iter().enumerate() {
                let own = f / n.pow(a as u32) % n;
                index[*k] = if *turned { self.degree - own } else { own };
            }
            index[0] + n * (index[1] + n * index[2])
        };
        let places: Vec<usize> = (0..n.pow(axes.len() as u32)).map(place).collect();
        let weights = places.iter().map(|f| self.weights[*f]).collect();
        Some((RationalBasis::new(lines.collect(), weights), places))
    }

    /// The Bernstein coefficients of a combination of the functions with these values, and their weights: those of the rational
    /// Bézier cell with the same values.
    pub fn bezier<const N: usize>(&self, values: &[[f64; N]]) -> (Vec<[f64; N]>, Vec<f64>) {
        let n = self.degree + 1;
        let mut points = vec![[0.0; N]; self.len()];
        let mut weights = vec![0.0; self.len()];
        for (f, value) in values.iter().enumerate() {
            let index = self.index(f);
            for b in 0..self.len() {
                let own = [b % n, b / n % n, b / n / n];
                let share: f64 = self.lines.iter().enumerate().map(|(k, l)| l.coefficients[index[k]][own[k]]).product();
                let w = share * self.weights[f];
                weights[b] += w;
                (0..N).for_each(|i| points[b][i] += w * value[i]);
            }
        }
        points.iter_mut().zip(&weights).for_each(|(p, w)| p.iter_mut().for_each(|v| *v /= w));
        (points, weights)
    }
}

/// A function over another one, with derivatives up to an order: `(R W)^(i,j) = A^(i,j)` solved for the last derivative.
fn quotient(a: &Derivatives, w: &Derivatives, order: usize) -> Derivatives {
    let mut out = [0.0; 10];
    for (k, [i, j]) in TIMES.into_iter().enumerate().take(place(0, order) + 1) {
        // What is known so far, without the derivative that is sought.
        let known = product(&out, w, order)[k];
        debug_assert_eq!(place(i, j), k);
        out[k] = (a[k] - known) / w[0];
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first span of a cubic spline and the middle one of another, which come from knots 0 0 0 0 1 2 2 2 2.
    fn basis(dimension: usize) -> RationalBasis {
        let span = Arc::new(SpanFunctions {
            coefficients: vec![
                vec![1.0, 0.0, 0.0, 0.0],
                vec![0.0, 1.0, 0.5, 0.25],
                vec![0.0, 0.0, 0.5, 0.5],
                vec![0.0, 0.0, 0.0, 0.25],
            ],
            greville: vec![-1.0, -1.0 / 3.0, 1.0, 7.0 / 3.0],
        });
        let n = 4usize.pow(dimension as u32);
        RationalBasis::new(vec![span; dimension], (0..n).map(|k| 1.0 + 0.4 * (k as f64 * 1.7).sin()).collect())
    }

    #[test]
    fn derivatives_are_differences_and_functions_sum_to_one() {
        let directions = [[0.7, -0.3, 0.2], [-0.2, 0.5, 0.9]];
        for dimension in [2, 3] {
            let basis = basis(dimension);
            let all: Vec<usize> = (0..basis.len()).collect();
            let x = [0.21, -0.33, 0.4];
            let h = 1e-5;
            let at = basis.derivatives(&all, &x, &directions, 3);
            let mut values = Values::default();
            basis.tabulate(&x, &mut values);
            assert!((values.value.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            for a in 0..2 {
                let moved = |h: f64| -> Local { std::array::from_fn(|k| x[k] + h * directions[a][k]) };
                let [plus, minus] = [h, -h].map(|h| basis.derivatives(&all, &moved(h), &directions, 3));
                for f in 0..basis.len() {
                    assert!((at[f][0] - values.value[f]).abs() < 1e-14);
                    let slope: f64 = (0..dimension).map(|k| values.gradient[f][k] * directions[a][k]).sum();
                    assert!((at[f][1 + a] - slope).abs() < 1e-13);
                    for [i, j] in TIMES.into_iter().filter(|t| t[0] + t[1] < 3) {
                        let difference = (plus[f][place(i, j)] - minus[f][place(i, j)]) / (2.0 * h);
                        let next = at[f][if a == 0 { place(i + 1, j) } else { place(i, j + 1) }];
                        assert!((difference - next).abs() < 1e-7, "{f} {i} {j}: {difference} {next}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_side_is_the_trace_of_its_cell() {
        let basis = basis(3);
        let (mut whole, mut trace) = (Values::default(), Values::default());
        // Upper ends are inside of the spline.
        let mut outer = 0;
        for side in 0..6 {
            let Some((face, places)) = basis.side(side) else { continue };
            outer += 1;
            let s = [0.3, -0.6, 0.0];
            let (x, along) = basis.shape().on_side(side, &s);
            basis.tabulate(&x, &mut whole);
            face.tabulate(&s, &mut trace);
            for (k, place) in places.iter().enumerate() {
                assert!((trace.value[k] - whole.value[*place]).abs() < 1e-14);
                for a in 0..2 {
                    let slope: f64 = (0..3).map(|i| whole.gradient[*place][i] * along[a][i]).sum();
                    assert!((trace.gradient[k][a] - slope).abs() < 1e-14);
                }
            }
            let mut sorted = places.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, basis.on_side(side));
        }
        assert_eq!(outer, 3);
    }
}
