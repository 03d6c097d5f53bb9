//! How the linear equations of Newton's method are solved, what solved them, and what a body offers for it.

use signorini_solve::blocks::Block;
use signorini_solve::schwarz::Sets;

/// How the linear equations of Newton's method are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinearSolver {
    /// By iterations where all bodies offer them and there are many unknowns; else linear bodies are condensed.
    #[default]
    Automatic,
    Direct,
    /// By iterations where all bodies offer them.
    Iterative,
}

/// What solved them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Solved {
    #[default]
    Direct,
    /// By a factorisation of the linear bodies, once, and of a dense system of what is left.
    Condensed,
    /// By a Cholesky factor with multipliers eliminated, which preconditions a Krylov method.
    Eliminated,
    Iterative {
        /// Linear systems, and the most iterations that one of them took.
        systems: usize,
        most_iterations: usize,
        coarse: Coarse,
    },
    /// By several processes together.
    Distributed {
        processes: usize,
        systems: usize,
        /// Of one linear system; none where all were factorised.
        most_iterations: Option<usize>,
    },
}

/// How the coarse unknowns of a preconditioner are solved for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coarse {
    Factorised,
    Multigrid,
}

/// Where the stiffness of linear bodies goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stiffness {
    InTangent,
    /// Iterations take it from the bodies.
    KeptByBodies,
    /// The linear bodies that are condensed are factorised by themselves.
    Condensed,
}

/// The stiffness of a linear body as small symmetric matrices, and the sets of unknowns that precondition it.
pub struct Subspaces<'a> {
    pub stiffness: Vec<Block<'a>>,
    pub sets: Sets,
}
