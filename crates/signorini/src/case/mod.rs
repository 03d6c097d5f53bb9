//! The statement of a problem: the case file, its values and units, and its errors.

pub mod error;
mod origin;
pub mod override_key;
pub mod schema;
pub mod statement;
pub mod units;
pub mod value;

pub use error::{CaseError, suggestion};
pub use origin::Origins;
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
    /// Where the parts of the text were written.
    origins: Origins,
}

impl Document {
    /// Reads a statement. `overrides` are `KEY=VALUE` pairs that replace or add keys.
    pub fn parse(name: &str, text: &str, overrides: &[String]) -> Result<Self, CaseError> {
        let (text, origins) = override_key::apply(name, text, overrides)?;
        let case: Case = toml::from_str(&text).map_err(|e| origins.relocated(error::from_toml(name, &text, &e)))?;
        Ok(Self { name: name.to_string(), text, case, origins })
    }

    /// The line of the file that a byte of the text comes from, from one; none for what `--set` says.
    pub fn line_of(&self, byte: usize) -> Option<usize> {
        self.origins.line(byte)
    }

    /// An error at a place of this file.
    pub fn error(&self, span: Range<usize>, message: impl Into<String>) -> CaseError {
        self.origins.relocated(CaseError::new(message).at(&self.name, &self.text, span))
    }
}
