//! What a part of a problem states, without its type: for what writes texts.

use serde::ser::{Serialize, Serializer};

/// A value, a list or a table in the order in which it is written.
#[derive(Debug)]
pub enum Tree {
    /// What is left out.
    None,
    Bool(bool),
    Integer(i128),
    Number(f64),
    Text(String),
    List(Vec<Tree>),
    Table(Vec<(String, Tree)>),
    /// A table with the one key of a kind.
    Kind(&'static str, Box<Tree>),
}

impl Serialize for Tree {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Tree::None => serializer.serialize_none(),
            Tree::Bool(is) => serializer.serialize_bool(*is),
            Tree::Integer(number) => match i64::try_from(*number) {
                Ok(number) => serializer.serialize_i64(number),
                Err(_) => serializer.serialize_i128(*number),
            },
            Tree::Number(number) => serializer.serialize_f64(*number),
            Tree::Text(text) => serializer.serialize_str(text),
            Tree::List(list) => serializer.collect_seq(list),
            Tree::Kind(kind, tree) => serializer.serialize_newtype_variant("", 0, kind, tree),
            Tree::Table(entries) => serializer.collect_map(entries.iter().map(|(key, entry)| (key, entry))),
        }
    }
}
