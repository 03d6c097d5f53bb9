//! Anderson acceleration of a fixed-point iteration `x ← x + g(x)`.
//!
//! The last few steps tell how `g` changes along them; the combination that makes the extrapolated `g` smallest is
//! taken. On a nearly linear iteration this is a quasi-Newton method (Walker & Ni, SIAM J. Numer. Anal. 49, 2011).

use crate::dense;

/// Steps remembered.
const DEPTH: usize = 5;

/// How many times longer than the plain step an extrapolated one may be.
const FURTHEST: f64 = 20.0;

/// The memory of an accelerated iteration.
#[derive(Clone, Debug, Default)]
pub struct Acceleration {
    /// Pairs of the step taken and the change of `g` it caused.
    history: Vec<(Vec<f64>, Vec<f64>)>,
    previous: Option<(Vec<f64>, Vec<f64>)>,
}

impl Acceleration {
    /// The step to take where the plain iteration proposes `g`.
    pub fn next(&mut self, g: Vec<f64>) -> Vec<f64> {
        if let Some((step, before)) = self.previous.take() {
            let change: Vec<f64> = g.iter().zip(&before).map(|(a, b)| a - b).collect();
            self.history.push((step, change));
            if self.history.len() > DEPTH {
                self.history.remove(0);
            }
        }
        let step = self.combined(&g).unwrap_or_else(|| g.clone());
        self.previous = Some((step.clone(), g));
        step
    }

    fn combined(&self, g: &[f64]) -> Option<Vec<f64>> {
        let m = self.history.len();
        if m == 0 {
            return None;
        }
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut matrix = vec![0.0; m * m];
        for i in 0..m {
            for j in 0..m {
                matrix[i * m + j] = dot(&self.history[i].1, &self.history[j].1);
            }
            // A trace of regularisation: steps that repeat each other carry no new information.
            matrix[i * m + i] *= 1.0 + 1e-12;
        }
        let rhs: Vec<f64> = self.history.iter().map(|(_, change)| dot(change, g)).collect();
        let gamma = dense::solve(&matrix, &rhs)?;
        let mut step = g.to_vec();
        for (c, (taken, change)) in gamma.iter().zip(&self.history) {
            for ((s, t), d) in step.iter_mut().zip(taken).zip(change) {
                *s -= c * (t + d);
            }
        }
        // An extrapolation far beyond the plain step is not to be trusted.
        let length = |v: &[f64]| dot(v, v).sqrt();
        (length(&step) <= FURTHEST * length(g)).then_some(step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_linear_iteration_ends_after_as_many_steps_as_it_has_rates() {
        let rates = [0.9, 0.5, -0.3];
        let mut x = vec![1.0, -2.0, 0.5];
        let mut acceleration = Acceleration::default();
        for _ in 0..8 {
            let g: Vec<f64> = x.iter().zip(rates).map(|(x, r)| (r - 1.0) * x).collect();
            for (x, s) in x.iter_mut().zip(acceleration.next(g)) {
                *x += s;
            }
        }
        // The plain iteration would still hold 0.9^8 = 0.43 of the first error.
        assert!(x.iter().all(|x| x.abs() < 1e-3), "{x:?}");
    }
}
