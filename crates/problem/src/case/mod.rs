//! Case files: a problem as TOML. Lines and columns are known here alone.

mod origin;
pub mod override_key;
mod reader;
pub mod renamed;
pub mod schema;
mod spans;
pub mod toml_error;

use crate::error::Place;
use crate::source::{Source, Text};
use crate::{CaseError, KeyPath, Problem, walk};
use origin::Origins;
use reader::Wrong;
use spans::Spans;
use std::ops::Range;
use std::sync::Arc;
use toml::de::DeTable;

/// Reads a problem from a text that is called `name`: the path of its file, by which files beside it are found. `overrides`
/// are `KEY=VALUE` pairs that replace or add keys.
///
/// # Errors
/// What is no case, with its place.
pub fn read(name: &str, text: &str, overrides: &[String]) -> Result<Problem, CaseError> {
    let (text, origins) = override_key::apply(name, text, overrides)?;
    let wrong = |e| origins.relocated(toml_error::from_toml(name, &text, &e));
    let table = DeTable::parse(&text).map_err(wrong)?.into_inner();
    let wrong = |e: Wrong| {
        let key = Some(Box::new(e.key())).filter(|key| !key.0.is_empty());
        let told = toml_error::told(name, &text, &e.message, e.span);
        origins.relocated(CaseError { key, ..told })
    };
    let mut problem: Problem = reader::read(table).map_err(wrong)?;
    problem.source = source(name, text, origins);
    Ok(problem)
}

/// The source of a problem that is part of a text, for the places of its errors.
fn source(name: &str, text: String, origins: Origins) -> Source {
    let spans = Spans::of(&text);
    let mut renamed: Vec<_> = origins.renamed.iter().map(|key| (key.line, key.old.clone(), key.new)).collect();
    renamed.sort_unstable();
    let text = CaseText { name: name.to_string(), text, origins, spans };
    Source { name: name.to_string(), text: Some(Arc::new(text)), renamed, ..Source::default() }
}

/// The text of a problem: the one it was read from, or else one that states the same.
pub fn text(problem: &Problem) -> String {
    match &problem.source.text {
        Some(text) => text.text().to_string(),
        None => walk::written(problem).and_then(|tree| toml::to_string(&tree).ok()).unwrap_or_default(),
    }
}

/// The text of a case file, and where its parts were written.
struct CaseText {
    name: String,
    /// With all settings.
    text: String,
    origins: Origins,
    spans: Spans,
}

impl Text for CaseText {
    fn text(&self) -> &str {
        &self.text
    }

    fn place(&self, key: &KeyPath, within: Option<(&str, Range<usize>)>) -> Place {
        let mut span = self.spans.nearest(key);
        // Some bytes of a quoted text, if it stands there without escapes.
        if let Some((text, part)) = within
            && let Some(at) = self.text.get(span.clone()).and_then(|quoted| quoted.find(text))
        {
            let start = span.start + at;
            span = start + part.start..start + part.end.max(part.start);
        }
        self.origins.relocate(Place { name: self.name.clone(), text: self.text.clone(), span })
    }

    fn order(&self, key: &KeyPath) -> usize {
        self.spans.nearest(key).start
    }

    fn line(&self, key: &KeyPath) -> Option<usize> {
        self.origins.line(self.order(key))
    }
}
