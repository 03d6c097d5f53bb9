//! Sweeps: one case run many times with other values of some of its keys.
//!
//! A [`Manifest`] states case, variations and rows. It is written before anything runs. Each row is a run of its own, and its
//! [`Record`] is written when the run ended: what has none is missing, and is run by the next call. The table is made from
//! the records alone, so that it does not depend on the order of the runs, on interruptions or on the number of workers.

mod collect;
mod columns;
mod design;
mod folder;
mod local;
mod manifest;
mod picture;
mod record;
mod slurm;
mod table;
mod task;
mod vary;

pub use design::Sample;
pub use folder::{MANIFEST, SweepFolder};
pub use local::{Counted, Watch, run_missing};
pub use manifest::{Keep, Manifest, Wanted};
pub use record::{Record, Status};
pub use slurm::script;
pub use table::{Column, Table};
pub use task::run_row;
pub use vary::{Setting, Variation};

use crate::output::OutputError;
use crate::problem::CaseError;

/// Why a sweep could not go on.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    #[error(transparent)]
    Case(#[from] Box<CaseError>),
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl From<CaseError> for SweepError {
    fn from(error: CaseError) -> Self {
        SweepError::Case(Box::new(error))
    }
}

/// Makes table and picture of what the runs have recorded so far, and writes them into the folder.
///
/// # Errors
/// Records that are damaged, files that cannot be written.
pub fn gather(folder: &SweepFolder, manifest: &Manifest) -> Result<Table, SweepError> {
    let table = Table::new(folder, manifest)?;
    folder.write("sweep.csv", table.to_csv().as_bytes())?;
    match picture::draw(manifest, &table) {
        Some(svg) => {
            folder.write("sweep.svg", svg.as_bytes())?;
            folder.write("sweep.png", &crate::output::chart::png(&svg)?)?;
        }
        None => ["sweep.svg", "sweep.png"].iter().for_each(|name| folder.remove(name)),
    }
    Ok(table)
}
