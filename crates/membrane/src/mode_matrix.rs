//! Symmetric matrices of the modes of fronts, of which each meets few others.

use signorini_solve::{Symbolic, SymmetricMatrix, dense};

/// Modes from which on their equations are solved by sparse elimination.
const MANY_MODES: usize = 150;

/// A few modes, and the row-major matrix that they have among themselves.
pub type Clique = (Vec<u32>, Vec<f64>);

/// A symmetric matrix of modes, as a sum of cliques.
pub struct ModeMatrix {
    n: usize,
    cliques: Vec<Clique>,
}

/// Adds cliques to a row-major matrix of `n` modes.
pub fn add_cliques(matrix: &mut [f64], n: usize, cliques: &[Clique]) {
    for (modes, values) in cliques {
        for (a, &i) in modes.iter().enumerate() {
            for (b, &j) in modes.iter().enumerate() {
                matrix[i as usize * n + j as usize] += values[a * modes.len() + b];
            }
        }
    }
}

impl ModeMatrix {
    /// `Σ f w_m w_n` over the points of fronts, with a factor `f` and pairs of mode and value `w_m` at each.
    pub fn of_products<'a>(
        n: usize,
        points: impl Iterator<Item = &'a [(usize, f64)]>,
        factors: impl Iterator<Item = f64>,
    ) -> Self {
        let mut cliques: Vec<Clique> = Vec::new();
        for (values_at, factor) in points.zip(factors) {
            let size = values_at.len();
            let numbers = || values_at.iter().map(|(i, _)| *i as u32);
            // Most points have the modes of the point before.
            if !cliques.last().is_some_and(|(modes, _)| modes.iter().copied().eq(numbers())) {
                cliques.push((numbers().collect(), vec![0.0; size * size]));
            }
            let Some((_, values)) = cliques.last_mut() else { continue };
            for (a, (_, va)) in values_at.iter().enumerate() {
                for (b, (_, vb)) in values_at.iter().enumerate() {
                    values[a * size + b] += factor * va * vb;
                }
            }
        }
        Self { n, cliques }
    }

    /// A sum of given cliques.
    pub fn of_cliques(n: usize, cliques: Vec<Clique>) -> Self {
        Self { n, cliques }
    }

    pub fn diagonal(&self) -> Vec<f64> {
        let mut out = vec![0.0; self.n];
        for (modes, values) in &self.cliques {
            modes.iter().enumerate().for_each(|(a, &i)| out[i as usize] += values[a * modes.len() + a]);
        }
        out
    }

    pub fn add(&mut self, cliques: Vec<Clique>) {
        self.cliques.extend(cliques);
    }

    /// The product with a vector.
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.n];
        for (modes, values) in &self.cliques {
            for (&i, row) in modes.iter().zip(values.chunks(modes.len())) {
                out[i as usize] += modes.iter().zip(row).map(|(&j, v)| v * x[j as usize]).sum::<f64>();
            }
        }
        out
    }

    /// The whole matrix, row by row.
    pub fn dense(&self) -> Vec<f64> {
        let mut out = vec![0.0; self.n * self.n];
        add_cliques(&mut out, self.n, &self.cliques);
        out
    }

    /// The solution for a right-hand side, where the matrix is positive definite.
    pub fn solve(&self, b: &[f64]) -> Option<Vec<f64>> {
        if self.n < MANY_MODES {
            return dense::solve(&self.dense(), b);
        }
        let sparse = SymmetricMatrix::of_cliques(self.n, &self.cliques);
        Symbolic::default().factor(sparse).and_then(|f| f.solve(b)).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sparse_elimination_solves_what_the_dense_matrix_says() {
        // Rings of overlapping modes, with one that no point of a front sees.
        let n = MANY_MODES + 1;
        let points: Vec<Vec<(usize, f64)>> = (0..4 * MANY_MODES)
            .map(|k| {
                let t = 0.25 * (k % 4) as f64;
                let at = |i: usize| (k / 4 + i) % MANY_MODES;
                // Quadratic splines.
                let values = [0.5 * (1.0 - t).powi(2), 0.5 + t * (1.0 - t), 0.5 * t * t];
                (0..3).map(|i| (at(i), values[i])).collect()
            })
            .collect();
        let factor = |k: usize| 1.0 + (k as f64).sin().powi(2);
        let mut matrix = ModeMatrix::of_products(n, points.iter().map(|p| &p[..]), (0..points.len()).map(factor));
        let products = matrix.dense();
        let value = |p: &[(usize, f64)], mode: usize| p.iter().filter(|(i, _)| *i == mode).map(|(_, v)| v).sum::<f64>();
        for (i, j) in (0..5).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let each = points.iter().enumerate().map(|(k, p)| factor(k) * value(p, i) * value(p, j));
            assert!((products[i * n + j] - each.sum::<f64>()).abs() < 1e-14, "{i}, {j}");
        }
        matrix.add(vec![(vec![MANY_MODES as u32], vec![2.0])]);
        let b: Vec<f64> = (0..n).map(|i| (1.3 * i as f64).cos()).collect();
        let x = matrix.solve(&b).expect("positive definite");
        let dense = matrix.dense();
        for (i, b) in b.iter().enumerate() {
            let row: f64 = (0..n).map(|j| dense[i * n + j] * x[j]).sum();
            assert!((row - b).abs() < 1e-10, "{row} {b}");
            assert_eq!(matrix.diagonal()[i], dense[i * n + i]);
            assert!((row - matrix.multiply(&x)[i]).abs() < 1e-12);
        }
    }
}
