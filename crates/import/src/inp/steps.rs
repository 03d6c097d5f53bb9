//! Steps: what supports and loads do in each of them.

use super::boundary::{Change, NodeHistories, Span, continued};
use super::card::Card;
use crate::ImportError;
use crate::curve::Curve;
use crate::deck::Step;
use std::collections::BTreeMap;

/// The most increments of a step whose increments the other program chooses by itself.
const MOST_INCREMENTS: usize = 20;

/// What a distributed load is: where, and which.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Distributed {
    /// Elements, or a surface.
    pub(super) on: String,
    pub(super) kind: DistributedKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum DistributedKind {
    /// On a face of elements.
    Face(usize),
    /// On a surface.
    Surface,
    /// Force per volume along an axis.
    Body(usize),
    /// Acceleration along an axis.
    Gravity(usize),
}

/// A value that a step states.
#[derive(Clone, Debug)]
struct Stated {
    target: String,
    value: f64,
    change: Change,
}

/// What is stated since the last step ended.
#[derive(Clone, Debug, Default)]
struct Pending {
    supports: BTreeMap<(u64, usize), Stated>,
    forces: BTreeMap<(u64, usize), Stated>,
    distributed: BTreeMap<Distributed, Stated>,
    /// Whether all earlier loads of a kind are removed.
    new_supports: bool,
    new_forces: bool,
    new_distributed: bool,
}

/// A kind of conditions that a step may state anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Conditions {
    Supports,
    Forces,
    Distributed,
}

/// The histories of all supports and loads.
#[derive(Clone, Debug, Default)]
pub(super) struct Histories {
    pub(super) supports: NodeHistories,
    pub(super) forces: NodeHistories,
    pub(super) distributed: BTreeMap<Distributed, Curve>,
    pub(super) steps: Vec<Step>,
    /// Supports that were released, by the time until which they hold.
    pub(super) ended: Vec<(f64, NodeHistories)>,
    pending: Pending,
    /// Time and increments of the step that is being read.
    analysis: Option<(f64, usize)>,
}

impl Histories {
    fn start(&self) -> f64 {
        self.steps.last().map_or(0.0, |s| s.to)
    }

    /// `*STATIC`: first increment and time of the step.
    pub(super) fn analysis(&mut self, card: &Card) -> Result<Option<String>, ImportError> {
        let first = card.data.first();
        let [increment, time] = [0, 1].map(|k| first.map_or(Ok(None), |data| card.number(data, k)));
        let time = time?.filter(|t| *t > 0.0).unwrap_or(1.0);
        let increment = increment?.filter(|t| *t > 0.0).unwrap_or(time).min(time);
        let wanted = ((time / increment) - 1e-9).ceil() as usize;
        let count = if card.has("DIRECT") { wanted } else { wanted.min(MOST_INCREMENTS) };
        self.analysis = Some((time, count));
        Ok((count < wanted)
            .then(|| format!("*{}: {count} increments in place of {wanted}; they are cut where needed", card.keyword)))
    }

    /// `OP=NEW` removes all earlier conditions of a kind.
    pub(super) fn renew(&mut self, what: Conditions) {
        match what {
            Conditions::Supports => self.pending.new_supports = true,
            Conditions::Forces => self.pending.new_forces = true,
            Conditions::Distributed => self.pending.new_distributed = true,
        }
    }

    pub(super) fn support(&mut self, node: u64, direction: usize, target: &str, value: f64, change: &Change) {
        let stated = Stated { target: target.into(), value, change: change.clone() };
        self.pending.supports.insert((node, direction), stated);
    }

    /// Forces on the same node add up within a step.
    pub(super) fn force(&mut self, node: u64, direction: usize, target: &str, value: f64, change: &Change) {
        let new = || Stated { target: target.into(), value: 0.0, change: change.clone() };
        self.pending.forces.entry((node, direction)).or_insert_with(new).value += value;
    }

    pub(super) fn distributed(&mut self, load: Distributed, value: f64, change: &Change) {
        let new = || Stated { target: String::new(), value: 0.0, change: change.clone() };
        self.pending.distributed.entry(load).or_insert_with(new).value += value;
    }

    /// Ends a step: all histories go on to its end, but for those of supports that are released in it.
    pub(super) fn end_step(&mut self) {
        let (time, increments) = self.analysis.take().unwrap_or((1.0, 1));
        let span = Span { from: self.start(), to: self.start() + time };
        let pending = std::mem::take(&mut self.pending);
        if pending.new_supports {
            let mut ended = NodeHistories::default();
            for (node, direction) in self.supports.keys() {
                if !pending.supports.contains_key(&(node, direction)) {
                    self.supports.end(node, direction, &mut ended);
                }
            }
            if !ended.keys().is_empty() {
                self.ended.push((span.from, ended));
            }
        }
        for ((node, direction), stated) in pending.supports {
            if self.supports.get(node, direction).is_none() {
                self.supports.begin(node, direction, span.from);
            }
            let curve = continued(self.supports.get(node, direction), stated.value, &stated.change, span);
            self.supports.set(node, direction, &stated.target, curve);
        }
        if pending.new_forces {
            for (node, direction) in self.forces.keys() {
                if !pending.forces.contains_key(&(node, direction)) {
                    let curve = continued(self.forces.get(node, direction), 0.0, &Change::Ramp, span);
                    self.forces.set(node, direction, &node.to_string(), curve);
                }
            }
        }
        for ((node, direction), stated) in pending.forces {
            let curve = continued(self.forces.get(node, direction), stated.value, &stated.change, span);
            self.forces.set(node, direction, &stated.target, curve);
        }
        if pending.new_distributed {
            for (load, curve) in &mut self.distributed {
                if !pending.distributed.contains_key(load) {
                    *curve = continued(Some(curve), 0.0, &Change::Ramp, span);
                }
            }
        }
        for (load, stated) in pending.distributed {
            let curve = continued(self.distributed.get(&load), stated.value, &stated.change, span);
            self.distributed.insert(load, curve);
        }
        self.steps.push(Step { to: span.to, increments });
    }
}
