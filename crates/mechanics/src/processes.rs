//! Processes that solve one system together, each with the stiffness of cells of its own.
//!
//! All vectors - unknowns, residual - are on all processes, with the same digits, so that all of them take the same decisions:
//! steps, active sets, cuts of increments. The matrix is distributed by rows. What connects processes is behind these traits.

use signorini_solve::SolveError;
use std::sync::Arc;

/// The processes, as one of them sees them. All of them call each function together, and in the same order.
pub trait Processes: Send + Sync {
    /// The number of this process, from 0.
    fn rank(&self) -> usize;

    fn count(&self) -> usize;

    /// Replaces each value by its sum over all processes, in the order of their numbers: the same digits on all of them.
    fn sum(&self, values: &mut [f64]);

    /// The numbers of each process, on all of them.
    fn gather(&self, own: &[f64]) -> Vec<Vec<f64>>;

    /// The word of the first process that has one, on all of them.
    fn first_word(&self, own: Option<String>) -> Option<String>;

    /// The matrix that the blocks of cells of all processes, whoever has their rows, and entries in rows of this process add up to:
    /// `owner` names the process that has the row of each unknown.
    fn matrix(&self, owner: &[u32], cells: &[CellBlock], entries: &[(u32, u32, f64)]) -> Box<dyn DistributedMatrix>;
}

/// What a cell adds to a matrix: entries of all pairs of its unknowns, row by row.
#[derive(Clone, Debug)]
pub struct CellBlock {
    pub unknowns: Vec<u32>,
    pub entries: Vec<f64>,
}

impl CellBlock {
    /// Row, column and value of what is not zero in rows that are asked for.
    pub fn list<'a>(
        &'a self,
        rows: impl Fn(u32) -> bool + Clone + 'a,
    ) -> impl Iterator<Item = (u32, u32, f64)> + Clone + 'a {
        let n = self.unknowns.len().max(1);
        let own = self.unknowns.iter().zip(self.entries.chunks(n)).filter(move |(row, _)| rows(**row));
        own.flat_map(move |(row, values)| {
            let entry = move |(column, value): (&u32, &f64)| (*row, *column, *value);
            self.unknowns.iter().zip(values).filter(|(_, v)| **v != 0.0).map(entry)
        })
    }
}

/// A matrix whose rows are distributed. Vectors are whole, and the same on all processes.
pub trait DistributedMatrix {
    /// The largest entry of each row in the first columns.
    fn row_sizes(&self, columns: usize) -> Vec<f64>;

    fn diagonal(&self) -> Vec<f64>;

    /// `A x`.
    fn multiply(&self, x: &[f64]) -> Vec<f64>;

    /// Adds to the diagonal: unknowns and what is added, the same list on all processes.
    fn add_to_diagonal(&mut self, list: &[(u32, f64)]);

    /// Solves the equations; `held` names unknowns whose value is known, and stands in the right-hand side.
    ///
    /// # Errors
    /// A singular matrix, no memory, or iterations that do not converge.
    fn solve(&self, equations: &DistributedEquations<'_>) -> Result<Found, SolveError>;
}

/// What a distributed matrix is solved for, and what is known of it.
pub struct DistributedEquations<'a> {
    pub right: &'a [f64],
    pub held: &'a [bool],
    /// Unknowns of bodies; those that follow are multipliers.
    pub of_bodies: usize,
    /// What preconditions iterations, from the diagonal of the matrix.
    pub preconditioner: &'a dyn Fn(&[f64]) -> Preconditioner,
}

/// What preconditions iterations: bodies that springs in place of multipliers hold together, as where the multipliers are
/// eliminated on one process, and what their algebraic multigrid has to know.
#[derive(Clone, Debug, Default)]
pub struct Preconditioner {
    /// What the springs add to rows of this process.
    pub springs: Vec<(u32, u32, f64)>,
    pub multipliers: Vec<SpringOfMultiplier>,
    /// Unknowns of bodies that a spring acts on.
    pub touched: Vec<bool>,
    /// Motions of the bodies that stretch nothing: steps of the unknowns of bodies.
    pub motions: Vec<Vec<f64>>,
    /// Unknowns that stand side by side at a node.
    pub components: usize,
}

/// The spring in place of a multiplier.
#[derive(Clone, Copy, Debug, Default)]
pub struct SpringOfMultiplier {
    /// Its stiffness; zero of one whose equation is its own.
    pub stiffness: f64,
    /// The multiplier, against its sign, per residual of its equation.
    pub pull: f64,
    /// By what its equation counts as a force.
    pub scale: f64,
}

/// A solution, and what it took.
pub struct Found {
    pub x: Vec<f64>,
    /// Of the linear solver; none of a factorisation.
    pub iterations: Option<usize>,
}

/// What one process has of a system that is divided, from which the memory of its equations is told.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Share {
    /// Unknowns of the bodies on all processes, and those whose rows this process has.
    pub unknowns: usize,
    pub rows: usize,
    /// Unknowns that stand side by side at a node.
    pub components: usize,
    /// Entries of the blocks of its cells, and of the matrix that these add up to.
    pub in_blocks: usize,
    pub entries: usize,
}

/// How a system is divided among processes.
#[derive(Clone)]
pub struct Division {
    pub processes: Arc<dyn Processes>,
    /// The process that has the row of each unknown of the bodies.
    pub owner: Vec<u32>,
    pub share: Share,
}
