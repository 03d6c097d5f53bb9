//! What an interrupted run needs to go on: written after every increment, whole or not at all, and read by
//! `run --resume`. Numbers are read as they were written, to the last bit.

use super::outcome::Begun;
use super::record::Record;
use crate::output::{Folder, OutputError};
use crate::report::Summary;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::path::Path;

/// The file, within the folder of results.
const FILE: &str = "checkpoint.json";
/// The folder of what stands beside it.
pub const BESIDE: &str = "checkpoint";
const VERSION: u64 = 3;

/// The state of a run between two increments.
pub struct Checkpoint {
    /// The next increment.
    pub next: usize,
    /// The state of the model.
    pub state: Value,
    pub record: Record,
}

/// Writes a state with what it is the state of.
///
/// # Errors
/// A file that cannot be written.
pub fn write(record: &Record, next: usize, state: Value) -> Result<(), OutputError> {
    let all = json!({
        "version": VERSION, "case": record.text, "next": next, "state": state, "steps": record.steps,
        "warnings": record.warnings, "events": record.events, "contact_events": record.contact_events, "frames": record.frames, "unknowns": record.unknowns,
    });
    record.folder.write(FILE, all.to_string().as_bytes())
}

/// Removes it from a run that is done.
pub fn remove(folder: &Folder) {
    folder.remove(FILE);
    folder.remove(BESIDE);
}

/// Reads the state of a run of the same case into its record.
///
/// # Errors
/// In words: no checkpoint, one of another case or version, or a damaged one.
pub fn read(path: &Path, record: Record) -> Result<Checkpoint, String> {
    let file = path.join(FILE);
    let text = std::fs::read_to_string(&file)
        .map_err(|e| format!("there is no run to continue: cannot read `{}`: {e}", file.display()))?;
    let mut v: Value = serde_json::from_str(&text).map_err(|e| format!("{}: {e}", damaged(path)))?;
    if v["version"] != VERSION {
        return Err(format!("`{}` was written by another version of this program", file.display()));
    }
    if v["case"] != record.text.as_str() {
        return Err(of_another_case(&file));
    }
    fn take<T: DeserializeOwned>(v: &mut Value, key: &str) -> Option<T> {
        serde_json::from_value(v[key].take()).ok()
    }
    let all = || {
        Some(Checkpoint {
            next: take(&mut v, "next")?,
            state: v["state"].take(),
            record: Record {
                steps: take(&mut v, "steps")?,
                warnings: take(&mut v, "warnings")?,
                events: take(&mut v, "events")?,
                contact_events: take(&mut v, "contact_events")?,
                frames: take(&mut v, "frames")?,
                unknowns: take(&mut v, "unknowns")?,
                ..record
            },
        })
    };
    all().ok_or_else(|| damaged(path))
}

/// Where a run of a case would go on in the folder of an earlier one.
///
/// # Errors
/// In words: no run, or one of another case.
pub fn begun(path: &Path, case: &str) -> Result<Begun, String> {
    if path.join(FILE).exists() {
        return Ok(Begun::Resumed);
    }
    let file = path.join("case.toml");
    let text = std::fs::read_to_string(&file)
        .map_err(|e| format!("there is no run to continue: cannot read `{}`: {e}", file.display()))?;
    if text != case {
        return Err(of_another_case(&file));
    }
    let done = summary(path).is_ok_and(|summary| summary.converged);
    Ok(if done { Begun::Done } else { Begun::Anew })
}

/// The summary of an earlier run.
///
/// # Errors
/// In words: a file that cannot be read, or is no summary of this version.
pub fn summary(path: &Path) -> Result<Summary, String> {
    let file = path.join("summary.json");
    let text = std::fs::read_to_string(&file).map_err(|e| format!("cannot read `{}`: {e}", file.display()))?;
    serde_json::from_str(&text).map_err(|e| format!("`{}` is damaged: {e}", file.display()))
}

fn of_another_case(file: &Path) -> String {
    format!("`{}` belongs to another case, or to this one before it was changed", file.display())
}

pub fn damaged(path: &Path) -> String {
    format!("`{}` is damaged", path.join(FILE).display())
}
