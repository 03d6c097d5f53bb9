//! What came of a run: `runs/0001.json`. Its numbers stand in `runs/0001/summary.json`.

use crate::report::Reason;
use serde::{Deserialize, Serialize};

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// All increments have a state.
    Done,
    /// Not all increments have a state, or there is none.
    Failed,
    /// The run has not ended.
    Missing,
}

impl Status {
    /// The word in tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Failed => "failed",
            Self::Missing => "missing",
        }
    }
}

/// What came of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    pub status: Status,
    /// A reason of the summary; `input` for values that the case cannot have, `fault` for a fault of the program.
    pub reason: String,
    /// For a run that failed, why.
    pub message: String,
}

impl Record {
    /// Of a run with a summary.
    pub fn of_summary(reason: Reason, verdict: &str) -> Self {
        let done = reason.is_converged();
        let message = if done { String::new() } else { verdict.to_string() };
        Self { status: if done { Status::Done } else { Status::Failed }, reason: word(reason), message }
    }

    /// Of a run that failed without a summary.
    pub fn failed(reason: &str, message: impl Into<String>) -> Self {
        Self { status: Status::Failed, reason: reason.into(), message: message.into() }
    }
}

/// The word for a reason, as in the summary.
fn word(reason: Reason) -> String {
    serde_json::to_value(reason).ok().and_then(|v| Some(v.as_str()?.to_string())).unwrap_or_default()
}
