//! Keys and words of earlier versions. They are still read; `signorini migrate` rewrites them.

use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// The earlier path of a key, and the present name of its last part. `*` stands for one part, `**` for any number of them, `FILE`
/// for one of `FILES`. A word in quotes that chooses is the last part of its path.
const RENAMED: [(&str, &str); 11] = [
    ("bodies.*.cells.fictitious", "alpha"),
    ("bodies.*.rigid.lies", "side"),
    ("bodies.*.rope.winch.paid_out", "length"),
    ("contacts.*.method.**.wanted_penetration", "penetration"),
    ("contacts.*.method.discrete_cell", "discs"),
    ("contacts.*.within", "self_contact"),
    ("supports.*.uniform", "tied"),
    ("bodies.**.FILE.move", "translate"),
    ("bodies.**.FILE.turn", "rotate"),
    ("ropes.**.FILE.move", "translate"),
    ("ropes.**.FILE.turn", "rotate"),
];

/// Kinds of files whose content is placed by keys.
const FILES: [&str; 5] = ["file", "gmsh", "height_map", "nurbs", "stl"];

/// A key or word of an earlier version.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Renamed {
    pub old: String,
    pub new: &'static str,
    /// The line of the text, from one.
    pub line: usize,
    /// Its place in the text: all of it that is replaced.
    pub span: Range<usize>,
    /// What replaces it there.
    pub with: String,
}

/// A text with the present keys, and what was renamed in it. Everything else stays as it is. A text that is no TOML is returned
/// unchanged.
pub fn modernised(text: &str) -> (String, Vec<Renamed>) {
    let (mut text, mut all) = (text.to_string(), Vec::new());
    // A table may be opened by several headers, of which a parsed table knows one: each pass renames one of them.
    loop {
        let mut found = Vec::new();
        if let Ok(table) = DeTable::parse(&text) {
            of_table(table.get_ref(), &mut Vec::new(), &mut found);
        }
        if found.is_empty() {
            return (text, all);
        }
        found.sort_by_key(|renamed| std::cmp::Reverse(renamed.span.start));
        for renamed in &mut found {
            renamed.line = text[..renamed.span.start].matches('\n').count() + 1;
            text.replace_range(renamed.span.clone(), &renamed.with);
        }
        all.extend(found);
    }
}

/// The present name of the last part of a path, if it has changed.
pub fn present_name(path: &[&str]) -> Option<&'static str> {
    RENAMED.iter().find(|(old, _)| fits(&old.split('.').collect::<Vec<_>>(), path)).map(|(_, new)| *new)
}

/// The present name of a word that was the name of a key.
pub fn present_word(word: &str) -> Option<&'static str> {
    let last = |path: &str| path.rsplit('.').next() == Some(word);
    RENAMED.iter().find(|(old, _)| last(old)).map(|(_, new)| *new)
}

fn fits(pattern: &[&str], path: &[&str]) -> bool {
    match (pattern, path) {
        ([], []) => true,
        (["**", rest @ ..], _) => (0..=path.len()).any(|skipped| fits(rest, &path[skipped..])),
        ([first, rest @ ..], [part, parts @ ..]) => {
            let is_same = match *first {
                "*" => true,
                "FILE" => FILES.contains(part),
                name => name == *part,
            };
            is_same && fits(rest, parts)
        }
        _ => false,
    }
}

fn of_table<'t>(table: &'t DeTable, path: &mut Vec<&'t str>, found: &mut Vec<Renamed>) {
    for (key, value) in table {
        path.push(key.get_ref());
        if let Some(new) = present_name(path)
            && opens_together(table.get(new).map(|v| v.get_ref()), value.get_ref())
        {
            found.push(Renamed { old: key.get_ref().to_string(), new, line: 0, span: key.span(), with: new.into() });
        } else {
            of_value(value.get_ref(), value.span(), path, found);
        }
        path.pop();
    }
}

/// Whether a value may have the present name: nothing has it, or both are tables opened by headers of the two names. A key that is
/// given by both names is left for the reader to refuse.
fn opens_together(present: Option<&DeValue>, earlier: &DeValue) -> bool {
    present.is_none_or(|present| present.is_table() && earlier.is_table())
}

fn of_value<'t>(value: &'t DeValue, span: Range<usize>, path: &mut Vec<&'t str>, found: &mut Vec<Renamed>) {
    match value {
        DeValue::Table(table) => of_table(table, path, found),
        DeValue::Array(list) => list.iter().for_each(|entry| of_value(entry.get_ref(), entry.span(), path, found)),
        DeValue::String(word) => {
            path.push(word);
            if let Some(new) = present_name(path) {
                found.push(Renamed { old: word.to_string(), new, line: 0, span, with: format!("\"{new}\"") });
            }
            path.pop();
        }
        _ => {}
    }
}
