//! Equations with a band matrix, by elimination with row exchanges (Golub & Van Loan, Matrix Computations, 4.3.5).

/// A square matrix whose entries lie at most `below` under and `above` over the diagonal.
#[derive(Clone, Debug, Default)]
pub(crate) struct Banded {
    n: usize,
    below: usize,
    /// Over the diagonal, with the `below` that row exchanges fill.
    reach: usize,
    /// Row by row, `below + reach + 1` entries each, the diagonal at `below`.
    entries: Vec<f64>,
    /// Row exchanged with each row.
    exchange: Vec<usize>,
}

impl Banded {
    /// Empties the matrix for new entries.
    pub fn reset(&mut self, n: usize, below: usize, above: usize) {
        (self.n, self.below, self.reach) = (n, below, above + below);
        self.entries.clear();
        self.entries.resize(n * (below + self.reach + 1), 0.0);
        self.exchange.clear();
    }

    fn place(&self, i: usize, j: usize) -> usize {
        i * (self.below + self.reach + 1) + (j + self.below - i)
    }

    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        let k = self.place(i, j);
        self.entries[k] += value;
    }

    /// Factorises in place. `false` where a column has no pivot.
    pub fn factorise(&mut self) -> bool {
        let n = self.n;
        for k in 0..n {
            let last = (k + self.below).min(n - 1);
            let mut pivot = k;
            for i in k + 1..=last {
                if self.entries[self.place(i, k)].abs() > self.entries[self.place(pivot, k)].abs() {
                    pivot = i;
                }
            }
            self.exchange.push(pivot);
            let right = (k + self.reach).min(n - 1);
            if pivot != k {
                for j in k..=right {
                    let (a, b) = (self.place(k, j), self.place(pivot, j));
                    self.entries.swap(a, b);
                }
            }
            let diagonal = self.entries[self.place(k, k)];
            if !(diagonal.is_finite() && diagonal != 0.0) {
                return false;
            }
            for i in k + 1..=last {
                let at = self.place(i, k);
                let factor = self.entries[at] / diagonal;
                self.entries[at] = factor;
                if factor != 0.0 {
                    for j in k + 1..=right {
                        let (a, b) = (self.place(i, j), self.place(k, j));
                        self.entries[a] -= factor * self.entries[b];
                    }
                }
            }
        }
        true
    }

    /// Solves with the factors.
    pub fn solve(&self, b: &mut [f64]) {
        let n = self.n;
        for k in 0..n {
            b.swap(k, self.exchange[k]);
            for i in k + 1..=(k + self.below).min(n - 1) {
                b[i] -= self.entries[self.place(i, k)] * b[k];
            }
        }
        for k in (0..n).rev() {
            for j in k + 1..=(k + self.reach).min(n - 1) {
                b[k] -= self.entries[self.place(k, j)] * b[j];
            }
            b[k] /= self.entries[self.place(k, k)];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_what_needs_row_exchanges() {
        let (n, below, above) = (23, 3, 2);
        let entry = |i: usize, j: usize| if i == j { 0.0 } else { ((7 * i + 3 * j) as f64 * 0.61).sin() };
        let mut a = Banded::default();
        a.reset(n, below, above);
        let x: Vec<f64> = (0..n).map(|k| (k as f64).cos()).collect();
        let mut b = vec![0.0; n];
        for i in 0..n {
            for j in i.saturating_sub(below)..=(i + above).min(n - 1) {
                a.add(i, j, entry(i, j));
                b[i] += entry(i, j) * x[j];
            }
        }
        assert!(a.factorise());
        a.solve(&mut b);
        assert!(x.iter().zip(&b).all(|(x, y)| (x - y).abs() < 1e-11), "{b:?}");
        a.reset(2, 1, 1);
        a.add(0, 0, 1.0);
        assert!(!a.factorise());
    }
}
