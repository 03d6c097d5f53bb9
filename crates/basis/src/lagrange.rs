//! Lagrange bases on Gauss-Lobatto points: one-dimensional, and their tensor products on the unit cell.

use signorini_geometry::rule::legendre;
use signorini_geometry::{Point, Vector};

/// Highest polynomial degree.
pub const MAX_DEGREE: usize = 8;

/// The `p + 1` Gauss-Lobatto points of `[0, 1]`: the ends and the extrema of the Legendre polynomial of degree `p`.
pub fn gauss_lobatto(p: usize) -> Vec<f64> {
    let mut x: Vec<f64> = (0..=p).map(|i| -(std::f64::consts::PI * i as f64 / p as f64).cos()).collect();
    for v in &mut x[1..p] {
        // Newton on P_p', with the second derivative from Legendre's equation.
        for _ in 0..20 {
            let (value, d) = legendre(p, *v);
            let n = p as f64;
            let dd = (2.0 * *v * d - n * (n + 1.0) * value) / (1.0 - *v * *v);
            let step = d / dd;
            *v -= step;
            if step.abs() < 1e-16 {
                break;
            }
        }
    }
    x.iter().map(|v| 0.5 * (1.0 + v)).collect()
}

/// Values and first derivatives of the one-dimensional basis functions at one point.
pub type Line = [[f64; MAX_DEGREE + 1]; 2];

/// The tensor-product basis of degree `p` on the unit cell `[0, 1]^D`, node `i` numbered with the first direction fastest.
#[derive(Clone, Debug)]
pub struct TensorBasis<const D: usize> {
    degree: usize,
    nodes: Vec<f64>,
    /// Barycentric weights of the nodes.
    weights: Vec<f64>,
}

/// Values and gradients of all basis functions at one point, in the coordinates the gradients are asked in.
#[derive(Clone, Debug, Default)]
pub struct Tabulation<const D: usize> {
    pub value: Vec<f64>,
    pub gradient: Vec<Vector<D>>,
}

impl<const D: usize> TensorBasis<D> {
    pub fn new(degree: usize) -> Self {
        assert!((1..=MAX_DEGREE).contains(&degree), "degree {degree} is not between 1 and {MAX_DEGREE}");
        let nodes = gauss_lobatto(degree);
        let weights = (0..=degree)
            .map(|i| (0..=degree).filter(|&j| j != i).map(|j| 1.0 / (nodes[i] - nodes[j])).product())
            .collect();
        Self { degree, nodes, weights }
    }

    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Number of functions: `(p + 1)^D`.
    pub fn len(&self) -> usize {
        (self.degree + 1).pow(D as u32)
    }

    pub fn is_empty(&self) -> bool {
        false
    }

    /// Positions of the nodes along one direction.
    pub fn line_nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Values and derivatives of the one-dimensional functions at `x`, which may lie outside `[0, 1]`.
    pub fn line(&self, x: f64) -> Line {
        let mut out = [[0.0; MAX_DEGREE + 1]; 2];
        self.line_into(x, &mut out);
        out
    }

    fn line_into(&self, x: f64, [values, slopes]: &mut Line) {
        for (i, weight) in self.weights.iter().enumerate() {
            // The product and, by the product rule, its derivative; exact at the nodes too.
            let (mut value, mut slope) = (*weight, 0.0);
            for (j, node) in self.nodes.iter().enumerate() {
                if j != i {
                    slope = slope * (x - node) + value;
                    value *= x - node;
                }
            }
            values[i] = value;
            slopes[i] = slope;
        }
    }

    /// Tabulates values and gradients at the relative position `xi` of a cell of the given size.
    pub fn tabulate(&self, xi: &Point<D>, size: &Point<D>, out: &mut Tabulation<D>) {
        let n = self.degree + 1;
        let mut lines = [[[0.0; MAX_DEGREE + 1]; 2]; D];
        for (k, line) in lines.iter_mut().enumerate() {
            self.line_into(xi[k], line);
        }
        out.value.clear();
        out.gradient.clear();
        let mut along = [0; D];
        for _ in 0..self.len() {
            out.value.push((0..D).map(|k| lines[k][0][along[k]]).product());
            out.gradient.push(Vector::from_fn(|d, _| {
                (0..D).map(|k| lines[k][usize::from(k == d)][along[k]]).product::<f64>() / size[d]
            }));
            for a in &mut along {
                *a += 1;
                if *a < n {
                    break;
                }
                *a = 0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_are_one_at_their_node_and_sum_to_one() {
        for p in 1..=MAX_DEGREE {
            let basis = TensorBasis::<2>::new(p);
            let mut t = Tabulation::default();
            let size = Point::<2>::new(0.5, 2.0);
            basis.tabulate(&Point::<2>::new(0.37, 1.2), &size, &mut t);
            assert!((t.value.iter().sum::<f64>() - 1.0).abs() < 1e-11);
            assert!(t.gradient.iter().sum::<Vector<2>>().norm() < 1e-10);
            for (i, x) in basis.line_nodes().iter().enumerate() {
                let line = basis.line(*x);
                for j in 0..=p {
                    assert!((line[0][j] - f64::from(i == j)).abs() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn gradients_reproduce_a_polynomial() {
        let basis = TensorBasis::<2>::new(3);
        let f = |x: f64, y: f64| x.powi(3) * y - 2.0 * x * y.powi(2);
        let nodes = basis.line_nodes();
        let size = Point::<2>::new(0.5, 2.0);
        let mut t = Tabulation::default();
        basis.tabulate(&Point::<2>::new(0.3, 0.6), &size, &mut t);
        let g: Vector<2> =
            (0..basis.len()).map(|i| f(size[0] * nodes[i % 4], size[1] * nodes[i / 4]) * t.gradient[i]).sum();
        let (x, y) = (0.15, 1.2);
        assert!((g[0] - (3.0 * x * x * y - 2.0 * y * y)).abs() < 1e-12);
        assert!((g[1] - (x * x * x - 4.0 * x * y)).abs() < 1e-12);
    }
}
