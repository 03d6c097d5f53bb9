//! Histories of supports and nodal loads, node by node, and the supports and loads that follow from them.

use crate::curve::{Curve, JUMP};
use crate::deck::{Axes, Deck, Load, LoadKind, Place, Support};
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// How a value changes within a step.
#[derive(Clone, Debug)]
pub(super) enum Change {
    /// Linearly from the value before to the new one.
    Ramp,
    /// At once.
    Jump,
    /// The new value times an amplitude: times since the start of the step, and factors.
    Amplitude(Vec<[f64; 2]>),
}

/// The time that a step takes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) from: f64,
    pub(super) to: f64,
}

/// Continues a history through a step to a new value.
pub(super) fn continued(before: Option<&Curve>, value: f64, change: &Change, span: Span) -> Curve {
    let mut curve = before.cloned().unwrap_or_else(|| Curve::constant(0.0));
    let (from, to) = (span.from, span.to);
    let start = curve.at(from);
    let jump = JUMP * (to - from);
    // A jump at the very start is no jump: nothing was before.
    let begin = |curve: &mut Curve, first: f64| {
        if from > 0.0 && first != start {
            curve.push(from, start);
            curve.push(from + jump, first);
        } else {
            curve.push(from, first);
        }
    };
    match change {
        Change::Ramp => {
            curve.push(from, start);
            curve.push(to, value);
        }
        Change::Jump => begin(&mut curve, value),
        Change::Amplitude(points) => {
            let factor = Curve::through(points.iter().copied());
            begin(&mut curve, value * factor.at(0.0));
            for [time, f] in points.iter().filter(|p| p[0] > 0.0 && p[0] < to - from) {
                curve.push(from + time, value * f);
            }
            curve.push(to, value * factor.at(to - from));
        }
    }
    curve
}

/// The histories of one kind, by node and direction, each with the set or node that names it.
#[derive(Clone, Debug, Default)]
pub(super) struct NodeHistories {
    list: BTreeMap<u64, BTreeMap<usize, (String, Curve)>>,
    /// The time at which the history of a node and a direction begins, where that is not the start.
    begins: BTreeMap<(u64, usize), f64>,
}

impl NodeHistories {
    pub(super) fn get(&self, node: u64, direction: usize) -> Option<&Curve> {
        Some(&self.list.get(&node)?.get(&direction)?.1)
    }

    /// Sets a history; nodes that are named one by one have no name in common but `nodes`.
    pub(super) fn set(&mut self, node: u64, direction: usize, target: &str, curve: Curve) {
        let target = if target.parse::<u64>().is_ok() { "nodes" } else { target };
        self.list.entry(node).or_default().insert(direction, (target.to_string(), curve));
    }

    /// Whether the history of a node and a direction begins after the start.
    pub(super) fn begins_later(&self, node: u64, direction: usize) -> bool {
        self.begins.contains_key(&(node, direction))
    }

    /// Sets the time at which a history begins.
    pub(super) fn begin(&mut self, node: u64, direction: usize, time: f64) {
        if time > 0.0 {
            self.begins.insert((node, direction), time);
        }
    }

    /// Moves the history of a node and a direction to others.
    pub(super) fn end(&mut self, node: u64, direction: usize, to: &mut NodeHistories) {
        if let Some(own) = self.list.get_mut(&node).and_then(|list| list.remove(&direction)) {
            to.list.entry(node).or_default().insert(direction, own);
        }
        if let Some(time) = self.begins.remove(&(node, direction)) {
            to.begin(node, direction, time);
        }
        self.list.retain(|_, list| !list.is_empty());
    }

    pub(super) fn keys(&self) -> Vec<(u64, usize)> {
        self.list.iter().flat_map(|(node, list)| list.keys().map(|d| (*node, *d))).collect()
    }

    pub(super) fn has(&self, node: u64) -> bool {
        self.list.contains_key(&node)
    }

    /// Takes out the histories of a node by direction, with the names of their places.
    pub(super) fn take_named(&mut self, node: u64) -> BTreeMap<usize, (String, Curve)> {
        self.list.remove(&node).unwrap_or_default()
    }

    /// Takes out the histories of a node.
    pub(super) fn take(&mut self, node: u64) -> Vec<(usize, Curve)> {
        let list = self.list.remove(&node).unwrap_or_default();
        list.into_iter().map(|(direction, (_, curve))| (direction, curve)).collect()
    }

    /// Nodes that have the same histories along the same axes under the same names, with their place.
    fn places(&self, deck: &Deck, axes: &BTreeMap<u64, Axes>) -> Vec<(Place, BTreeMap<usize, (String, Curve)>)> {
        let mut groups: Vec<(BTreeMap<usize, (String, Curve)>, Vec<u64>)> = Vec::new();
        let mut found: BTreeMap<String, usize> = BTreeMap::new();
        for (node, histories) in &self.list {
            let key = format!("{histories:?} {:?}", axes.get(node));
            let at = *found.entry(key).or_insert_with(|| {
                groups.push((histories.clone(), Vec::new()));
                groups.len() - 1
            });
            groups[at].1.push(*node);
        }
        let place = |(histories, nodes): (BTreeMap<usize, (String, Curve)>, Vec<u64>)| {
            let names: BTreeSet<&String> = histories.values().map(|(name, _)| name).collect();
            let is_whole = |name: &str| {
                deck.node_sets.get(name).is_some_and(|(_, set)| {
                    set.iter().collect::<BTreeSet<_>>() == nodes.iter().collect::<BTreeSet<_>>()
                })
            };
            let set = names.iter().find(|name| is_whole(name)).and_then(|name| deck.node_sets.get(name));
            let place = match set {
                Some((name, _)) => Place::NodeSet(name.to_string()),
                None => {
                    let joined: Vec<String> = names.iter().take(3).map(|n| n.to_string()).collect();
                    Place::Nodes(joined.join("_"), nodes)
                }
            };
            (place, histories)
        };
        groups.into_iter().map(place).collect()
    }

    /// The supports of prescribed displacements, which hold until a time if one is given: one for each direction, so that sets of
    /// nodes that overlap stay whole, with the faces that they contain.
    pub(super) fn supports(&self, deck: &Deck, axes: &BTreeMap<u64, Axes>, until: Option<f64>) -> Vec<Support> {
        let mut apart: BTreeMap<(OrderedTime, usize), NodeHistories> = BTreeMap::new();
        for (node, list) in &self.list {
            for (direction, history) in list {
                let from = self.begins.get(&(*node, *direction)).copied();
                let own = apart.entry((OrderedTime(from), *direction)).or_default();
                own.list.entry(*node).or_default().insert(*direction, history.clone());
            }
        }
        let mut out = Vec::new();
        for ((OrderedTime(from), _), own) in apart {
            let support = |(on, mut histories): (Place, BTreeMap<usize, (String, Curve)>)| {
                let displacement = std::array::from_fn(|d| histories.remove(&d).map(|(_, curve)| curve));
                let node = match &on {
                    Place::NodeSet(name) => deck.node_sets.get(name).and_then(|(_, nodes)| nodes.first()),
                    Place::Nodes(_, nodes) => nodes.first(),
                    _ => None,
                };
                let axes = node.and_then(|node| axes.get(node)).cloned();
                Support { on, displacement, axes, tied: [false; 3], from, until }
            };
            out.extend(own.places(deck, axes).into_iter().map(support));
        }
        out
    }

    /// The loads of forces on nodes.
    pub(super) fn loads(&self, deck: &Deck) -> Vec<Load> {
        let load = |(on, mut histories): (Place, BTreeMap<usize, (String, Curve)>)| {
            let zero = || Curve::constant(0.0);
            let force = std::array::from_fn(|d| histories.remove(&d).map_or_else(zero, |(_, curve)| curve));
            Load { on, kind: LoadKind::NodalForce(force) }
        };
        self.places(deck, &BTreeMap::new()).into_iter().map(load).collect()
    }
}

/// A time, or none before all others.
#[derive(Clone, Copy, Debug, PartialEq)]
struct OrderedTime(Option<f64>);

impl Eq for OrderedTime {}

impl Ord for OrderedTime {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.unwrap_or(f64::NEG_INFINITY).total_cmp(&other.0.unwrap_or(f64::NEG_INFINITY))
    }
}

impl PartialOrd for OrderedTime {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Nodes that have the same displacement in a direction.
#[derive(Clone, Debug, Default)]
pub(super) struct EqualDisplacements {
    classes: Vec<(usize, BTreeSet<u64>)>,
}

impl EqualDisplacements {
    /// Two nodes have the same displacement in a direction.
    pub(super) fn join(&mut self, direction: usize, nodes: [u64; 2]) {
        let touches = |(d, list): &(usize, BTreeSet<u64>)| *d == direction && nodes.iter().any(|n| list.contains(n));
        let (joined, rest): (Vec<_>, Vec<_>) = self.classes.drain(..).partition(touches);
        let all = joined.into_iter().flat_map(|(_, list)| list).chain(nodes).collect();
        self.classes = rest;
        self.classes.push((direction, all));
    }

    pub(super) fn contains(&self, node: u64) -> bool {
        self.classes.iter().any(|(_, nodes)| nodes.contains(&node))
    }

    /// Supports in which the nodes of each class are tied. A class with a prescribed node is prescribed as a whole.
    pub(super) fn apply(&self, supports: &mut NodeHistories) -> Vec<Support> {
        let mut tied: BTreeMap<&BTreeSet<u64>, [bool; 3]> = BTreeMap::new();
        for (direction, nodes) in &self.classes {
            match nodes.iter().find_map(|n| supports.get(*n, *direction).cloned()) {
                Some(curve) => nodes.iter().for_each(|n| supports.set(*n, *direction, "equal", curve.clone())),
                None => tied.entry(nodes).or_default()[*direction] = true,
            }
        }
        let support = |(nodes, tied): (&BTreeSet<u64>, [bool; 3])| {
            let on = Place::Nodes("equal".into(), nodes.iter().copied().collect());
            Support { on, displacement: [None, None, None], axes: None, tied, from: None, until: None }
        };
        tied.into_iter().map(support).collect()
    }
}
