//! What a solver reports while it works. Libraries never print: a front end renders these events.

/// One iteration of a nonlinear solver.
#[derive(Clone, Debug)]
pub struct Iteration<'a> {
    /// Index of the load increment and its time.
    pub step: usize,
    pub time: f64,
    /// Equilibrium solves so far in this increment.
    pub iteration: usize,
    /// The residual relative to its tolerance: the iteration ends where it is at most one.
    pub residual: f64,
    /// What the iteration did, in words.
    pub action: &'a str,
    /// Named figures of the state: area, zones and the like.
    pub figures: &'a [(&'static str, f64)],
}

/// Receives what a solver reports.
pub trait Progress {
    /// Before anything is solved: how large the problem is, what solves it, and about how much memory that takes, in words.
    fn size(&mut self, _told: &str) {}
    /// A new increment begins.
    fn step(&mut self, _index: usize, _count: usize, _time: f64) {}
    fn iteration(&mut self, _iteration: &Iteration) {}
    /// Whether the user asked to stop; the solver then returns as soon as its state is consistent.
    fn interrupted(&self) -> bool {
        false
    }
}

/// Reports nothing.
pub struct Silent;

impl Progress for Silent {}
