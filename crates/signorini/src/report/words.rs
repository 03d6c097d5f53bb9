//! The words of the summary: its schema, its keys and what they mean, from the types.

use super::{
    ContactEventKind, EventKind, LocatedBy, PathEventKind, Reason, RopeCondition, Summary, TractionKind, WarningKind,
};
use crate::case::schema::{Key, keys_of};
use serde_json::{Value, json};

/// A word that stands as a value in the summary.
#[derive(Clone, Debug, PartialEq)]
pub struct Word {
    pub word: String,
    /// What it is a value of: a reason, an event, a warning, a way to locate events.
    pub kind: &'static str,
    pub about: String,
}

/// The JSON Schema of summary.json (draft 2020-12).
pub fn schema() -> Value {
    let mut schema = schemars::schema_for!(Summary).to_value();
    if let Some(table) = schema.as_object_mut() {
        table.insert("title".into(), json!("signorini summary"));
    }
    schema
}

/// All keys of the summary, in the order of the types.
pub fn keys() -> Vec<Key> {
    keys_of(&schema())
}

/// The words that stand as values.
pub fn words() -> Vec<Word> {
    let of = |kind: &'static str, schema: schemars::Schema| {
        let schema = schema.to_value();
        let list = schema["oneOf"].as_array().cloned().unwrap_or_default();
        let word = move |v: Value| {
            let about = v["description"].as_str()?.split_whitespace().collect::<Vec<_>>().join(" ");
            Some(Word { word: v["const"].as_str()?.to_string(), kind, about })
        };
        list.into_iter().filter_map(word)
    };
    of("reason", schemars::schema_for!(Reason))
        .chain(of("event", schemars::schema_for!(EventKind)))
        .chain(of("event of a contact", schemars::schema_for!(ContactEventKind)))
        .chain(of("warning", schemars::schema_for!(WarningKind)))
        .chain(of("event of a path", schemars::schema_for!(PathEventKind)))
        .chain(of("condition of a rope", schemars::schema_for!(RopeCondition)))
        .chain(of("kind of contact forces", schemars::schema_for!(TractionKind)))
        .chain(of("way to locate an event", schemars::schema_for!(LocatedBy)))
        .collect()
}
