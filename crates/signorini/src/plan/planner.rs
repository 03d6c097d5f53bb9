//! Values in the context of one problem: units, constants and functions.

use super::located::LocatedExpression;
use super::reader::Reader;
use crate::expression::{Definition, Names};
use crate::problem::units::Units;
use crate::problem::{self, CaseError, KeyPath, Location, Problem, ProblemPart, Space, Value, suggestion};
use crate::report::Warning;
use signorini_import::Deck;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;

/// Reads values in the context of one problem.
pub(crate) struct Planner<'a> {
    pub problem: &'a Problem,
    pub reader: Reader<'a>,
    pub space: Space,
    /// Whether the cells of solids are halved, to estimate errors where functions cannot be raised.
    pub halves: bool,
    /// What looks wrong in files that were read.
    pub warnings: RefCell<Vec<Warning>>,
    /// Decks that were read, by their paths.
    pub decks: RefCell<BTreeMap<PathBuf, Rc<Deck>>>,
}

/// Names of the position's coordinates, by space.
pub(crate) fn coordinates(space: Space) -> &'static [&'static str] {
    match space {
        Space::Line | Space::Axisymmetric => &["x", "t"],
        _ => &["x", "y", "t"],
    }
}

impl<'a> Planner<'a> {
    pub(crate) fn new(problem: &'a Problem) -> Result<Self, CaseError> {
        let units = match &problem.units {
            None => None,
            Some(key) => Some(match key {
                problem::UnitSystem::System(name) => Units::system(name).ok_or_else(|| {
                    problem
                        .error(key, format!("unknown system of units `{name}`"))
                        .help(suggestion(name, &["m-N-Pa", "mm-N-MPa", "um-uN-MPa"]))
                })?,
                problem::UnitSystem::Base(b) => Units::from_names([&b.length, &b.force, &b.time, &b.temperature])
                    .map_err(|message| problem.error(key, message))?,
            }),
        };
        let mut planner = Self {
            problem,
            reader: Reader { problem, units, names: Names::default(), interpreted: RefCell::default() },
            space: problem.space,
            halves: false,
            warnings: RefCell::default(),
            decks: RefCell::default(),
        };
        planner.define_constants()?;
        planner.define_functions()?;
        Ok(planner)
    }

    /// Constants may use each other in any order, but not in a circle.
    fn define_constants(&mut self) -> Result<(), CaseError> {
        let mut open: Vec<(&String, &Value)> = self.problem.constants.iter().collect();
        for (name, value) in &open {
            self.check_name(name, self.key(*value))?;
        }
        while !open.is_empty() {
            let before = open.len();
            let mut first_error = None;
            let mut left = Vec::new();
            for (name, value) in open {
                if let Some(angle) = self.reader.in_degrees(value)? {
                    self.reader.names.constants.insert(name.clone(), angle);
                    continue;
                }
                match self.reader.any(value, &[]) {
                    Ok((e, _)) => {
                        let v = e.constant().unwrap_or(f64::NAN);
                        if !v.is_finite() {
                            return Err(self
                                .problem
                                .error(value, format!("the constant `{name}` is {v}, not a finite number")));
                        }
                        self.reader.names.constants.insert(name.clone(), v);
                    }
                    Err(error) => {
                        first_error.get_or_insert(error);
                        left.push((name, value));
                    }
                }
            }
            open = left;
            if open.len() == before {
                let circle = open.iter().all(|(_, v)| self.mentions(v, open.iter().map(|(n, _)| n.as_str())));
                return Err(match first_error {
                    Some(_) if circle => self
                        .problem
                        .error(open[0].1, format!("the constant `{}` depends on itself", open[0].0))
                        .help("a constant may use others, but not itself, directly or indirectly"),
                    Some(error) => error,
                    None => CaseError::new("constants"),
                });
            }
        }
        Ok(())
    }

    /// Functions may use each other in any order, but not in a circle.
    fn define_functions(&mut self) -> Result<(), CaseError> {
        let problem = self.problem;
        let mut open: Vec<_> = problem.functions.iter().collect();
        for (name, key) in &open {
            self.check_name(name, self.key(*key))?;
            if self.reader.names.constants.contains_key(*name) {
                return Err(problem.error(*key, format!("`{name}` is both a constant and a function")));
            }
        }
        while !open.is_empty() {
            let before = open.len();
            let mut first_error = None;
            let mut left = Vec::new();
            for (name, key) in open {
                match self.function(name, key) {
                    Ok(definition) => {
                        self.reader.names.functions.insert(name.clone(), Arc::new(definition));
                    }
                    Err(error) => {
                        first_error.get_or_insert(error);
                        left.push((name, key));
                    }
                }
            }
            open = left;
            if open.len() == before {
                let names: Vec<&str> = open.iter().map(|(n, _)| n.as_str()).collect();
                let circle = open
                    .iter()
                    .find(|(_, k)| k.expression.as_ref().is_some_and(|v| self.mentions(v, names.iter().copied())));
                return Err(match (circle, first_error) {
                    (Some((name, key)), _) => problem
                        .error(*key, format!("the function `{name}` calls itself, directly or indirectly"))
                        .help("functions may use each other, but not in a circle"),
                    (None, Some(error)) => error,
                    (None, None) => CaseError::new("functions"),
                });
            }
        }
        Ok(())
    }

    pub(crate) fn function(&self, name: &str, key: &problem::TimeFunction) -> Result<Definition, CaseError> {
        let error = |at: &KeyPath, message: String| self.problem.error(at, message);
        match (&key.table, &key.expression) {
            (Some(table), None) => {
                let (t, value) = (&table.t, &table.value);
                if t.is_empty() || t.len() != value.len() {
                    return Err(error(
                        &self.key(table),
                        format!("`t` has {} entries and `value` {}", t.len(), value.len()),
                    )
                    .help("both require the same number of entries, at least one"));
                }
                if t.iter().chain(value).any(|v| !v.is_finite()) {
                    return Err(error(&self.key(table), "the table contains a number that is not finite".into()));
                }
                if let Some(i) = (1..t.len()).find(|&i| t[i] <= t[i - 1]) {
                    return Err(error(
                        &self.key(table),
                        format!("`t` does not increase: {} follows {}", t[i], t[i - 1]),
                    ));
                }
                Ok(Definition::Table { t: t.0.clone(), value: value.0.clone() })
            }
            (None, Some(value)) => Ok(Definition::Formula(self.reader.any(value, &["t"])?.0)),
            _ => Err(error(&self.key(key), format!("the function `{name}` requires either `table` or `expression`"))),
        }
    }

    /// Whether a value's text uses one of the names as a word.
    fn mentions<'b>(&self, value: &Value, mut names: impl Iterator<Item = &'b str>) -> bool {
        let Value::Text(text) = value else { return false };
        let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
        names.any(|n| words.contains(&n))
    }

    pub(crate) fn check_name(&self, name: &str, at: KeyPath) -> Result<(), CaseError> {
        let word =
            name.chars().all(|c| c.is_alphanumeric() || c == '_') && !name.starts_with(|c: char| c.is_ascii_digit());
        let taken = ["x", "y", "z", "t", "pi", "e", "if"].contains(&name);
        match (word, taken) {
            (true, false) => Ok(()),
            (true, true) => Err(self.problem.error(&at, format!("`{name}` already has a meaning in expressions"))),
            (false, _) => Err(self
                .problem
                .error(&at, format!("`{name}` cannot be used in an expression"))
                .help("a name consists of letters, digits and _, and does not begin with a digit")),
        }
    }

    pub(crate) fn unavailable(&self, at: &impl Location, what: &str) -> CaseError {
        self.problem.error(at, format!("{what} is not available in this version"))
    }

    /// The way to a part of the problem.
    pub(crate) fn key<T: ProblemPart>(&self, part: &T) -> KeyPath {
        self.problem.key(part)
    }

    pub(crate) fn placed(
        &self,
        value: &Value,
        dimension: problem::units::Dimension,
    ) -> Result<LocatedExpression, CaseError> {
        let expression = self.reader.expression(value, dimension, coordinates(self.space))?;
        Ok(LocatedExpression { expression, key: self.key(value) })
    }
}
