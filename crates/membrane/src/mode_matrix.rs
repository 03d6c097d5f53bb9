//! Symmetric matrices of the modes of fronts, of which each meets few others.

use signorini_solve::{Symbolic, SymmetricMatrix, dense};

/// Modes from which on their equations are solved by sparse elimination.
pub const MANY_MODES: usize = 150;

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
