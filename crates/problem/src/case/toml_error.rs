//! Errors of the TOML reader in words of a case file.

use crate::{CaseError, suggestion};
use std::ops::Range;

/// Turns an error of the TOML reader into ours, with the nearest valid key.
pub fn from_toml(name: &str, text: &str, error: &toml::de::Error) -> CaseError {
    told(name, text, error.message(), error.span())
}

/// Whether a text is TOML.
///
/// # Errors
/// What is wrong, with its place.
pub fn check(name: &str, text: &str) -> Result<(), CaseError> {
    toml::de::DeTable::parse(text).map(|_| ()).map_err(|error| from_toml(name, text, &error))
}

/// The same of what a reader of anything but a text says: without a place.
pub fn in_plain_words(message: &str) -> CaseError {
    CaseError { place: None, ..told("", "", message, None) }
}

/// The same of what a reader of TOML says, and where.
pub(crate) fn told(name: &str, text: &str, message: &str, span: Option<Range<usize>>) -> CaseError {
    let message = message.trim().replace('\n', " ");
    let mut ours = CaseError::new(message.clone());
    if let Some(rest) = message.strip_prefix("unknown field `").or_else(|| message.strip_prefix("unknown variant `"))
        && let Some((key, expected)) = rest.split_once('`')
    {
        let known: Vec<&str> = expected.split('`').skip(1).step_by(2).collect();
        ours.message = format!("unknown {} `{key}`", if quoted(text, span.clone()) { "word" } else { "key" });
        ours.help = Some(suggestion(key, &known));
    } else if let Some(key) = message.strip_prefix("missing field `").and_then(|r| r.strip_suffix('`')) {
        ours.message = format!("missing key `{key}`");
        ours.help = Some(format!("add `{key} = …` to this table"));
    } else if let (true, Some(name)) =
        (message.contains("wanted exactly 1 element"), body_without_kind(text, span.clone()))
    {
        ours.message = format!("the kind of body `{name}` is missing or given more than once");
        ours.help = Some(format!(
            "write [bodies.{name}.KIND] with one of the kinds {}",
            super::schema::keys_in("bodies.NAME").join(", ")
        ));
    } else if message.contains("wanted exactly 1 element") || message.contains("wanted string or table") {
        ours.message = "expected a choice: one word in quotes, or a table with exactly one key".into();
        ours.help = key_before(text, span.clone()).map(|key| {
            let told = format!("`signorini explain {key}` lists the choices");
            example(text, span.clone(), key).map_or(told.clone(), |example| format!("{example}; {told}"))
        });
    } else if let Some((found, wanted)) = message
        .strip_prefix("invalid type: ")
        .or_else(|| message.strip_prefix("invalid value: "))
        .and_then(|rest| rest.rsplit_once(", expected "))
    {
        ours.message = format!("expected {}, found {}", in_words(wanted), found_in_words(found));
    }
    let span = span.unwrap_or(0..0);
    // An error in a table without a key of its own spans the whole table: its first line says enough.
    let end =
        text[span.start.min(text.len())..span.end.min(text.len())].find('\n').map_or(span.end, |n| span.start + n);
    ours.at(name, text, span.start..end.max(span.start))
}

/// The body without a kind, or with several, that an error at a place is about.
fn body_without_kind(text: &str, span: Option<Range<usize>>) -> Option<String> {
    let document = toml_edit::Document::parse(text).ok()?;
    let bodies = document.get("bodies")?.as_table_like()?;
    let start = span?.start;
    let wrong = |item: &toml_edit::Item| {
        item.as_table_like().is_some_and(|kinds| kinds.len() != 1) && item.span().is_none_or(|s| s.start == start)
    };
    bodies.iter().find(|(_, item)| wrong(item)).map(|(name, _)| name.to_string())
}

/// Whether a place in a text is one in quotes.
fn quoted(text: &str, span: Option<Range<usize>>) -> bool {
    span.and_then(|s| text.get(s.start..)).is_some_and(|value| value.starts_with(['"', '\'']))
}

/// The last word of the key whose value stands at a place, where both are on one line.
pub(crate) fn key_before(text: &str, span: Option<Range<usize>>) -> Option<&str> {
    let before = text.get(..span?.start)?.trim_end().strip_suffix('=')?.trim_end();
    let word = before.rsplit(|c: char| !(c.is_alphanumeric() || c == '_')).next()?;
    (!word.is_empty()).then_some(word)
}

/// How the first choice of a key is written, in the section about a place.
fn example(text: &str, span: Option<Range<usize>>, key: &str) -> Option<String> {
    let header = text.get(..span?.start)?.lines().rev().find_map(|line| line.trim().strip_prefix('['))?;
    let section = header.trim_start_matches('[').split(['.', ']']).next()?.trim();
    let of_section = |path: &String| path.starts_with(section) && path.ends_with(&format!(".{key}"));
    let path = super::schema::keys().into_iter().map(|k| k.path).find(of_section)?;
    let first = super::schema::keys_in(&path).into_iter().next()?;
    let below = format!("{path}.{first}.");
    let needed = super::schema::keys().into_iter().filter(|k| k.required);
    let needed: Vec<String> =
        needed.filter_map(|k| k.path.strip_prefix(&below).map(|name| format!("{name} = …"))).collect();
    Some(match needed.is_empty() {
        true => format!("{key}.{first} = {{}}"),
        false => format!("{key}.{first} = {{ {} }}", needed.join(", ")),
    })
}

/// What a type of the reader is called in a case file.
fn in_words(wanted: &str) -> String {
    let wanted = wanted.trim();
    match wanted {
        "i64" | "u64" | "usize" | "i32" | "u32" => "a whole number".into(),
        "f64" => "a number".into(),
        "a boolean" | "bool" => "true or false".into(),
        "a string" | "string" => "a text in quotes".into(),
        "a sequence" => "a list in brackets".into(),
        "a map" => "a table".into(),
        other if other.starts_with("struct ") => "a table of keys".into(),
        other if other.starts_with("enum ") => "a choice: a table with exactly one key".into(),
        other if other.starts_with("a tuple of size ") || other.starts_with("an array of length ") => {
            let size = other.rsplit(' ').next().unwrap_or("");
            format!("a list of {size}")
        }
        other => other.to_string(),
    }
}

/// What the reader found, in words of a case file.
fn found_in_words(found: &str) -> String {
    let found = found.trim();
    match found.split_once(' ') {
        Some(("string", text)) => format!("the text `{}`", text.trim_matches('"')),
        Some(("integer" | "boolean", value)) => value.into(),
        Some(("floating", rest)) => rest.trim_start_matches("point ").into(),
        _ => match found {
            "map" => "a table".into(),
            "sequence" => "a list".into(),
            other => other.into(),
        },
    }
}
