//! What Python states: plain values, lists, tables and arrays of numbers, and their reader, which knows the path of each.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyBytes, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use serde::de::{self, Deserialize, DeserializeSeed, Error, Unexpected, Visitor};
use serde::forward_to_deserialize_any;
use signorini::problem::{KeyPath, Part};
use std::fmt;
use std::sync::Arc;

/// A value of Python in plain types.
#[derive(Clone, Debug)]
pub enum Node {
    Bool(bool),
    Integer(i64),
    Number(f64),
    Text(String),
    List(Vec<Node>),
    Table(Vec<(String, Node)>),
    Array(Rows),
}

/// An array of numbers, or a part of it: the last index runs fastest.
#[derive(Clone, Debug)]
pub struct Rows {
    numbers: Numbers,
    shape: Arc<[usize]>,
    /// How many leading indices are chosen, and where the part begins.
    level: usize,
    start: usize,
}

#[derive(Clone, Debug)]
enum Numbers {
    Whole(Arc<[i64]>),
    Real(Arc<[f64]>),
}

impl Node {
    /// From what `signorini._tree` makes: an array is a tuple `(kind, shape, bytes)`.
    ///
    /// # Errors
    /// A value of another type.
    pub fn of(value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(table) = value.cast::<PyDict>() {
            let entry = |(key, value): (Bound<PyAny>, Bound<PyAny>)| Ok((key.extract()?, Self::of(&value)?));
            return table.iter().map(entry).collect::<PyResult<_>>().map(Node::Table);
        }
        if let Ok(list) = value.cast::<PyList>() {
            return list.iter().map(|entry| Self::of(&entry)).collect::<PyResult<_>>().map(Node::List);
        }
        if let Ok(array) = value.cast::<PyTuple>() {
            return Rows::of(array).map(Node::Array);
        }
        if let Ok(text) = value.cast::<PyString>() {
            return text.extract().map(Node::Text);
        }
        if value.is_instance_of::<PyBool>() {
            return value.extract().map(Node::Bool);
        }
        if value.is_instance_of::<PyInt>() {
            // What no case has is told as a number.
            return Ok(value
                .extract()
                .map_or_else(|_| Node::Number(value.extract().unwrap_or(f64::INFINITY)), Node::Integer));
        }
        if value.is_instance_of::<PyFloat>() {
            return value.extract().map(Node::Number);
        }
        Err(PyTypeError::new_err(format!("a {} cannot be stated in a case", value.get_type().name()?)))
    }
}

impl Rows {
    fn of(array: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (kind, shape, bytes): (String, Vec<usize>, Bound<'_, PyBytes>) = array.extract()?;
        let words = bytes.as_bytes().chunks_exact(8).map(|word| <[u8; 8]>::try_from(word).unwrap_or_default());
        let numbers = match kind.as_str() {
            "f8" => Numbers::Real(words.map(f64::from_le_bytes).collect()),
            "i8" => Numbers::Whole(words.map(i64::from_le_bytes).collect()),
            other => return Err(PyTypeError::new_err(format!("arrays of {other} are not read"))),
        };
        let (found, told) = (numbers.len(), shape.iter().product::<usize>());
        if shape.is_empty() || found != told {
            return Err(PyTypeError::new_err(format!("{found} numbers in an array of {shape:?}")));
        }
        Ok(Self { numbers, shape: shape.into(), level: 0, start: 0 })
    }

    fn count(&self) -> usize {
        self.shape[self.level]
    }

    /// The entry with the next index.
    fn entry(&self, index: usize) -> Node {
        let level = self.level + 1;
        let start = self.start + index * self.shape[level..].iter().product::<usize>();
        if level < self.shape.len() {
            return Node::Array(Self { numbers: self.numbers.clone(), shape: self.shape.clone(), level, start });
        }
        match &self.numbers {
            Numbers::Whole(numbers) => Node::Integer(numbers[start]),
            Numbers::Real(numbers) => Node::Number(numbers[start]),
        }
    }
}

impl Numbers {
    fn len(&self) -> usize {
        match self {
            Numbers::Whole(numbers) => numbers.len(),
            Numbers::Real(numbers) => numbers.len(),
        }
    }
}

/// Something that does not fit, and the way to it.
#[derive(Debug)]
pub struct Wrong {
    pub message: String,
    /// Whether it is a word that chooses, not a key.
    pub is_word: bool,
    /// From the innermost key outwards.
    path: Vec<Part>,
}

impl Wrong {
    fn within(mut self, part: Part) -> Self {
        self.path.push(part);
        self
    }

    pub fn key(&self) -> KeyPath {
        KeyPath(self.path.iter().rev().cloned().collect())
    }
}

impl fmt::Display for Wrong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Wrong {}

impl Error for Wrong {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self { message: message.to_string(), is_word: false, path: Vec::new() }
    }
}

/// Reads what a value of Python states.
///
/// # Errors
/// What does not fit, with the way to it.
pub fn read<'de, T: Deserialize<'de>>(node: Node) -> Result<T, Wrong> {
    T::deserialize(node)
}

impl<'de> de::Deserializer<'de> for Node {
    type Error = Wrong;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        match self {
            Node::Bool(is) => visitor.visit_bool(is),
            Node::Integer(number) => visitor.visit_i64(number),
            Node::Number(number) => visitor.visit_f64(number),
            Node::Text(text) => visitor.visit_str(&text),
            Node::List(list) => visitor.visit_seq(Entries { rest: list.into_iter(), index: 0 }),
            Node::Array(rows) => visitor.visit_seq(ArrayEntries { rows, index: 0 }),
            Node::Table(table) => visitor.visit_map(Keys { rest: table.into_iter(), value: None }),
        }
    }

    /// What is not there is never asked for.
    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Wrong> {
        visitor.visit_newtype_struct(self)
    }

    /// A table of keys; a list in place of it is refused.
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Wrong> {
        match self {
            Node::List(_) | Node::Array(_) => Err(Wrong::invalid_type(Unexpected::Seq, &visitor)),
            other => other.deserialize_any(visitor),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Wrong> {
        match self {
            Node::Text(key) => visitor.visit_enum(Choice { key, value: None }),
            Node::Table(mut table) => match (table.pop(), table.is_empty()) {
                (Some((key, value)), true) => visitor.visit_enum(Choice { key, value: Some(value) }),
                _ => Err(Wrong::custom("wanted exactly 1 element")),
            },
            _ => Err(Wrong::custom("wanted string or table")),
        }
    }

    forward_to_deserialize_any! {
        bool u8 u16 u32 u64 i8 i16 i32 i64 f32 f64 char str string seq bytes byte_buf unit map tuple ignored_any
        unit_struct tuple_struct identifier
    }
}

struct Entries {
    rest: std::vec::IntoIter<Node>,
    index: usize,
}

impl<'de> de::SeqAccess<'de> for Entries {
    type Error = Wrong;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Wrong> {
        let Some(node) = self.rest.next() else { return Ok(None) };
        self.index += 1;
        seed.deserialize(node).map(Some).map_err(|wrong| wrong.within(Part::Index(self.index - 1)))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

struct ArrayEntries {
    rows: Rows,
    index: usize,
}

impl<'de> de::SeqAccess<'de> for ArrayEntries {
    type Error = Wrong;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Wrong> {
        if self.index == self.rows.count() {
            return Ok(None);
        }
        self.index += 1;
        let node = self.rows.entry(self.index - 1);
        seed.deserialize(node).map(Some).map_err(|wrong| wrong.within(Part::Index(self.index - 1)))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rows.count() - self.index)
    }
}

struct Keys {
    rest: std::vec::IntoIter<(String, Node)>,
    /// The value of the key that was read last.
    value: Option<(String, Node)>,
}

impl<'de> de::MapAccess<'de> for Keys {
    type Error = Wrong;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Wrong> {
        let Some((key, value)) = self.rest.next() else { return Ok(None) };
        self.value = Some((key.clone(), value));
        seed.deserialize(Key(&key)).map(Some).map_err(|wrong| wrong.within(Part::Key(key)))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Wrong> {
        let (key, value) = self.value.take().ok_or_else(|| Wrong::custom("a value without a key"))?;
        seed.deserialize(value).map_err(|wrong| wrong.within(Part::Key(key)))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

/// A key, or a word that chooses.
struct Key<'a>(&'a str);

impl<'de> de::Deserializer<'de> for Key<'_> {
    type Error = Wrong;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        visitor.visit_str(self.0)
    }

    forward_to_deserialize_any! {
        bool u8 u16 u32 u64 i8 i16 i32 i64 f32 f64 char str string seq bytes byte_buf map unit ignored_any unit_struct
        tuple_struct tuple struct identifier option newtype_struct enum
    }
}

/// One of several kinds: a word, or a table with the key of that kind.
struct Choice {
    key: String,
    value: Option<Node>,
}

impl<'de> de::EnumAccess<'de> for Choice {
    type Error = Wrong;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Wrong> {
        let kind = seed.deserialize(Key(&self.key)).map_err(|wrong| match self.value {
            Some(_) => wrong.within(Part::Key(self.key.clone())),
            None => Wrong { is_word: true, ..wrong },
        })?;
        Ok((kind, self))
    }
}

impl<'de> de::VariantAccess<'de> for Choice {
    type Error = Wrong;

    fn unit_variant(self) -> Result<(), Wrong> {
        match self.value {
            None => Ok(()),
            Some(Node::Table(table)) if table.is_empty() => Ok(()),
            Some(_) => Err(Wrong::custom("expected an empty table").within(Part::Key(self.key))),
        }
    }

    /// A word alone is a kind with nothing said of it.
    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Wrong> {
        let value = self.value.unwrap_or_else(|| Node::Table(Vec::new()));
        seed.deserialize(value).map_err(|wrong| wrong.within(Part::Key(self.key)))
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, _: V) -> Result<V::Value, Wrong> {
        unreachable!("every variant of a problem holds one thing")
    }

    fn struct_variant<V: Visitor<'de>>(self, _: &'static [&'static str], _: V) -> Result<V::Value, Wrong> {
        unreachable!("every variant of a problem holds one thing")
    }
}
