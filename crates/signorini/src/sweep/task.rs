//! The run of one row.

use super::SweepError;
use super::folder::SweepFolder;
use super::manifest::{Keep, Manifest};
use super::record::Record;
use crate::output::{Folder, OutputError};
use crate::paths::{self, PathCase};
use crate::problem::Problem;
use crate::report::Summary;
use crate::run::{Begun, Ending, Progress, RunError, begun, resume, run, summarise};
use crate::scene::SceneError;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Runs a row, and writes what came of it. Returns none where it was interrupted: its run goes on with the next call.
///
/// # Errors
/// A row that the sweep does not have, files that cannot be written.
pub fn run_row(
    folder: &SweepFolder,
    manifest: &Manifest,
    index: usize,
    progress: &mut dyn Progress,
) -> Result<Option<Record>, SweepError> {
    let path = folder.run_folder(index);
    let name = manifest.case.display().to_string();
    let attempt = || -> Result<Option<Record>, RunError> {
        let problem = crate::case::read(&name, &manifest.text, &manifest.settings(index))?;
        let (summary, ending) = run_problem(&problem, folder, index, manifest.keep, progress)?;
        if ending == Ending::Interrupted {
            return Ok(None);
        }
        if manifest.keep == Keep::Summary {
            let file = format!("runs/{}/summary.json", SweepFolder::row_name(index));
            folder.write(&file, summary.to_json().as_bytes())?;
        }
        Ok(Some(Record::of_summary(summary.reason, &summary.verdict)))
    };
    // A fault in one run leaves the others as they are.
    let record = match catch_unwind(AssertUnwindSafe(attempt)) {
        Ok(Ok(None)) => return Ok(None),
        Ok(Ok(Some(record))) => record,
        Ok(Err(RunError::Case(error))) => Record::failed("input", plain(&error, &name)),
        Ok(Err(RunError::Output(error @ OutputError::Picture(_)))) => Record::failed("output", error.to_string()),
        Ok(Err(RunError::Output(error))) => return Err(error.into()),
        Err(_) => Record::failed("fault", format!("internal fault; please report `{}`", path.display())),
    };
    folder.write_record(index, &record)?;
    Ok(Some(record))
}

/// An error in one line, without the folder of the case, which is not the same everywhere. Settings have no lines.
fn plain(error: &crate::problem::CaseError, name: &str) -> String {
    if error.place.as_ref().is_some_and(|place| place.name == "--set") {
        return error.message.clone();
    }
    let file = Path::new(name).file_name().map_or(name.into(), |f| f.to_string_lossy());
    error.one_line().replace(name, &file)
}

fn run_problem(
    problem: &Problem,
    folder: &SweepFolder,
    index: usize,
    keep: Keep,
    progress: &mut dyn Progress,
) -> Result<(Summary, Ending), RunError> {
    let path = folder.run_folder(index);
    if paths::is_of_paths(problem) {
        let found = PathCase::new(problem).map_err(SceneError::Case).and_then(|case| match keep {
            Keep::All => clear(&path).map_err(SceneError::Output).and_then(|()| paths::run(&case, &path, progress)),
            Keep::Summary => paths::run_into(&case, &Folder::default(), progress),
        });
        return match found {
            Ok(summary) => Ok((summary, Ending::Converged)),
            Err(SceneError::Case(error)) => Err(error.into()),
            Err(SceneError::Output(error)) => Err(error.into()),
        };
    }
    let outcome = match keep {
        Keep::Summary => summarise(problem, progress)?,
        // What was killed goes on from its last increment.
        Keep::All if begun(problem, &path).is_ok_and(|b| b == Begun::Resumed) => resume(problem, &path, progress)?,
        Keep::All => {
            clear(&path)?;
            run(problem, &path, progress)?
        }
    };
    Ok((outcome.summary, outcome.ending))
}

/// Removes what a killed run left behind.
fn clear(path: &Path) -> Result<(), OutputError> {
    match std::fs::remove_dir_all(path) {
        Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
            Err(OutputError::Write { path: path.to_path_buf(), source })
        }
        _ => Ok(()),
    }
}
