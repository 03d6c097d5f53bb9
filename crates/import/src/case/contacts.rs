//! Contacts between bodies.

use super::{Names, Writer, quoted};
use crate::ImportError;
use crate::deck::{Friction, Surface};
use std::collections::BTreeSet;
use std::fmt::Write;

impl Writer<'_> {
    /// The tables of all contacts.
    pub(super) fn contacts(&mut self) -> Result<String, ImportError> {
        let mut names = Names::default();
        // Bodies that touch themselves do so with all of their surface.
        let mut selves = BTreeSet::new();
        let mut out = String::new();
        for pair in &self.deck.contacts {
            let wrong = |message: String| ImportError::new(&self.deck.file, pair.line, message);
            let surface = |name: &str| {
                let none = || wrong(format!("there is no surface `{name}`"));
                self.deck.surfaces.get(name).map(|(name, surface)| (name.to_string(), surface)).ok_or_else(none)
            };
            let ((slave, on_slave), (master, on_master)) = (surface(&pair.slave)?, surface(&pair.master)?);
            let mut friction = match pair.friction.clone() {
                Friction::None => String::new(),
                Friction::Coulomb(mu) => format!("friction.coulomb = {{ mu = {} }}\n", self.values.value(&mu)),
                Friction::Tied { within: None } => "tied = true\n".into(),
                Friction::Tied { within: Some(within) } => format!("tied = true\ntie_distance = {within:?}\n"),
                Friction::Sticky { strength, opening } => {
                    let energy = strength * opening;
                    format!("cohesion = {{ strength = {strength:?}, energy = {energy:?}, opening = {opening:?} }}\n")
                }
            };
            match pair.stiffness.filter(|_| !matches!(pair.friction, Friction::Tied { .. })) {
                Some(stiffness) if self.deck.keeps_stiffness => {
                    let text = format!("compliance.power = {{ pressure = {:?}, penetration = 1 }}\n", stiffness.value);
                    friction.push_str(&text);
                }
                Some(stiffness) => self.remark(format!(
                    "line {}: the stiffness {:?} of the surfaces is left out; here they do not penetrate (`signorini import \
                     --keep-stiffness` keeps it)",
                    stiffness.line, stiffness.value
                )),
                None => {}
            }
            let is_tied = matches!(pair.friction, Friction::Tied { .. });
            let bodies = |surface: &Surface| -> Vec<usize> {
                (0..self.bodies.len()).filter(|k| self.touches(*k, surface)).collect()
            };
            let (first, second) = (bodies(on_slave), bodies(on_master));
            if first.is_empty() || second.is_empty() {
                return Err(wrong(format!("`{slave}` or `{master}` is no part of a body")));
            }
            let mut remarks = Vec::new();
            for a in &first {
                for b in &second {
                    let [own, other] = [a, b].map(|k| &self.bodies[*k]);
                    let part = |k: usize, group: &str| {
                        let body = &self.bodies[k];
                        if body.is_rigid && !body.is_held {
                            quoted(&body.name)
                        } else {
                            quoted(&format!("{}:{group}", body.name))
                        }
                    };
                    if own.is_rigid && other.is_rigid {
                        remarks.push(format!(
                            "the contact of the rigid bodies `{}` and `{}` is left out",
                            own.name, other.name
                        ));
                        continue;
                    }
                    if is_tied && a == b {
                        remarks.push(format!("the tie of `{slave}` with `{master}` within `{}` is left out", own.name));
                        continue;
                    }
                    // What is held everywhere is touched by what deforms.
                    let ((a, slave), (b, master)) =
                        if own.is_held { ((b, &master), (a, &slave)) } else { ((a, &slave), (b, &master)) };
                    if a == b && !selves.insert(*a) {
                        continue;
                    }
                    let between = if a == b {
                        remarks.push(format!(
                            "the contact of `{slave}` with `{master}` is self-contact of all of `{}`",
                            own.name
                        ));
                        format!("self_contact = {}", quoted(&own.name))
                    } else {
                        format!("between = [{}, {}]", part(*a, slave), part(*b, master))
                    };
                    let name = names.take(&pair.name);
                    let _ = writeln!(out, "\n[contacts.{name}]\n{between}\n{friction}");
                    while out.ends_with("\n\n") {
                        out.pop();
                    }
                }
            }
            remarks.into_iter().for_each(|r| self.remark(r));
        }
        Ok(out)
    }

    /// Whether a part of a surface is on a body.
    fn touches(&self, body: usize, surface: &Surface) -> bool {
        let own = &self.bodies[body].contained;
        surface.faces.iter().any(|face| face.iter().all(|n| own.contains(n)))
            || surface.nodes.iter().any(|n| own.contains(n))
    }
}
