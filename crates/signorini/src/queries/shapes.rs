//! The shapes of a file of queries: those with names, and unnamed ones that come again and again.
//!
//! What is computed once per shape (bounds of its pieces, the tree of a mesh) costs up to a thousand times a search. A
//! shape that is written several times within a batch of queries, in the same characters, is therefore built once and
//! kept for the queries that follow.

use super::fields::FieldError;
use super::geometry;
use super::object::Object;
use super::scanner::LARGEST_CASE;
use crate::problem::suggestion;
use rayon::prelude::*;
use serde_json::Value;
use signorini_geometry::shape::Shape;
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The most unnamed shapes that are kept. Together their texts are no longer than one query may be.
pub const KEPT: usize = 64;

type Built = Result<Arc<Shape>, FieldError>;

/// All shapes that are there before a query is answered.
pub struct Shapes {
    /// Where files are looked for.
    folder: PathBuf,
    named: BTreeMap<String, Arc<Shape>>,
    /// Unnamed shapes by their text, the last used first.
    kept: Vec<(Box<str>, Built)>,
}

impl Shapes {
    /// No shapes; files that shapes name are looked for in `folder`.
    pub fn new(folder: &Path) -> Self {
        Shapes { folder: folder.to_path_buf(), named: BTreeMap::new(), kept: Vec::new() }
    }

    /// How many unnamed shapes are kept.
    pub fn kept(&self) -> usize {
        self.kept.len()
    }

    /// Builds the shapes of an object `{NAME: SHAPE, ...}`.
    ///
    /// # Errors
    /// What is no such object, or the first shape that is wrong.
    pub fn name(&mut self, text: &[u8]) -> Result<(), FieldError> {
        let object = Object::parse(text).map_err(|e| e.within("shapes"))?;
        let build = |(name, shape): &(String, &serde_json::value::RawValue)| {
            let shape = build(shape.get(), &self.folder).map_err(|e| e.within(name).within("shapes"))?;
            Ok((name.clone(), Arc::new(shape)))
        };
        self.named = object.entries.par_iter().map(build).collect::<Vec<_>>().into_iter().collect::<Result<_, _>>()?;
        Ok(())
    }

    /// Builds what the texts of partners have in common, and forgets what was used longest ago.
    pub fn prepare<'a>(&mut self, texts: impl Iterator<Item = &'a str>) {
        let mut counts: HashMap<&str, usize> = HashMap::new();
        let mut again: Vec<&str> = Vec::new();
        let mut in_use = 0;
        for text in texts.filter(|t| !is_name(t)) {
            if let Some(k) = self.kept.iter().position(|(kept, _)| **kept == *text) {
                in_use = in_use.max(k + 1);
                self.kept[..=k].rotate_right(1);
                continue;
            }
            let count = counts.entry(text).or_default();
            *count += 1;
            if *count == 2 {
                again.push(text);
            }
        }
        again.truncate(KEPT);
        let built: Vec<Built> = again.par_iter().map(|text| build(text, &self.folder).map(Arc::new)).collect();
        self.kept.splice(0..0, again.into_iter().map(Box::from).zip(built));
        self.kept.truncate(KEPT);
        let lengths = self.kept.iter().scan(0, |sum, (text, _)| {
            *sum += text.len();
            Some(*sum)
        });
        let fitting = lengths.take_while(|sum| *sum <= LARGEST_CASE).count();
        self.kept.truncate(fitting);
    }

    /// The partner of a query: a shape that is there, or one that is built now.
    ///
    /// # Errors
    /// What is wrong with the shape, or that none has this name.
    pub fn partner(&self, text: &str) -> Built {
        if is_name(text) {
            let message = |e: serde_json::Error| FieldError { path: String::new(), message: format!("not JSON: {e}") };
            let name: String = serde_json::from_str(text).map_err(message)?;
            return self.named.get(&name).cloned().ok_or_else(|| self.unknown(&name));
        }
        match self.kept.iter().find(|(kept, _)| **kept == *text) {
            Some((_, built)) => built.clone(),
            None => build(text, &self.folder).map(Arc::new),
        }
    }

    fn unknown(&self, name: &str) -> FieldError {
        let names: Vec<&str> = self.named.keys().map(String::as_str).collect();
        let known = if names.is_empty() { "the file has no `shapes`".into() } else { suggestion(name, &names) };
        FieldError { path: String::new(), message: format!("no shape is called `{name}`: {known}") }
    }
}

/// Whether a partner is the name of a shape.
fn is_name(text: &str) -> bool {
    text.starts_with('"')
}

/// Builds a shape from its text.
pub fn build(text: &str, folder: &Path) -> Result<Shape, FieldError> {
    let value: Value = serde_json::from_str(text)
        .map_err(|e| FieldError { path: String::new(), message: format!("not JSON: {e}") })?;
    geometry::shape("", &value, folder)
}
