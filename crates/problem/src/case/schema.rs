//! What may stand in a case file, told by the types that read it: as a JSON Schema, key by key, as a table.

use crate::Problem;
use serde_json::{Map, Value, json};

/// A key of the case file.
#[derive(Clone, Debug, PartialEq)]
pub struct Key {
    /// The way to it; `NAME` stands for a name that the case gives, `[]` for an entry of a list.
    pub path: String,
    /// What it means, in which unit, and what holds if it is left out.
    pub about: String,
    /// What may stand there, in words.
    pub kind: String,
    /// Whether the table round it needs it.
    pub required: bool,
}

/// The JSON Schema of case files (draft 2020-12), for editors and other programs.
pub fn schema() -> Value {
    let mut schema = schemars::schema_for!(Problem).to_value();
    // Editors tell a file by what it names; the line itself is a comment to TOML.
    if let Some(table) = schema.as_object_mut() {
        table.insert("title".into(), json!("signorini case"));
    }
    schema
}

/// All keys, in the order of the types.
pub fn keys() -> Vec<Key> {
    keys_of(&schema())
}

/// All keys that a JSON Schema tells of.
pub fn keys_of(schema: &Value) -> Vec<Key> {
    let mut keys = Vec::new();
    walk(schema, schema, "", &mut Walk { keys: &mut keys, open: Vec::new() });
    keys
}

/// The keys that end with the given words as they are; where there are none, with `NAME` matching any. A full path finds one.
pub fn find(word: &str) -> Vec<Key> {
    let mut found: Vec<Key> = keys().into_iter().filter(|k| k.ends_with(word)).collect();
    let as_is = |k: &Key| k.path.replace("[]", "").ends_with(word.trim_matches('.'));
    if found.iter().any(as_is) {
        found.retain(as_is);
    }
    found
}

impl Key {
    /// Whether its path ends with the given words, `NAME` matching any.
    pub fn ends_with(&self, word: &str) -> bool {
        let wanted: Vec<&str> = word.trim_matches('.').split('.').collect();
        let same = |key: &str, word: &str| key == word || key == "NAME" || key.trim_end_matches("[]") == word;
        let parts: Vec<&str> = self.path.split('.').collect();
        parts.len() >= wanted.len()
            && parts.last().map(|p| p.trim_end_matches("[]")) == wanted.last().copied()
            && parts[parts.len() - wanted.len()..].iter().zip(&wanted).all(|(p, w)| same(p, w))
    }
}

/// The names of the keys that stand in the table of another one.
pub fn keys_in(path: &str) -> Vec<String> {
    let below = |key: Key| {
        let name = key.path.strip_prefix(path)?.trim_start_matches("[]").strip_prefix('.')?.trim_end_matches("[]");
        (!name.contains('.')).then(|| name.to_string())
    };
    keys().into_iter().filter_map(below).collect()
}

/// Keys as tables in Markdown: first those that have none below them, then one table for each that has.
pub fn tables(keys: &[Key]) -> String {
    let head = |key: &Key| key.path.split('.').next().unwrap_or_default().trim_end_matches("[]").to_string();
    let alone = |key: &Key| keys.iter().filter(|k| head(k) == head(key)).count() == 1;
    let row = |key: &Key| {
        let star = if key.required { " *" } else { "" };
        format!("| `{}`{star} | {} | {} |\n", key.path, key.kind.replace('|', "or"), key.about.replace('|', "or"))
    };
    const COLUMNS: &str = "| key | value | meaning |\n|---|---|---|\n";
    let mut text = format!("\n{COLUMNS}");
    keys.iter().filter(|k| alone(k)).for_each(|key| text += &row(key));
    let mut section = String::new();
    for key in keys.iter().filter(|k| !alone(k)) {
        if head(key) != section {
            section = head(key);
            text += &format!("\n## {section}\n\n{COLUMNS}");
        }
        text += &row(key);
    }
    text
}

fn resolve<'a>(root: &'a Value, node: &'a Value) -> &'a Value {
    let name = node["$ref"].as_str().and_then(|r| r.rsplit('/').next());
    name.and_then(|name| root["$defs"].get(name)).unwrap_or(node)
}

/// The alternatives of a node, without `null`.
fn alternatives(node: &Value) -> Vec<&Value> {
    let lists = ["anyOf", "oneOf"].iter().filter_map(|k| node[*k].as_array());
    let found: Vec<&Value> = lists.flatten().filter(|v| v["type"] != "null").collect();
    if found.is_empty() { vec![node] } else { found }
}

fn about(node: &Value, target: &Value) -> String {
    let text = node["description"].as_str().or_else(|| target["description"].as_str()).unwrap_or_default();
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The keys that were found, and the definitions that are being told of: one within itself is not told again.
struct Walk<'a> {
    keys: &'a mut Vec<Key>,
    open: Vec<*const Value>,
}

fn walk(root: &Value, node: &Value, path: &str, found: &mut Walk) {
    let here = std::ptr::from_ref(resolve(root, node));
    if found.open.contains(&here) {
        return;
    }
    found.open.push(here);
    walk_open(root, node, path, found);
    found.open.pop();
}

fn walk_open(root: &Value, node: &Value, path: &str, keys: &mut Walk) {
    for alternative in alternatives(resolve(root, node)) {
        let target = resolve(root, alternative);
        if !std::ptr::eq(target, node) && alternatives(target).first().is_none_or(|a| !std::ptr::eq(*a, target)) {
            walk(root, target, path, keys);
            continue;
        }
        let required: Vec<&str> =
            target["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
        // A table with exactly one key is a choice: none of its keys is needed.
        let choice =
            target["minProperties"] == 1 || node["oneOf"].is_array() || resolve(root, node)["oneOf"].is_array();
        for (name, child) in target["properties"].as_object().unwrap_or(&Map::new()) {
            let here = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
            let required = required.contains(&name.as_str()) && !choice;
            // What a choice means is said of the table that holds it.
            let of_choice = if choice { about(target, target) } else { String::new() };
            add(root, child, here, of_choice, required, keys);
        }
        let names = &target["additionalProperties"];
        if names.is_object() {
            walk_entry(root, names, &format!("{path}.NAME"), keys);
        }
        if target["type"] == "array" || target["type"].as_array().is_some_and(|t| t.contains(&json!("array"))) {
            walk_entry(root, &target["items"], &format!("{path}[]"), keys);
        }
    }
}

/// An entry of a list or of a table of names: it is a key of its own only where it is a value.
fn walk_entry(root: &Value, node: &Value, path: &str, keys: &mut Walk) {
    let before = keys.keys.len();
    walk(root, node, path, keys);
    if keys.keys.len() == before && path.ends_with(".NAME") {
        let about = "Entry with a name of your own.".to_string();
        keys.keys.push(Key { path: path.to_string(), about, kind: kind(root, node), required: false });
    }
}

fn add(root: &Value, child: &Value, path: String, mut said: String, required: bool, keys: &mut Walk) {
    let targets: Vec<&Value> = alternatives(child).into_iter().map(|a| resolve(root, a)).collect();
    if said.is_empty() {
        said = targets.iter().map(|t| about(child, t)).find(|a| !a.is_empty()).unwrap_or_default();
    }
    keys.keys.push(Key { path: path.clone(), about: said, kind: kind(root, child), required });
    walk(root, child, &path, keys);
}

/// What may stand at a node, in words.
fn kind(root: &Value, node: &Value) -> String {
    let mut words: Vec<String> = Vec::new();
    let mut say = |word: String| {
        if !word.is_empty() && !words.contains(&word) {
            words.push(word);
        }
    };
    for alternative in alternatives(node) {
        let target = resolve(root, alternative);
        if alternative["$ref"].as_str().is_some_and(|r| r.ends_with("/Value")) {
            say("value".into());
            continue;
        }
        for inner in alternatives(target) {
            let inner = resolve(root, inner);
            if let Some(list) = inner["enum"].as_array() {
                list.iter().filter_map(Value::as_str).for_each(|w| say(format!("`\"{w}\"`")));
            } else if let Some(word) = inner["const"].as_str() {
                say(format!("`\"{word}\"`"));
            } else if inner["items"].is_object() {
                say(format!("list of {}", kind(root, &inner["items"])));
            } else {
                let types = match &inner["type"] {
                    Value::String(t) => vec![t.clone()],
                    Value::Array(list) => list.iter().filter_map(|t| t.as_str().map(str::to_string)).collect(),
                    // A table with one of several keys.
                    _ if inner["oneOf"].is_array() => vec!["object".to_string()],
                    _ => Vec::new(),
                };
                for t in types {
                    match t.as_str() {
                        "object" => say("table".into()),
                        "boolean" => say("`true` or `false`".into()),
                        "integer" => say("whole number".into()),
                        "string" => say("text".into()),
                        "null" => {}
                        other => say(other.into()),
                    }
                }
            }
        }
    }
    words.join(" or ")
}
