//! Access to the elements of an XML file, with the lines of errors.

use crate::ImportError;
use roxmltree::{Document, Node};
use std::path::Path;

/// A file that is being read.
pub(crate) struct File<'a> {
    pub(crate) path: &'a Path,
    pub(crate) document: &'a Document<'a>,
}

/// The children of a name.
pub(crate) fn children<'a, 'i: 'a>(node: Node<'a, 'i>, name: &'static str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(move |n| n.is_element() && n.tag_name().name() == name)
}

/// The first child of a name.
pub(crate) fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|n| n.is_element() && n.tag_name().name() == name)
}

/// The text of an element, without blanks around.
pub(crate) fn text(node: Node) -> String {
    node.text().unwrap_or_default().trim().to_string()
}

impl File<'_> {
    pub(crate) fn line(&self, node: Node) -> usize {
        self.document.text_pos_at(node.range().start).row as usize
    }

    /// What is wrong with an element.
    pub(crate) fn wrong(&self, node: Node, message: impl Into<String>) -> ImportError {
        let message = format!("<{}>: {}", node.tag_name().name(), message.into());
        ImportError::new(self.path, self.line(node), message)
    }

    /// The numbers in the text of an element.
    pub(crate) fn numbers(&self, node: Node) -> Result<Vec<f64>, ImportError> {
        let parse = |t: &str| {
            let number: Option<f64> = t.parse().ok().filter(|v: &f64| v.is_finite());
            number.ok_or_else(|| self.wrong(node, format!("expected numbers, found `{t}`")))
        };
        let text = node.text().unwrap_or_default();
        text.split(|c: char| c == ',' || c.is_whitespace()).filter(|t| !t.is_empty()).map(parse).collect()
    }

    pub(crate) fn number(&self, node: Node) -> Result<f64, ImportError> {
        match self.numbers(node)?[..] {
            [number] => Ok(number),
            _ => Err(self.wrong(node, format!("expected a number, found `{}`", text(node)))),
        }
    }

    pub(crate) fn vector(&self, node: Node) -> Result<[f64; 3], ImportError> {
        let numbers = self.numbers(node)?;
        <[f64; 3]>::try_from(numbers)
            .map_err(|_| self.wrong(node, format!("expected three numbers, found `{}`", text(node))))
    }

    /// Numbers of nodes or elements.
    pub(crate) fn whole(&self, node: Node, text: &str) -> Result<Vec<u64>, ImportError> {
        let parse = |t: &str| t.parse().map_err(|_| self.wrong(node, format!("expected whole numbers, found `{t}`")));
        text.split(|c: char| c == ',' || c.is_whitespace()).filter(|t| !t.is_empty()).map(parse).collect()
    }

    /// An attribute that must be there.
    pub(crate) fn attribute<'n>(&self, node: Node<'n, '_>, name: &str) -> Result<&'n str, ImportError> {
        node.attribute(name).ok_or_else(|| self.wrong(node, format!("the attribute `{name}` is missing")))
    }

    /// Whether a switch is on; off if it is not there.
    pub(crate) fn is_on(&self, node: Node, name: &str) -> Result<bool, ImportError> {
        child(node, name).map_or(Ok(false), |n| Ok(self.number(n)? != 0.0))
    }
}
