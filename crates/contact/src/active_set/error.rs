//! Why no contact state was found.

use signorini_solve::SolveError;

/// Why no contact state was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ActiveSetError {
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// A motion that no contact found resists: what each spring lacks.
    #[error("the contact found does not hold the bodies")]
    Free { motion: Vec<f64> },
    /// Rows that say the same as others, or as a support.
    #[error("the conditions of the contacts depend on each other")]
    Dependent,
    /// Rows that change from one state to the other for ever.
    #[error("the contact state alternates between open and closed at {} points", rows.len())]
    Chatter { rows: Vec<usize> },
    /// Rows of the pressures whose nodes find no state of stick and slip.
    #[error("no state of stick and slip was found in {solves} solves")]
    Friction { solves: usize, rows: Vec<usize> },
    #[error("no contact state was found in {iterations} iterations")]
    TooMany { iterations: usize },
    #[error("interrupted")]
    Interrupted,
}
