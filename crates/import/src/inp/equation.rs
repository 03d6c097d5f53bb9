//! `*EQUATION`: linear equations between displacements of nodes.

use super::card::Card;
use super::model::Model;
use crate::ImportError;
use crate::curve::Curve;
use crate::deck::Equation;
use std::collections::{BTreeSet, HashSet};

/// An equation as it stands in the deck.
#[derive(Clone, Debug)]
pub(super) struct StatedEquation {
    /// Node, direction from 0, coefficient.
    terms: Vec<(u64, usize, f64)>,
    line: usize,
}

impl Model {
    pub(super) fn equation(&mut self, card: &Card) -> Result<(), ImportError> {
        let dimension = self.deck.space().dimension() as u64;
        let mut rest = card.data.iter();
        while let Some(head) = rest.next() {
            let count = card.whole(head, 0, "the number of terms")? as usize;
            let mut terms: Vec<(u64, usize, f64)> = Vec::new();
            while terms.len() < count {
                let data = rest.next().ok_or_else(|| card.wrong(head, "terms are missing"))?;
                for k in (0..data.fields.len()).step_by(3).filter(|k| data.fields.get(k + 2).is_some()) {
                    let coefficient = card.required_number(data, k + 2, "a coefficient")?;
                    let node = card.whole(data, k, "the number of a node")?;
                    let direction = card.whole(data, k + 1, "a direction")?;
                    if !(1..=dimension).contains(&direction) {
                        return Err(card.wrong(data, format!("direction {direction}: valid are 1 to {dimension}")));
                    }
                    if !self.deck.nodes.contains_key(&node) {
                        return Err(card.wrong(data, format!("there is no node {node}")));
                    }
                    terms.push((node, direction as usize - 1, coefficient));
                }
                if data.fields.len() < 3 {
                    return Err(card.wrong(data, "expected node, direction, coefficient"));
                }
            }
            match terms[..] {
                [(a, d, p), (b, e, q)] if d == e && p == -q && p != 0.0 => self.equal.join(d, [a, b]),
                _ => self.equations.push(StatedEquation { terms, line: head.line }),
            }
        }
        Ok(())
    }

    /// The equations between nodes of elements along the axes of space. What is prescribed of a node without elements makes their
    /// value.
    pub(super) fn equations(&self) -> Result<Vec<Equation>, ImportError> {
        let meshed: HashSet<u64> = self.deck.elements.iter().flat_map(|e| e.nodes.iter().copied()).collect();
        let released: BTreeSet<u64> =
            self.histories.ended.iter().flat_map(|(_, list)| list.keys()).map(|(node, _)| node).collect();
        let mut out = Vec::new();
        for stated in &self.equations {
            let wrong = |node: u64, what: &str| {
                let message = format!("*EQUATION: the node {node} {what}: cannot be imported");
                Err(ImportError::new(&self.deck.file, stated.line, message))
            };
            let mut equation = Equation { terms: Vec::new(), value: Curve::constant(0.0), line: stated.line };
            for &(node, direction, coefficient) in &stated.terms {
                if self.reference(node) {
                    return wrong(node, "moves a rigid body");
                }
                let mut factor = [0.0; 3];
                if meshed.contains(&node) {
                    match self.transformed.get(&node) {
                        Some(axes) => match self.deck.nodes.get(&node).and_then(|x| axes.at(x)) {
                            Some(e) => factor = e[direction].map(|v| coefficient * v),
                            None => return wrong(node, "lies on the line about which its axes turn"),
                        },
                        None => factor[direction] = coefficient,
                    }
                    match equation.terms.iter_mut().find(|(other, _)| *other == node) {
                        Some((_, sum)) => (0..3).for_each(|k| sum[k] += factor[k]),
                        None => equation.terms.push((node, factor)),
                    }
                    continue;
                }
                if released.contains(&node) || self.histories.supports.begins_later(node, direction) {
                    return wrong(node, "belongs to no element and is not prescribed in all steps");
                }
                let Some(curve) = self.histories.supports.get(node, direction) else {
                    return wrong(node, "belongs to no element, and *BOUNDARY does not prescribe it");
                };
                equation.value = equation.value.plus(&curve.scaled(-coefficient));
            }
            equation.terms.retain(|(_, factor)| *factor != [0.0; 3]);
            if let Some((node, ..)) = stated.terms.first().filter(|_| equation.terms.is_empty()) {
                return wrong(*node, "and the others of the equation leave no displacement of an element in it");
            }
            out.push(equation);
        }
        Ok(out)
    }
}
