//! Why an increment has no solution.

use crate::heat::HeatError;
use crate::system::AssemblyError;
use signorini_solve::SolveError;

/// Why an increment has no solution.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum IncrementError {
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    #[error(transparent)]
    Solve(#[from] SolveError),
    #[error("Newton's method did not converge in {} iterations{}", history.len() - 1, worst.as_deref().unwrap_or(""))]
    NotConverged { history: Vec<f64>, worst: Option<String> },
    #[error("`{body}` is free: no support or contact restrains it against {motion}")]
    Free { body: String, motion: String },
    #[error("the contact tractions did not converge in {outer} outer iterations")]
    Augmentation { outer: usize, history: Vec<f64> },
    /// A prescribed motion that is too long for one increment.
    #[error("contact `{contact}`: the prescribed motion passes through the other body after {:.0} % of its way", 100.0 * share)]
    PassesThrough { contact: String, share: f64 },
    /// What lies inside of a rigid body, where no contact sees it.
    #[error(
        "contact `{contact}`: a point of `{body}` lies {depth:.4e} deep inside the rigid body, at ({:.4}, {:.4}, \
         {:.4}), where no contact force pushes it out",
        x[0], x[1], x[2]
    )]
    Inside { contact: String, body: String, depth: f64, x: [f64; 3] },
    /// No stable state was found near one that is not stable.
    #[error(
        "`{body}` is unstable ({negative_eigenvalues} negative eigenvalue{} of the tangent), and no stable state was \
         found after a disturbance",
        if *negative_eigenvalues == 1 { "" } else { "s" }
    )]
    Unstable { body: String, negative_eigenvalues: usize },
    #[error(transparent)]
    Heat(#[from] HeatError),
    #[error("interrupted")]
    Interrupted,
}
