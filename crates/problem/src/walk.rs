//! The one walk through all types of a problem: each of them is compiled for it alone. It looks for a part, or it writes what
//! it meets as a tree.

use crate::key_path::Part;
use crate::tree::Tree;
use crate::{Components, List, Value};
use serde::ser::{self, Serialize};
use std::fmt;

/// A walk.
pub struct Walk {
    /// Address and type of the part that is looked for; none if all is written.
    sought: Option<(usize, &'static str)>,
    /// The keys on the way.
    path: Vec<Part>,
}

/// The end of a walk: the part was found, or something cannot be written.
#[derive(Debug)]
pub struct Ended;

impl fmt::Display for Ended {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("found")
    }
}

impl std::error::Error for Ended {}

impl ser::Error for Ended {
    fn custom<T: fmt::Display>(_: T) -> Self {
        Ended
    }
}

/// The way to the part of the given type at an address.
pub fn find(within: &impl Serialize, address: usize, kind: &'static str) -> Option<Vec<Part>> {
    let mut walk = Walk { sought: Some((address, kind)), path: Vec::new() };
    within.serialize(&mut walk).is_err().then_some(walk.path)
}

/// What a part states, but for what no text states.
pub fn written(part: &impl Serialize) -> Option<Tree> {
    part.serialize(&mut Walk { sought: None, path: Vec::new() }).ok()
}

pub fn address<T: ?Sized>(of: &T) -> usize {
    std::ptr::from_ref(of).cast::<()>() as usize
}

/// A look at something of any type.
type Look<'a> = dyn FnMut(&mut Walk) -> Result<Tree, Ended> + 'a;

impl Walk {
    /// Looks at a part without a key of its own.
    fn look<T: ?Sized + Serialize>(&mut self, value: &T) -> Result<Tree, Ended> {
        if self.is_sought(address(value), std::any::type_name::<T>()) {
            return Err(Ended);
        }
        value.serialize(self)
    }

    fn is_sought(&self, at: usize, kind: &str) -> bool {
        let Some((address, sought)) = self.sought else { return false };
        // Components are told where their list is wrong, which lies where they do.
        let list_of = || kind == std::any::type_name::<Components>() && sought == std::any::type_name::<List<Value>>();
        address == at && (kind == sought || list_of())
    }

    /// Looks, as told, at what stands at a key; the path keeps it where the walk ends there.
    fn at(&mut self, part: Part, look: &mut Look<'_>) -> Result<Tree, Ended> {
        self.path.push(part);
        let tree = look(self)?;
        self.path.pop();
        Ok(tree)
    }

    fn kind(&mut self, kind: &'static str, look: &mut Look<'_>) -> Result<Tree, Ended> {
        let tree = self.at(Part::Key(kind.into()), look)?;
        self.leaf(|| Tree::Kind(kind, tree.into()))
    }

    fn leaf(&self, tree: impl FnOnce() -> Tree) -> Result<Tree, Ended> {
        Ok(if self.sought.is_some() { Tree::None } else { tree() })
    }
}

/// The entries of a list on the way.
pub struct Entries<'a> {
    walk: &'a mut Walk,
    count: usize,
    written: Vec<Tree>,
}

impl Entries<'_> {
    fn next(&mut self, look: &mut Look<'_>) -> Result<(), Ended> {
        let tree = self.walk.at(Part::Index(self.count), look)?;
        self.count += 1;
        if self.walk.sought.is_none() {
            self.written.push(tree);
        }
        Ok(())
    }
}

impl ser::SerializeSeq for Entries<'_> {
    type Ok = Tree;
    type Error = Ended;
    fn serialize_element<T: ?Sized + Serialize>(&mut self, value: &T) -> Result<(), Ended> {
        self.next(&mut |walk| walk.look(value))
    }
    fn end(self) -> Result<Tree, Ended> {
        Ok(Tree::List(self.written))
    }
}

impl ser::SerializeTuple for Entries<'_> {
    type Ok = Tree;
    type Error = Ended;
    fn serialize_element<T: ?Sized + Serialize>(&mut self, value: &T) -> Result<(), Ended> {
        self.next(&mut |walk| walk.look(value))
    }
    fn end(self) -> Result<Tree, Ended> {
        Ok(Tree::List(self.written))
    }
}

/// The keys of a table on the way.
pub struct Keys<'a> {
    walk: &'a mut Walk,
    /// The key whose value follows.
    key: String,
    written: Vec<(String, Tree)>,
}

impl Keys<'_> {
    fn next(&mut self, key: &str, look: &mut Look<'_>) -> Result<(), Ended> {
        let tree = self.walk.at(Part::Key(key.into()), look)?;
        if !matches!(tree, Tree::None) {
            self.written.push((key.into(), tree));
        }
        Ok(())
    }
}

impl ser::SerializeStruct for Keys<'_> {
    type Ok = Tree;
    type Error = Ended;
    fn serialize_field<T: ?Sized + Serialize>(&mut self, key: &'static str, value: &T) -> Result<(), Ended> {
        self.next(key, &mut |walk| walk.look(value))
    }
    fn end(self) -> Result<Tree, Ended> {
        Ok(Tree::Table(self.written))
    }
}

impl ser::SerializeMap for Keys<'_> {
    type Ok = Tree;
    type Error = Ended;
    fn serialize_key<T: ?Sized + Serialize>(&mut self, key: &T) -> Result<(), Ended> {
        let mut walk = Walk { sought: None, path: Vec::new() };
        let Tree::Text(key) = key.serialize(&mut walk)? else { return Err(Ended) };
        self.key = key;
        Ok(())
    }
    fn serialize_value<T: ?Sized + Serialize>(&mut self, value: &T) -> Result<(), Ended> {
        let key = std::mem::take(&mut self.key);
        self.next(&key, &mut |walk| walk.look(value))
    }
    fn end(self) -> Result<Tree, Ended> {
        Ok(Tree::Table(self.written))
    }
}

/// Serialisers of leaves, in which there is nothing to find.
macro_rules! leaves {
    ($($name:ident: $kind:ty => $leaf:ident),*) => {
        $(fn $name(self, value: $kind) -> Result<Tree, Ended> { self.leaf(|| Tree::$leaf(value.into())) })*
    };
}

impl<'a> ser::Serializer for &'a mut Walk {
    type Ok = Tree;
    type Error = Ended;
    type SerializeSeq = Entries<'a>;
    type SerializeTuple = Entries<'a>;
    type SerializeTupleStruct = ser::Impossible<Tree, Ended>;
    type SerializeTupleVariant = ser::Impossible<Tree, Ended>;
    type SerializeMap = Keys<'a>;
    type SerializeStruct = Keys<'a>;
    type SerializeStructVariant = ser::Impossible<Tree, Ended>;

    leaves!(serialize_bool: bool => Bool, serialize_i8: i8 => Integer, serialize_i16: i16 => Integer,
        serialize_i32: i32 => Integer, serialize_i64: i64 => Integer, serialize_u8: u8 => Integer,
        serialize_u16: u16 => Integer, serialize_u32: u32 => Integer, serialize_u64: u64 => Integer,
        serialize_f32: f32 => Number, serialize_f64: f64 => Number, serialize_char: char => Text,
        serialize_str: &str => Text);

    fn serialize_bytes(self, _: &[u8]) -> Result<Tree, Ended> {
        unreachable!("problems have no bytes")
    }
    fn serialize_unit_struct(self, _: &'static str) -> Result<Tree, Ended> {
        unreachable!("problems have no structs without keys")
    }
    fn serialize_none(self) -> Result<Tree, Ended> {
        Ok(Tree::None)
    }
    fn serialize_unit(self) -> Result<Tree, Ended> {
        Ok(Tree::None)
    }
    fn serialize_unit_variant(self, _: &'static str, _: u32, variant: &'static str) -> Result<Tree, Ended> {
        self.leaf(|| Tree::Text(variant.into()))
    }
    fn serialize_some<T: ?Sized + Serialize>(self, value: &T) -> Result<Tree, Ended> {
        self.look(value)
    }
    fn serialize_newtype_struct<T: ?Sized + Serialize>(self, _: &'static str, value: &T) -> Result<Tree, Ended> {
        self.look(value)
    }
    fn serialize_newtype_variant<T: ?Sized + Serialize>(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        value: &T,
    ) -> Result<Tree, Ended> {
        self.kind(variant, &mut |walk| walk.look(value))
    }
    fn serialize_seq(self, _: Option<usize>) -> Result<Entries<'a>, Ended> {
        Ok(Entries { walk: self, count: 0, written: Vec::new() })
    }
    fn serialize_tuple(self, _: usize) -> Result<Entries<'a>, Ended> {
        Ok(Entries { walk: self, count: 0, written: Vec::new() })
    }
    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<Self::SerializeTupleStruct, Ended> {
        unreachable!("problems have no structs without keys")
    }
    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self::SerializeTupleVariant, Ended> {
        unreachable!("every variant of a problem holds one thing")
    }
    fn serialize_map(self, _: Option<usize>) -> Result<Keys<'a>, Ended> {
        Ok(Keys { walk: self, key: String::new(), written: Vec::new() })
    }
    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Keys<'a>, Ended> {
        Ok(Keys { walk: self, key: String::new(), written: Vec::new() })
    }
    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self::SerializeStructVariant, Ended> {
        unreachable!("every variant of a problem holds one thing")
    }
    /// What is looked for is in no array of numbers.
    fn is_human_readable(&self) -> bool {
        self.sought.is_none()
    }
}
