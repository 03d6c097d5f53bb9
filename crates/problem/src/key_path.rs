//! The way to a part of a problem, and how it is found: by where that part lies in memory.
//!
//! A reader of a problem holds references to its parts. Where one of them is wrong, the problem is walked through once until
//! the part at that address and of that type is met, and the keys on the way to it are its path. So no reader carries paths
//! along, and no plain type carries one in it.

use crate::{Components, List, Problem, Value};
use serde::de::DeserializeOwned;
use serde::ser::{self, Serialize};
use std::fmt;

/// The keys from the problem to one of its parts: `bodies.film.membrane.tension`, `steps[1].to`.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct KeyPath(pub Vec<Part>);

/// A key of a table, or the place in a list.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    Key(String),
    Index(usize),
}

impl KeyPath {
    /// The path of keys without lists, joined by dots.
    pub fn of_keys(keys: &[&str]) -> Self {
        Self(keys.iter().map(|key| Part::Key((*key).to_string())).collect())
    }

    /// The path to what contains the part; none of the problem itself.
    pub fn parent(&self) -> Option<Self> {
        let (_, before) = self.0.split_last()?;
        Some(Self(before.to_vec()))
    }

    /// Whether the last key is the given one.
    pub fn ends_with(&self, key: &str) -> bool {
        matches!(self.0.last(), Some(Part::Key(last)) if last == key)
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, part) in self.0.iter().enumerate() {
            match part {
                Part::Index(index) => write!(f, "[{index}]")?,
                Part::Key(key) => {
                    let dot = if k == 0 { "" } else { "." };
                    let bare =
                        !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
                    if bare { write!(f, "{dot}{key}")? } else { write!(f, "{dot}{key:?}")? }
                }
            }
        }
        Ok(())
    }
}

/// A part of a problem, of which errors tell. References are none: their address is not that of the part.
pub trait ProblemPart: Serialize + DeserializeOwned {}
impl<T: Serialize + DeserializeOwned> ProblemPart for T {}

/// The way to a part of a problem; none where the part is not in it.
pub fn find<T: ProblemPart>(problem: &Problem, part: &T) -> Option<KeyPath> {
    find_at(problem, address(part), std::any::type_name::<T>())
}

/// The way to the part of the given type at an address. Without parameters, so that the walk is compiled once.
fn find_at(problem: &Problem, address: usize, kind: &'static str) -> Option<KeyPath> {
    let mut search = Search { address, kind, path: Vec::new() };
    problem.serialize(&mut search).is_err().then_some(KeyPath(search.path))
}

fn address<T: ?Sized>(of: &T) -> usize {
    std::ptr::from_ref(of).cast::<()>() as usize
}

/// A walk through a problem that ends, as an error, at the part that is looked for.
struct Search {
    address: usize,
    kind: &'static str,
    path: Vec<Part>,
}

/// The end of a walk.
#[derive(Debug)]
struct Found;

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("found")
    }
}

impl std::error::Error for Found {}

impl ser::Error for Found {
    fn custom<T: fmt::Display>(_: T) -> Self {
        Found
    }
}

impl Search {
    /// Looks at a part without a key of its own.
    fn look<T: ?Sized + Serialize>(&mut self, value: &T) -> Result<(), Found> {
        let is_kind = |kind: &str| {
            // Components are told where their list is wrong, which lies where they do.
            let list_of =
                kind == std::any::type_name::<Components>() && self.kind == std::any::type_name::<List<Value>>();
            kind == self.kind || list_of
        };
        if address(value) == self.address && is_kind(std::any::type_name::<T>()) {
            return Err(Found);
        }
        value.serialize(self)
    }

    /// Looks at what stands at a key; the path keeps it where the walk ends there.
    fn at<T: ?Sized + Serialize>(&mut self, part: Part, value: &T) -> Result<(), Found> {
        self.path.push(part);
        self.look(value)?;
        self.path.pop();
        Ok(())
    }
}

/// The entries of a list or a table on the way.
struct Entries<'a> {
    search: &'a mut Search,
    count: usize,
    /// The key whose value follows.
    key: String,
}

impl<'a> Entries<'a> {
    fn of(search: &'a mut Search) -> Result<Self, Found> {
        Ok(Self { search, count: 0, key: String::new() })
    }

    fn next<T: ?Sized + Serialize>(&mut self, value: &T) -> Result<(), Found> {
        self.count += 1;
        self.search.at(Part::Index(self.count - 1), value)
    }
}

impl ser::SerializeSeq for Entries<'_> {
    type Ok = ();
    type Error = Found;
    fn serialize_element<T: ?Sized + Serialize>(&mut self, value: &T) -> Result<(), Found> {
        self.next(value)
    }
    fn end(self) -> Result<(), Found> {
        Ok(())
    }
}

impl ser::SerializeTuple for Entries<'_> {
    type Ok = ();
    type Error = Found;
    fn serialize_element<T: ?Sized + Serialize>(&mut self, value: &T) -> Result<(), Found> {
        self.next(value)
    }
    fn end(self) -> Result<(), Found> {
        Ok(())
    }
}

impl ser::SerializeStruct for Entries<'_> {
    type Ok = ();
    type Error = Found;
    fn serialize_field<T: ?Sized + Serialize>(&mut self, key: &'static str, value: &T) -> Result<(), Found> {
        self.search.at(Part::Key(key.into()), value)
    }
    fn end(self) -> Result<(), Found> {
        Ok(())
    }
}

impl ser::SerializeMap for Entries<'_> {
    type Ok = ();
    type Error = Found;
    fn serialize_key<T: ?Sized + Serialize>(&mut self, key: &T) -> Result<(), Found> {
        let text = serde_json::to_value(key).map_err(|_| Found)?;
        self.key = text.as_str().unwrap_or_default().into();
        Ok(())
    }
    fn serialize_value<T: ?Sized + Serialize>(&mut self, value: &T) -> Result<(), Found> {
        let key = std::mem::take(&mut self.key);
        self.search.at(Part::Key(key), value)
    }
    fn end(self) -> Result<(), Found> {
        Ok(())
    }
}

/// Serialisers of leaves, in which there is nothing to find.
macro_rules! leaves {
    ($($name:ident: $kind:ty),*) => { $(fn $name(self, _: $kind) -> Result<(), Found> { Ok(()) })* };
}

impl<'a> ser::Serializer for &'a mut Search {
    type Ok = ();
    type Error = Found;
    type SerializeSeq = Entries<'a>;
    type SerializeTuple = Entries<'a>;
    type SerializeTupleStruct = ser::Impossible<(), Found>;
    type SerializeTupleVariant = ser::Impossible<(), Found>;
    type SerializeMap = Entries<'a>;
    type SerializeStruct = Entries<'a>;
    type SerializeStructVariant = ser::Impossible<(), Found>;

    leaves!(serialize_bool: bool, serialize_i8: i8, serialize_i16: i16, serialize_i32: i32, serialize_i64: i64,
        serialize_u8: u8, serialize_u16: u16, serialize_u32: u32, serialize_u64: u64, serialize_f32: f32,
        serialize_f64: f64, serialize_char: char, serialize_str: &str, serialize_bytes: &[u8],
        serialize_unit_struct: &'static str);

    fn serialize_none(self) -> Result<(), Found> {
        Ok(())
    }
    fn serialize_unit(self) -> Result<(), Found> {
        Ok(())
    }
    fn serialize_unit_variant(self, _: &'static str, _: u32, _: &'static str) -> Result<(), Found> {
        Ok(())
    }
    fn serialize_some<T: ?Sized + Serialize>(self, value: &T) -> Result<(), Found> {
        self.look(value)
    }
    fn serialize_newtype_struct<T: ?Sized + Serialize>(self, _: &'static str, value: &T) -> Result<(), Found> {
        self.look(value)
    }
    fn serialize_newtype_variant<T: ?Sized + Serialize>(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        value: &T,
    ) -> Result<(), Found> {
        self.at(Part::Key(variant.into()), value)
    }
    fn serialize_seq(self, _: Option<usize>) -> Result<Entries<'a>, Found> {
        Entries::of(self)
    }
    fn serialize_tuple(self, _: usize) -> Result<Entries<'a>, Found> {
        Entries::of(self)
    }
    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<Self::SerializeTupleStruct, Found> {
        unreachable!("problems have no structs without keys")
    }
    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self::SerializeTupleVariant, Found> {
        unreachable!("every variant of a problem holds one thing")
    }
    fn serialize_map(self, _: Option<usize>) -> Result<Entries<'a>, Found> {
        Entries::of(self)
    }
    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Entries<'a>, Found> {
        Entries::of(self)
    }
    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self::SerializeStructVariant, Found> {
        unreachable!("every variant of a problem holds one thing")
    }
    /// Arrays of numbers are not walked through.
    fn is_human_readable(&self) -> bool {
        false
    }
}
