//! Frictional contact of a linearised system as a second-order cone complementarity problem.
//!
//! | symbol | meaning |
//! |---|---|
//! | `r` | contact forces of all rows: by contact the normal force, then friction along its axes |
//! | `u = W (r - r_0) + q` | gap, and slip against the axes, that they leave; `W` is the compliance of the bodies (Delassus), and `q` what the forces `r_0` leave |
//! | `r = Π(r - ρ u)` | contact and friction, with the projection `Π` of the law (Alart & Curnier 1991) |
//!
//! Newton's method with the generalised derivative of `Π` finds them, from the known ones or from what an interior point method
//! finds ([`interior`]). Laws whose forces are in no cone have none; for them sweeps over the contacts, each solved for itself, come
//! nearer (after the nonlinear Gauss-Seidel method of Jean 1999). Forces that are not unique, as those of a stack of many contacts, are those that
//! a small compliance of all contacts alike would leave: the least of all in the sum of squares. That compliance is taken
//! back by a proximal iteration (Rockafellar 1976), so that nothing is left of it.

use super::interior::interior;
use nalgebra::{DMatrix, DVector};
use signorini_contact::Law;
use signorini_solve::dense::Lu;

/// What a few rows state together.
#[derive(Clone, Copy, Debug)]
pub enum Kind<'a> {
    /// One row with a force of any sign: what a support asks for.
    Bilateral,
    /// A gap, and `rows - 1` components of slip with the law of friction per `weight`.
    Contact { law: Option<&'a dyn Law>, weight: f64 },
}

/// Rows of one contact or support.
#[derive(Clone, Copy, Debug)]
pub struct Block<'a> {
    pub kind: Kind<'a>,
    pub first: usize,
    pub rows: usize,
    /// Which axis of friction each row after the first is.
    pub axes: [usize; 2],
}

/// The forces of a block with their derivative in the trial, row by row.
pub struct Projection {
    pub force: [f64; 3],
    pub derivative: [[f64; 3]; 3],
}

impl Block<'_> {
    /// The admissible forces for a trial.
    pub fn project(&self, trial: [f64; 3]) -> Projection {
        match self.kind {
            Kind::Bilateral => {
                let derivative = [[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]];
                Projection { force: trial, derivative }
            }
            Kind::Contact { law: None, .. } => {
                let closed = trial[0] > 0.0;
                let derivative = [[f64::from(u8::from(closed)), 0.0, 0.0], [0.0; 3], [0.0; 3]];
                Projection { force: [trial[0].max(0.0), 0.0, 0.0], derivative }
            }
            Kind::Contact { law: Some(law), weight } => {
                let mut full = [trial[0] / weight, 0.0, 0.0];
                (1..self.rows).for_each(|k| full[1 + self.axes[k - 1]] = trial[k] / weight);
                let found = law.project(full);
                let place = |k: usize| if k == 0 { 0 } else { 1 + self.axes[k - 1] };
                let mut out = Projection { force: [0.0; 3], derivative: [[0.0; 3]; 3] };
                for i in 0..self.rows {
                    out.force[i] = found.traction[place(i)] * weight;
                    (0..self.rows).for_each(|j| out.derivative[i][j] = found.derivative[place(i)][place(j)]);
                }
                out
            }
        }
    }
}

/// The problem: compliance, and what known forces leave: those of the last iterate, so that nothing cancels.
pub struct Complementarity<'a> {
    pub blocks: Vec<Block<'a>>,
    /// Symmetric but for the change of the contacts in a step.
    pub w: DMatrix<f64>,
    pub q: DVector<f64>,
    pub known: DVector<f64>,
}

/// Compliances of all contacts relative to the mean of the bodies, one tried after the other: small enough that few iterations take
/// them back, large enough that Newton's method is sure where forces are not unique. Where contacts have to squeeze each
/// other before friction holds them, forces grow from iteration to iteration, faster with less compliance.
const PROXIMAL: [f64; 5] = [1e-3, 1e-5, 1e-4, 1e-2, 1e-1];
/// Change of the forces, relative to the largest, that ends the proximal iteration.
const SAME: f64 = 1e-13;
/// Compliances, relative to the same mean, by which a solution is approached where Newton's method does not find it at once.
const LADDER: [f64; 11] = [3.0, 1.0, 0.3, 0.1, 0.03, 0.01, 0.003, 1e-3, 3e-4, 1e-4, 3e-5];
const MOST_PROXIMAL: usize = 200;
/// Change that rounding leaves at worst.
const NEARLY_SAME: f64 = 1e-10;
/// Change of forces that may be left when the iterations end: the next step mends the gaps that it means.
const LEFT: f64 = 1e-6;
/// Residual relative to the largest force that ends Newton's method: that of `r` itself.
const TOLERANCE: f64 = 1e-13;
/// What rounding leaves of it at worst.
const ROUNDED: f64 = 1e2;
const MOST_NEWTON: usize = 40;
/// Whole steps at first, and the shares that are tried after them.
const WHOLE: usize = 12;
const SHARES: [f64; 5] = [1.0, 0.5, 0.25, 0.1, 0.03];
/// Part of the way that a block goes in a sweep: a body is held by some three others.
const RELAXED: f64 = 0.3;
/// Sweeps between two tries of Newton's method, and how often both take turns.
const SWEEPS: usize = 40;
const MOST_TURNS: usize = 20;
/// Steps on one contact within a sweep.
const MOST_LOCAL: usize = 30;

impl Complementarity<'_> {
    /// Forces that solve the problem, from the known ones; none where the iterations come to no end.
    pub fn solve(&self) -> Option<DVector<f64>> {
        let n = self.q.len();
        if n == 0 {
            return Some(DVector::zeros(0));
        }
        let mean = self.w.diagonal().iter().map(|d| d.abs()).sum::<f64>() / n as f64;
        PROXIMAL.iter().find_map(|share| self.solve_by(share * mean, mean))
    }

    /// Proximal iterations with a compliance.
    fn solve_by(&self, compliance: f64, mean: f64) -> Option<DVector<f64>> {
        // The least forces: from none.
        let mut centre = DVector::zeros(self.q.len());
        let mut initial_multipliers = self.known.clone();
        let mut before = f64::INFINITY;
        for _ in 0..MOST_PROXIMAL {
            let direct = self.proximal(compliance, &centre, |inner| inner.newton(&initial_multipliers));
            let found = match direct.or_else(|| self.proximal(compliance, &centre, |inner| inner.by_interior_point())) {
                Some(found) => found,
                None => {
                    let near = self.soften_first([compliance, mean], &initial_multipliers)?;
                    self.proximal(compliance, &centre, |inner| inner.solve(near))?
                }
            };
            let change = (&found - &centre).amax();
            centre = found.clone();
            initial_multipliers = found;
            let most = centre.amax();
            if change <= SAME * most || (change <= NEARLY_SAME * most && change >= 0.5 * before) {
                return Some(centre);
            }
            before = change;
        }
        (before <= LEFT * centre.amax()).then_some(centre)
    }

    /// Forces near a solution: by contacts that give way, less and less.
    fn soften_first(&self, [least, mean]: [f64; 2], start: &DVector<f64>) -> Option<DVector<f64>> {
        let mut r = start.clone();
        for share in LADDER.iter().filter(|share| **share * mean > least) {
            let centre = r.clone();
            r = self.proximal(share * mean, &centre, |inner| inner.solve(centre.clone()))?;
        }
        Some(r)
    }

    /// One proximal step, solved by a method.
    fn proximal(
        &self,
        compliance: f64,
        centre: &DVector<f64>,
        by: impl FnOnce(&Inner<'_>) -> Option<DVector<f64>>,
    ) -> Option<DVector<f64>> {
        let mut w = self.w.clone();
        (0..self.q.len()).for_each(|k| w[(k, k)] += compliance);
        let q = &self.q + (&self.known - centre) * compliance;
        by(&Inner { blocks: &self.blocks, q: &q, known: &self.known, scale: &self.scales(&w), w: &w })
    }

    /// The scale `ρ` of the trials of each row: the inverse of the largest compliance of its block.
    fn scales(&self, w: &DMatrix<f64>) -> Vec<f64> {
        let mut out = vec![0.0; self.q.len()];
        for b in &self.blocks {
            let range = b.first..b.first + b.rows;
            let largest = range.clone().map(|i| range.clone().map(|j| w[(i, j)].abs()).sum()).fold(0.0f64, f64::max);
            range.for_each(|i| out[i] = 1.0 / largest.max(f64::MIN_POSITIVE));
        }
        out
    }
}

/// One proximal step.
struct Inner<'a> {
    blocks: &'a [Block<'a>],
    w: &'a DMatrix<f64>,
    q: &'a DVector<f64>,
    known: &'a DVector<f64>,
    scale: &'a [f64],
}

impl Inner<'_> {
    /// Newton's method from what an interior point method finds.
    fn by_interior_point(&self) -> Option<DVector<f64>> {
        let near = interior(self.blocks, self.w, &(self.q - self.w * self.known))?;
        self.newton(&near)
    }

    fn solve(&self, start: DVector<f64>) -> Option<DVector<f64>> {
        let mut r = start;
        for _ in 0..MOST_TURNS {
            if let Some(found) = self.newton(&r) {
                return Some(found);
            }
            for _ in 0..SWEEPS {
                self.sweep(&mut r);
            }
        }
        None
    }

    /// `r - Π(r - ρ u)` of all rows, with the trials.
    fn residual(&self, r: &DVector<f64>) -> (DVector<f64>, Vec<Projection>) {
        let u = self.w * (r - self.known) + self.q;
        let mut out = DVector::zeros(r.len());
        let mut projections = Vec::with_capacity(self.blocks.len());
        for b in self.blocks {
            let mut trial = [0.0; 3];
            for i in 0..b.rows {
                trial[i] = r[b.first + i] - self.scale[b.first + i] * u[b.first + i];
            }
            let found = b.project(trial);
            (0..b.rows).for_each(|i| out[b.first + i] = r[b.first + i] - found.force[i]);
            projections.push(found);
        }
        (out, projections)
    }

    /// What a residual may be: that of rounding in `u`, too.
    fn tolerance(&self, r: &DVector<f64>) -> f64 {
        let size = r.amax();
        let rounding = (0..r.len()).map(|i| self.scale[i] * self.q[i].abs()).fold(0.0f64, f64::max);
        TOLERANCE * size.max(rounding).max(f64::MIN_POSITIVE)
    }

    fn newton(&self, start: &DVector<f64>) -> Option<DVector<f64>> {
        let n = start.len();
        let mut r = start.clone();
        let (mut residual, mut found) = self.residual(&r);
        // A last step after the tolerance is met: gaps are as good as rounding then.
        let mut is_last = false;
        for iteration in 0..MOST_NEWTON {
            if residual.amax() <= self.tolerance(&r) {
                if is_last || residual.amax() == 0.0 {
                    return Some(r);
                }
                is_last = true;
            }
            // J = I - Π' (I - ρ W), columns one after the other.
            let mut j = DMatrix::<f64>::identity(n, n);
            for (b, p) in self.blocks.iter().zip(&found) {
                for i in 0..b.rows {
                    for k in 0..b.rows {
                        let d = p.derivative[i][k];
                        if d == 0.0 {
                            continue;
                        }
                        let (row, from) = (b.first + i, b.first + k);
                        j[(row, from)] -= d;
                        let factor = d * self.scale[from];
                        for c in 0..n {
                            j[(row, c)] += factor * self.w[(from, c)];
                        }
                    }
                }
            }
            let mut step = -&residual;
            Lu::new(n, j.as_slice()).solve_in_place(step.as_mut_slice());
            if !step.iter().all(|v| v.is_finite()) {
                return None;
            }
            // Whole steps at first: as of an active set, each goes at once to where its rows meet. What comes round in circles takes
            // the best of several shares.
            let shares: &[f64] = if iteration < WHOLE { &SHARES[..1] } else { &SHARES };
            let tried = shares.iter().map(|share| {
                let next = &r + &step * *share;
                let (of_next, projections) = self.residual(&next);
                (of_next.norm(), next, of_next, projections)
            });
            let (_, next, of_next, projections) = tried.min_by(|a, b| a.0.total_cmp(&b.0))?;
            if is_last && of_next.amax() >= residual.amax() {
                return Some(r);
            }
            (r, residual, found) = (next, of_next, projections);
        }
        (residual.amax() <= ROUNDED * self.tolerance(&r)).then_some(r)
    }

    /// One sweep: each block goes a part of the way to the forces that suit those of all others, all at once, so that their order
    /// changes nothing.
    fn sweep(&self, r: &mut DVector<f64>) {
        let u = self.w * (&*r - self.known) + self.q;
        let before = r.clone();
        for b in self.blocks {
            let mut free = [0.0; 3];
            for i in 0..b.rows {
                let row = b.first + i;
                let own: f64 = (0..b.rows).map(|k| self.w[(row, b.first + k)] * before[b.first + k]).sum();
                free[i] = u[row] - own;
            }
            let found = self.local(b, free, &before);
            (0..b.rows).for_each(|i| r[b.first + i] += RELAXED * (found[i] - before[b.first + i]));
        }
    }

    /// The forces of one block, with `free` gap and slip without them, by `r ← Π(r - ρ u)`.
    fn local(&self, b: &Block<'_>, free: [f64; 3], r: &DVector<f64>) -> [f64; 3] {
        let mut own = [0.0; 3];
        (0..b.rows).for_each(|i| own[i] = r[b.first + i]);
        let w = |i: usize, k: usize| self.w[(b.first + i, b.first + k)];
        if matches!(b.kind, Kind::Bilateral) {
            own[0] = -free[0] / w(0, 0);
            return own;
        }
        for _ in 0..MOST_LOCAL {
            let mut trial = [0.0; 3];
            for i in 0..b.rows {
                let u: f64 = free[i] + (0..b.rows).map(|k| w(i, k) * own[k]).sum::<f64>();
                trial[i] = own[i] - self.scale[b.first + i] * u;
            }
            let next = b.project(trial).force;
            let change = (0..b.rows).map(|i| (next[i] - own[i]).abs()).fold(0.0, f64::max);
            own = next;
            if change <= 1e-12 * own.iter().fold(0.0f64, |m, v| m.max(v.abs())) {
                break;
            }
        }
        own
    }
}
