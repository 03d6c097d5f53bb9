//! Equations between displacements of nodes.

use super::{Writer, quoted};
use crate::ImportError;
use crate::deck::Place;
use std::fmt::Write;

impl Writer<'_> {
    /// The tables of all equations.
    pub(super) fn equations(&mut self) -> Result<String, ImportError> {
        let mut out = String::new();
        let dimension = self.deck.space().dimension();
        let deck = self.deck;
        for (k, equation) in deck.equations.iter().enumerate() {
            let _ = writeln!(out, "\n[constraints.equation_{}]\nterms = [", k + 1);
            for (node, factor) in &equation.terms {
                let wrong = |what: &str| {
                    let message = format!("*EQUATION: the node {node} {what}: cannot be imported");
                    ImportError::new(&deck.file, equation.line, message)
                };
                let places = self.places_once(&Place::Nodes(node.to_string(), vec![*node]))?;
                let on = places.first().ok_or_else(|| wrong("belongs to no body"))?;
                if self.bodies[on.body].is_rigid {
                    return Err(wrong("belongs to a rigid body"));
                }
                let _ = writeln!(out, "    {{ on = {}, factor = {:?} }},", quoted(&on.text), &factor[..dimension]);
            }
            out.push_str("]\n");
            if equation.value.as_constant() != Some(0.0) {
                let _ = writeln!(out, "value = {}", self.values.value(&equation.value));
            }
        }
        Ok(out)
    }
}
