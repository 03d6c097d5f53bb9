//! The problem of friction in its rows: nodes, the compliance between them, and the natural residual.

use crate::compliance::RowProducts;
use crate::law::{Law, Projected, Status};
use signorini_solve::SolveError;

/// Weighted gaps and slips under tractions: `y = q + W z`.
///
/// Only the columns that were asked for are known.
pub trait RowCompliance {
    /// Number of rows, those of springs included.
    fn rows(&self) -> usize;

    /// Makes the columns of rows known.
    ///
    /// # Errors
    /// Those of the solver of the bodies.
    fn require(&mut self, rows: &[usize]) -> Result<(), SolveError>;

    /// A column that is known, but for what [`Self::own`] adds to its diagonal.
    fn column(&self, column: usize) -> &[f64];

    /// The compliance by its products, where columns are not known.
    fn products(&self) -> Option<&RowProducts<'_>> {
        None
    }

    /// How a row gives way by itself.
    fn own(&self, _row: usize) -> f64 {
        0.0
    }

    /// `q + W z` for tractions that vanish on all rows whose columns are not known.
    ///
    /// # Errors
    /// Those of the solver of the bodies.
    fn values(&self, z: &[f64]) -> Result<Vec<f64>, SolveError>;

    /// An entry between rows of one node, or of a spring, of a column that is known; of products it is near to that.
    fn entry(&self, row: usize, column: usize) -> f64 {
        self.column(column)[row] + if row == column { self.own(row) } else { 0.0 }
    }

    /// About the root of the stiffness against the traction of a row, for a row that is known.
    fn scale(&self, row: usize) -> f64 {
        1.0 / self.entry(row, row).abs().sqrt()
    }
}

/// A node: the row of its pressure, and after it those of its friction.
#[derive(Clone, Copy, Debug)]
pub struct Node<'a> {
    /// The row of the pressure.
    pub first: usize,
    /// Number of rows of friction: 0 to 2.
    pub tangents: usize,
    /// The directions of these rows in the axes of the law.
    pub directions: [[f64; 2]; 2],
    /// Without a law there is no friction.
    pub law: Option<&'a dyn Law>,
}

impl Node<'_> {
    /// Its rows.
    pub fn rows(&self) -> std::ops::Range<usize> {
        self.first..self.first + 1 + self.tangents
    }
}

/// What friction a solution obeys.
#[derive(Clone, Copy, Debug)]
pub(super) enum Friction<'a> {
    /// The law.
    Law,
    None,
    /// The law under given pressures, by node.
    Fixed(&'a [f64]),
}

/// Nodes, and rows on which nothing limits the traction.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    pub nodes: &'a [Node<'a>],
    /// Rows of equations `y = 0`, such as those of springs that are taken away again.
    pub equations: &'a [usize],
}

/// The scale of the trial `z - c y` of a node: for its pressure and for its friction.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrialScale {
    pub normal: f64,
    pub tangential: f64,
}

impl TrialScale {
    /// That of a row of the node.
    pub fn of_row(&self, place: usize) -> f64 {
        if place == 0 { self.normal } else { self.tangential }
    }

    /// `1/W_nn`, and `factor` over the mean of `W_tt`.
    pub fn of(node: &Node<'_>, w: &dyn RowCompliance, factor: f64) -> Self {
        let diagonal = |k: usize| w.entry(node.first + k, node.first + k);
        let mean = (1..=node.tangents).map(diagonal).sum::<f64>() / node.tangents.max(1) as f64;
        TrialScale { normal: 1.0 / diagonal(0), tangential: if node.tangents > 0 { factor / mean } else { 0.0 } }
    }
}

/// The tractions that a node answers with, in its rows.
pub(super) fn answer(
    node: &Node<'_>,
    pressure: Option<f64>,
    friction: Friction<'_>,
    z: &[f64],
    y: &[f64],
    scale: TrialScale,
) -> Projected {
    let mut trial = [z[node.first] - scale.normal * y[node.first], 0.0, 0.0];
    let law = node.law.filter(|_| node.tangents > 0 && !matches!(friction, Friction::None));
    let Some(law) = law else {
        let closed = trial[0] > 0.0;
        let mut out = Projected::default();
        if closed {
            out.traction[0] = trial[0];
            out.derivative[0][0] = 1.0;
            out.status = Status::Slip;
        }
        return out;
    };
    for (row, v) in (node.first + 1..).zip(&node.directions[..node.tangents]) {
        let t = z[row] - scale.tangential * y[row];
        trial[1] += t * v[0];
        trial[2] += t * v[1];
    }
    let in_axes = match pressure {
        None => law.project(trial),
        // The pressure is free, and the friction that of another one.
        Some(given) => {
            let mut found = law.project([given, trial[1], trial[2]]);
            found.traction[0] = trial[0].max(0.0);
            (found.derivative[1][0], found.derivative[2][0]) = (0.0, 0.0);
            if trial[0] <= 0.0 || trial[0].is_nan() {
                found = Projected::default();
            } else if found.status == Status::Open {
                // Nothing to rub with: the node slips freely.
                found.status = Status::Slip;
                found.derivative[0][0] = 1.0;
            }
            found
        }
    };
    let v = &node.directions;
    let along = |t: [f64; 2], k: usize| t[0] * v[k][0] + t[1] * v[k][1];
    let mut out = Projected { status: in_axes.status, ..Projected::default() };
    out.traction[0] = in_axes.traction[0];
    out.derivative[0][0] = in_axes.derivative[0][0];
    let d = &in_axes.derivative;
    for a in 0..node.tangents {
        out.traction[a + 1] = along([in_axes.traction[1], in_axes.traction[2]], a);
        out.derivative[a + 1][0] = along([d[1][0], d[2][0]], a);
        for b in 0..node.tangents {
            out.derivative[a + 1][b + 1] = along([along([d[1][1], d[1][2]], b), along([d[2][1], d[2][2]], b)], a);
        }
    }
    out
}

/// Answers of all nodes, what they differ from the tractions by, and how much that is.
pub(super) struct Residual {
    pub answers: Vec<Projected>,
    pub scales: Vec<TrialScale>,
    /// `z - Π` of all rows of nodes.
    pub difference: Vec<f64>,
    /// The largest difference, and what the equations lack, relative.
    pub relative: f64,
}

impl<'a> Problem<'a> {
    /// The residual `z - Π(z - c y)`; `factor` scales `c` of the friction from the natural one, `1/W_kk`.
    ///
    /// # Errors
    /// Those of the solver of the bodies.
    pub(super) fn residual(
        &self,
        w: &mut dyn RowCompliance,
        friction: Friction<'_>,
        (z, y): (&[f64], &[f64]),
        factor: f64,
    ) -> Result<Residual, SolveError> {
        // Nodes that carry, or lie in each other.
        let touched = |node: &Node<'_>| y[node.first] < 0.0 || node.rows().any(|r| z[r] != 0.0);
        let rows: Vec<usize> = self.nodes.iter().filter(|n| touched(n)).flat_map(|n| n.rows()).collect();
        w.require(&rows)?;
        let mut out = Residual {
            answers: vec![Projected::default(); self.nodes.len()],
            scales: vec![TrialScale { normal: 0.0, tangential: 0.0 }; self.nodes.len()],
            difference: vec![0.0; z.len()],
            relative: 0.0,
        };
        let (mut worst, mut largest) = (0.0f64, 0.0f64);
        for (k, node) in self.nodes.iter().enumerate().filter(|(_, n)| touched(n)) {
            out.scales[k] = TrialScale::of(node, w, factor);
            let pressure = if let Friction::Fixed(given) = friction { Some(given[k]) } else { None };
            out.answers[k] = answer(node, pressure, friction, z, y, out.scales[k]);
            for (r, t) in node.rows().zip(&out.answers[k].traction) {
                out.difference[r] = z[r] - t;
                worst = if out.difference[r].is_nan() { f64::NAN } else { worst.max(out.difference[r].abs()) };
                largest = largest.max(z[r].abs()).max(t.abs());
            }
        }
        out.relative = if worst == 0.0 { 0.0 } else { worst / largest };
        for &r in self.equations {
            let size = |c: &usize| (w.entry(r, *c) * z[*c]).abs();
            let carried: f64 = rows.iter().chain(self.equations).filter(|c| z[**c] != 0.0).map(size).sum();
            let lack = if y[r] == 0.0 { 0.0 } else { y[r].abs() / (carried + y[r].abs()) };
            out.relative = if lack.is_nan() { f64::NAN } else { out.relative.max(lack) };
        }
        Ok(out)
    }
}
