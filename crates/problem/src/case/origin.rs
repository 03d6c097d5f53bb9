//! Where the parts of a case text come from: the file, a key of it that has another name now, or a `--set` on the command line.

use super::renamed::Renamed;
use crate::CaseError;
use crate::error::Place;
use std::ops::Range;
use toml_edit::{Document, TableLike};

/// A case text with present keys and its settings, and what is needed to tell where each part was written.
#[derive(Clone, Debug, Default)]
pub struct Origins {
    /// The text of the file.
    file: String,
    edits: Vec<Edit>,
    /// The keys that were renamed.
    pub renamed: Vec<Renamed>,
    /// Places of the keys that were set and of their values in the text with all settings.
    set: Vec<(Range<usize>, String)>,
}

/// What one setting changed, or one key that was renamed; in bytes of the text before it and after it.
#[derive(Clone, Debug)]
struct Edit {
    setting: Option<String>,
    before: Range<usize>,
    after: Range<usize>,
}

/// Where a byte of the text comes from.
enum Origin<'a> {
    File(usize),
    Setting(&'a str),
}

impl Origins {
    /// The origins of a text that nothing was set in.
    pub fn of_file(text: &str) -> Self {
        Self { file: text.into(), ..Self::default() }
    }

    /// Takes into account that a setting made one text of another.
    pub fn set(&mut self, setting: &str, [before, after]: [&str; 2]) {
        let [a, b] = [before, after].map(str::as_bytes);
        let start = a.iter().zip(b).take_while(|(a, b)| a == b).count();
        let most = a.len().min(b.len()) - start;
        let end = a.iter().rev().zip(b.iter().rev()).take(most).take_while(|(a, b)| a == b).count();
        self.edits.push(Edit {
            setting: Some(setting.into()),
            before: start..a.len() - end,
            after: start..b.len() - end,
        });
    }

    /// Takes into account that keys of a text were renamed, in this order.
    pub fn rename(&mut self, renamed: Vec<Renamed>) {
        for Renamed { span, with, .. } in &renamed {
            self.edits.push(Edit { setting: None, before: span.clone(), after: span.start..span.start + with.len() });
        }
        self.renamed.extend(renamed);
    }

    /// Finds the keys that were set in the text with all settings.
    pub fn finish(&mut self, text: &str) {
        let Ok(document) = Document::parse(text) else { return };
        self.set = (self.edits.iter())
            .filter_map(|edit| {
                let setting = edit.setting.as_ref()?;
                let key: Vec<&str> = setting.split_once('=')?.0.split('.').map(str::trim).collect();
                Some((place_of(document.as_table(), &key)?, setting.clone()))
            })
            .collect();
    }

    fn of(&self, mut at: usize) -> Origin<'_> {
        if let Some((_, setting)) = self.set.iter().rev().find(|(place, _)| place.contains(&at)) {
            return Origin::Setting(setting);
        }
        for edit in self.edits.iter().rev() {
            if edit.after.contains(&at) {
                match &edit.setting {
                    Some(setting) => return Origin::Setting(setting),
                    None => at = edit.before.start,
                }
            } else if at >= edit.after.end {
                at = at - edit.after.end + edit.before.end;
            }
        }
        Origin::File(at)
    }

    /// The line of the file that a byte of the text comes from, from one; none for what was set.
    pub fn line(&self, byte: usize) -> Option<usize> {
        match self.of(byte) {
            Origin::File(at) => Some(self.file.as_bytes().iter().take(at).filter(|b| **b == b'\n').count() + 1),
            Origin::Setting(_) => None,
        }
    }

    /// An error at a place of the text, told at the place where that was written.
    pub fn relocated(&self, mut error: CaseError) -> CaseError {
        error.place = error.place.map(|place| self.relocate(place));
        error
    }

    /// A place of the text, where it was written.
    pub fn relocate(&self, place: Place) -> Place {
        match self.of(place.span.start) {
            Origin::Setting(setting) => {
                let part = place.text.get(place.span).unwrap_or("").trim_matches(['"', '\'']);
                let start = if part.is_empty() { None } else { setting.find(part) };
                let span = start.map_or(0..setting.len(), |start| start..start + part.len());
                Place { name: "--set".into(), text: setting.into(), span }
            }
            Origin::File(start) => {
                let end = match self.of(place.span.end) {
                    Origin::File(end) => end.max(start),
                    Origin::Setting(_) => start,
                };
                Place { text: self.file.clone(), span: start..end, ..place }
            }
        }
    }
}

/// The place of a key of a parsed table, with its value.
fn place_of(table: &dyn TableLike, key: &[&str]) -> Option<Range<usize>> {
    let (first, rest) = key.split_first()?;
    let (name, item) = table.get_key_value(first)?;
    match (item.as_array_of_tables(), rest) {
        (_, []) => Some(name.span()?.start..item.span()?.end),
        (Some(list), [index, rest @ ..]) => place_of(list.get(index.parse().ok()?)?, rest),
        _ => place_of(item.as_table_like()?, rest),
    }
}
