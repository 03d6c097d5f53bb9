//! The way to a part of a problem, and how it is found: by where that part lies in memory.
//!
//! A reader of a problem holds references to its parts. Where one of them is wrong, the problem is walked through once until
//! the part at that address and of that type is met, and the keys on the way to it are its path. So no reader carries paths
//! along, and no plain type carries one in it.

use crate::{Problem, walk};
use serde::Serialize;
use serde::de::DeserializeOwned;
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
    find_at(problem, walk::address(part), std::any::type_name::<T>())
}

/// Without parameters, so that the walk is compiled once.
fn find_at(problem: &Problem, address: usize, kind: &'static str) -> Option<KeyPath> {
    walk::find(problem, address, kind).map(KeyPath)
}
