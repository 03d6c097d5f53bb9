//! `--set KEY=VALUE`: replaces or adds a key of the case file before it is read.

use super::origin::Origins;
use crate::CaseError;
use std::str::FromStr;
use toml_edit::{DocumentMut, Item, Table, Value};

/// Applies overrides to the text of a case file, the rest of which stays as it is; and tells where its parts come from.
pub fn apply(name: &str, text: &str, overrides: &[String]) -> Result<(String, Origins), CaseError> {
    let mut origins = Origins::of_file(text);
    if overrides.is_empty() {
        return Ok((text.into(), origins));
    }
    let mut document = DocumentMut::from_str(text)
        .map_err(|e| CaseError::new(e.message().to_string()).at(name, text, e.span().unwrap_or(0..0)))?;
    let mut before = document.to_string();
    for setting in overrides {
        let (key, value) = setting.split_once('=').ok_or_else(|| {
            CaseError::new(format!("`--set {setting}` has no `=`")).help("write  --set loads.press.normal=-0.3")
        })?;
        set(document.as_table_mut(), key.trim(), parse_value(value.trim()))
            .map_err(|message| CaseError::new(format!("`--set {setting}`: {message}")))?;
        let after = document.to_string();
        origins.set(setting, [&before, &after]);
        before = after;
    }
    origins.finish(&before);
    Ok((before, origins))
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
        item = inner.get_mut(part).ok_or("a table that cannot be changed")?;
    }
    let decor = item.as_value().map(|v| v.decor().clone());
    let mut value = value;
    if let Some(decor) = decor {
        *value.decor_mut() = decor;
    }
    *item = Item::Value(value);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_replaced_added_and_refused() {
        let text = "a = 1 # one\n[b.c]\nd = \"x\"\n[[steps]]\nto = 1\n";
        let set = |s: &str| apply("case", text, &[s.to_string()]).map(|(text, _)| text);
        assert!(set("b.c.d=-2*t").unwrap().contains("d = \"-2*t\""));
        assert!(set("a=3").unwrap().starts_with("a = 3 # one"));
        assert!(set("b.e.f=2.5").unwrap().contains("f = 2.5"));
        assert!(set("steps.0.to=4").unwrap().contains("to = 4"));
        assert!(set("a.b=1").is_err() && set("novalue").is_err() && set("..=1").is_err());
    }
}
