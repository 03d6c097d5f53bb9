//! Histories as values of a case: a number, an expression of `t`, or a table of `[functions]`.

use crate::curve::Curve;
use std::fmt::Write;

/// The tables that histories need.
#[derive(Clone, Debug)]
pub(super) struct Values {
    /// The time at the end of all steps.
    end: f64,
    tables: Vec<Curve>,
}

impl Values {
    pub(super) fn new(end: f64) -> Self {
        Self { end, tables: Vec::new() }
    }

    /// The value of a key.
    pub(super) fn value(&mut self, curve: &Curve) -> String {
        if let Some(value) = curve.as_constant() {
            return format!("{value:?}");
        }
        if let Some(slope) = curve.as_ramp(self.end) {
            return format!("\"{slope:?}*t\"");
        }
        let found = self.tables.iter().position(|c| c == curve).unwrap_or_else(|| {
            self.tables.push(curve.clone());
            self.tables.len() - 1
        });
        format!("\"curve_{}(t)\"", found + 1)
    }

    /// The values of a vector with the given number of components.
    pub(super) fn vector(&mut self, curves: &[Curve; 3], dimension: usize) -> String {
        let list: Vec<String> = curves[..dimension].iter().map(|c| self.value(c)).collect();
        format!("[{}]", list.join(", "))
    }

    /// The tables of `[functions]`.
    pub(super) fn tables(&self) -> String {
        let mut out = String::new();
        for (k, curve) in self.tables.iter().enumerate() {
            let list = |i: usize| curve.points().iter().map(|p| format!("{:?}", p[i])).collect::<Vec<_>>().join(", ");
            let _ = writeln!(out, "\n[functions.curve_{}.table]\nt = [{}]\nvalue = [{}]", k + 1, list(0), list(1));
        }
        out
    }
}
