//! States of a history that are known.

use signorini_solve::{Iteration, Progress};

/// A state on the path.
#[derive(Clone)]
pub struct PathPoint<Z> {
    pub time: f64,
    pub zone: Z,
    pub area: f64,
    /// Force of the floor on the membrane along z.
    pub force: f64,
    pub energy_total: f64,
    /// How far an adhesive state is from its loss.
    pub margin: Option<f64>,
}

/// What a time between two others has.
pub enum Trial<Z> {
    State(PathPoint<Z>),
    /// Contact as at the earlier or the later time, in zones smaller than the grid can tell.
    AsEarlier,
    AsLater,
    Unknown,
}

/// Equilibrium solves that one time between may take: beside a merger, where fronts nearly touch, a state may take
/// hundreds.
const MOST_SOLVES: usize = 100;

/// A progress that asks to stop after [`MOST_SOLVES`].
pub struct Bounded<'a> {
    pub inner: &'a mut dyn Progress,
    pub solves: usize,
}

impl Progress for Bounded<'_> {
    fn iteration(&mut self, iteration: &Iteration) {
        self.solves += 1;
        self.inner.iteration(iteration);
    }
    fn interrupted(&self) -> bool {
        self.solves >= MOST_SOLVES || self.inner.interrupted()
    }
}
