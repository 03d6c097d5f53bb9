//! What is varied: `KEY=FROM:TO:COUNT`, `KEY=FROM:TO:COUNT:log` or `KEY=a,b,c`.

use crate::problem::CaseError;
use crate::report::headed;
use serde::{Deserialize, Serialize};

/// How the values of a key are written, for advice.
const FORMS: &str = "write KEY=FROM:TO:COUNT, KEY=FROM:TO:COUNT:log, or KEY=a,b,c";
/// Digits of values of a range: those of rounding are dropped.
const DIGITS: usize = 14;

/// A key and its values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Variation {
    /// The key, as `--set` takes it.
    pub key: String,
    /// The unit of all values, where they are numbers with one.
    pub unit: String,
    /// The values.
    pub values: Values,
}

/// Values of a key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Values {
    /// From one number to another.
    Range {
        from: f64,
        to: f64,
        /// Number of values; none where a sample decides.
        count: Option<usize>,
        /// Whether equal steps are equal factors.
        log: bool,
    },
    /// One by one.
    List(Vec<Setting>),
}

/// A value of a key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Setting {
    Number(f64),
    Text(String),
}

impl Setting {
    /// As it is written in a setting, in a unit.
    pub fn written(&self, unit: &str) -> String {
        match (self, unit) {
            (Setting::Number(v), "") => number(*v),
            (Setting::Number(v), unit) => format!("{} {unit}", number(*v)),
            (Setting::Text(text), _) => text.clone(),
        }
    }
}

/// A number, whole ones without a point.
pub fn number(v: f64) -> String {
    if v.fract() == 0.0 && v.abs() < 1e15 { format!("{v:.0}") } else { format!("{v:?}") }
}

impl Variation {
    /// Reads `KEY=VALUES`.
    ///
    /// # Errors
    /// What is wrong with it, at its place.
    pub fn parse(text: &str) -> Result<Self, CaseError> {
        let wrong = |message: String, part: &str| {
            let start = text.find(part).unwrap_or(0);
            CaseError::new(message).help(FORMS).at("--vary", text, start..start + part.len())
        };
        let (key, stated) = text.split_once('=').ok_or_else(|| wrong(format!("`{text}` contains no `=`"), text))?;
        let (key, stated) = (key.trim(), stated.trim());
        if key.is_empty() || key.split('.').any(|part| part.trim().is_empty()) {
            return Err(wrong(format!("`{key}` is not a key"), key));
        }
        if stated.is_empty() {
            return Err(wrong(format!("`{key}` has no values"), text));
        }
        let parts = split(stated, ':');
        // Names of sides contain colons too.
        let counts = |part: &&str| part.parse::<usize>().is_ok();
        let is_range = parts.len() > 1 && (quantity(parts[0]).is_some() || parts.get(2).is_some_and(counts));
        if is_range {
            let (unit, values) = range(&parts).map_err(|(message, part)| wrong(format!("`{key}`: {message}"), part))?;
            return Ok(Self { key: key.into(), unit, values });
        }
        let entries = split(stated, ',');
        if entries.iter().any(|entry| entry.is_empty()) {
            return Err(wrong(format!("`{key}` has an empty value"), stated));
        }
        if let Some(entry) = entries.iter().find(|e| e.parse::<f64>().is_ok_and(|v| !v.is_finite())) {
            return Err(wrong(format!("`{key}`: `{entry}` is not a finite number"), entry));
        }
        Ok(Self::list(key, &entries))
    }

    /// A list of values; numbers with one and the same unit are numbers.
    pub fn list(key: &str, entries: &[&str]) -> Self {
        let numbers: Option<Vec<(f64, &str)>> = entries.iter().map(|e| quantity(e)).collect();
        let one_unit = |list: &Vec<(f64, &str)>| list.iter().all(|(_, unit)| *unit == list[0].1);
        let key = key.to_string();
        match numbers.filter(one_unit) {
            Some(list) if !list.is_empty() => {
                let values = list.iter().map(|(v, _)| Setting::Number(*v)).collect();
                Self { key, unit: list[0].1.into(), values: Values::List(values) }
            }
            _ => {
                let values = entries.iter().map(|e| Setting::Text(e.to_string())).collect();
                Self { key, unit: String::new(), values: Values::List(values) }
            }
        }
    }

    /// Number of the values, for a grid.
    ///
    /// # Errors
    /// A range without a number of values.
    pub fn count(&self) -> Result<usize, CaseError> {
        match &self.values {
            Values::List(list) => Ok(list.len()),
            Values::Range { count: Some(count), .. } => Ok(*count),
            Values::Range { count: None, .. } => {
                let message = format!("`{}`: a grid needs the number of values", self.key);
                Err(CaseError::new(message).help("write KEY=FROM:TO:COUNT, or sample the ranges with --sample N"))
            }
        }
    }

    /// All values, for a grid.
    ///
    /// # Errors
    /// A range without a number of values.
    pub fn grid(&self) -> Result<Vec<Setting>, CaseError> {
        let count = self.count()?;
        Ok(match &self.values {
            Values::List(list) => list.clone(),
            Values::Range { .. } => {
                let last = count.saturating_sub(1).max(1) as f64;
                (0..count).map(|k| self.at(k as f64 / last)).collect()
            }
        })
    }

    /// The value at a share in [0, 1] of the way from the first to the last.
    pub fn at(&self, share: f64) -> Setting {
        match &self.values {
            Values::List(list) => {
                let index = (share * list.len() as f64) as usize;
                list[index.min(list.len() - 1)].clone()
            }
            Values::Range { from, to, log, .. } => Setting::Number(match share {
                0.0 => *from,
                1.0 => *to,
                share if *log => rounded(from * (to / from).powf(share)),
                share => rounded(from + (to - from) * share),
            }),
        }
    }

    /// Whether all values are numbers.
    pub fn is_numeric(&self) -> bool {
        match &self.values {
            Values::Range { .. } => true,
            Values::List(list) => list.iter().all(|v| matches!(v, Setting::Number(_))),
        }
    }

    /// Whether equal steps are equal factors.
    pub fn is_log(&self) -> bool {
        matches!(self.values, Values::Range { log: true, .. })
    }

    /// The key with its unit.
    pub fn title(&self) -> String {
        headed(&self.key, &self.unit)
    }
}

/// A number without the digits of rounding.
fn rounded(v: f64) -> f64 {
    format!("{v:.DIGITS$e}").parse().unwrap_or(v)
}

/// Unit and values of a range, from its parts; else the message, and the part that is wrong.
fn range<'a>(parts: &[&'a str]) -> Result<(String, Values), (String, &'a str)> {
    let end = |part: &'a str| match quantity(part) {
        Some((v, unit)) if v.is_finite() => Ok((v, unit)),
        _ => Err((format!("`{part}` is not a finite number"), part)),
    };
    let ((from, a), (to, b)) = (end(parts[0])?, end(parts[1])?);
    // One unit may stand for both.
    let unit =
        if a.is_empty() || a == b { b } else { return Err((format!("`{a}` and `{b}` are two units"), parts[1])) };
    let (count, rest) = match parts.get(2) {
        None => (None, &parts[2..]),
        Some(&"log") => (None, &parts[2..]),
        Some(part) => match part.parse::<usize>() {
            Ok(0) => return Err(("0 is no number of values: give 1 or more".into(), part)),
            Ok(count) => (Some(count), &parts[3..]),
            Err(_) => return Err((format!("`{part}` is not a number of values"), part)),
        },
    };
    let log = match rest {
        [] => false,
        ["log"] => true,
        [other, ..] => return Err((format!("`{other}` is not `log`"), other)),
    };
    if log && (from * to <= 0.0 || from == 0.0) {
        let message = format!("a logarithmic range from {} to {} meets zero", number(from), number(to));
        return Err((message, if from == 0.0 { parts[0] } else { parts[1] }));
    }
    Ok((unit.into(), Values::Range { from, to, count, log }))
}

/// A number and its unit, which may be empty.
fn quantity(text: &str) -> Option<(f64, &str)> {
    let text = text.trim().trim_matches('"');
    let (number, unit) = text.split_once(' ').unwrap_or((text, ""));
    let unit = unit.trim();
    // An expression is no unit.
    if !unit.is_empty() && !unit.starts_with(|c: char| c.is_alphabetic() || c == '%' || c == '°') {
        return None;
    }
    // Words such as `inf` begin with a letter.
    let v: f64 = number.parse().ok()?;
    Some((v, unit))
}

/// Parts of a text between separators outside of quotes and brackets, without the blanks around them.
fn split(text: &str, at: char) -> Vec<&str> {
    let (mut parts, mut start, mut depth, mut quote) = (Vec::new(), 0, 0i32, None);
    for (k, c) in text.char_indices() {
        match (quote, c) {
            (Some(q), c) if c == q => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, '(' | '[' | '{') => depth += 1,
            (None, ')' | ']' | '}') => depth -= 1,
            (None, c) if c == at && depth == 0 => {
                parts.push(text[start..k].trim());
                start = k + c.len_utf8();
            }
            _ => {}
        }
    }
    parts.push(text[start..].trim());
    parts
}
