//! Cards of an input deck of CalculiX or Abaqus: a keyword with its parameters, and lines of data.

use crate::ImportError;
use std::path::Path;
use std::sync::Arc;

/// How deep files may include each other.
const DEEPEST: usize = 20;

/// A line of data.
#[derive(Clone, Debug)]
pub(super) struct Data {
    file: Arc<Path>,
    pub(super) line: usize,
    pub(super) fields: Vec<String>,
}

/// A keyword with its parameters and data.
#[derive(Clone, Debug)]
pub(super) struct Card {
    file: Arc<Path>,
    pub(super) line: usize,
    /// As it is written, in capitals, with single spaces.
    pub(super) keyword: String,
    /// Names in capitals, and values as they are written.
    pub(super) parameters: Vec<(String, Option<String>)>,
    pub(super) data: Vec<Data>,
}

/// All cards of a file and of the files that it includes.
pub(super) fn cards(file: &Path) -> Result<Vec<Card>, ImportError> {
    let mut out = Vec::new();
    add(file, 0, &mut out)?;
    Ok(out)
}

/// Adds the cards of a file. An included file may begin with data of the card before it.
fn add(path: &Path, depth: usize, out: &mut Vec<Card>) -> Result<(), ImportError> {
    let wrong = |line: Option<usize>, message: String| ImportError::new(path, line, message);
    let bytes = std::fs::read(path).map_err(|e| wrong(None, format!("cannot be read: {e}")))?;
    let text = String::from_utf8_lossy(&bytes);
    let file: Arc<Path> = Arc::from(path);
    let mut lines = text.lines().enumerate().map(|(k, l)| (k + 1, l.trim())).filter(|(_, l)| !l.starts_with("**"));
    while let Some((line, text)) = lines.next() {
        if text.is_empty() {
            continue;
        }
        let Some(keyword) = text.strip_prefix('*') else {
            let fields = text.split(',').map(|f| f.trim().to_string()).collect();
            let none = || wrong(Some(line), "data before the first keyword".into());
            out.last_mut().ok_or_else(none)?.data.push(Data { file: Arc::clone(&file), line, fields });
            continue;
        };
        // A keyword goes on in the next line after a comma.
        let mut whole = keyword.to_string();
        while whole.trim_end().ends_with(',') {
            let Some((_, more)) = lines.next() else { break };
            whole.push_str(more);
        }
        let mut parts = whole.split(',').map(str::trim);
        let keyword = squeezed(parts.next().unwrap_or_default());
        let parameters: Vec<(String, Option<String>)> = parts
            .filter(|p| !p.is_empty())
            .map(|p| match p.split_once('=') {
                Some((name, value)) => (squeezed(name), Some(value.trim().trim_matches('"').to_string())),
                None => (squeezed(p), None),
            })
            .collect();
        let card = Card { file: Arc::clone(&file), line, keyword, parameters, data: Vec::new() };
        if card.name() != "INCLUDE" {
            out.push(card);
            continue;
        }
        let input = card.required("INPUT")?;
        if depth >= DEEPEST {
            return Err(card.wrong(None, format!("`{input}`: files include each other more than {DEEPEST} deep")));
        }
        let included = path.parent().unwrap_or(Path::new("")).join(input);
        if !included.is_file() {
            return Err(card.wrong(None, format!("there is no file `{}`", included.display())));
        }
        add(&included, depth + 1, out)?;
    }
    Ok(())
}

/// In capitals, without blanks around and with single ones within.
fn squeezed(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").to_uppercase()
}

impl Card {
    /// The keyword in capitals without blanks, as CalculiX compares it.
    pub(super) fn name(&self) -> String {
        self.keyword.replace(' ', "")
    }

    /// The value of a parameter.
    pub(super) fn value(&self, name: &str) -> Option<&str> {
        self.parameters.iter().find(|(n, _)| n.replace([' ', '-'], "") == name).and_then(|(_, v)| v.as_deref())
    }

    /// Whether a parameter is there, with or without a value.
    pub(super) fn has(&self, name: &str) -> bool {
        self.parameters.iter().any(|(n, _)| n.replace([' ', '-'], "") == name)
    }

    pub(super) fn required(&self, name: &str) -> Result<&str, ImportError> {
        self.value(name).ok_or_else(|| self.wrong(None, format!("the parameter {name} is missing")))
    }

    /// What is wrong with the card, at a line of its data or at its keyword.
    pub(super) fn wrong<'a>(&self, data: impl Into<Option<&'a Data>>, message: impl Into<String>) -> ImportError {
        let (file, line) = data.into().map_or((&self.file, self.line), |d| (&d.file, d.line));
        ImportError::new(file, line, format!("*{}: {}", self.keyword, message.into()))
    }

    /// A number of a line of data; `None` where the field is empty.
    pub(super) fn number(&self, data: &Data, field: usize) -> Result<Option<f64>, ImportError> {
        let Some(text) = data.fields.get(field).filter(|t| !t.is_empty()) else { return Ok(None) };
        // Fortran writes exponents with a D.
        let none = || self.wrong(data, format!("expected a number, found `{text}`"));
        let number: f64 = text.replace(['d', 'D'], "e").parse().map_err(|_| none())?;
        if number.is_finite() { Ok(Some(number)) } else { Err(none()) }
    }

    pub(super) fn required_number(&self, data: &Data, field: usize, what: &str) -> Result<f64, ImportError> {
        self.number(data, field)?.ok_or_else(|| self.wrong(data, format!("{what} is missing")))
    }

    /// All numbers of the data, line after line.
    pub(super) fn numbers(&self) -> Result<Vec<f64>, ImportError> {
        let mut out = Vec::new();
        for data in &self.data {
            for field in 0..data.fields.len() {
                out.extend(self.number(data, field)?);
            }
        }
        Ok(out)
    }

    /// A whole number that counts nodes or elements.
    pub(super) fn whole(&self, data: &Data, field: usize, what: &str) -> Result<u64, ImportError> {
        let text = data.fields.get(field).map_or("", String::as_str);
        text.parse().map_err(|_| self.wrong(data, format!("expected {what}, found `{text}`")))
    }

    /// The parameters other than the known ones.
    pub(super) fn unknown(&self, known: &[&str]) -> Vec<String> {
        let plain = |n: &str| n.replace([' ', '-'], "");
        let names = self.parameters.iter().map(|(n, _)| n);
        names.filter(|n| !known.contains(&plain(n).as_str())).cloned().collect()
    }
}
