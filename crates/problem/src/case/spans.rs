//! Where the keys of a TOML text stand.

use crate::{KeyPath, Part};
use std::collections::BTreeMap;
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// The bytes of the values of all keys.
pub struct Spans(BTreeMap<KeyPath, Range<usize>>);

impl Spans {
    /// Those of a text that was read before.
    pub fn of(text: &str) -> Self {
        let mut found = BTreeMap::new();
        if let Ok(table) = DeTable::parse(text) {
            of_table(table.get_ref(), &mut Vec::new(), &mut found);
        }
        Self(found)
    }

    /// Where a key stands, or else the nearest thing round it.
    pub fn nearest(&self, key: &KeyPath) -> Range<usize> {
        let mut way = Some(key.clone());
        while let Some(key) = way {
            if let Some(span) = self.0.get(&key) {
                return span.clone();
            }
            way = key.parent();
        }
        0..0
    }
}

fn of_table(table: &DeTable, way: &mut Vec<Part>, found: &mut BTreeMap<KeyPath, Range<usize>>) {
    for (key, value) in table {
        way.push(Part::Key(key.get_ref().to_string()));
        of_value(value.get_ref(), value.span(), way, found);
        way.pop();
    }
}

fn of_value(value: &DeValue, span: Range<usize>, way: &mut Vec<Part>, found: &mut BTreeMap<KeyPath, Range<usize>>) {
    found.insert(KeyPath(way.clone()), span);
    match value {
        DeValue::Table(table) => of_table(table, way, found),
        DeValue::Array(list) => {
            for (index, entry) in list.iter().enumerate() {
                way.push(Part::Index(index));
                of_value(entry.get_ref(), entry.span(), way, found);
                way.pop();
            }
        }
        _ => {}
    }
}
