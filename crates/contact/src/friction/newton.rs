//! The semismooth Newton method on `z = Π(z - c y)`, `y = q + W z`.
//!
//! With the generalised derivative `D` of the law, a step solves `(I - D) δz + D c W δz = -(z - Π)` for the rows of the
//! closed nodes; the tractions of open ones vanish. In the plane a slipping node makes the row `λ_t = ±μ λ_n`, whatever
//! `c`, which then decides about the states alone; it is chosen by the caller. The matrix is unsymmetric through
//! `∂Π/∂p`, even for small strains.

use super::problem::{Friction, Node, Problem, Residual, RowCompliance};
use crate::compliance::RowProducts;
use crate::law::Status;
use nalgebra::DMatrix;
use signorini_solve::SolveError;
use signorini_solve::dense::Lu;

/// Natural residual, relative, below which tractions are accepted.
pub(super) const ACCEPTED: f64 = 1e-8;
/// Pivots, relative, below which there are none: springs are taken away again to about this accuracy.
const SINGULAR: f64 = 1e-11;
/// Halvings of a step by the line search.
const MOST_HALVINGS: usize = 8;

/// How to iterate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settings {
    /// `c` of the friction, in terms of `1/W_tt`.
    pub factor: f64,
    /// Solves at most.
    pub most: usize,
    pub line_search: bool,
}

/// Why the iteration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    Accepted,
    /// In the plane: a set of states came again, and so would all after it.
    Repeats,
    TooMany,
    /// No tractions change what is wanted.
    Singular,
    Interrupted,
}

/// Where the iteration ended.
pub(super) struct Outcome {
    pub z: Vec<f64>,
    pub y: Vec<f64>,
    /// The natural one.
    pub residual: Residual,
    pub end: End,
}

/// Called after every solve with the number of nodes that changed their state; returns whether to go on.
pub(super) type Report<'a> = &'a mut dyn FnMut(usize) -> bool;

/// Iterates from given tractions.
pub(super) fn newton(
    problem: &Problem<'_>,
    w: &mut dyn RowCompliance,
    friction: Friction<'_>,
    start: Vec<f64>,
    settings: &Settings,
    report: Report<'_>,
) -> Result<Outcome, SolveError> {
    let carrying: Vec<usize> = (0..start.len()).filter(|&r| start[r] != 0.0).collect();
    w.require(&carrying)?;
    w.require(problem.equations)?;
    let mut z = start;
    let mut y = w.values(&z)?;
    let planar = problem.nodes.iter().all(|n| n.tangents < 2);
    let mut seen: Vec<Vec<u8>> = Vec::new();
    let mut solves = 0;
    loop {
        let residual = problem.residual(w, friction, (&z, &y), 1.0)?;
        let ended = |z, y, residual, end| Ok(Outcome { z, y, residual, end });
        if residual.relative.is_nan() {
            return ended(z, y, residual, End::Singular);
        }
        if residual.relative <= ACCEPTED {
            return ended(z, y, residual, End::Accepted);
        }
        if solves == settings.most {
            return ended(z, y, residual, End::TooMany);
        }
        let scaled;
        let level = if settings.factor == 1.0 {
            &residual
        } else {
            scaled = problem.residual(w, friction, (&z, &y), settings.factor)?;
            &scaled
        };
        let states = states(level);
        if planar && !settings.line_search && seen.contains(&states) {
            return ended(z, y, residual, End::Repeats);
        }
        let changed = match seen.last() {
            Some(last) => last.iter().zip(&states).filter(|(a, b)| a != b).count(),
            None => states.iter().filter(|s| **s != 0).count(),
        };
        seen.push(states);
        let system = System::new(problem, &*w, friction, level);
        let Some(step) = system.step(problem, &*w, level, (&z, &y))? else {
            return ended(z, y, residual, End::Singular);
        };
        solves += 1;
        if !report(changed) {
            return ended(z, y, residual, End::Interrupted);
        }
        let mut share = 1.0;
        let norm = |r: &Residual| r.difference.iter().map(|d| d * d).sum::<f64>();
        let before = norm(level);
        for halving in 0.. {
            let moved: Vec<f64> = z.iter().zip(&step).map(|(z, s)| z + share * s).collect();
            let reached = w.values(&moved)?;
            let fine = !settings.line_search || halving == MOST_HALVINGS || {
                norm(&problem.residual(w, friction, (&moved, &reached), settings.factor)?) < before
            };
            if fine {
                (z, y) = (moved, reached);
                break;
            }
            share *= 0.5;
        }
    }
}

/// The state of every node: open, sticking, or slipping, either way in the plane.
fn states(residual: &Residual) -> Vec<u8> {
    let of = |answer: &crate::law::Projected| match answer.status {
        Status::Open => 0,
        Status::Stick => 1,
        Status::Slip if answer.traction[1] < 0.0 => 2,
        Status::Slip => 3,
    };
    residual.answers.iter().map(of).collect()
}

/// The factorised equations of the rows that may carry, in units in which each is about one.
pub(super) struct System {
    /// Rows that may carry, those of equations at the end, and how many are of nodes.
    rows: Vec<usize>,
    of_nodes: usize,
    /// The node of each row, and its place in it.
    owner: Vec<(usize, usize)>,
    dense: Option<DenseRows>,
}

/// The matrix of the rows of a [`System`].
struct DenseRows {
    row_scale: Vec<f64>,
    column_scale: Vec<f64>,
    lu: Lu,
}

impl System {
    pub fn new(problem: &Problem<'_>, w: &dyn RowCompliance, friction: Friction<'_>, at: &Residual) -> Self {
        let rubs = |node: &Node<'_>| node.law.is_some() && !matches!(friction, Friction::None);
        let (mut rows, mut owner) = (Vec::new(), Vec::new());
        for (k, node) in problem.nodes.iter().enumerate().filter(|(k, _)| at.answers[*k].status != Status::Open) {
            let count = if rubs(node) { 1 + node.tangents } else { 1 };
            rows.extend(node.rows().take(count));
            owner.extend((0..count).map(|a| (k, a)));
        }
        let of_nodes = rows.len();
        rows.extend(problem.equations);
        if w.products().is_some() {
            return System { rows, of_nodes, owner, dense: None };
        }
        let column_scale: Vec<f64> = rows.iter().map(|&r| w.scale(r)).collect();
        let mut matrix = DMatrix::<f64>::zeros(rows.len(), rows.len());
        for (j, &c) in rows.iter().enumerate() {
            let (column, own, scale) = (w.column(c), w.own(c), column_scale[j]);
            let entry = |r: usize| column[r] + if r == c { own } else { 0.0 };
            for (i, &(k, a)) in owner.iter().enumerate() {
                let (node, derivative) = (&problem.nodes[k], &at.answers[k].derivative[a]);
                let mut value = 0.0;
                for (b, r) in node.rows().enumerate() {
                    if derivative[b] != 0.0 {
                        value += derivative[b] * at.scales[k].of_row(b) * entry(r);
                    }
                    if r == c {
                        value -= derivative[b];
                    }
                }
                if rows[i] == c {
                    value += 1.0;
                }
                matrix[(i, j)] = value * scale;
            }
            for i in of_nodes..rows.len() {
                matrix[(i, j)] = entry(rows[i]) * scale;
            }
        }
        let row_scale: Vec<f64> = (0..rows.len())
            .map(|i| 1.0 / (0..rows.len()).map(|j| matrix[(i, j)].abs()).fold(f64::MIN_POSITIVE, f64::max))
            .collect();
        for j in 0..rows.len() {
            for (i, scale) in row_scale.iter().enumerate() {
                matrix[(i, j)] *= scale;
            }
        }
        let lu = Lu::new(matrix.nrows(), matrix.as_slice());
        System { rows, of_nodes, owner, dense: Some(DenseRows { row_scale, column_scale, lu }) }
    }

    /// The sign of the determinant; none by products.
    pub fn determinant_sign(&self) -> Option<f64> {
        self.dense.as_ref().map(|d| d.lu.determinant_sign())
    }

    /// The step from tractions and what they come to, which need not be `q + W z`; none where some tractions change nothing.
    ///
    /// # Errors
    /// Those of the solver of the bodies.
    pub fn step(
        &self,
        problem: &Problem<'_>,
        w: &dyn RowCompliance,
        at: &Residual,
        (z, y): (&[f64], &[f64]),
    ) -> Result<Option<Vec<f64>>, SolveError> {
        let dense = match (&self.dense, w.products()) {
            (Some(dense), _) => dense,
            (None, Some(products)) => return self.step_by_products((problem, w, products), at, y),
            (None, None) => return Ok(None),
        };
        if dense.lu.smallest_pivot() <= SINGULAR {
            return Ok(None);
        }
        // First those rows are left that do not carry.
        let mut kept = vec![0.0; z.len()];
        self.rows.iter().for_each(|&r| kept[r] = z[r]);
        let mut moved = vec![0.0; z.len()];
        if kept != z {
            let (with, without) = (w.values(z)?, w.values(&kept)?);
            moved.iter_mut().zip(without.iter().zip(&with)).for_each(|(m, (a, b))| *m = a - b);
        }
        let mut x: Vec<f64> = (self.owner.iter())
            .map(|&(k, a)| {
                let (node, derivative) = (&problem.nodes[k], &at.answers[k].derivative[a]);
                let of = |(b, r): (usize, usize)| derivative[b] * at.scales[k].of_row(b) * moved[r];
                -at.difference[node.first + a] - node.rows().enumerate().map(of).sum::<f64>()
            })
            .collect();
        x.extend(self.rows[self.of_nodes..].iter().map(|&r| -(y[r] + moved[r])));
        x.iter_mut().zip(&dense.row_scale).for_each(|(x, s)| *x *= s);
        dense.lu.solve_in_place(&mut x);
        let mut step: Vec<f64> = kept.iter().zip(z).map(|(k, z)| k - z).collect();
        for ((&r, x), scale) in self.rows.iter().zip(&x).zip(&dense.column_scale) {
            step[r] += x * scale;
        }
        Ok(Some(step))
    }

    /// The same by products with the compliance. All other rows give up what they carry.
    fn step_by_products(
        &self,
        (problem, w, products): (&Problem<'_>, &dyn RowCompliance, &RowProducts<'_>),
        at: &Residual,
        y: &[f64],
    ) -> Result<Option<Vec<f64>>, SolveError> {
        let mut scale = vec![1.0; y.len()];
        (problem.nodes.iter().zip(&at.scales).filter(|(_, s)| s.normal > 0.0)).for_each(|(node, _)| {
            node.rows().for_each(|r| scale[r] = w.scale(r));
        });
        (products.count() - products.springs()..products.count()).for_each(|r| scale[r] = w.scale(r));
        // Each equation in units in which its own traction counts about one.
        let size = |(&r, &(k, a)): (&usize, &(usize, usize))| {
            let own = at.answers[k].derivative[a][a];
            (1.0 - own + own * at.scales[k].of_row(a) / scale[r].powi(2)).abs().max(f64::MIN_POSITIVE)
        };
        let size: Vec<f64> = self.rows.iter().zip(&self.owner).map(size).collect();
        let image = |x: &[f64], wx: &[f64]| {
            let give = |r: usize| wx[r] + w.own(r) * x[r];
            let mut out = x.to_vec();
            for (&r, &(k, a)) in self.rows.iter().zip(&self.owner) {
                let (node, derivative) = (&problem.nodes[k], &at.answers[k].derivative[a]);
                for (b, c) in node.rows().enumerate().filter(|(b, _)| derivative[*b] != 0.0) {
                    out[r] += derivative[b] * (at.scales[k].of_row(b) * give(c) - x[c]);
                }
            }
            self.rows.iter().zip(&size).for_each(|(&r, size)| out[r] /= size);
            for &r in &self.rows[self.of_nodes..] {
                out[r] = scale[r].powi(2) * give(r);
            }
            out
        };
        if !problem.equations.is_empty() && products.unheld(&scale, &image).is_some() {
            return Ok(None);
        }
        let mut b: Vec<f64> = at.difference.iter().map(|d| -d).collect();
        self.rows.iter().zip(&size).for_each(|(&r, size)| b[r] /= size);
        self.rows[self.of_nodes..].iter().for_each(|&r| b[r] = -scale[r].powi(2) * y[r]);
        // Closed gaps and slips that stick: their answer is the trial itself.
        let is_held = |&(k, a): &(usize, usize)| {
            let derivative = &at.answers[k].derivative[a];
            (0..3).all(|b| derivative[b] == if a == b { 1.0 } else { 0.0 })
        };
        let held: Vec<usize> =
            self.rows.iter().zip(&self.owner).filter(|(_, owner)| is_held(owner)).map(|(r, _)| *r).collect();
        Ok(products.solve(&scale, &held, &image, &b)?.map(|found| found.x))
    }
}
