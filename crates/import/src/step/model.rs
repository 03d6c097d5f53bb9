//! Access to instances and their parameters.

use super::exchange::{Parameter, Record};
use super::{StepError, StepFile};

/// A record with the number of its instance, for messages.
#[derive(Clone, Copy)]
pub(super) struct Entity<'a> {
    pub file: &'a StepFile,
    pub id: u64,
    pub record: &'a Record,
}

impl StepFile {
    /// The one record of a simple instance, or the first of a complex one.
    pub(super) fn entity(&self, id: u64) -> Result<Entity<'_>, StepError> {
        match self.instances.get(&id).and_then(|i| i.records.first()) {
            Some(record) => Ok(Entity { file: self, id, record }),
            None => Err(self.error(id, format!("#{id} is not in the file"), "export the file again: it is not whole")),
        }
    }

    /// The record with a name of an instance.
    pub(super) fn record(&self, id: u64, name: &str) -> Option<Entity<'_>> {
        let record = self.instances.get(&id)?.records.iter().find(|r| r.name == name)?;
        Some(Entity { file: self, id, record })
    }

    /// What an instance stands for that only adds to another one, such as a curve on surfaces: `of` are the names of those, with
    /// the number of the parameter that refers to the other.
    pub(super) fn behind(&self, id: u64, of: &[(&str, usize)]) -> Result<Entity<'_>, StepError> {
        // A curve of a curve of a curve and so on is a circle.
        const DEEPEST: usize = 8;
        let mut entity = self.entity(id)?;
        for _ in 0..DEEPEST {
            match of.iter().find(|(name, _)| *name == entity.name()) {
                Some((_, k)) => entity = entity.entity(*k)?,
                None => return Ok(entity),
            }
        }
        Err(entity.error("it refers to itself", "export the file again: it is damaged"))
    }

    /// All instances with a record of a name.
    pub(super) fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = Entity<'a>> {
        self.instances.keys().filter_map(move |id| self.record(*id, name))
    }
}

impl<'a> Entity<'a> {
    pub fn name(&self) -> &'a str {
        &self.record.name
    }

    fn wrong(&self, k: usize, wanted: &str) -> StepError {
        self.file.error(self.id, format!("parameter {} is not {wanted}", k + 1), "export the file again: it is damaged")
    }

    pub fn get(&self, k: usize) -> &'a Parameter {
        self.record.parameters.get(k).unwrap_or(&Parameter::Omitted)
    }

    /// The instance that a parameter refers to.
    pub fn reference(&self, k: usize) -> Result<u64, StepError> {
        match self.get(k) {
            Parameter::Reference(id) => Ok(*id),
            _ => Err(self.wrong(k, "a reference")),
        }
    }

    pub fn entity(&self, k: usize) -> Result<Entity<'a>, StepError> {
        self.file.entity(self.reference(k)?)
    }

    pub fn number(&self, k: usize) -> Result<f64, StepError> {
        match self.get(k) {
            Parameter::Number(x) => Ok(*x),
            // A measure with its type.
            Parameter::Typed(_, list) => match list[..] {
                [Parameter::Number(x)] => Ok(x),
                _ => Err(self.wrong(k, "a number")),
            },
            _ => Err(self.wrong(k, "a number")),
        }
    }

    pub fn count(&self, k: usize) -> Result<usize, StepError> {
        match self.number(k)? {
            x if x >= 0.0 && x.fract() == 0.0 && x < 1e6 => Ok(x as usize),
            _ => Err(self.wrong(k, "a count")),
        }
    }

    pub fn flag(&self, k: usize) -> Result<bool, StepError> {
        match self.get(k) {
            Parameter::Enumeration(word) => match &word[..] {
                "T" | "TRUE" => Ok(true),
                "F" | "FALSE" => Ok(false),
                _ => Err(self.wrong(k, ".T. or .F.")),
            },
            _ => Err(self.wrong(k, ".T. or .F.")),
        }
    }

    pub fn text(&self, k: usize) -> &'a str {
        match self.get(k) {
            Parameter::Text(text) => text,
            _ => "",
        }
    }

    pub fn list(&self, k: usize) -> Result<&'a [Parameter], StepError> {
        match self.get(k) {
            Parameter::List(list) => Ok(list),
            _ => Err(self.wrong(k, "a list")),
        }
    }

    pub fn references(&self, k: usize) -> Result<Vec<u64>, StepError> {
        let of = |p: &Parameter| match p {
            Parameter::Reference(id) => Ok(*id),
            _ => Err(self.wrong(k, "a list of references")),
        };
        self.list(k)?.iter().map(of).collect()
    }

    pub fn numbers(&self, k: usize) -> Result<Vec<f64>, StepError> {
        numbers(self.list(k)?).ok_or_else(|| self.wrong(k, "a list of numbers"))
    }

    /// A list of lists.
    pub fn rows<T>(&self, k: usize, of: impl Fn(&[Parameter]) -> Option<T>) -> Result<Vec<T>, StepError> {
        let row = |p: &Parameter| match p {
            Parameter::List(list) => of(list),
            _ => None,
        };
        self.list(k)?.iter().map(|p| row(p).ok_or_else(|| self.wrong(k, "a list of lists"))).collect()
    }

    pub fn error(&self, message: impl Into<String>, help: impl Into<String>) -> StepError {
        self.file.error(self.id, message, help)
    }
}

pub(super) fn numbers(list: &[Parameter]) -> Option<Vec<f64>> {
    let of = |p: &Parameter| match p {
        Parameter::Number(x) => Some(*x),
        _ => None,
    };
    list.iter().map(of).collect()
}

pub(super) fn references(list: &[Parameter]) -> Option<Vec<u64>> {
    let of = |p: &Parameter| match p {
        Parameter::Reference(id) => Some(*id),
        _ => None,
    };
    list.iter().map(of).collect()
}
