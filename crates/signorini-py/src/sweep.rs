//! Sweeps: begun and gathered here, their rows run one by one by whoever calls.

use crate::errors::{Failure, apart};
use crate::progress::Told;
use pyo3::prelude::*;
use serde_json::json;
use signorini::sweep::{Keep, Manifest, Sample, SweepError, SweepFolder, Variation, Wanted, gather, run_row};
use std::path::PathBuf;

impl From<SweepError> for Failure {
    fn from(error: SweepError) -> Self {
        match error {
            SweepError::Case(error) => Failure::Case(error),
            SweepError::Output(error) => Failure::Output(error),
        }
    }
}

/// Begins a sweep in a folder, or goes on with it. `vary` has keys with a text as of the command, or with values one by one.
/// `choices`: whether all files of runs are kept, and whether an earlier sweep is removed. Returns whether it was there before.
///
/// # Errors
/// What is wrong with case or variations; another sweep in the folder, or a folder that cannot be written.
#[pyfunction]
#[pyo3(signature = (case, vary, sample, output, collect, choices))]
pub fn sweep_begin(
    py: Python<'_>,
    case: (String, String, Vec<String>),
    vary: Vec<(String, Option<String>, Vec<String>)>,
    sample: Option<(usize, u64)>,
    output: PathBuf,
    collect: Vec<String>,
    choices: (bool, bool),
) -> PyResult<bool> {
    apart(py, || {
        let variation = |(key, text, values): &(String, Option<String>, Vec<String>)| match text {
            Some(text) => Variation::parse(&format!("{key}={text}")),
            None => Ok(Variation::list(key, &values.iter().map(String::as_str).collect::<Vec<_>>())),
        };
        let ((name, text, set), (keep_all, restart)) = (case, choices);
        let manifest = Manifest::new(&Wanted {
            name,
            text,
            set,
            vary: vary.iter().map(variation).collect::<Result<Vec<_>, _>>()?,
            sample: sample.map(|(count, seed)| Sample { count, seed }),
            keep: if keep_all { Keep::All } else { Keep::Summary },
            collect,
        })?;
        Ok(manifest.enter(&SweepFolder::new(&output), restart)?.1)
    })
}

/// The rows of a sweep whose runs have not ended, from 0.
///
/// # Errors
/// A folder without a sweep.
#[pyfunction]
pub fn sweep_missing(py: Python<'_>, output: PathBuf) -> PyResult<Vec<usize>> {
    apart(py, || {
        let folder = SweepFolder::new(&output);
        Ok(Manifest::read(&folder)?.missing(&folder))
    })
}

/// Runs a row of a sweep, unless its run has ended. Returns what came of it as JSON; none where it was interrupted.
///
/// # Errors
/// A folder without a sweep, files that cannot be written.
#[pyfunction]
pub fn sweep_row(py: Python<'_>, output: PathBuf, index: usize) -> PyResult<Option<String>> {
    apart(py, || {
        let folder = SweepFolder::new(&output);
        let manifest = Manifest::read(&folder)?;
        let record = match folder.record(index)? {
            Some(record) => Some(record),
            None => run_row(&folder, &manifest, index, &mut Told::new(None))?,
        };
        Ok(record.map(|record| json!(record).to_string()))
    })
}

/// Makes the table of a sweep, as files in its folder and as JSON.
///
/// # Errors
/// A folder without a sweep, records that are damaged, files that cannot be written.
#[pyfunction]
pub fn sweep_gather(py: Python<'_>, output: PathBuf) -> PyResult<String> {
    apart(py, || {
        let folder = SweepFolder::new(&output);
        let manifest = Manifest::read(&folder)?;
        Ok(gather(&folder, &manifest)?.to_json().to_string())
    })
}
