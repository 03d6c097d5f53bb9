//! Results as a page: one HTML file that needs nothing else, of the folder of a run.
//!
//! [`report`] reads a folder and returns the page; [`write()`] stores it. [`serve`](serve::Server) shows the page of a run
//! that goes on.

mod charts;
mod collection;
mod detail;
pub mod draw;
mod error;
mod folder;
mod html;
mod naming;
mod pack;
mod page;
mod pieces;
mod scene;
mod sections;
pub mod serve;
mod surface;
mod view;
mod vtk;

pub use error::ReportError;
use folder::Results;
use page::{Purpose, page};
use std::path::{Path, PathBuf};

/// The page of a folder of results, or of a file of answers of closest points.
///
/// # Errors
/// A path without results of a run, or with ones that are damaged.
pub fn report(folder: &Path) -> Result<String, ReportError> {
    Ok(page(&Results::read(folder)?, Purpose::File))
}

/// Writes the page of a folder, whole or not at all: into the folder as `report.html`, beside a file of answers, or to another
/// place. Returns where.
///
/// # Errors
/// Those of [`report`], and a file that cannot be written.
pub fn write(folder: &Path, output: Option<&Path>) -> Result<PathBuf, ReportError> {
    let html = report(folder)?;
    let path = output.map_or_else(|| beside(folder), Path::to_path_buf);
    match signorini::output::atomic::write(&path, html.as_bytes()) {
        Ok(()) => Ok(path),
        Err(source) => Err(ReportError::Write { path, source }),
    }
}

/// Where a page is stored if nothing else is said.
fn beside(results: &Path) -> PathBuf {
    if results.is_dir() { results.join("report.html") } else { results.with_extension("html") }
}
