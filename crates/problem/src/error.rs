//! Errors of a problem: what is wrong, where, and what would be right.

use crate::KeyPath;
use std::ops::Range;

/// An error in a problem.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{message}")]
pub struct CaseError {
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// The key that contains the error.
    pub key: Option<Box<KeyPath>>,
    /// Where: file, its text, and the bytes.
    pub place: Option<Place>,
}

/// A place in a text.
#[derive(Clone, Debug)]
pub struct Place {
    pub name: String,
    pub text: String,
    pub span: Range<usize>,
}

impl Place {
    /// Line and column, from one, in characters.
    pub fn line_and_column(&self) -> (usize, usize) {
        let mut end = self.span.start.min(self.text.len());
        while !self.text.is_char_boundary(end) {
            end -= 1;
        }
        let before = &self.text[..end];
        let line = before.matches('\n').count() + 1;
        (line, before.chars().rev().take_while(|c| *c != '\n').count() + 1)
    }
}

impl CaseError {
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), help: None, key: None, place: None }
    }

    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Says what to do where nothing is said yet.
    pub fn or_help(mut self, help: impl Into<String>) -> Self {
        self.help.get_or_insert_with(|| help.into());
        self
    }

    pub fn at(mut self, name: &str, text: &str, span: Range<usize>) -> Self {
        self.place = Some(Place { name: name.into(), text: text.into(), span });
        self
    }

    /// File, line, column and message in one line.
    pub fn one_line(&self) -> String {
        match &self.place {
            Some(place) => {
                let (line, column) = place.line_and_column();
                format!("{}:{line}:{column}: {}", place.name, self.message)
            }
            None => match &self.key {
                Some(key) if !key.0.is_empty() => format!("{key}: {}", self.message),
                _ => self.message.clone(),
            },
        }
    }
}

impl miette::Diagnostic for CaseError {
    fn help<'a>(&'a self) -> Option<Box<dyn std::fmt::Display + 'a>> {
        self.help.as_ref().map(|h| Box::new(h) as _)
    }

    fn source_code(&self) -> Option<&dyn miette::SourceCode> {
        self.place.as_ref().map(|p| p as _)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = miette::LabeledSpan> + '_>> {
        let place = self.place.as_ref()?;
        let end = place.span.end.min(place.text.len());
        let start = place.span.start.min(end);
        Some(Box::new(std::iter::once(miette::LabeledSpan::new_with_span(Some("here".into()), start..end))))
    }
}

impl miette::SourceCode for Place {
    fn read_span<'a>(
        &'a self,
        span: &miette::SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn miette::SpanContents<'a> + 'a>, miette::MietteError> {
        let inner = self.text.read_span(span, before, after)?;
        Ok(Box::new(miette::MietteSpanContents::new_named(
            self.name.clone(),
            inner.data(),
            *inner.span(),
            inner.line(),
            inner.column(),
            inner.line_count(),
        )))
    }
}
