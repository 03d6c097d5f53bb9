//! A problem as Python states it.

use crate::errors::Failure;
use crate::node::{self, Node};
use pyo3::prelude::*;
use pyo3::types::PyString;
use signorini::case::{self, toml_error};
use signorini::problem::{CaseError, Problem};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A problem as it is stated: the text of a case file, or a table.
pub struct Stated {
    name: String,
    how: How,
    settings: Vec<String>,
    files: BTreeMap<String, Vec<u8>>,
}

enum How {
    Text(String),
    Table(Node),
}

impl Stated {
    /// # Errors
    /// A value that no case has.
    pub fn of(
        name: String,
        stated: &Bound<'_, PyAny>,
        settings: Vec<String>,
        files: BTreeMap<String, Vec<u8>>,
    ) -> PyResult<Self> {
        let how = match stated.cast::<PyString>() {
            Ok(text) => How::Text(text.extract()?),
            Err(_) => How::Table(Node::of(stated)?),
        };
        Ok(Self { name, how, settings, files })
    }

    /// The problem.
    ///
    /// # Errors
    /// What is wrong with it, by its key.
    pub fn problem(&self) -> Result<Problem, Failure> {
        let mut problem = match &self.how {
            How::Text(text) => case::read(&self.name, text, &self.settings)?,
            How::Table(node) => {
                let mut problem: Problem = node::read(node.clone()).map_err(|wrong| {
                    let told = toml_error::in_plain_words(&wrong.message);
                    let message = match told.message.strip_prefix("unknown key ") {
                        Some(word) if wrong.is_word => format!("unknown word {word}"),
                        _ => told.message,
                    };
                    CaseError { message, key: Some(Box::new(wrong.key())), ..told }
                })?;
                problem.source.name.clone_from(&self.name);
                problem
            }
        };
        problem.source.files = Arc::new(self.files.clone());
        Ok(problem)
    }
}
