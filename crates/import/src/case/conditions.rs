//! Supports, loads, and motions of rigid bodies.

use super::{Names, Writer, quoted};
use crate::ImportError;
use crate::curve::Curve;
use crate::deck::{Axes, LoadKind, Place, RigidMotion, Support};
use std::collections::{BTreeSet, HashSet};
use std::fmt::Write;

/// The part of a body on which something acts: its name in the case.
pub(super) struct On {
    pub(super) body: usize,
    pub(super) text: String,
}

impl Writer<'_> {
    /// The tables of all supports.
    pub(super) fn supports(&mut self) -> Result<String, ImportError> {
        let mut names = Names::default();
        let mut out = String::new();
        let dimension = self.deck.space().dimension();
        for support in merged(&self.deck.supports) {
            let places = self.places(&support.on)?;
            let several = places.iter().filter(|on| !self.bodies[on.body].is_rigid).count() > 1;
            for on in places {
                let body = &self.bodies[on.body];
                if body.is_rigid {
                    let message = format!("the support of nodes of the rigid body `{}` is left out", body.name);
                    self.remark(message);
                    continue;
                }
                let name = names.take(&named(&support.on, several.then_some(&body.name)));
                let _ = writeln!(out, "\n[supports.{name}]\non = {}", quoted(&on.text));
                if support.displacement.iter().any(Option::is_some) {
                    let list: Vec<String> = support.displacement[..dimension]
                        .iter()
                        .map(|c| c.as_ref().map_or("\"free\"".to_string(), |c| self.values.value(c)))
                        .collect();
                    let _ = writeln!(out, "displacement = [{}]", list.join(", "));
                    // What is held in all directions has no need of axes.
                    let rests = |d: &Option<Curve>| d.as_ref().and_then(Curve::as_constant) == Some(0.0);
                    let is_fixed = support.displacement[..dimension].iter().all(rests);
                    if let Some(axes) = support.axes.as_ref().filter(|_| !is_fixed) {
                        let _ = writeln!(out, "{}", axes_text(axes, dimension));
                    }
                }
                if support.tied.contains(&true) {
                    let _ = writeln!(out, "tied = {:?}", &support.tied[..dimension]);
                }
                for (key, time) in [("from", support.from), ("until", support.until)] {
                    if let Some(time) = time {
                        let _ = writeln!(out, "{key} = {time:?}");
                    }
                }
            }
        }
        for k in (0..self.bodies.len()).filter(|k| self.bodies[*k].is_rigid).collect::<Vec<_>>() {
            out.push_str(&self.rigid_support(k, &mut names));
        }
        Ok(out)
    }

    /// The tables of all loads.
    pub(super) fn loads(&mut self) -> Result<String, ImportError> {
        let mut names = Names::default();
        let mut out = String::new();
        let dimension = self.deck.space().dimension();
        for load in &self.deck.loads {
            let value = match &load.kind {
                LoadKind::NodalForce(f) => format!("nodal_force = {}", self.values.vector(f, dimension)),
                LoadKind::Traction(f) => format!("traction = {}", self.values.vector(f, dimension)),
                LoadKind::BodyForce(f) => format!("body_force = {}", self.values.vector(f, dimension)),
                LoadKind::Pressure(p) => format!("pressure = {}", self.values.value(p)),
            };
            let places = match &load.kind {
                LoadKind::NodalForce(_) if self.bodies.iter().any(|b| b.is_split) => self.places_once(&load.on)?,
                _ => self.places(&load.on)?,
            };
            let several = places.len() > 1;
            for on in places {
                let body = &self.bodies[on.body];
                if body.is_rigid {
                    let message = format!("the load on a part of the rigid body `{}` is left out", body.name);
                    self.remark(message);
                    continue;
                }
                let name = names.take(&named(&load.on, several.then_some(&body.name)));
                let _ = writeln!(out, "\n[loads.{name}]\non = {}\n{value}", quoted(&on.text));
            }
        }
        for k in 0..self.bodies.len() {
            let body = &self.bodies[k];
            let motion = self.deck.rigid.get(&body.material).filter(|_| body.is_rigid);
            let Some(force) = motion.map(|(_, m)| &m.force).filter(|f| f.iter().any(Option::is_some)) else { continue };
            let force = force.clone().map(|f| f.unwrap_or_else(|| Curve::constant(0.0)));
            let name = names.take(&body.name);
            let _ = writeln!(
                out,
                "\n[loads.{name}]\non = \"{}\"\nforce = {}",
                self.bodies[k].name.clone(),
                self.values.vector(&force, dimension)
            );
        }
        Ok(out)
    }

    /// The bodies that a place touches, with the name of that part. Groups that the mesh of a body does not have by itself are
    /// added to it.
    pub(super) fn places(&mut self, place: &Place) -> Result<Vec<On>, ImportError> {
        let mut out = Vec::new();
        for body in 0..self.bodies.len() {
            if let Some(group) = self.group(place, body)? {
                let name = &self.bodies[body].name;
                let text = group.map_or_else(|| name.clone(), |group| format!("{name}:{group}"));
                out.push(On { body, text });
            }
        }
        Ok(out)
    }

    /// The same of nodes, each in the first body that has it.
    pub(super) fn places_once(&mut self, place: &Place) -> Result<Vec<On>, ImportError> {
        let (name, nodes) = match place {
            Place::NodeSet(name) => match self.deck.node_sets.get(name) {
                Some((name, nodes)) => (name.to_string(), nodes.clone()),
                None => return self.places(place),
            },
            Place::Nodes(name, nodes) => (name.clone(), nodes.clone()),
            _ => return self.places(place),
        };
        let mut out = Vec::new();
        for body in 0..self.bodies.len() {
            let own = Place::Nodes(name.clone(), self.nodes_of_its_own(body, &nodes));
            if let Some(Some(group)) = self.group(&own, body)? {
                out.push(On { body, text: format!("{}:{group}", self.bodies[body].name) });
            }
        }
        Ok(out)
    }

    /// The group of a body that a place is, `Some(None)` for the whole body; `None` if the body has no part of it.
    fn group(&mut self, place: &Place, k: usize) -> Result<Option<Option<String>>, ImportError> {
        let deck = self.deck;
        let file = &deck.file;
        let unknown = |what: &str, name: &str| ImportError::new(file, None, format!("there is no {what} `{name}`"));
        let body = &mut self.bodies[k];
        Ok(match place {
            Place::All => Some(None),
            Place::NodeSet(name) => {
                let (name, nodes) = deck.node_sets.get(name).ok_or_else(|| unknown("set of nodes", name))?;
                nodes.iter().any(|n| body.contained.contains(n)).then(|| Some(deck.node_group(name)))
            }
            Place::Nodes(name, nodes) => {
                let own: Vec<u64> = nodes.iter().copied().filter(|n| body.contained.contains(n)).collect();
                if own.is_empty() {
                    return Ok(None);
                }
                if let Some((known, _)) = body.nodes.iter().find(|(_, list)| *list == own) {
                    return Ok(Some(Some(known.clone())));
                }
                let name = own_name(name, deck, &body.nodes, &body.sides);
                body.nodes.push((name.clone(), own));
                Some(Some(name))
            }
            Place::Surface(name) => {
                let (name, surface) = deck.surfaces.get(name).ok_or_else(|| unknown("surface", name))?;
                let whole = |face: &Vec<u64>| face.iter().all(|n| body.contained.contains(n));
                let touches =
                    surface.faces.iter().any(whole) || surface.nodes.iter().any(|n| body.contained.contains(n));
                touches.then(|| Some(name.to_string()))
            }
            Place::Faces(name, faces) => {
                let mut own = Vec::new();
                for face in faces {
                    let list = crate::mesh::faces_of(deck, std::slice::from_ref(face))
                        .map_err(|m| ImportError::new(file, None, m))?;
                    if list.iter().any(|f| f.iter().all(|n| body.contained.contains(n))) {
                        own.push(face.clone());
                    }
                }
                if own.is_empty() {
                    return Ok(None);
                }
                let name = own_name(name, deck, &body.nodes, &body.sides);
                body.sides.push((name.clone(), own));
                Some(Some(name))
            }
            Place::ElementSet(name) => {
                let list = deck.elements_of(Some(name)).ok_or_else(|| unknown("set of elements", name))?;
                let inside: HashSet<usize> = list.into_iter().filter(|e| body.elements.contains(e)).collect();
                match inside.len() {
                    0 => None,
                    n if n == body.elements.len() => Some(None),
                    _ => {
                        let name = deck.element_sets.get(name).map_or(name.as_str(), |(name, _)| name);
                        Some(Some(deck.element_group(name)))
                    }
                }
            }
        })
    }

    /// The motion of a rigid body: prescribed if all components are and it does not turn, free otherwise. What is prescribed of
    /// a free body is a support, which turns it about its centre.
    pub(super) fn motion(&mut self, k: usize) -> String {
        let body = &self.bodies[k];
        let Some((_, motion)) = self.deck.rigid.get(&body.material) else { return String::new() };
        let used = self.rigid_components();
        if moves_freely(&used, motion) {
            return match motion.centre {
                Some(c) => format!("motion.free = {{ center = {:?} }}\n", &c[..self.deck.space().dimension()]),
                None => "motion.free = {}\n".into(),
            };
        }
        let zero = Curve::constant(0.0);
        let all: Vec<Curve> = used.iter().map(|c| motion.components[*c].clone().unwrap_or(zero.clone())).collect();
        if all.iter().all(|c| c.as_constant() == Some(0.0)) {
            return String::new();
        }
        let shift: Vec<String> =
            all[..self.deck.space().dimension()].iter().map(|curve| self.values.value(curve)).collect();
        format!("motion.prescribed = {{ displacement = [{}] }}\n", shift.join(", "))
    }

    /// The components of a rigid motion that exist in the space: displacements, then rotations.
    fn rigid_components(&self) -> Vec<usize> {
        if self.deck.space().dimension() == 3 { (0..6).collect() } else { vec![0, 1, 5] }
    }

    /// The support of a rigid body that is free in some components and held in others.
    fn rigid_support(&mut self, k: usize, names: &mut Names) -> String {
        let used = self.rigid_components();
        let name = self.bodies[k].name.clone();
        let rests = RigidMotion::default();
        let motion = match self.deck.rigid.get(&self.bodies[k].material) {
            Some((_, motion)) => motion,
            None if self.bodies[k].is_held => &rests,
            None => return String::new(),
        };
        if self.bodies[k].is_held {
            let dimension = self.deck.space().dimension();
            let list: Vec<String> = motion.components[..dimension]
                .iter()
                .map(|c| self.values.value(c.as_ref().unwrap_or(&Curve::constant(0.0))))
                .collect();
            let displacement = list.join(", ");
            return format!("\n[supports.{}]\non = \"{name}\"\ndisplacement = [{displacement}]\n", names.take(&name));
        }
        if !moves_freely(&used, motion) || used.iter().all(|c| motion.components[*c].is_none()) {
            return String::new();
        }
        let dimension = self.deck.space().dimension();
        let mut list = |components: &[usize]| -> Option<String> {
            let some = components.iter().any(|c| motion.components[*c].is_some());
            let of = |c: &usize, values: &mut super::Values| {
                motion.components[*c].as_ref().map_or("\"free\"".to_string(), |curve| values.value(curve))
            };
            let list: Vec<String> = components.iter().map(|c| of(c, &mut self.values)).collect();
            some.then(|| format!("[{}]", list.join(", ")))
        };
        let mut out = format!("\n[supports.{}]\non = \"{name}\"\n", names.take(&name));
        let (shift, turn) = used.split_at(dimension);
        if let Some(text) = list(shift) {
            let _ = writeln!(out, "displacement = {text}");
        }
        if let Some(text) = list(turn) {
            let _ = writeln!(out, "rotation = {text}");
        }
        out
    }
}

/// The axes of a support.
fn axes_text(axes: &Axes, dimension: usize) -> String {
    let vector = |v: &[f64; 3]| format!("{:?}", &v[..dimension]);
    match axes {
        Axes::Rectangular([a, _]) if dimension == 2 => format!("axes.rectangular = [{}]", vector(a)),
        Axes::Rectangular([a, b]) => format!("axes.rectangular = [{}, {}]", vector(a), vector(b)),
        Axes::Cylindrical { point, .. } if dimension == 2 => {
            format!("axes.cylindrical = {{ point = {} }}", vector(point))
        }
        Axes::Cylindrical { point, axis } => {
            format!("axes.cylindrical = {{ point = {}, axis = {} }}", vector(point), vector(axis))
        }
    }
}

/// Whether some component of a rigid body is free, or it turns.
fn moves_freely(used: &[usize], motion: &RigidMotion) -> bool {
    let turns = |c: usize| c >= 3 && motion.components[c].as_ref().is_some_and(|v| v.as_constant() != Some(0.0));
    used.iter().any(|c| motion.components[*c].is_none() || turns(*c))
}

/// Supports of the same place, put together where they are of different directions.
fn merged(supports: &[Support]) -> Vec<Support> {
    let mut out: Vec<Support> = Vec::new();
    for support in supports {
        let fits = |other: &&mut Support| {
            other.on == support.on
                && (other.from, other.until) == (support.from, support.until)
                && other.axes == support.axes
                && (0..3).all(|k| other.displacement[k].is_none() || support.displacement[k].is_none())
                && (0..3).all(|k| !(other.tied[k] && support.displacement[k].is_some()))
                && (0..3).all(|k| !(support.tied[k] && other.displacement[k].is_some()))
        };
        match out.iter_mut().find(fits) {
            Some(other) => {
                for k in 0..3 {
                    other.tied[k] |= support.tied[k];
                    if support.displacement[k].is_some() {
                        other.displacement[k] = support.displacement[k].clone();
                    }
                }
            }
            None => out.push(support.clone()),
        }
    }
    out
}

/// The wanted name of a condition: that of its place, with that of the body where there are several.
fn named(place: &Place, body: Option<&String>) -> String {
    let name = match place {
        Place::NodeSet(n) | Place::Nodes(n, _) | Place::Surface(n) | Place::Faces(n, _) | Place::ElementSet(n) => n,
        Place::All => "all",
    };
    // A node has a number for a name.
    let name = if name.starts_with(|c: char| c.is_ascii_digit()) { format!("node_{name}") } else { name.to_string() };
    body.map_or(name.clone(), |body| format!("{name}_{body}"))
}

/// A name of a group that neither the deck nor the body has.
fn own_name(wanted: &str, deck: &crate::Deck, nodes: &[(String, Vec<u64>)], sides: &[(String, Vec<String>)]) -> String {
    let taken: BTreeSet<&str> =
        nodes.iter().map(|(n, _)| n.as_str()).chain(sides.iter().map(|(n, _)| n.as_str())).collect();
    let is_number = wanted.starts_with(|c: char| c.is_ascii_digit());
    let plain = if is_number { format!("node_{wanted}") } else { wanted.to_string() };
    (1..)
        .map(|k| if k == 1 { plain.clone() } else { format!("{plain}_{k}") })
        .find(|n| {
            let known = deck.surfaces.contains(n) || deck.node_sets.contains(n) || deck.element_sets.contains(n);
            !known && !taken.contains(n.as_str())
        })
        .unwrap_or(plain)
}
