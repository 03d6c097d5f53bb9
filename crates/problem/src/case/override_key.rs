//! `--set KEY=VALUE`: replaces or adds a key of the case file before it is read.

use super::origin::Origins;
use super::renamed::{self, modernised};
use crate::{CaseError, suggestion};
use std::str::FromStr;
use toml_edit::{DocumentMut, Item, Table, Value};

/// Applies overrides to the text of a case file, the rest of which stays as it is but for keys of earlier versions; and tells where
/// its parts come from.
pub fn apply(name: &str, text: &str, overrides: &[String]) -> Result<(String, Origins), CaseError> {
    let mut origins = Origins::of_file(text);
    let (mut text, renamed) = modernised(text);
    origins.rename(renamed);
    if overrides.is_empty() {
        return Ok((text, origins));
    }
    let mut document = DocumentMut::from_str(&text)
        .map_err(|e| CaseError::new(e.message().to_string()).at(name, &text, e.span().unwrap_or(0..0)))
        .map_err(|e| origins.relocated(e))?;
    let stated = document.clone();
    let settings: Vec<String> = overrides.iter().map(|setting| with_present_names(setting)).collect();
    for setting in &settings {
        let (key, value) = setting.split_once('=').ok_or_else(|| {
            CaseError::new(format!("`--set {setting}` contains no `=`")).help("write  --set loads.press.normal=-0.3")
        })?;
        set(document.as_table_mut(), key.trim(), parse_value(value.trim()))
            .map_err(|message| CaseError::new(format!("`--set {setting}`: {message}")))?;
        let after = document.to_string();
        origins.set(setting, [&text, &after]);
        text = after;
    }
    for setting in &settings {
        check_entry(&stated, &document, setting)?;
    }
    let (text, renamed) = modernised(&text);
    origins.rename(renamed);
    origins.finish(&text);
    Ok((text, origins))
}

/// A setting whose key has the names of today.
fn with_present_names(setting: &str) -> String {
    let Some((key, value)) = setting.split_once('=') else { return setting.into() };
    let earlier: Vec<&str> = key.split('.').map(str::trim).collect();
    let present = (1..=earlier.len()).map(|n| renamed::present_name(&earlier[..n]).unwrap_or(earlier[n - 1]));
    format!("{}={value}", present.collect::<Vec<_>>().join("."))
}

/// A TOML value, or else a string: `--set loads.press.normal=-2*t` needs no quotes.
fn parse_value(text: &str) -> Value {
    Value::from_str(text).unwrap_or_else(|_| Value::from(text))
}

fn set(table: &mut Table, key: &str, value: Value) -> Result<(), String> {
    let parts: Vec<&str> = key.split('.').map(str::trim).collect();
    if parts.iter().any(|p| p.is_empty()) {
        return Err(format!("`{key}` is not a key"));
    }
    let mut item: &mut Item =
        table.entry(parts[0]).or_insert_with(|| if parts.len() == 1 { Item::None } else { Item::Table(Table::new()) });
    for (i, part) in parts.iter().enumerate().skip(1) {
        let last = i + 1 == parts.len();
        if let (Some(list), Ok(index)) = (item.as_array_of_tables_mut().map(|l| l.len()), part.parse::<usize>()) {
            let entries = item.as_array_of_tables_mut().ok_or("no list")?;
            let entry = entries.get_mut(index).ok_or(format!("`{}` has {list} entries", parts[..i].join(".")))?;
            return set(entry, &parts[i + 1..].join("."), value);
        }
        let Some(inner) = item.as_table_like_mut() else {
            return Err(format!("`{}` is not a table", parts[..i].join(".")));
        };
        if inner.get(part).is_none() {
            let empty = if last { Item::Value(Value::from(0)) } else { Item::Table(Table::new()) };
            inner.insert(part, empty);
        }
        item = inner.get_mut(part).ok_or("a table that cannot be modified")?;
    }
    let decor = item.as_value().map(|v| v.decor().clone());
    let mut value = value;
    if let Some(decor) = decor {
        *value.decor_mut() = decor;
    }
    *item = Item::Value(value);
    Ok(())
}

/// The tables of names that a case gives, what one is called, and the keys of which each needs one at least.
const NAMED: [(&str, &str, &[&str]); 10] = [
    ("bodies", "body", &[]),
    ("supports", "support", &["on"]),
    ("loads", "load", &["on"]),
    ("contacts", "contact", &["between", "self_contact", "all"]),
    ("constraints", "constraint", &["terms"]),
    ("paths", "path", &["from"]),
    ("winding", "winding", &["on"]),
    ("ropes", "rope", &["on"]),
    ("functions", "function", &["table", "expression"]),
    ("constants", "constant", &[]),
];

/// A setting of a key of something that the case does not have, by a name near to one that it has or without what makes it
/// whole, is a misspelt one.
fn check_entry(stated: &DocumentMut, document: &DocumentMut, setting: &str) -> Result<(), CaseError> {
    let key = setting.split_once('=').map_or("", |(key, _)| key);
    let parts: Vec<&str> = key.split('.').map(str::trim).collect();
    let Some((section, what, needs)) = NAMED.iter().find(|(section, ..)| parts[0] == *section) else { return Ok(()) };
    let Some(&name) = parts.get(1) else { return Ok(()) };
    let names: Vec<&str> = match stated.get(section).and_then(Item::as_table_like) {
        Some(table) => table.iter().map(|(name, _)| name).collect(),
        None => Vec::new(),
    };
    if names.contains(&name) {
        return Ok(());
    }
    let is_whole = match *section {
        // One that nothing uses changes nothing.
        "constants" => uses(&document.to_string(), name) > 1,
        "bodies" => document["bodies"][name].as_table_like().is_some_and(|kinds| {
            let is_near = suggestion(name, &names).starts_with("did you mean");
            kinds.iter().all(|(_, keys)| keys.as_table_like().is_some_and(|keys| keys.len() > 1)) || !is_near
        }),
        _ => {
            let entry = document.get(section).and_then(|table| table.get(name)).and_then(Item::as_table_like);
            entry.is_some_and(|entry| needs.iter().any(|key| entry.contains_key(key)))
        }
    };
    if is_whole {
        return Ok(());
    }
    let help = match names.is_empty() {
        true => format!("the case has no `{section}`"),
        false => suggestion(name, &names),
    };
    let place = setting.find(name).unwrap_or(0);
    Err(CaseError::new(format!("there is no {what} `{name}`")).help(help).at(
        "--set",
        setting,
        place..place + name.len(),
    ))
}

/// How often a word stands in a text.
fn uses(text: &str, word: &str) -> usize {
    text.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|w| *w == word).count()
}
