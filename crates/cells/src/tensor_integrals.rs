//! Integrals of products of derivatives over a tensor grid of points, direction by direction (sum factorisation, Orszag
//! 1980).
//!
//! The functions of a cell are products of functions of one direction, `N_i = Π_k f_{i_k}(x_k)`. With `m` points and `R`
//! functions in each direction, `∫ ∂_a N_i ∂_c N_j` takes `R² m` products for each of `m^2` lines, then of `R² m`, then of
//! `R⁴`, in place of `R⁶` for each of `m³` points.

use crate::legendre::integrated_legendre;
use crate::space::LocalMode;
use crate::tree::{CellTree, Leaf};
use nalgebra::DMatrix;
use signorini_geometry::Aabb;
use signorini_geometry::rule::gauss_legendre;

/// The functions of a cell at the Gauss points of its leaf, by direction.
pub(crate) struct TensorFunctions<const D: usize> {
    /// Values and slopes in space: a row for each function of one direction, a column for each point.
    lines: [[DMatrix<f64>; 2]; D],
    /// Which of these functions make each function of the cell.
    factors: Vec<[usize; D]>,
}

impl<const D: usize> TensorFunctions<D> {
    /// With `order` points in each direction.
    pub fn new(tree: &CellTree<D>, leaf: &Leaf<D>, degree: usize, modes: &[LocalMode<D>], order: usize) -> Self {
        let gauss = gauss_legendre(order);
        let mut known: [Vec<[usize; 2]>; D] = std::array::from_fn(|_| Vec::new());
        let factors = (modes.iter())
            .map(|m| {
                std::array::from_fn(|k| {
                    let own = [m.mode.level, m.factors[k]];
                    known[k].iter().position(|f| *f == own).unwrap_or_else(|| {
                        known[k].push(own);
                        known[k].len() - 1
                    })
                })
            })
            .collect();
        let lines = std::array::from_fn(|k| {
            let mut out = [0, 1].map(|_| DMatrix::zeros(known[k].len(), order));
            for (row, [level, factor]) in known[k].iter().enumerate() {
                let b: Aabb<D> = tree.cell_box(*level, &leaf.index.map(|i| i >> (leaf.level - level)));
                let size = b.max[k] - b.min[k];
                for (point, (t, _)) in gauss.iter().enumerate() {
                    let x = leaf.bounds.min[k] + t * (leaf.bounds.max[k] - leaf.bounds.min[k]);
                    let [value, slope] = integrated_legendre(degree, (2.0 * x - b.min[k] - b.max[k]) / size)[*factor];
                    out[0][(row, point)] = value;
                    out[1][(row, point)] = slope * 2.0 / size;
                }
            }
            out
        });
        TensorFunctions { lines, factors }
    }

    /// `Σ_q w_q ∂_a N_i ∂_c N_j` over the points, of which the first direction runs fastest.
    pub fn products(&self, weights: &[f64], [a, c]: [usize; 2]) -> DMatrix<f64> {
        let mut sums = weights.to_vec();
        let (mut of_first, mut of_second) = ([0; D], [0; D]);
        let mut stride = 1;
        for k in 0..D {
            let first = &self.lines[k][usize::from(k == a)];
            let second = &self.lines[k][usize::from(k == c)];
            let (rows, points) = first.shape();
            let pairs = DMatrix::from_fn(rows * rows, points, |p, q| first[(p / rows, q)] * second[(p % rows, q)]);
            let lines = DMatrix::from_vec(points, sums.len() / points, sums);
            // The next direction leads.
            sums = (pairs * lines).transpose().data.into();
            (of_first[k], of_second[k]) = (stride * rows, stride);
            stride *= rows * rows;
        }
        let place = |f: &[usize; D], steps: &[usize; D]| (0..D).map(|k| f[k] * steps[k]).sum::<usize>();
        let first: Vec<usize> = self.factors.iter().map(|f| place(f, &of_first)).collect();
        let second: Vec<usize> = self.factors.iter().map(|f| place(f, &of_second)).collect();
        DMatrix::from_fn(first.len(), first.len(), |i, j| sums[first[i] + second[j]])
    }
}
