//! A body, or a named part of it.

/// Part of a body: its number and a group.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Part {
    pub body: usize,
    pub group: Option<String>,
}

impl From<usize> for Part {
    /// A whole body.
    fn from(body: usize) -> Self {
        Part { body, group: None }
    }
}
