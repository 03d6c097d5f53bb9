//! What was asked: bodies, loads, contacts and steps in short, and the whole case.

use crate::folder::Results;
use crate::html::{escaped, list, section};

/// Tables of the case file whose entries have names, and what an entry is said to be.
const TABLES: [(&str, &str); 8] = [
    ("bodies", "Bodies"),
    ("supports", "Supports"),
    ("loads", "Loads"),
    ("contacts", "Contacts"),
    ("paths", "Paths"),
    ("winding", "Yarns"),
    ("ropes", "Ropes"),
    ("parameters", "Parameters"),
];

/// The case in short; nothing where it is not known.
pub fn short(results: &Results) -> String {
    let Some(table) = results.case.as_ref().and_then(|text| text.parse::<toml::Table>().ok()) else {
        return String::new();
    };
    let mut entries = Vec::new();
    for (key, title) in TABLES {
        let Some(of) = table.get(key).and_then(|v| v.as_table()) else { continue };
        let told: Vec<String> = of.iter().map(|(name, entry)| described(key, name, entry)).collect();
        if !told.is_empty() {
            entries.push((title.to_string(), told.join(", ")));
        }
    }
    let text = |key: &str| table.get(key).and_then(|v| v.as_str()).map(|v| format!("`{v}`"));
    let stated = ["analysis", "space", "units"].map(|key| Some((capital(key), text(key)?)));
    entries.splice(0..0, stated.into_iter().flatten());
    list(&entries)
}

/// The text of the case.
pub fn whole(results: &Results) -> String {
    let Some(text) = &results.case else { return String::new() };
    let interpreted = results.summary().map(|s| &s.interpreted[..]).unwrap_or_default();
    let lines: Vec<String> = interpreted
        .iter()
        .filter_map(|i| serde_json::to_value(i).ok())
        .filter_map(|v| {
            let (text, value) = (v["text"].as_str()?.to_string(), v["value"].as_f64()?);
            Some(format!("<code>{}</code> is {value} {}", escaped(&text), escaped(v["unit"].as_str().unwrap_or(""))))
        })
        .collect();
    let units = if lines.is_empty() {
        String::new()
    } else {
        format!("<p>Values with units, as they were understood: {}.</p>", lines.join("; "))
    };
    let count = text.lines().count();
    // Arrays of a case written from Python may be long.
    let open = if count <= 60 { " open" } else { "" };
    let body = format!(
        "<details{open}><summary>Case file, {count} lines</summary><pre tabindex=\"0\" aria-label=\"Case file\"><code>{}</code></pre></details>{units}",
        escaped(text)
    );
    section("case", "What was asked", &body)
}

/// An entry in a few words.
fn described(key: &str, name: &str, entry: &toml::Value) -> String {
    let kind = || Some(entry.as_table()?.iter().find(|(_, v)| v.is_table())?.0.clone());
    let list = |key: &str| -> Option<String> {
        let names = entry.get(key)?.as_array()?.iter().filter_map(|v| v.as_str()).map(|v| format!("`{v}`"));
        Some(names.collect::<Vec<_>>().join(" and "))
    };
    let on = || entry.get("on").and_then(|v| v.as_str()).map(|on| format!("on `{on}`"));
    let told = match key {
        "bodies" => kind().map(|k| k.replace('_', " ")),
        "contacts" => list("between"),
        "parameters" => Some(entry.to_string()),
        _ => on(),
    };
    told.map_or(format!("`{name}`"), |told| format!("`{name}` ({told})"))
}

fn capital(text: &str) -> String {
    crate::naming::sentence(text)
}
