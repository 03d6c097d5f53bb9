//! What a folder of results holds.

use crate::error::ReportError;
use serde::de::DeserializeOwned;
use serde_json::Value;
use signorini::report::{ContactEvent, Event, StepReport, Summary, Warning};
use std::path::{Path, PathBuf};

/// The first line of the log of every run.
const FIRST_LINE: &str = "{\"event\":\"signorini\"";
/// Files of which one is in every folder of results.
const KNOWN: [&str; 3] = ["log.jsonl", "summary.json", "fields.pvd"];

/// What is told of a run.
pub enum Told {
    /// The summary of a run that ended, in one way or another.
    Run(Box<Summary>),
    /// What a run that goes on, or that was killed, has found so far.
    Unfinished(Unfinished),
    /// The summary of a fit, or of a scene of moving bodies.
    Other(Value),
    /// Answers of closest points, by the names of their queries.
    Answers(Vec<(String, Value)>),
}

/// What a run without a summary has stored.
#[derive(Default)]
pub struct Unfinished {
    pub steps: Vec<StepReport>,
    pub warnings: Vec<Warning>,
    pub events: Vec<Event>,
    pub contact_events: Vec<ContactEvent>,
}

/// An iteration of the log.
#[derive(Clone, Debug, PartialEq)]
pub struct Iteration {
    pub step: usize,
    pub time: f64,
    pub residual: f64,
    pub action: String,
}

/// A folder of results that was read.
pub struct Results {
    pub path: PathBuf,
    pub told: Told,
    /// The text of the case, where it is known.
    pub case: Option<String>,
    pub iterations: Vec<Iteration>,
    /// The version of the program that ran the case.
    pub version: Option<String>,
}

impl Results {
    /// Reads a folder. Files of fields are read when they are drawn.
    ///
    /// # Errors
    /// A path without results of a run, or with ones that are damaged.
    pub fn read(path: &Path) -> Result<Self, ReportError> {
        if !path.exists() {
            return Err(ReportError::Missing(path.to_path_buf()));
        }
        if !path.is_dir() {
            return answers(path).ok_or_else(|| ReportError::NotAFolder(path.to_path_buf()));
        }
        if !KNOWN.iter().any(|name| path.join(name).is_file()) {
            return Err(ReportError::NotResults(path.to_path_buf()));
        }
        let log = text(&path.join("log.jsonl"))?.unwrap_or_default();
        let checkpoint: Option<Value> =
            text(&path.join("checkpoint.json"))?.and_then(|text| serde_json::from_str(&text).ok());
        let told = match text(&path.join("summary.json"))? {
            Some(text) => summary(&path.join("summary.json"), &text)?,
            None if log.starts_with(FIRST_LINE) => Told::Unfinished(unfinished(checkpoint.as_ref())),
            None => return Err(ReportError::NotResults(path.to_path_buf())),
        };
        let case = text(&path.join("case.toml"))?
            .or_else(|| Some(checkpoint.as_ref()?.get("case")?.as_str()?.to_string()))
            .filter(|text| !text.trim().is_empty());
        let lines: Vec<Value> = log.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
        let version = lines.first().and_then(|line| Some(line["version"].as_str()?.to_string()));
        Ok(Self {
            path: path.to_path_buf(),
            told,
            case,
            iterations: lines.iter().filter_map(iteration).collect(),
            version,
        })
    }

    /// The summary of a run that ended.
    pub fn summary(&self) -> Option<&Summary> {
        match &self.told {
            Told::Run(summary) => Some(summary),
            _ => None,
        }
    }

    /// The increments so far.
    pub fn steps(&self) -> &[StepReport] {
        match &self.told {
            Told::Run(summary) => &summary.steps,
            Told::Unfinished(found) => &found.steps,
            Told::Other(_) | Told::Answers(_) => &[],
        }
    }

    /// The warnings so far.
    pub fn warnings(&self) -> Vec<Warning> {
        match &self.told {
            Told::Run(summary) => summary.warnings.clone(),
            Told::Unfinished(found) => found.warnings.clone(),
            Told::Answers(_) => Vec::new(),
            Told::Other(value) => {
                let list = value["warnings"].as_array().into_iter().flatten();
                list.filter_map(|w| w.as_str()).map(Warning::from).collect()
            }
        }
    }

    /// The time at which the bodies of a scene are closest.
    pub fn closest(&self) -> Option<f64> {
        match &self.told {
            Told::Other(value) => value["closest"]["time"].as_f64(),
            _ => None,
        }
    }

    /// Title of the case, or the name of its folder.
    pub fn title(&self) -> String {
        let of_case = || {
            let table: toml::Table = self.case.as_ref()?.parse().ok()?;
            Some(table.get("title")?.as_str()?.to_string())
        };
        let told = match &self.told {
            Told::Run(summary) => Some(summary.case.clone()),
            Told::Unfinished(_) => None,
            Told::Answers(_) => Some("Closest points".to_string()),
            Told::Other(value) => value["case"].as_str().or(value["title"].as_str()).map(String::from),
        };
        let name = || self.path.file_name().map_or("Results".into(), |name| name.to_string_lossy().into_owned());
        told.filter(|title| !title.is_empty()).or_else(of_case).unwrap_or_else(name)
    }

    /// Whether areas of contacts are lengths.
    pub fn is_flat(&self) -> bool {
        let of_case = || {
            let table: toml::Table = self.case.as_ref()?.parse().ok()?;
            Some(["line", "plane_strain", "plane_stress"].contains(&table.get("space")?.as_str()?))
        };
        of_case().unwrap_or(false)
    }

    /// A text file of the folder; none where it is not there or no text.
    pub fn text(&self, name: &str) -> Option<String> {
        std::fs::read_to_string(self.path.join(name)).ok()
    }
}

/// The answers of `signorini closest`; none for any other file.
fn answers(path: &Path) -> Option<Results> {
    let table: serde_json::Map<String, Value> = serde_json::from_slice(&std::fs::read(path).ok()?).ok()?;
    let is_answer = |v: &Value| ["distance", "error"].iter().any(|key| v.get(key).is_some());
    if table.is_empty() || !table.values().all(is_answer) {
        return None;
    }
    let told = Told::Answers(table.into_iter().collect());
    Some(Results { path: path.to_path_buf(), told, case: None, iterations: Vec::new(), version: None })
}

/// The content of a file; none where there is none.
fn text(path: &Path) -> Result<Option<String>, ReportError> {
    match std::fs::read(path) {
        Ok(bytes) => Ok(Some(String::from_utf8_lossy(&bytes).into_owned())),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(ReportError::Read { path: path.to_path_buf(), source }),
    }
}

/// The summary of a run, a fit or a scene.
fn summary(path: &Path, text: &str) -> Result<Told, ReportError> {
    let damaged = |what: String| ReportError::Damaged { path: path.to_path_buf(), what };
    let value: Value = serde_json::from_str(text).map_err(|e| damaged(format!("it is no JSON: {e}")))?;
    if value.get("steps").is_some() {
        let summary = serde_json::from_value(value).map_err(|e| damaged(format!("{e}")))?;
        return Ok(Told::Run(Box::new(summary)));
    }
    let is_known = ["adhesion_energy", "contact_pair_kinds"].iter().any(|key| value.get(key).is_some());
    if is_known { Ok(Told::Other(value)) } else { Err(damaged("it is not the summary of a run".into())) }
}

fn unfinished(checkpoint: Option<&Value>) -> Unfinished {
    fn list<T: DeserializeOwned>(of: Option<&Value>, key: &str) -> Vec<T> {
        of.and_then(|v| serde_json::from_value(v.get(key)?.clone()).ok()).unwrap_or_default()
    }
    Unfinished {
        steps: list(checkpoint, "steps"),
        warnings: list(checkpoint, "warnings"),
        events: list(checkpoint, "events"),
        contact_events: list(checkpoint, "contact_events"),
    }
}

fn iteration(line: &Value) -> Option<Iteration> {
    if line["event"] != "iteration" {
        return None;
    }
    Some(Iteration {
        step: line["step"].as_u64()? as usize,
        time: line["time"].as_f64()?,
        residual: line["residual"].as_f64().unwrap_or(f64::NAN),
        action: line["action"].as_str().unwrap_or_default().to_string(),
    })
}
