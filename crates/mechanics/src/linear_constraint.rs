//! Linear equations between displacements of single nodes: `Σ a_k·u_k = value`.
//!
//! Each has a multiplier `m`: the force on the node `k` is `m a_k`. Equations that say what supports or other equations say too
//! are found by elimination with the unknowns of these, and have no multiplier of their own.

use crate::body::{Body, BodyState, Constraint, Hold, PlaceError};
use crate::part::Part;
use crate::system::{AssemblyError, Held, Holder, System};
use signorini_geometry::{Point, Vector};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A number by time.
pub type OfTime = Arc<dyn Fn(f64) -> f64 + Send + Sync>;

/// The displacement of a node times a vector.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstraintTerm {
    /// A group of a body with one node.
    pub part: Part,
    pub factor: Vector<3>,
}

/// The sum of all terms is a value by time.
#[derive(Clone)]
pub struct LinearConstraint {
    pub name: String,
    pub terms: Vec<ConstraintTerm>,
    pub value: OfTime,
}

/// What is left of an equation below this part of its largest term says nothing.
const SAME: f64 = 1e-9;

impl ConstraintTerm {
    /// A component of the displacement of the node as an equation of its body: its violation is the displacement less `wanted` at
    /// the reference position.
    fn component(
        &self,
        body: &dyn Body,
        state: &BodyState,
        component: usize,
        wanted: &dyn Fn(&Point<3>) -> f64,
    ) -> Result<Constraint, PlaceError> {
        let mut hold = Hold::default();
        hold.displacement[component] = Some(wanted);
        let mut found = body.hold(self.part.group.as_deref(), &hold, state)?;
        let count = found.len();
        match found.pop() {
            Some(own) if count == 1 => Ok(own),
            _ => Err(PlaceError::Unsuitable {
                body: body.name().to_string(),
                message: format!(
                    "`{}` has {count} places that can be held: a term of a constraint is the displacement of one node",
                    self.part.group.as_deref().unwrap_or("the whole body")
                ),
            }),
        }
    }

    /// Reference position of the node, and its displacement in a state.
    ///
    /// # Errors
    /// A place that is not a single node.
    pub fn place(&self, bodies: &[Box<dyn Body>], states: &[BodyState]) -> Result<[Vector<3>; 2], PlaceError> {
        let (body, state) = (bodies[self.part.body].as_ref(), &states[self.part.body]);
        let start = body.start();
        let mut out = [Vector::<3>::zeros(); 2];
        for k in 0..3 {
            // A body in the plane has no third component.
            let Ok(at_start) = self.component(body, &start, k, &|x| x[k]) else { continue };
            out[0][k] = -at_start.violation;
            out[1][k] = self.component(body, state, k, &|_| 0.0)?.violation;
        }
        Ok(out)
    }
}

impl LinearConstraint {
    /// The equation in the numbers of the system, of which `first` are the first unknowns of the bodies.
    ///
    /// # Errors
    /// A place that is not a single node of a solid.
    pub fn equation(
        &self,
        (bodies, first): (&[Box<dyn Body>], &[u32]),
        states: &[BodyState],
        time: f64,
    ) -> Result<Constraint, PlaceError> {
        let mut terms: BTreeMap<u32, f64> = BTreeMap::new();
        let mut violation = -(self.value)(time);
        for term in &self.terms {
            let own = term.part.body;
            for k in (0..3).filter(|k| term.factor[*k] != 0.0) {
                let found = term.component(bodies[own].as_ref(), &states[own], k, &|_| 0.0)?;
                violation += term.factor[k] * found.violation;
                for (unknown, factor) in found.terms {
                    *terms.entry(first[own] + unknown).or_default() += term.factor[k] * factor;
                }
            }
        }
        let terms = terms.into_iter().filter(|t| t.1 != 0.0).collect();
        Ok(Constraint { terms, violation, ..Constraint::default() })
    }
}

/// An equation from which others are eliminated: the unknown that it gives, by which others, and who says so.
struct Row {
    terms: BTreeMap<u32, f64>,
    /// The sum of the terms of a step, plus this, is zero.
    rest: f64,
    /// Size of the terms before others were eliminated.
    size: f64,
    /// Numbers of the equations that it is made of.
    of: Vec<Holder>,
}

impl Row {
    /// Takes a multiple of another equation away.
    fn less(&mut self, share: f64, other: &Row) {
        for (unknown, factor) in &other.terms {
            *self.terms.entry(*unknown).or_default() -= share * factor;
        }
        self.rest -= share * other.rest;
        other
            .of
            .iter()
            .filter(|h| !self.of.contains(h))
            .copied()
            .collect::<Vec<_>>()
            .into_iter()
            .for_each(|h| self.of.push(h));
    }
}

impl System {
    /// The equations of linear constraints that are not said already, by supports or by each other. `single` finds what a support
    /// prescribes of an unknown, `coupled` are its equations between several.
    ///
    /// # Errors
    /// Places that are not single nodes, and equations that contradict each other.
    pub(crate) fn constrained<'a>(
        &self,
        first: &[u32],
        (bodies, time): (&[BodyState], f64),
        single: impl Fn(u32) -> Option<&'a Held>,
        coupled: &[Held],
    ) -> Result<Vec<Held>, AssemblyError> {
        let mut out = Vec::new();
        if self.constraints.is_empty() {
            return Ok(out);
        }
        let row = |held: &Held| {
            let terms = &held.constraint.terms;
            let size = terms.iter().fold(0.0f64, |m, t| m.max(t.1.abs()));
            let mut row = Row { terms: BTreeMap::new(), rest: held.constraint.violation, size, of: vec![held.by] };
            for &(unknown, factor) in terms {
                match single(unknown) {
                    // The step of this unknown is known.
                    Some(other) => {
                        row.rest -= factor * other.constraint.violation / other.constraint.terms[0].1;
                        if !row.of.contains(&other.by) {
                            row.of.push(other.by);
                        }
                    }
                    None => *row.terms.entry(unknown).or_default() += factor,
                }
            }
            row
        };
        // By the unknown that each gives.
        let mut known: BTreeMap<u32, Row> = BTreeMap::new();
        let mut reduced = |mut row: Row| -> Result<bool, Row> {
            while let Some((unknown, share)) =
                row.terms.iter().find(|(u, f)| **f != 0.0 && known.contains_key(u)).map(|(u, f)| (*u, *f))
            {
                row.less(share, &known[&unknown]);
                row.terms.insert(unknown, 0.0);
            }
            let pivot = row.terms.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).map(|(u, f)| (*u, *f));
            match pivot.filter(|(_, f)| f.abs() > SAME * row.size) {
                Some((unknown, factor)) => {
                    row.terms.values_mut().for_each(|f| *f /= factor);
                    row.rest /= factor;
                    row.size /= factor.abs();
                    known.insert(unknown, row);
                    Ok(true)
                }
                None => Err(row),
            }
        };
        for held in coupled {
            let _ = reduced(row(held));
        }
        let length = self.size();
        for (k, constraint) in self.constraints.iter().enumerate() {
            let equation = constraint.equation((&self.bodies, first), bodies, time)?;
            let held = Held { by: Holder::Constraint(k), constraint: equation };
            match reduced(row(&held)) {
                Ok(_) => out.push(held),
                Err(left) if left.rest.abs() > SAME * length * left.size.max(f64::MIN_POSITIVE) => {
                    let others = left.of.iter().filter(|h| **h != held.by).map(|h| self.holder(*h));
                    return Err(AssemblyError::ContradictedConstraint {
                        constraint: constraint.name.clone(),
                        by: others.map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", "),
                    });
                }
                Err(_) => {}
            }
        }
        Ok(out)
    }

    /// The name of what holds something.
    pub(crate) fn holder(&self, by: Holder) -> &str {
        match by {
            Holder::Support(k) => &self.supports[k].name,
            Holder::Constraint(k) => &self.constraints[k].name,
        }
    }

    /// The constraints that say what supports or others before them say, at the start: they have no force of their own.
    ///
    /// # Errors
    /// As of the equations of supports.
    pub fn idle_constraints(&self, time: f64) -> Result<Vec<usize>, AssemblyError> {
        let (_, coupled) = self.held(&self.start().bodies, time)?;
        let is_idle = |k: &usize| !coupled.iter().any(|h| h.by == Holder::Constraint(*k));
        Ok((0..self.constraints.len()).filter(is_idle).collect())
    }
}
