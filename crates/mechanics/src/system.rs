//! Many bodies in one system: supports, loads and contacts at one time, assembled.
//!
//! The unknowns are those of the bodies one after the other, then the multipliers of the contacts, then those of the
//! equations of supports that couple several unknowns. An unknown that a support prescribes by itself keeps its place;
//! its equation says so, and its residual is the reaction.

use crate::body::{Body, BodyError, BodyState, Constraint, Contribution, PlaceError};
use crate::dynamics::{Dynamics, Mass};
use crate::heat::Heat;
use crate::interaction::{Assembler, Bodies, Interaction, InteractionUnknowns};
use crate::linear_bodies::LinearBodies;
use crate::linear_constraint::LinearConstraint;
pub use crate::linear_constraint::OfTime;
use crate::linear_solver::{LinearSolver, Stiffness};
pub use crate::placed::{PlacedLoad, Support, TimeField, TimeVectorField, TimedLoad};
use crate::points::Order;
use crate::processes::{CellBlock, Division};
use crate::time_step::TimeStep;
use crate::unstable::Unstable;
use signorini_geometry::Vector;
use signorini_solve::general::{Entries, Matrix};
use std::collections::BTreeMap;

/// Bodies with what holds, pushes and joins them.
#[derive(Default)]
pub struct System {
    pub bodies: Vec<Box<dyn Body>>,
    pub supports: Vec<Support>,
    pub loads: Vec<PlacedLoad>,
    pub contacts: Vec<Box<dyn Interaction>>,
    /// Equations between displacements of single nodes.
    pub constraints: Vec<LinearConstraint>,
    pub solver: LinearSolver,
    /// What is done with states that are not stable.
    pub unstable: Unstable,
    /// What is known of linear bodies, from the first step on.
    pub linear: LinearBodies,
    /// How bodies move from the next increment on; none where they are in equilibrium.
    pub dynamics: Option<Dynamics>,
    /// What each body weighs; nothing before dynamics are asked for.
    pub masses: Vec<Option<Mass>>,
    /// The increment in time that is being solved.
    pub step: Option<TimeStep>,
    /// Temperatures and heat; none where nothing is known of them.
    pub heat: Option<Heat>,
    /// The temperatures of bodies in the increment that is being solved; none where they stay as they are.
    pub temperatures: Vec<Vec<f64>>,
    /// How several processes solve it together; none where one does.
    pub division: Option<Division>,
}

/// A state of the system.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SystemState {
    /// The time that it was solved for.
    pub time: f64,
    pub bodies: Vec<BodyState>,
    /// Tractions that are unknowns, of all contacts.
    pub multipliers: Vec<f64>,
    /// Multipliers of the supports that couple unknowns.
    pub reactions: Vec<f64>,
    /// What each contact predicts for the next iteration.
    pub(crate) predictions: Vec<Vec<f64>>,
    /// Steps of the unknowns of the bodies since the last state that was accepted.
    pub(crate) travel: Vec<f64>,
    /// Velocities of the unknowns of the bodies, angular velocities of spins; none before they move with inertia.
    pub velocities: Vec<f64>,
    /// Accelerations by which the method in time goes on, and those that forces balance with, damping by mass included: the same
    /// where nothing is damped (Arnold and Brüls 2007).
    pub(crate) accelerations: Vec<f64>,
    pub(crate) balancing: Vec<f64>,
    /// What equilibrium lacks where there is a mass.
    pub(crate) forces: Vec<f64>,
    /// Energy that is still to be taken from the velocities of each body.
    pub owed: Vec<f64>,
}

impl SystemState {
    /// Takes all motion out of the state.
    pub fn come_to_rest(&mut self) {
        let of_motion =
            [&mut self.velocities, &mut self.accelerations, &mut self.balancing, &mut self.forces, &mut self.owed];
        of_motion.into_iter().for_each(Vec::clear);
    }
}

/// Why a system cannot be assembled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AssemblyError {
    #[error(transparent)]
    Body(#[from] BodyError),
    #[error(transparent)]
    Place(#[from] PlaceError),
    /// Two supports that ask for different things.
    #[error("supports `{first}` and `{second}` contradict each other on `{body}`")]
    Contradiction { first: String, second: String, body: String },
    /// A linear constraint that asks for something else than what holds already.
    #[error("the constraint `{constraint}` contradicts {by}")]
    ContradictedConstraint { constraint: String, by: String },
}

/// What an equation is of, by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[doc(hidden)]
pub enum Holder {
    Support(usize),
    Constraint(usize),
}

/// An equation of a support or a linear constraint, in the numbers of the system.
#[derive(Clone, Debug)]
#[doc(hidden)]
pub struct Held {
    pub by: Holder,
    pub constraint: Constraint,
}

impl Held {
    /// The number of the support that it is of, if it is of one.
    pub fn support(&self) -> Option<usize> {
        match self.by {
            Holder::Support(k) => Some(k),
            Holder::Constraint(_) => None,
        }
    }

    /// Adds what the support does to its body at a value of the multiplier.
    pub fn add_reaction(&self, multiplier: f64, forces: &mut [[Vector<3>; 2]]) {
        let Some(support) = self.support() else { return };
        let own = &mut forces[support];
        own.iter_mut().zip(&self.constraint.reaction).for_each(|(sum, r)| *sum += r * multiplier);
    }
}

/// The system at a state.
pub(crate) struct Assembled {
    /// Internal forces less loads and contact forces; then the equations of the multipliers. Reactions are not in it.
    pub residual: Vec<f64>,
    /// Sum of the sizes of the terms of each equation.
    pub sizes: Vec<f64>,
    pub tangent: Entries,
    /// What the cells of this process add to the tangent, where others have others; none where all is in `tangent`.
    pub of_cells: Option<Vec<CellBlock>>,
    /// Equations that hold one unknown, and those that couple several.
    pub single: Vec<Held>,
    pub coupled: Vec<Held>,
    /// Support, and the force of it on its body, of what is held by terms in the residual.
    pub weakly_held: Vec<(usize, Vector<3>)>,
    pub energy: f64,
    /// Sites that have no coordinates.
    pub lost: usize,
}

/// What is held twice may differ by so much of the size of the body.
const SAME: f64 = 1e-9;

impl System {
    /// First unknown of each body, and their number.
    pub(crate) fn numbering(&self) -> (Vec<u32>, usize) {
        let mut first = Vec::with_capacity(self.bodies.len());
        let mut count = 0;
        for body in &self.bodies {
            first.push(count as u32);
            count += body.unknowns();
        }
        (first, count)
    }

    /// Which unknowns of the bodies are spins.
    pub(crate) fn is_spin(&self) -> Vec<bool> {
        let (first, count) = self.numbering();
        let mut out = vec![false; count];
        for (body, first) in self.bodies.iter().zip(first) {
            body.spins().iter().flatten().for_each(|s| out[(first + s) as usize] = true);
        }
        out
    }

    /// The largest extent of a body.
    pub fn size(&self) -> f64 {
        self.bodies.iter().map(|b| b.size()).fold(0.0, f64::max)
    }

    /// All bodies as they start.
    pub fn start(&self) -> SystemState {
        let (_, count) = self.numbering();
        SystemState {
            time: 0.0,
            bodies: self.bodies.iter().map(|b| b.start()).collect(),
            multipliers: vec![0.0; self.contacts.iter().map(|c| c.law().rows().count()).sum()],
            reactions: Vec::new(),
            predictions: self.contacts.iter().map(|c| c.prediction()).collect(),
            travel: vec![0.0; count],
            ..SystemState::default()
        }
    }

    /// All bodies in a state; `first` are their first unknowns.
    pub(crate) fn bodies_in<'a>(&'a self, state: &'a SystemState, first: &'a [u32]) -> Bodies<'a> {
        Bodies { bodies: &self.bodies, states: &state.bodies, first }
    }

    /// The numbers of each contact in a state.
    pub(crate) fn own<'a>(&self, state: &'a SystemState) -> Vec<InteractionUnknowns<'a>> {
        let (_, count) = self.numbering();
        let mut done = 0;
        (self.contacts.iter().enumerate())
            .map(|(k, contact)| {
                let size = contact.law().rows().count();
                let multipliers = &state.multipliers[done..done + size];
                let first = (count + done) as u32;
                done += size;
                InteractionUnknowns {
                    multipliers,
                    first,
                    prediction: state.predictions.get(k).map_or(&[], Vec::as_slice),
                }
            })
            .collect()
    }

    /// Whether supports agree with each other at a time, with the bodies at rest.
    ///
    /// # Errors
    /// Two that prescribe different displacements.
    pub fn check_supports(&self, time: f64) -> Result<(), AssemblyError> {
        self.held(&self.start().bodies, time)?;
        Ok(())
    }

    /// Adds what all contacts do in a state; how many of their sites have no coordinates.
    pub(crate) fn add_contacts(&self, state: &SystemState, target: &mut Assembler<'_>) -> Result<usize, PlaceError> {
        let (first, _) = self.numbering();
        let mut lost = 0;
        for (contact, own) in self.contacts.iter().zip(self.own(state)) {
            lost += contact.add_to(self.bodies_in(state, &first), own, target)?;
        }
        Ok(lost)
    }

    /// The equations of all supports.
    pub(crate) fn held(&self, bodies: &[BodyState], time: f64) -> Result<(Vec<Held>, Vec<Held>), AssemblyError> {
        let (first, count) = self.numbering();
        let mut by_unknown: Vec<Option<usize>> = vec![None; count];
        let (mut single, mut coupled): (Vec<Held>, Vec<Held>) = (Vec::new(), Vec::new());
        for (number, support) in self.supports.iter().enumerate() {
            let body = &self.bodies[support.part.body];
            let (on, own) = (support.part.group.as_deref(), &bodies[support.part.body]);
            let list = support.at(time, |hold| body.hold(on, hold, own))?;
            for mut constraint in list {
                constraint.terms.iter_mut().for_each(|t| t.0 += first[support.part.body]);
                let held = Held { by: Holder::Support(number), constraint };
                let [(unknown, factor)] = held.constraint.terms[..] else {
                    coupled.push(held);
                    continue;
                };
                let place = &mut by_unknown[unknown as usize];
                let Some(before) = place.map(|k| &single[k]) else {
                    *place = Some(single.len());
                    single.push(held);
                    continue;
                };
                let violation = |h: &Held, factor: f64| h.constraint.violation / factor;
                let other = violation(before, before.constraint.terms[0].1);
                if (violation(&held, factor) - other).abs() > SAME * body.size() {
                    return Err(AssemblyError::Contradiction {
                        first: self.holder(before.by).to_string(),
                        second: support.name.clone(),
                        body: body.name().to_string(),
                    });
                }
            }
        }
        let held_at = |unknown: u32| Some(&single[by_unknown[unknown as usize]?]);
        let mut coupled = self.independent(coupled, held_at)?;
        coupled.extend(self.constrained(&first, (bodies, time), held_at, &coupled)?);
        Ok((single, coupled))
    }

    /// The equations between several unknowns that are not said twice: some are by those that hold one unknown, or by the same
    /// equation of another support.
    fn independent<'a>(
        &self,
        coupled: Vec<Held>,
        single: impl Fn(u32) -> Option<&'a Held>,
    ) -> Result<Vec<Held>, AssemblyError> {
        let mut out: Vec<Held> = Vec::with_capacity(coupled.len());
        let mut by_first: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for held in coupled {
            let Some(support) = held.support() else { continue };
            let body = &self.bodies[self.supports[support].part.body];
            let terms = &held.constraint.terms;
            let size = terms.iter().fold(0.0f64, |m, t| m.max(t.1.abs()));
            let counts: Vec<(u32, f64)> = terms.iter().copied().filter(|t| t.1.abs() > SAME * size).collect();
            // An equation without terms is nobody's twin.
            let Some(&(first, _)) = counts.first() else {
                out.push(held);
                continue;
            };
            // What others leave of what is lacking, and the support that says the same.
            let said = if counts.iter().all(|(unknown, _)| single(*unknown).is_some()) {
                let others = counts.iter().filter_map(|(unknown, f)| Some((f, single(*unknown)?)));
                let done: f64 = others.map(|(f, h)| f * h.constraint.violation / h.constraint.terms[0].1).sum();
                single(first).map(|h| (h.by, held.constraint.violation - done))
            } else {
                let alike = by_first.get(&first).into_iter().flatten().map(|k| &out[*k]);
                let mut found = alike.filter_map(|other| Some((other, ratio(terms, &other.constraint.terms)?)));
                found.next().map(|(other, r)| (other.by, held.constraint.violation - r * other.constraint.violation))
            };
            match said {
                Some((other, violation)) if violation.abs() > SAME * body.size() * size => {
                    return Err(AssemblyError::Contradiction {
                        first: self.holder(other).to_string(),
                        second: self.supports[support].name.clone(),
                        body: body.name().to_string(),
                    });
                }
                Some(_) => {}
                None => {
                    by_first.entry(first).or_default().push(out.len());
                    out.push(held);
                }
            }
        }
        Ok(out)
    }

    /// The state after a share of a step of all unknowns.
    ///
    /// # Panics
    /// If the step is shorter than the unknowns of the bodies and the multipliers of the contacts.
    pub fn advance(&self, at: &SystemState, step: &[f64], share: f64) -> SystemState {
        let (first, count) = self.numbering();
        let bodies = (self.bodies.iter().zip(&at.bodies).zip(&first))
            .map(|((body, state), &first)| {
                let own = &step[first as usize..first as usize + body.unknowns()];
                body.advance(state, own, share)
            })
            .collect();
        let multipliers: Vec<f64> = at.multipliers.iter().zip(&step[count..]).map(|(m, s)| m + share * s).collect();
        let rest = &step[count + multipliers.len()..];
        let reaction = |k: usize| at.reactions.get(k).copied().unwrap_or(0.0);
        let reactions = rest.iter().enumerate().map(|(k, s)| reaction(k) + share * s).collect();
        let travel = at.travel.iter().zip(step).map(|(t, s)| t + share * s).collect();
        let now = self.bodies_in(at, &first);
        let predictions = (self.contacts.iter().zip(self.own(at)))
            .map(|(contact, own)| contact.predict(now, own, step, share))
            .collect();
        SystemState {
            time: at.time,
            bodies,
            multipliers,
            reactions,
            predictions,
            travel,
            velocities: at.velocities.clone(),
            accelerations: at.accelerations.clone(),
            balancing: at.balancing.clone(),
            forces: at.forces.clone(),
            owed: at.owed.clone(),
        }
    }

    /// The residual at a state and a time, without the reactions of supports, and its derivative; of a system that is divided
    /// among processes without the derivative of its bodies.
    ///
    /// # Errors
    /// States and places that cannot be.
    pub fn linearise(&self, at: &SystemState, time: f64) -> Result<(Vec<f64>, Matrix), AssemblyError> {
        let out = self.assemble(at, time, Order::Second)?;
        let matrix = out.tangent.matrix(out.residual.len());
        Ok((out.residual, matrix))
    }

    /// Residual, and the tangent if asked for.
    pub(crate) fn assemble(&self, state: &SystemState, time: f64, order: Order) -> Result<Assembled, AssemblyError> {
        self.assemble_with(state, time, order, Stiffness::InTangent)
    }

    /// Residual, and the tangent if asked for, with or without the stiffness of linear bodies.
    pub(crate) fn assemble_with(
        &self,
        state: &SystemState,
        time: f64,
        order: Order,
        stiffness: Stiffness,
    ) -> Result<Assembled, AssemblyError> {
        let (first, count) = self.numbering();
        let multipliers = state.multipliers.len();
        let (single, coupled) = self.held(&state.bodies, time)?;
        let size = count + multipliers + coupled.len();
        let mut residual = vec![0.0; size];
        let mut sizes = vec![0.0; size];
        let mut tangent = match stiffness {
            Stiffness::InTangent | Stiffness::Condensed => Entries::default(),
            Stiffness::KeptByBodies => Entries::in_blocks(),
        };
        // What of the tangent of a body is the same in all states, and what is not.
        let is_condensed = |body: usize| stiffness == Stiffness::Condensed && self.is_condensed()[body];
        let constant = |body: usize| if is_condensed(body) { Order::First } else { order };
        let mut of_cells = self.division.as_ref().map(|_| Vec::new());
        let mut energy = 0.0;
        for (k, (body, (state, &first))) in self.bodies.iter().zip(state.bodies.iter().zip(&first)).enumerate() {
            let mut out = Contribution::new(body.unknowns());
            let order = if stiffness == Stiffness::KeptByBodies { Order::First } else { constant(k) };
            let added = body.internal(state, order, &mut out);
            energy += match &self.division {
                Some(division) => division.summed(added, &mut out)?,
                None => added?,
            };
            if let Some(step) = &self.step {
                step.scale(first, &mut out);
            }
            if let Some(of_cells) = &mut of_cells {
                let blocks = std::mem::take(&mut out.blocks).into_iter();
                of_cells.extend(blocks.map(|(unknowns, entries)| {
                    let unknowns = unknowns.into_iter().map(|u| u + first).collect();
                    CellBlock { unknowns, entries }
                }));
            }
            add(&out, first, &mut residual, &mut sizes, &mut tangent);
        }
        for load in &self.loads {
            let k = load.part.body;
            let (body, first) = (&self.bodies[k], first[k]);
            let mut out = Contribution::new(body.unknowns());
            let order = if load.load.is_constant() { constant(k) } else { order };
            load.act(body.as_ref(), &state.bodies[k], time, order, &mut out)?;
            add(&out, first, &mut residual, &mut sizes, &mut tangent);
        }
        let mut weakly_held = Vec::new();
        for (number, support) in self.supports.iter().enumerate() {
            let (body, own) = (&self.bodies[support.part.body], &state.bodies[support.part.body]);
            let mut out = Contribution::new(body.unknowns());
            let on = support.part.group.as_deref();
            let order = constant(support.part.body);
            if let Some(force) = support.at(time, |hold| body.hold_weakly(on, hold, own, order, &mut out))? {
                add(&out, first[support.part.body], &mut residual, &mut sizes, &mut tangent);
                weakly_held.push((number, force));
            }
        }
        if let Some(step) = &self.step {
            let tangent = (order == Order::Second).then_some(&mut tangent);
            step.add_to(self, state, (&mut residual, &mut sizes), tangent);
        }
        let lost = self.add_contacts(
            state,
            &mut Assembler {
                residual: &mut residual,
                sizes: &mut sizes,
                tangent: (order == Order::Second).then_some(&mut tangent),
            },
        )?;
        for (k, held) in coupled.iter().enumerate() {
            let row = count + multipliers + k;
            let reaction = state.reactions.get(k).copied().unwrap_or(0.0);
            residual[row] = held.constraint.violation;
            for &(unknown, factor) in &held.constraint.terms {
                residual[unknown as usize] += factor * reaction;
                sizes[unknown as usize] += (factor * reaction).abs();
                if order == Order::Second {
                    tangent.add(row as u32, unknown, factor);
                    tangent.add(unknown, row as u32, factor);
                }
            }
        }
        Ok(Assembled { residual, sizes, tangent, of_cells, single, coupled, weakly_held, energy, lost })
    }
}

/// By what one list of terms is to be multiplied to give another one; none if by nothing.
fn ratio(of: &[(u32, f64)], to: &[(u32, f64)]) -> Option<f64> {
    let (_, first) = to.iter().find(|t| t.0 == of[0].0)?;
    let ratio = of[0].1 / first;
    let is_alike = |((u, a), (v, b)): (&(u32, f64), &(u32, f64))| u == v && (a - ratio * b).abs() <= SAME * a.abs();
    (of.len() == to.len() && of.iter().zip(to).all(is_alike)).then_some(ratio)
}

pub(crate) fn add(from: &Contribution, first: u32, residual: &mut [f64], sizes: &mut [f64], tangent: &mut Entries) {
    for (k, force) in from.forces.iter().enumerate() {
        residual[first as usize + k] += force;
        sizes[first as usize + k] += force.abs();
    }
    for (unknowns, values) in &from.blocks {
        let unknowns: Vec<u32> = unknowns.iter().map(|u| u + first).collect();
        tangent.add_block(&unknowns, values);
    }
}
