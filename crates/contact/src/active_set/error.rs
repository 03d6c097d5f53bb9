//! Why no contact state was found.

use signorini_solve::SolveError;

/// Why no contact state was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ActiveSetError {
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// A motion that no contact found resists: what each spring lacks.
    #[error("the computed contact does not restrain the bodies")]
    Free { motion: Vec<f64> },
    /// Rows that say the same as others, or as a support.
    #[error("the contact conditions are linearly dependent")]
    Dependent,
    /// Rows that change from one state to the other for ever.
    #[error("the contact status alternates between open and closed at {} points", rows.len())]
    Chatter { rows: Vec<usize> },
    /// Rows of the pressures whose nodes find no state of stick and slip.
    #[error("the stick and slip zones did not converge in {solves} solves")]
    Friction { solves: usize, rows: Vec<usize> },
    #[error("the active set did not converge in {iterations} iterations")]
    TooMany { iterations: usize },
    #[error("interrupted")]
    Interrupted,
}
