//! The one reader of all types of a problem: each of them is compiled for it alone.
//!
//! It reads parsed TOML and says what the reader of the `toml` crate does. That one offers each type its values in several
//! ways, for dates and places too, and every type of a problem would be compiled for each of these.

use crate::key_path::{KeyPath, Part};
use serde::de::{self, Deserialize, DeserializeSeed, Error, Expected, Unexpected, Visitor};
use serde::forward_to_deserialize_any;
use std::fmt;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeArray, DeInteger, DeString, DeTable, DeValue};

/// Reads what a table states.
///
/// # Errors
/// What does not fit, with its place.
pub fn read<'de, T: Deserialize<'de>>(table: DeTable<'de>) -> Result<T, Wrong> {
    T::deserialize(Reader { value: DeValue::Table(table), span: None })
}

/// Something that does not fit.
#[derive(Debug)]
pub struct Wrong {
    pub message: String,
    pub span: Option<Range<usize>>,
    /// The keys on the way to it, from the innermost outwards.
    path: Vec<Part>,
}

impl Wrong {
    fn at(message: impl Into<String>, span: Option<Range<usize>>) -> Self {
        Self { message: message.into(), span, path: Vec::new() }
    }

    /// The way to it.
    pub fn key(&self) -> KeyPath {
        KeyPath(self.path.iter().rev().cloned().collect())
    }

    /// It is at or below a key.
    fn below(mut self, part: Part) -> Self {
        self.path.push(part);
        self
    }

    /// The innermost place counts.
    fn within(mut self, span: Option<Range<usize>>) -> Self {
        self.span = self.span.or(span);
        self
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
        Self::at(message.to_string(), None)
    }
}

/// A value to be read; the whole has no place.
struct Reader<'de> {
    value: DeValue<'de>,
    span: Option<Range<usize>>,
}

impl<'de> From<Spanned<DeValue<'de>>> for Reader<'de> {
    fn from(value: Spanned<DeValue<'de>>) -> Self {
        let span = Some(value.span());
        Self { value: value.into_inner(), span }
    }
}

/// A value by what visitors call it, its number or text read: what is the same for all types is compiled once.
enum Given<'de> {
    Text(DeString<'de>),
    Signed(i64),
    Unsigned(u64),
    /// A whole number beyond what any type takes, as it is told.
    Large(String),
    Number(f64),
    Bool(bool),
    List(List<'de>),
    Table(Entries<'de>),
}

impl<'de> Reader<'de> {
    fn given(self) -> Result<Given<'de>, Wrong> {
        let wrong = |message: &str| Wrong::at(message, self.span.clone());
        Ok(match self.value {
            DeValue::String(text) => Given::Text(text),
            DeValue::Integer(number) => integer(&number).ok_or_else(|| wrong("integer number overflowed"))?,
            DeValue::Float(number) => {
                Given::Number(float(number.as_str()).ok_or_else(|| wrong("floating-point number overflowed"))?)
            }
            DeValue::Boolean(is) => Given::Bool(is),
            DeValue::Datetime(date) => Given::Table(Entries::of_date(date.to_string(), self.span.unwrap_or_default())),
            DeValue::Array(list) => Given::List(List { rest: list.into_iter(), index: 0 }),
            DeValue::Table(table) => Given::Table(Entries::of(table)),
        })
    }
}

impl Given<'_> {
    /// It is none of what is expected.
    fn refused(&self, expected: &dyn Expected) -> Wrong {
        let found = match self {
            Given::Text(text) => Unexpected::Str(text),
            Given::Signed(number) => Unexpected::Signed(*number),
            Given::Unsigned(number) => Unexpected::Unsigned(*number),
            Given::Large(number) => Unexpected::Other(number),
            Given::Number(number) => Unexpected::Float(*number),
            Given::Bool(is) => Unexpected::Bool(*is),
            Given::List(_) => Unexpected::Seq,
            Given::Table(_) => Unexpected::Map,
        };
        Wrong::invalid_type(found, expected)
    }
}

impl<'de> de::Deserializer<'de> for Reader<'de> {
    type Error = Wrong;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        let span = self.span.clone();
        let read = match self.given()? {
            Given::Text(text) => visitor.visit_str(&text),
            Given::Signed(number) => visitor.visit_i64(number),
            Given::Unsigned(number) => visitor.visit_u64(number),
            Given::Number(number) => visitor.visit_f64(number),
            Given::Bool(is) => visitor.visit_bool(is),
            Given::List(list) => visitor.visit_seq(list),
            Given::Table(table) => visitor.visit_map(table),
            large @ Given::Large(_) => Err(large.refused(&visitor)),
        };
        read.map_err(|wrong| wrong.within(span))
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        let span = self.span.clone();
        let read = match self.given()? {
            Given::List(list) => visitor.visit_seq(list),
            other => Err(other.refused(&visitor)),
        };
        read.map_err(|wrong| wrong.within(span))
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Wrong> {
        self.deserialize_seq(visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        let span = self.span.clone();
        let read = match self.given()? {
            Given::Table(table) => visitor.visit_map(table),
            other => Err(other.refused(&visitor)),
        };
        read.map_err(|wrong| wrong.within(span))
    }

    /// A table, or its values in a list.
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Wrong> {
        let span = self.span.clone();
        let read = match self.given()? {
            Given::Table(table) => visitor.visit_map(table),
            Given::List(list) => visitor.visit_seq(list),
            other => Err(other.refused(&visitor)),
        };
        read.map_err(|wrong| wrong.within(span))
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        let span = self.span.clone();
        let read = match self.given()? {
            Given::Text(text) => visitor.visit_str(&text),
            other => Err(other.refused(&visitor)),
        };
        read.map_err(|wrong| wrong.within(span))
    }

    /// What is not there is never asked for.
    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        let span = self.span.clone();
        visitor.visit_some(self).map_err(|wrong| wrong.within(span))
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Wrong> {
        let span = self.span.clone();
        visitor.visit_newtype_struct(self).map_err(|wrong| wrong.within(span))
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Wrong> {
        let span = self.span.clone();
        visitor.visit_enum(self.choice()?).map_err(|wrong| wrong.within(span))
    }

    forward_to_deserialize_any! {
        bool u8 u16 u32 u64 i8 i16 i32 i64 f32 f64 char str bytes byte_buf unit ignored_any unit_struct tuple_struct
        identifier
    }
}

/// By the narrowest type that holds it.
fn integer<'de>(number: &DeInteger<'de>) -> Option<Given<'de>> {
    let (digits, radix) = (number.as_str(), number.radix());
    if let Ok(number) = i64::from_str_radix(digits, radix) {
        Some(Given::Signed(number))
    } else if let Ok(number) = u64::from_str_radix(digits, radix) {
        Some(Given::Unsigned(number))
    } else if let Ok(number) = i128::from_str_radix(digits, radix) {
        Some(Given::Large(format!("integer `{number}` as i128")))
    } else {
        let number = u128::from_str_radix(digits, radix).ok()?;
        Some(Given::Large(format!("integer `{number}` as u128")))
    }
}

/// Infinite only where that is what was written.
fn float(digits: &str) -> Option<f64> {
    digits.parse().ok().filter(|number: &f64| !number.is_infinite() || digits.contains("inf"))
}

/// The entries of a list.
struct List<'de> {
    rest: <DeArray<'de> as IntoIterator>::IntoIter,
    /// How many were read.
    index: usize,
}

impl<'de> de::SeqAccess<'de> for List<'de> {
    type Error = Wrong;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Wrong> {
        let Some(value) = self.rest.next() else { return Ok(None) };
        self.index += 1;
        seed.deserialize(Reader::from(value)).map(Some).map_err(|wrong| wrong.below(Part::Index(self.index - 1)))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

/// The entries of a table.
struct Entries<'de> {
    rest: <DeTable<'de> as IntoIterator>::IntoIter,
    /// The key that was read last, and its value.
    value: Option<(DeString<'de>, Spanned<DeValue<'de>>)>,
}

impl<'de> Entries<'de> {
    fn of(table: DeTable<'de>) -> Self {
        Self { rest: table.into_iter(), value: None }
    }

    /// What the `toml` crate takes for a date, so that it is told as there.
    fn of_date(date: String, span: Range<usize>) -> Self {
        let key = Spanned::new(span.clone(), "$__toml_private_datetime".into());
        Self::of(DeTable::from_iter([(key, Spanned::new(span, DeValue::String(date.into())))]))
    }
}

impl<'de> de::MapAccess<'de> for Entries<'de> {
    type Error = Wrong;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Wrong> {
        let Some((key, value)) = self.rest.next() else { return Ok(None) };
        let (span, key) = (key.span(), key.into_inner());
        self.value = Some((key.clone(), value));
        let read = seed.deserialize(Key(key.clone()));
        read.map(Some).map_err(|wrong| wrong.within(Some(span)).below(Part::Key(key.into())))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Wrong> {
        let (key, value) = self.value.take().ok_or_else(|| Wrong::custom("a value without a key"))?;
        let span = value.span();
        let read = seed.deserialize(Reader::from(value));
        read.map_err(|wrong| wrong.within(Some(span)).below(Part::Key(key.into())))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

/// A key, or a word that chooses.
struct Key<'de>(DeString<'de>);

impl<'de> de::Deserializer<'de> for Key<'de> {
    type Error = Wrong;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        visitor.visit_str(&self.0)
    }

    forward_to_deserialize_any! {
        bool u8 u16 u32 u64 i8 i16 i32 i64 f32 f64 char str string seq bytes byte_buf map unit ignored_any unit_struct
        tuple_struct tuple struct identifier option newtype_struct enum
    }
}

/// One of several kinds: a word, or a table with the key of that kind.
struct Choice<'de> {
    key: DeString<'de>,
    span: Option<Range<usize>>,
    value: Option<Spanned<DeValue<'de>>>,
}

impl<'de> Reader<'de> {
    fn choice(self) -> Result<Choice<'de>, Wrong> {
        let message = match self.value {
            DeValue::String(key) => return Ok(Choice { key, span: None, value: None }),
            DeValue::Table(table) => {
                let mut entries = table.into_iter();
                match (entries.next(), entries.next()) {
                    (Some((key, value)), None) => {
                        let span = Some(key.span());
                        return Ok(Choice { key: key.into_inner(), span, value: Some(value) });
                    }
                    (None, _) => "wanted exactly 1 element, found 0 elements",
                    (Some(_), Some(_)) => "wanted exactly 1 element, more than 1 element",
                }
            }
            _ => "wanted string or table",
        };
        Err(Wrong::at(message, self.span))
    }
}

impl<'de> de::EnumAccess<'de> for Choice<'de> {
    type Error = Wrong;
    type Variant = Kind<'de>;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Kind<'de>), Wrong> {
        let kind = seed.deserialize(Key(self.key.clone())).map_err(|wrong| match &self.value {
            Some(_) => wrong.within(self.span).below(Part::Key(self.key.to_string())),
            None => wrong,
        })?;
        Ok((kind, Kind(self.value.map(|value| (self.key, value)))))
    }
}

/// What stands under the key of a kind; nothing under a word.
struct Kind<'de>(Option<(DeString<'de>, Spanned<DeValue<'de>>)>);

impl<'de> de::VariantAccess<'de> for Kind<'de> {
    type Error = Wrong;

    fn unit_variant(self) -> Result<(), Wrong> {
        let Some((_, value)) = self.0 else { return Ok(()) };
        let message = match value.get_ref() {
            DeValue::Array(list) if list.is_empty() => return Ok(()),
            DeValue::Table(table) if table.is_empty() => return Ok(()),
            DeValue::Array(_) => "expected empty array".to_string(),
            DeValue::Table(_) => "expected empty table".to_string(),
            other => format!("expected table, found {}", other.type_str()),
        };
        Err(Wrong::at(message, Some(value.span())))
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Wrong> {
        match self.0 {
            Some((key, value)) => {
                seed.deserialize(Reader::from(value)).map_err(|wrong| wrong.below(Part::Key(key.into())))
            }
            None => Err(Wrong::invalid_type(Unexpected::UnitVariant, &"newtype variant")),
        }
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, _: V) -> Result<V::Value, Wrong> {
        unreachable!("every variant of a problem holds one thing")
    }

    fn struct_variant<V: Visitor<'de>>(self, _: &'static [&'static str], _: V) -> Result<V::Value, Wrong> {
        unreachable!("every variant of a problem holds one thing")
    }
}
