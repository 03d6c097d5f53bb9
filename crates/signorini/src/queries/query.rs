//! A query, and why a file of them could not be answered.

use super::fields::FieldError;
use super::scanner::ScanError;
use signorini_geometry::shape::Shape;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;

/// A query: two shapes.
#[derive(Clone, Debug)]
pub struct PairQuery {
    pub a: Arc<Shape>,
    pub b: Arc<Shape>,
}

/// Why a file of queries could not be answered to its end.
#[derive(Debug, thiserror::Error)]
pub enum QueriesError {
    #[error("{}: cannot read: {source}", path.display())]
    Open { path: PathBuf, source: io::Error },
    #[error("{}: cannot write: {source}", path.display())]
    Write { path: PathBuf, source: io::Error },
    #[error("{}: {source}; the {answered} cases before it are answered", path.display())]
    Scan { path: PathBuf, source: ScanError, answered: usize },
    #[error("{}: line {line}: {source}", path.display())]
    Shapes { path: PathBuf, line: usize, source: FieldError },
    #[error("{}: {message}", path.display())]
    Input { path: PathBuf, message: String },
}
