//! Where a run begins, and how it ends.

use crate::fields::ShownState;
use crate::output::OutputError;
use crate::problem::CaseError;
use crate::report::{Reason, Summary};

/// Why a run has no summary.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    #[error(transparent)]
    Case(#[from] Box<CaseError>),
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl From<CaseError> for RunError {
    fn from(error: CaseError) -> Self {
        RunError::Case(Box::new(error))
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    Converged,
    NotConverged,
    Interrupted,
}

impl Ending {
    /// The ending that a reason means.
    pub(crate) fn of(reason: Reason) -> Self {
        match reason {
            Reason::Interrupted => Self::Interrupted,
            reason if reason.is_converged() => Self::Converged,
            _ => Self::NotConverged,
        }
    }
}

/// What a run leaves behind.
pub struct Outcome {
    pub summary: Summary,
    pub ending: Ending,
    /// The states of [`solve`](crate::run::solve), as often as the output asks for; of a run with a folder they are there.
    pub states: Vec<ShownState>,
}

/// Where a run begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Begun {
    /// At its beginning, as was asked.
    Fresh,
    /// After the last increment that an earlier run kept.
    Resumed,
    /// At its beginning, as the earlier run kept no increment.
    Anew,
    /// Nowhere: the earlier run is done.
    Done,
}

/// Why there is nothing to go on with, for a user.
pub fn not_resumed(why: String) -> CaseError {
    CaseError::new(why).help("start it from the beginning, without --resume")
}
