//! The way to a part of a problem, as keys.

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
