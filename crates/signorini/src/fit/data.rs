//! Measurements from a text table with a row of names.

use crate::problem::Fit;
use crate::problem::{CaseError, Problem, suggestion};
use crate::text_table::{self, Numbers, Row};

/// Times and what was measured then.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurements {
    pub time: Vec<f64>,
    pub value: Vec<f64>,
    /// Names of the two columns.
    pub names: [String; 2],
}

/// Reads the two columns that a case names.
pub(super) fn read(problem: &Problem, key: &Fit, column: &String) -> Result<Measurements, CaseError> {
    let path = problem.source.folder().join(&key.data);
    let told = |message: String| problem.error(&key.data, format!("`{}`: {message}", path.display()));
    let bytes = problem.source.read(&key.data).map_err(|e| told(format!("{e}")))?;
    let rows = text_table::rows(&bytes).map_err(told)?;
    let Some((header, rows)) = rows.split_first() else { return Err(told("is empty".into())) };
    let names: Vec<&str> = header.entries.iter().collect();
    let find = |name: &String| {
        let matching: Vec<usize> = (0..names.len()).filter(|&i| names[i] == name).collect();
        match matching[..] {
            [one] => Ok(one),
            [] => Err(problem
                .error(name, format!("`{}` has no column `{}`", path.display(), name))
                .help(suggestion(name, &names))),
            _ => Err(problem.error(name, format!("`{}` has two columns called `{}`", path.display(), name))),
        }
    };
    let columns = [find(&key.time)?, find(column)?];
    let mut found = [Vec::new(), Vec::new()];
    let mut numbers = Numbers::default();
    for Row { line, entries } in rows {
        if entries.len() != names.len() {
            let message = format!("line {line}: {} entries under {} names", entries.len(), names.len());
            return Err(told(message).help("use a decimal point, and put texts with commas in quotes"));
        }
        for (list, &k) in found.iter_mut().zip(&columns) {
            let place = format!("line {line}, column `{}`", names[k]);
            let value = match numbers.read(*line, &entries[k]) {
                Err(what) if entries[k].is_empty() => {
                    return Err(told(format!("{place}: {what}")).help("delete the line, or give the value"));
                }
                read => read.map_err(|what| told(format!("{place}: {what}")))?,
            };
            if !value.is_finite() {
                return Err(told(format!("{place}: {value} is not finite")));
            }
            list.push(value);
        }
    }
    numbers.finish().map_err(told)?;
    let [time, value] = found;
    if time.is_empty() {
        return Err(told("contains no measurements".into()));
    }
    Ok(Measurements { time, value, names: columns.map(|k| names[k].to_string()) })
}
