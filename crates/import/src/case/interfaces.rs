//! Ties between bodies of different materials that share nodes in the deck.

use super::{Names, Writer, quoted};
use crate::ImportError;
use std::collections::BTreeSet;
use std::fmt::Write;

/// A pair of bodies that share faces: the one that deforms first.
struct Interface {
    bodies: [usize; 2],
    /// Names of the groups of the faces; none of a rigid body.
    groups: [Option<String>; 2],
}

impl Writer<'_> {
    /// Adds the groups of shared faces to the bodies, and the ties between them.
    pub(super) fn interfaces(&mut self) -> String {
        let mut names = Names::default();
        let mut out = String::new();
        for Interface { bodies: [a, b], groups } in self.shared_faces() {
            let on = |k: usize, group: &Option<String>| match group {
                Some(group) => quoted(&format!("{}:{group}", self.bodies[k].name)),
                None => quoted(&self.bodies[k].name),
            };
            let between = [on(a, &groups[0]), on(b, &groups[1])].join(", ");
            let name = names.take(&format!("{}_{}_joined", self.bodies[a].name, self.bodies[b].name));
            let _ = writeln!(out, "\n[contacts.{name}]\nbetween = [{between}]\ntied = true");
            let (first, second) = (self.bodies[a].name.clone(), self.bodies[b].name.clone());
            self.remark(format!("`{first}` and `{second}` share nodes and have different materials: they are tied"));
        }
        out
    }

    /// The ties of nodes to rigid bodies that turn or are pushed.
    ///
    /// # Errors
    /// Sets or rigid bodies that do not exist.
    pub(super) fn carried(&mut self) -> Result<String, ImportError> {
        let mut names = Names::default();
        let mut out = String::new();
        let lengths = |i: usize| self.deck.nodes.values().map(move |x| x[i]);
        let extent = |i: usize| lengths(i).fold(f64::MIN, f64::max) - lengths(i).fold(f64::MAX, f64::min);
        // Nodes are carried wherever they are.
        let far = (0..3).map(extent).fold(0.0, f64::max) * 10.0;
        for (place, material) in &self.deck.carried {
            let rigid = self.bodies.iter().find(|b| b.is_rigid && b.material.eq_ignore_ascii_case(material));
            let Some(rigid) = rigid.map(|b| b.name.clone()) else {
                let message = format!("there is no rigid body of the material `{material}` that carries nodes");
                return Err(ImportError::new(&self.deck.file, None, message));
            };
            for on in self.places(place)?.into_iter().filter(|on| !self.bodies[on.body].is_rigid) {
                let name = names.take(&format!("{}_{rigid}_carried", self.bodies[on.body].name));
                let _ = writeln!(
                    out,
                    "\n[contacts.{name}]\nbetween = [{}, {}]\ntied = true\ntie_distance = {far:?}\nmethod.node = {{}}",
                    quoted(&on.text),
                    quoted(&rigid)
                );
            }
        }
        Ok(out)
    }

    fn shared_faces(&mut self) -> Vec<Interface> {
        let split: Vec<usize> = (0..self.bodies.len()).filter(|k| self.bodies[*k].is_split).collect();
        let mut out = Vec::new();
        for (k, &a) in split.iter().enumerate() {
            for &b in &split[k + 1..] {
                let [a, b] = if self.bodies[a].is_rigid { [b, a] } else { [a, b] };
                if self.bodies[a].is_rigid {
                    continue;
                }
                let faces = [self.faces_within(a, b), self.faces_within(b, a)];
                if faces.iter().any(Vec::is_empty) {
                    continue;
                }
                let mut groups = [None, None];
                for ((own, other), (faces, group)) in
                    [(a, b), (b, a)].into_iter().zip(faces.into_iter().zip(&mut groups))
                {
                    if self.bodies[own].is_rigid {
                        continue;
                    }
                    let name = format!("to {}", self.bodies[other].name);
                    self.bodies[own].sides.push((name.clone(), faces));
                    *group = Some(name);
                }
                out.push(Interface { bodies: [a, b], groups });
            }
        }
        out
    }

    /// The faces of the elements of a body all of whose vertices belong to another one, as `ELEMENT FACE`.
    fn faces_within(&self, body: usize, other: usize) -> Vec<String> {
        let [own, other] = [body, other].map(|k| &self.bodies[k]);
        let shared: BTreeSet<u64> = own.contained.intersection(&other.contained).copied().collect();
        let mut out = Vec::new();
        for element in own.elements.iter().map(|k| &self.deck.elements[*k]) {
            for (face, corners) in element.kind.faces().iter().enumerate() {
                if corners.iter().all(|v| shared.contains(&element.nodes[*v])) {
                    out.push(format!("{} {}", element.number, face + 1));
                }
            }
        }
        out
    }

    /// The nodes of a set that belong to a body and to none before it: forces on nodes act once.
    pub(super) fn nodes_of_its_own(&self, body: usize, nodes: &[u64]) -> Vec<u64> {
        let taken = |n: &u64| self.bodies[..body].iter().any(|b| b.contained.contains(n));
        nodes.iter().copied().filter(|n| self.bodies[body].contained.contains(n) && !taken(n)).collect()
    }
}
