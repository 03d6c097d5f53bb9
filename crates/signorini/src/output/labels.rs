//! Names of axes with the units of the case.

use crate::problem::Space;
use crate::report::UnitNames;

/// The units of a case, where it states any.
pub struct Labels(pub Option<UnitNames>);

impl Labels {
    fn with(&self, what: &str, unit: fn(&UnitNames) -> &String) -> String {
        self.0.as_ref().map_or_else(|| what.to_string(), |units| format!("{what} [{}]", unit(units)))
    }

    pub fn length(&self, what: &str) -> String {
        self.with(what, |u| &u.length)
    }

    pub fn area(&self, what: &str) -> String {
        self.with(what, |u| &u.area)
    }

    pub fn force(&self, what: &str) -> String {
        self.with(what, |u| &u.force)
    }

    pub fn force_per_length(&self, what: &str) -> String {
        self.0.as_ref().map_or_else(|| what.to_string(), |units| format!("{what} [{}/{}]", units.force, units.length))
    }

    pub fn moment(&self, what: &str) -> String {
        self.0.as_ref().map_or_else(|| what.to_string(), |units| format!("{what} [{} {}]", units.force, units.length))
    }

    pub fn pressure(&self, what: &str) -> String {
        self.with(what, |u| &u.pressure)
    }

    pub fn temperature(&self) -> String {
        self.with("T", |u| &u.temperature)
    }

    /// What the axes are called.
    pub fn axes(&self, space: Space) -> [String; 3] {
        let first = if space == Space::Axisymmetric { "r" } else { "x" };
        [first, "y", "z"].map(|name| self.length(name))
    }
}
