//! Whether rigid bodies may rest where they are: forces within the cones of friction that balance all loads.
//!
//! | symbol | meaning |
//! |---|---|
//! | `s` | forces of all rows, friction in shares of its coefficient: all cones are those of a half right angle |
//! | `B s = b` | balance with the loads |
//! | `K`, `Π` | the forces within all cones, and the projection onto them |
//! | `y` | multipliers of the balance: a virtual motion of the bodies |
//!
//! The forces are the least ones, `min ½|s|²` with `B s = b`, `s ∈ K`, so that they depend neither on names nor on orders where
//! they are not unique. They are `s = Π(Bᵀ y)` with the `y` of the least
//!
//! `φ(y) = ½|Π(Bᵀ y)|² - b·y`,  `∇φ = B Π(Bᵀ y) - b`
//!
//! which a Newton method finds, with the derivative of `Π` (Qi & Sun 2006). Where no forces balance the loads, `φ` has no least
//! value: `y` goes to the motion in which the bodies collapse. As all admissible forces have `½|s|² ≥ -φ(y)`, whatever `y` is,
//! there is an end to that.

use super::complementarity::{Block, Kind};
use nalgebra::{DMatrix, DVector};

/// Forces out of balance, relative to the largest load, with which bodies rest; and those that rounding leaves.
const BALANCED: f64 = 1e-10;
const ROUNDING: f64 = 1e-13;
/// Eigenvalues relative to the largest that are rounding.
const RANK: f64 = 1e-12;
/// Forces as large, relative to the least that balance the loads without cones, are none: rounding of theirs is `BALANCED`.
const LARGEST: f64 = 1e6;
const MOST_ITERATIONS: usize = 100;
/// Halvings of a step, and the part of the slope by which it has to go down (Armijo).
const MOST_HALVINGS: usize = 60;
const DESCENT: f64 = 1e-4;
/// Stiffness added to that of Newton's method, relative to the largest, by the part of the loads that is out of balance; and its
/// bounds: motions against which nothing acts are large, but finite.
const ADDED: f64 = 1e-4;
const LEAST_ADDED: f64 = 1e-13;
/// Forces out of balance from which Newton's method is trusted to halve them: `φ` then changes by less than its rounding.
const NEAR: f64 = 1e-6;

/// The forces of all rows with which what acts is in balance: `rows` are the rows of all blocks in the unknowns, in a metric in
/// which forces and moments count alike, and so is the `load`. None where there are none.
pub fn rest(blocks: &[Block<'_>], rows: &DMatrix<f64>, load: &DVector<f64>) -> Option<DVector<f64>> {
    let m = rows.nrows();
    let most = load.amax();
    if most == 0.0 {
        return Some(DVector::zeros(m));
    }
    if m == 0 {
        return None;
    }
    let mut share = DVector::from_element(m, 1.0);
    for b in blocks {
        if let Kind::Contact { law: Some(law), .. } = b.kind
            && let Some(mu) = law.per_pressure()
        {
            (1..b.rows).for_each(|k| share[b.first + k] = mu[b.axes[k - 1]]);
        }
    }
    let mut scaled = rows.clone();
    (0..m).for_each(|i| scaled.row_mut(i).scale_mut(share[i]));
    let least = Least { blocks, rows: &scaled, load, most };
    Some(least.solve()?.component_mul(&share))
}

/// The least forces within all cones in balance with a load.
struct Least<'a> {
    blocks: &'a [Block<'a>],
    /// `Bᵀ`.
    rows: &'a DMatrix<f64>,
    /// `-b`.
    load: &'a DVector<f64>,
    most: f64,
}

/// `φ` at some multipliers.
struct Dual {
    y: DVector<f64>,
    value: f64,
    /// `Bᵀ y`, and its projection.
    trial: DVector<f64>,
    forces: DVector<f64>,
    gradient: DVector<f64>,
}

impl Least<'_> {
    fn solve(&self) -> Option<DVector<f64>> {
        let n = self.load.len();
        let gram = self.rows.tr_mul(self.rows).symmetric_eigen();
        let stiffest = gram.eigenvalues.amax();
        // The forces without cones: by the pseudo-inverse; twice, for the digits that the product of rows loses.
        let inverse = gram.eigenvalues.map(|v| if v > RANK * stiffest { 1.0 / v } else { 0.0 });
        let solve = |right: &DVector<f64>| &gram.eigenvectors * gram.eigenvectors.tr_mul(right).component_mul(&inverse);
        let mut y = -solve(self.load);
        let lacks = |y: &DVector<f64>| self.rows.tr_mul(&(self.rows * y)) + self.load;
        y -= solve(&lacks(&y));
        if lacks(&y).amax() > BALANCED * self.most {
            return None;
        }
        let largest = LARGEST * (self.rows * &y).norm();
        let mut at = self.dual(y);
        for _ in 0..MOST_ITERATIONS {
            at = self.scaled(at);
            let out = self.out_of_balance(&at);
            if out <= ROUNDING * (at.forces.amax() / self.most).max(1.0) {
                return Some(at.forces);
            }
            if -2.0 * at.value > largest.powi(2) {
                return None;
            }
            let mut matrix = self.derivative(&at);
            let added = stiffest * (ADDED * out).clamp(LEAST_ADDED, ADDED);
            (0..n).for_each(|k| matrix[(k, k)] += added);
            let step = matrix.cholesky()?.solve(&-&at.gradient);
            match self.go(&at, &step) {
                Some(next) => at = next,
                None => break,
            }
        }
        (self.out_of_balance(&at) <= BALANCED).then_some(at.forces)
    }

    fn out_of_balance(&self, at: &Dual) -> f64 {
        at.gradient.amax() / self.most
    }

    fn dual(&self, y: DVector<f64>) -> Dual {
        let trial = self.rows * &y;
        let mut forces = trial.clone();
        for b in self.blocks {
            let own = b.nearest(&trial).0;
            (0..b.rows).for_each(|k| forces[b.first + k] = own[k]);
        }
        let value = trial.dot(&forces) - 0.5 * forces.norm_squared() + self.load.dot(&y);
        let gradient = self.rows.tr_mul(&forces) + self.load;
        Dual { y, value, trial, forces, gradient }
    }

    /// The least on the ray through some multipliers, if that is lower: the forces of cones grow with them.
    fn scaled(&self, at: Dual) -> Dual {
        let (work, square) = (-self.load.dot(&at.y), at.trial.dot(&at.forces));
        if !(work > 0.0 && square > 0.0) {
            return at;
        }
        let next = self.dual(&at.y * (work / square));
        if next.value < at.value { next } else { at }
    }

    /// `B Π' Bᵀ`.
    fn derivative(&self, at: &Dual) -> DMatrix<f64> {
        let mut by_trial = DMatrix::zeros(self.rows.nrows(), self.load.len());
        for b in self.blocks {
            let derivative = b.nearest(&at.trial).1;
            for i in 0..b.rows {
                for k in (0..b.rows).filter(|k| derivative[i][*k] != 0.0) {
                    for c in 0..self.load.len() {
                        by_trial[(b.first + i, c)] += derivative[i][k] * self.rows[(b.first + k, c)];
                    }
                }
            }
        }
        let out = self.rows.tr_mul(&by_trial);
        (&out + out.transpose()) * 0.5
    }

    /// Along a step, as far as it leads down.
    fn go(&self, at: &Dual, step: &DVector<f64>) -> Option<Dual> {
        let slope = at.gradient.dot(step);
        let out = self.out_of_balance(at);
        let mut share = 1.0;
        for _ in 0..MOST_HALVINGS {
            let next = self.dual(&at.y + step * share);
            if out <= NEAR && self.out_of_balance(&next) <= 0.5 * out {
                return Some(next);
            }
            let is_told = -share * slope > ROUNDING * at.value.abs();
            if is_told && next.value <= at.value + DESCENT * share * slope {
                return Some(if share == 1.0 { self.farther(at, step, next) } else { next });
            }
            share *= 0.5;
        }
        None
    }

    /// Twice as far along a step as long as that leads down: where there is no least value.
    fn farther(&self, at: &Dual, step: &DVector<f64>, mut best: Dual) -> Dual {
        for k in 1..MOST_HALVINGS as i32 {
            let next = self.dual(&at.y + step * 2f64.powi(k));
            if next.value.is_nan() || next.value >= best.value {
                break;
            }
            best = next;
        }
        best
    }
}

impl Block<'_> {
    /// The nearest forces within the cone, with the derivative of that projection.
    fn nearest(&self, trial: &DVector<f64>) -> ([f64; 3], [[f64; 3]; 3]) {
        let own: [f64; 3] = std::array::from_fn(|k| if k < self.rows { trial[self.first + k] } else { 0.0 });
        let is_cone = matches!(self.kind, Kind::Contact { law: Some(law), .. } if law.per_pressure().is_some());
        if !is_cone || self.rows == 1 {
            let found = self.project(own);
            return (found.force, found.derivative);
        }
        let [normal, a, b] = own;
        let across = a.hypot(b);
        let identity = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
        if across <= normal {
            return (own, identity);
        }
        if across <= -normal {
            return ([0.0; 3], [[0.0; 3]; 3]);
        }
        let w = [1.0, a / across, b / across];
        let middle = 0.5 * (normal + across);
        let turns = middle / across;
        let derivative = std::array::from_fn(|i| {
            std::array::from_fn(|j| match (i, j) {
                (0, _) | (_, 0) => 0.5 * w[i] * w[j],
                _ if i == j => turns + (0.5 - turns) * w[i] * w[j],
                _ => (0.5 - turns) * w[i] * w[j],
            })
        });
        (w.map(|w| middle * w), derivative)
    }
}
