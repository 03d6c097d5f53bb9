//! Objects of JSON cut into their entries.

use super::fields::FieldError;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::Value;
use serde_json::value::RawValue;
use std::fmt;

/// The entries of an object in their order, the values as text.
pub struct Object<'a> {
    pub entries: Vec<(String, &'a RawValue)>,
}

impl<'a> Object<'a> {
    /// Cuts a text.
    ///
    /// # Errors
    /// The text is not JSON or no object, or has a key twice.
    pub fn parse(text: &'a [u8]) -> Result<Self, FieldError> {
        let fail = |message: String| FieldError { path: String::new(), message };
        let object: Object<'a> =
            serde_json::from_slice(text).map_err(|e| match serde_json::from_slice::<Value>(text) {
                Ok(value) => fail(format!("{} instead of an object", super::fields::kind(&value))),
                Err(_) => fail(not_json(text, &e)),
            })?;
        let mut keys: Vec<&String> = object.entries.iter().map(|(key, _)| key).collect();
        keys.sort_unstable();
        match keys.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(pair) => Err(FieldError { path: pair[0].clone(), message: "given twice".into() }),
            None => Ok(object),
        }
    }
}

/// That a text is not JSON, and why.
pub fn not_json(text: &[u8], error: &serde_json::Error) -> String {
    let text = String::from_utf8_lossy(text);
    match ["NaN", "Infinity"].into_iter().find(|word| text.contains(word)) {
        Some(word) => format!("{word} is not a JSON number"),
        None => format!("not JSON: {error}"),
    }
}

impl<'de> Deserialize<'de> for Object<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries;
        impl<'de> Visitor<'de> for Entries {
            type Value = Object<'de>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Object<'de>, M::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Object { entries })
            }
        }
        deserializer.deserialize_map(Entries)
    }
}
