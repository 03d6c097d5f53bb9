//! Measurements from a CSV file.

use crate::case::statement::FitKey;
use crate::case::{CaseError, Document, suggestion};
use std::path::Path;
use toml::Spanned;

/// Times and what was measured then.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurements {
    pub time: Vec<f64>,
    pub value: Vec<f64>,
    /// Names of the two columns.
    pub names: [String; 2],
}

/// Reads the two columns that a case names.
pub(super) fn read(document: &Document, key: &FitKey, column: &Spanned<String>) -> Result<Measurements, CaseError> {
    let beside = Path::new(&document.name).parent().unwrap_or(Path::new(""));
    let path = beside.join(key.data.get_ref());
    let told = |message: String| document.error(key.data.span(), format!("`{}`: {message}", path.display()));
    let bytes = std::fs::read(&path).map_err(|e| told(format!("{e}")))?;
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(bytes.as_slice());
    let header = reader.headers().map_err(|e| told(format!("{e}")))?.clone();
    let names: Vec<&str> = header.iter().collect();
    let find = |name: &Spanned<String>| {
        let matching: Vec<usize> = (0..names.len()).filter(|&i| names[i] == name.get_ref()).collect();
        match matching[..] {
            [one] => Ok(one),
            [] => Err(document
                .error(name.span(), format!("`{}` has no column `{}`", path.display(), name.get_ref()))
                .help(suggestion(name.get_ref(), &names))),
            _ => Err(document
                .error(name.span(), format!("`{}` has two columns called `{}`", path.display(), name.get_ref()))),
        }
    };
    let columns = [find(&key.time)?, find(column)?];
    let mut found = [Vec::new(), Vec::new()];
    for record in reader.records() {
        let record = record.map_err(|e| told(format!("{e}")))?;
        let line = record.position().map_or(0, |p| p.line());
        for (list, &k) in found.iter_mut().zip(&columns) {
            let text = record.get(k).unwrap_or("");
            let place = format!("line {line}, column `{}`", names[k]);
            let value: f64 = match text {
                "" => return Err(told(format!("{place}: is empty")).help("delete the line, or give the value")),
                text => text.parse().map_err(|_| told(format!("{place}: `{text}` is no number")))?,
            };
            if !value.is_finite() {
                return Err(told(format!("{place}: {value} is not finite")));
            }
            list.push(value);
        }
    }
    let [time, value] = found;
    if time.is_empty() {
        return Err(told("holds no measurements".into()));
    }
    Ok(Measurements { time, value, names: columns.map(|k| names[k].to_string()) })
}
