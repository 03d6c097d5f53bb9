//! The statement of a problem: the case file, its values and units, and its errors.

pub mod error;
pub mod override_key;
pub mod schema;
pub mod statement;
pub mod units;
pub mod value;

pub use error::{CaseError, suggestion};
pub use statement::Case;
pub use value::{Literal, OneOrMany, Value, Values};

use std::ops::Range;

/// A case file that was read: the statement and its text, to which errors point.
#[derive(Clone, Debug)]
pub struct Document {
    /// What the file is called in messages.
    pub name: String,
    pub text: String,
    pub case: Case,
}

impl Document {
    /// Reads a statement. `overrides` are `KEY=VALUE` pairs that replace or add keys.
    pub fn parse(name: &str, text: &str, overrides: &[String]) -> Result<Self, CaseError> {
        let text = if overrides.is_empty() { text.to_string() } else { override_key::apply(name, text, overrides)? };
        let case: Case = toml::from_str(&text).map_err(|e| error::from_toml(name, &text, &e))?;
        Ok(Self { name: name.to_string(), text, case })
    }

    /// The line of a byte, from one.
    pub fn line_of(&self, byte: usize) -> usize {
        self.text.as_bytes().iter().take(byte).filter(|b| **b == b'\n').count() + 1
    }

    /// An error at a place of this file.
    pub fn error(&self, span: Range<usize>, message: impl Into<String>) -> CaseError {
        CaseError::new(message).at(&self.name, &self.text, span)
    }
}
