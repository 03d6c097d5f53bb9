//! Why a step has no solution.

use crate::supports::SupportError;
use signorini_contact::ActiveSetError;
use signorini_solve::SolveError;

/// Why a step has no solution.
#[derive(Clone, Debug, thiserror::Error)]
pub enum StepError {
    #[error(transparent)]
    Support(#[from] SupportError),
    #[error(transparent)]
    Solve(#[from] SolveError),
    #[error("contact `{contact}`: {error}")]
    Contact { contact: String, error: ActiveSetError, places: Vec<String> },
    #[error("body `{body}` is free {motion}")]
    Free { body: String, motion: String },
    /// The loads pull a body away from all that could hold it.
    #[error("body `{body}` is pulled away {direction}")]
    PulledAway { body: String, direction: String },
    #[error("contact `{contact}`: the shape of a master face is invalid: {message}")]
    Shape { contact: String, message: String },
    /// Most of the slave side is inside the master before anything moves.
    #[error("contact `{contact}`: the bodies start {depth:.4e} deep in each other")]
    Deep { contact: String, depth: f64 },
    #[error("contact `{contact}`: friction requires multipliers or a penalty, but {unlike}")]
    FrictionUnsupported { contact: String, unlike: String },
    /// An axis of friction that lies nowhere in the surface.
    #[error("contact `{contact}`: the axis of friction is normal to the surface at {place}")]
    FrictionAxis { contact: String, place: String },
    /// The loads ask for more friction than there is.
    #[error(
        "body `{body}` slides away {direction}: its loads require a friction force of {demanded:.6e}, but the \
         friction limit is {available:.6e}"
    )]
    Slides { body: String, direction: String, demanded: f64, available: f64 },
    #[error("interrupted")]
    Interrupted,
}
