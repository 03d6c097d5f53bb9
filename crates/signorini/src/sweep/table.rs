//! The table of a sweep: a row for each run, in the order of the manifest.

use super::SweepError;
use super::collect::{collected, last_state};
use super::columns::unit;
use super::folder::SweepFolder;
use super::manifest::Manifest;
use super::record::{Record, Status};
use super::vary::Setting;
use crate::problem::CaseError;
use crate::report::headed;
use serde_json::{Map, Value, json};

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    pub name: String,
    /// Its unit, which may be empty.
    pub unit: String,
    /// Null where a run has none.
    pub values: Vec<Value>,
}

impl Column {
    /// The name with the unit.
    pub fn title(&self) -> String {
        headed(&self.name, &self.unit)
    }
}

/// What came of all runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Number of the run, the varied keys, status, reason, time and iterations; then what was collected; at last the message
    /// of runs that failed.
    pub columns: Vec<Column>,
    /// How each run ended.
    pub records: Vec<Record>,
    /// Columns before those that were collected.
    pub head: usize,
}

impl Table {
    /// Reads what the runs have recorded.
    ///
    /// # Errors
    /// Files that are damaged; a path that no summary has.
    pub fn new(folder: &SweepFolder, manifest: &Manifest) -> Result<Self, SweepError> {
        let count = manifest.rows.len();
        let column = |name: &str| Column { name: name.into(), unit: String::new(), values: Vec::with_capacity(count) };
        let mut columns = vec![column("run")];
        columns[0].values = (1..=count).map(Value::from).collect();
        for (k, variation) in manifest.vary.iter().enumerate() {
            let value = |row: &Vec<Setting>| match &row[k] {
                Setting::Number(v) => json!(v),
                Setting::Text(text) => json!(text),
            };
            let values = manifest.rows.iter().map(value).collect();
            columns.push(Column { name: variation.key.clone(), unit: variation.unit.clone(), values });
        }
        let first = columns.len();
        columns.extend(["status", "reason", "time", "iterations"].map(column));
        let head = columns.len();
        let (mut records, mut messages) = (Vec::new(), column("message"));
        for index in 0..count {
            let record = folder.record(index)?;
            let summary = match &record {
                Some(record) if !matches!(record.reason.as_str(), "input" | "fault") => summary(folder, index)?,
                _ => None,
            };
            let record = record.unwrap_or_else(|| Record {
                status: Status::Missing,
                reason: String::new(),
                message: String::new(),
            });
            let summary = summary.unwrap_or_default();
            let time = last_state(&summary).map_or(Value::Null, |step| step["time"].clone());
            for (k, value) in
                [json!(record.status.word()), json!(record.reason), time, iterations(&summary)].into_iter().enumerate()
            {
                columns[first + k].values.push(value);
            }
            messages.values.push(json!(record.message));
            records.push(record);
            for (name, value) in collected(&summary, &manifest.collect) {
                let known = columns[head..].iter().position(|c| c.name == name).map(|k| head + k);
                let at = known.unwrap_or_else(|| {
                    columns.push(Column { unit: unit(&summary, &name), ..column(&name) });
                    columns.len() - 1
                });
                columns[at].values.resize(index, Value::Null);
                columns[at].values.push(value);
            }
        }
        columns.iter_mut().for_each(|c| c.values.resize(count, Value::Null));
        let done = records.iter().any(|r| r.status == Status::Done);
        if columns.len() == head && done && !manifest.collect.is_empty() {
            let message = format!("no summary has anything at `{}`", manifest.collect.join("`, `"));
            let help =
                "the runs are kept: call again with other paths; docs/reference.md lists the keys of the summary";
            return Err(CaseError::new(message).help(help).into());
        }
        columns.push(messages);
        Ok(Self { columns, records, head })
    }

    /// Number of runs that ended so.
    pub fn count(&self, status: Status) -> usize {
        self.records.iter().filter(|r| r.status == status).count()
    }

    /// What was collected.
    pub fn collected(&self) -> &[Column] {
        &self.columns[self.head..self.columns.len() - 1]
    }

    /// As CSV, with the units in the header.
    pub fn to_csv(&self) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let text = |v: &Value| match v {
            Value::Null => String::new(),
            Value::String(text) => text.replace('\n', " "),
            Value::Number(n) if n.is_f64() => super::vary::number(n.as_f64().unwrap_or(f64::NAN)),
            other => other.to_string(),
        };
        // Memory takes everything.
        let _ = writer.write_record(self.columns.iter().map(Column::title));
        for row in 0..self.records.len() {
            let _ = writer.write_record(self.columns.iter().map(|c| text(&c.values[row])));
        }
        String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
    }

    /// As JSON: a table of columns for each run, and the units of columns that have one.
    pub fn to_json(&self) -> Value {
        let row = |k: usize| -> Map<String, Value> {
            self.columns.iter().map(|c| (c.name.clone(), c.values[k].clone())).collect()
        };
        let units: Map<String, Value> =
            self.columns.iter().filter(|c| !c.unit.is_empty()).map(|c| (c.name.clone(), json!(c.unit))).collect();
        let columns: Vec<&str> = self.columns.iter().map(|c| c.name.as_str()).collect();
        json!({
            "rows": (0..self.records.len()).map(row).collect::<Vec<_>>(),
            "columns": columns,
            "units": units,
            "done": self.count(Status::Done),
            "failed": self.count(Status::Failed),
            "missing": self.count(Status::Missing),
        })
    }
}

/// The summary of a run; none where it wrote none.
fn summary(folder: &SweepFolder, index: usize) -> Result<Option<Value>, CaseError> {
    let file = folder.run_folder(index).join("summary.json");
    let Ok(text) = std::fs::read_to_string(&file) else { return Ok(None) };
    let damaged = |e: serde_json::Error| {
        let help = format!("remove `{}.json`: the row is run again", folder.run_folder(index).display());
        CaseError::new(format!("`{}` is damaged: {e}", file.display())).help(help)
    };
    serde_json::from_str(&text).map(Some).map_err(damaged)
}

/// Iterations of all increments, or of all paths.
fn iterations(summary: &Value) -> Value {
    let sum = |list: &Value, keys: &[&str]| -> u64 {
        let entries = list.as_array().into_iter().flatten();
        entries.flat_map(|entry| keys.iter().filter_map(|key| entry[*key].as_u64())).sum()
    };
    if summary.is_null() {
        return Value::Null;
    }
    json!(sum(&summary["steps"], &["iterations", "iterations_before"]) + sum(&summary["paths"], &["iterations"]))
}
