//! The text of a case that says what a deck says.
//!
//! Connected parts of the mesh with one material are bodies. They refer to the deck for their mesh, so no coordinates are
//! copied. A support, load or contact that spans several bodies becomes one for each of them.

mod bodies;
mod conditions;
mod contacts;
mod equations;
mod interfaces;
mod material;
pub(crate) mod names;
mod values;

use crate::ImportError;
use crate::adjust::Adjustment;
use crate::deck::Deck;
use bodies::{Body, bodies};
use names::Names;
use std::fmt::Write;
use values::Values;

/// The case of a deck, as TOML. `file` is the path of the deck from the folder of the case.
///
/// # Errors
/// What the deck states and a case cannot: materials without a law, conditions on nothing.
pub fn text(deck: &Deck, file: &str) -> Result<String, ImportError> {
    Writer::new(deck, file)?.text()
}

/// A case that is being written.
struct Writer<'a> {
    deck: &'a Deck,
    file: &'a str,
    bodies: Vec<Body>,
    values: Values,
    remarks: Vec<String>,
}

impl<'a> Writer<'a> {
    fn new(deck: &'a Deck, file: &'a str) -> Result<Self, ImportError> {
        let remarks = deck.remarks.iter().map(|r| format!("line {}: {}", r.line, r.message)).collect();
        let end = deck.steps.last().map_or(1.0, |s| s.to);
        let mut bodies = bodies(deck)?;
        for body in bodies.iter_mut().filter(|b| b.is_rigid) {
            body.plane = bodies::plane(deck, body);
            body.is_held = body.plane.is_none() && bodies::is_moved(deck, body);
        }
        for adjustment in &deck.adjustments {
            let Some((_, surface)) = deck.surfaces.get(&adjustment.surface) else { continue };
            let nodes = || surface.nodes.iter().chain(surface.faces.iter().flatten());
            for body in bodies.iter_mut().filter(|b| nodes().any(|n| b.contained.contains(n))) {
                body.adjust.push(adjustment.clone());
            }
        }
        Ok(Self { deck, file, bodies, values: Values::new(end), remarks })
    }

    fn remark(&mut self, message: String) {
        if !self.remarks.contains(&message) {
            self.remarks.push(message);
        }
    }

    fn text(mut self) -> Result<String, ImportError> {
        let supports = self.supports()?;
        let loads = self.loads()?;
        let equations = self.equations()?;
        let contacts = self.contacts()?;
        let interfaces = self.interfaces() + &self.carried()?;
        let bodies = self.body_tables();
        let deck = self.deck;
        let mut out = String::new();
        let name = deck.file.file_name().unwrap_or_default().to_string_lossy();
        let _ = writeln!(out, "# Imported from {name}.");
        out.push_str(&left_out(&self.remarks));
        let title = deck.title.clone().unwrap_or_else(|| name.to_string());
        let _ = writeln!(out, "\ntitle = {}\nspace = \"{}\"", quoted(title.trim()), deck.space());
        out.push_str(&self.values.tables());
        out.push_str(&bodies);
        out.push_str(&supports);
        out.push_str(&loads);
        out.push_str(&equations);
        out.push_str(&contacts);
        out.push_str(&interfaces);
        for step in &deck.steps {
            let _ = writeln!(out, "\n[[steps]]\nto = {:?}\nincrements = {}", step.to, step.increments);
        }
        Ok(out)
    }

    /// The tables of all bodies.
    fn body_tables(&mut self) -> String {
        let mut out = String::new();
        for k in 0..self.bodies.len() {
            let is_held = self.bodies[k].is_held;
            let kind = if self.bodies[k].is_rigid && !is_held { "rigid" } else { "solid" };
            let body = &self.bodies[k];
            let _ = writeln!(out, "\n[bodies.{}.{kind}]", body.name);
            if is_held {
                out.push_str("material.linear_elastic = { youngs_modulus = 1.0, poissons_ratio = 0.0 }\n");
                let message =
                    format!("the rigid body `{}`, which does not turn, is a solid that is held everywhere", body.name);
                self.remark(message);
            } else if body.is_rigid {
                out.push_str(&self.motion(k));
            } else {
                if let Some(density) = self.deck.density(&body.material) {
                    let _ = writeln!(out, "density = {density:?}");
                }
                let hyperelastic = material::needs_finite_strain(&body.law);
                if self.deck.finite_strain || hyperelastic {
                    out.push_str("strain = \"finite\"\n");
                }
                let _ = writeln!(
                    out,
                    "material.{}",
                    material::text(&body.law, body.axes.as_ref(), self.deck.finite_strain)
                );
            }
            let body = &self.bodies[k];
            if let Some([point, normal]) = body.plane {
                let _ = writeln!(out, "shape.plane = {{ point = {point:?}, normal = {normal:?} }}");
                let message = format!("the flat surface of the rigid body `{}` is a plane without end", body.name);
                self.remark(message);
                continue;
            }
            let key = if body.is_rigid && !is_held { "shape.file" } else { "mesh.file" };
            let _ = writeln!(out, "\n[bodies.{}.{kind}.{key}]\nfile = {}", body.name, quoted(self.file));
            if let Some(group) = &body.group {
                let _ = writeln!(out, "group = {}", quoted(group));
            }
            if let Some(node) = body.connected_to {
                let _ = writeln!(out, "connected_to = {node}");
            }
            for (name, nodes) in &body.nodes {
                let _ = writeln!(out, "nodes.{} = {}", key_of(name), wrapped(nodes.iter().map(u64::to_string)));
            }
            for (name, sides) in &body.sides {
                let _ = writeln!(out, "sides.{} = {}", key_of(name), wrapped(sides.iter().map(|s| quoted(s))));
            }
            if !body.adjust.is_empty() {
                let list: Vec<String> = body.adjust.iter().map(adjustment).collect();
                let _ = writeln!(out, "adjust = [{}]", list.join(", "));
            }
        }
        out
    }
}

/// An entry of `adjust`.
fn adjustment(of: &Adjustment) -> String {
    let within = of.within.map_or(String::new(), |within| format!(", within = {within:?}"));
    let nodes = of.nodes.as_ref().map_or(String::new(), |set| format!(", nodes = {}", quoted(set)));
    format!("{{ surface = {}, to = {}{within}{nodes} }}", quoted(&of.surface), quoted(&of.to))
}

/// What is left out or changed, as comments; nothing where nothing is.
pub(crate) fn left_out(remarks: &[String]) -> String {
    if remarks.is_empty() {
        return String::new();
    }
    let lines: String = remarks.iter().map(|remark| format!("# - {remark}\n")).collect();
    format!("# Left out or changed:\n{lines}")
}

/// A text in quotes.
pub(crate) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\"").replace(char::is_control, " "))
}

/// A key, in quotes where it needs them.
fn key_of(name: &str) -> String {
    let is_bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if is_bare { name.to_string() } else { quoted(name) }
}

/// A list over lines of moderate length.
fn wrapped(entries: impl Iterator<Item = String>) -> String {
    let mut lines = vec![String::new()];
    for entry in entries {
        let last = lines.len() - 1;
        if lines[last].len() + entry.len() > 100 {
            lines.push(String::new());
        }
        let line = lines.last_mut().unwrap_or_else(|| unreachable!("there is a line"));
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(&entry);
        line.push(',');
    }
    if lines.len() == 1 {
        format!("[{}]", lines[0].trim_end_matches(','))
    } else {
        format!("[\n    {}\n]", lines.join("\n    "))
    }
}
