//! What can be wrong with a folder of which a report is wanted.

use std::io;
use std::path::PathBuf;

/// A report that could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// Nothing is there.
    #[error("there is no folder `{0}`")]
    Missing(PathBuf),
    /// It is a file.
    #[error("`{0}` is neither a folder of results nor a file of closest points")]
    NotAFolder(PathBuf),
    /// No run has written there.
    #[error("the folder `{0}` does not contain the results of a run")]
    NotResults(PathBuf),
    /// The summary is no JSON, or not that of a run.
    #[error("`{path}` is damaged: {what}")]
    Damaged { path: PathBuf, what: String },
    /// A file cannot be read.
    #[error("cannot read `{path}`: {source}")]
    Read { path: PathBuf, source: io::Error },
    /// The report cannot be written.
    #[error("cannot write `{path}`: {source}")]
    Write { path: PathBuf, source: io::Error },
    /// A picture that cannot be drawn as it is wanted.
    #[error("{message}")]
    Option { message: String, help: String },
    /// The address is taken, or may not be used.
    #[error("cannot listen on port {port} of this computer: {source}")]
    Listen { port: u16, source: io::Error },
}

impl ReportError {
    /// What to do about it.
    pub fn help(&self) -> &str {
        match self {
            Self::Missing(_) | Self::NotAFolder(_) | Self::NotResults(_) => {
                "give the folder of a run, such as `out` after  signorini run case.toml -o out"
            }
            Self::Damaged { .. } => "run the case again; signorini run CASE -o DIR --resume keeps finished increments",
            Self::Read { .. } => "check the permission to read the folder",
            Self::Write { .. } => {
                "check the free space and the permission to write; or choose another file with -o FILE"
            }
            Self::Option { help, .. } => help,
            Self::Listen { .. } => "choose another port with --port, or 0 for any that is free",
        }
    }
}
