//! What can be wrong with a deck.

use std::path::{Path, PathBuf};

/// A deck that cannot be imported: where, what, and why.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{}: {message}", file.display(), line.map_or(String::new(), |l| format!(", line {l}")))]
pub struct ImportError {
    pub file: PathBuf,
    /// Counted from one.
    pub line: Option<usize>,
    /// The keyword, what is wrong with it, and what would be valid.
    pub message: String,
}

impl ImportError {
    pub fn new(file: &Path, line: impl Into<Option<usize>>, message: impl Into<String>) -> Self {
        Self { file: file.to_path_buf(), line: line.into(), message: message.into() }
    }
}
