//! The field that colours show: its name, its values on a piece, and what of it is round-off.

use super::wanted::wrong;
use crate::error::ReportError;
use crate::naming::{WANTED, named};
use crate::pieces::{Look, Piece};
use crate::scene::Context;
use signorini::problem::suggestion;
use std::collections::BTreeSet;

/// A field with none of its values above this part of what is natural is round-off.
const ROUND_OFF: f64 = 1e-12;
/// The name by which no field is wanted.
const NONE: &str = "none";
/// Components of the displacement, which files store as a vector.
const COMPONENTS: [&str; 3] = ["displacement_x", "displacement_y", "displacement_z"];

/// A field that is drawn.
#[derive(Clone, Debug)]
pub struct Field {
    pub name: String,
    pub label: String,
    pub unit: String,
    /// What values of this field are compared with, to tell round-off.
    pub natural: f64,
    /// The largest size of its values at all times that are drawn.
    pub largest: f64,
}

impl Field {
    /// The field of a name, or that of the largest interest; none where there is none, or none is wanted.
    ///
    /// # Errors
    /// A field that the results do not have; the help lists those that they have.
    pub fn choose(
        name: Option<&str>,
        frames: &[Vec<Piece>],
        context: &Context,
        size: f64,
        modulus: f64,
    ) -> Result<Option<Self>, ReportError> {
        let known = names(frames);
        let key = name.map(|name| name.trim().to_lowercase().replace([' ', '-'], "_"));
        let found = match &key {
            Some(key) if key == NONE => return Ok(None),
            Some(key) => known.iter().find(|k| *k == key),
            None => first(&known, frames, context),
        };
        let Some(found) = found else {
            let Some(name) = name else { return Ok(None) };
            let list: Vec<&str> = known.iter().map(String::as_str).collect();
            let key = key.unwrap_or_default();
            let part = list.iter().find(|known| !key.is_empty() && known.contains(&key));
            let near = part.map_or_else(|| suggestion(&key, &list), |known| format!("did you mean `{known}`?"));
            let all = format!("the fields of these results are {}; or {NONE}", list.join(", "));
            let help = if near.starts_with("did") { format!("{near} {all}") } else { all };
            return Err(wrong(format!("there is no field `{name}` in these results"), help));
        };
        let told = of_name(found, context);
        let largest = largest(found, frames);
        let mut natural = known.iter().filter(|k| of_name(k, context).1 == told.1).fold(0.0f64, |m, k| {
            if told.1.is_empty() && k.as_str() != found { m } else { m.max(self::largest(k, frames)) }
        });
        if found.starts_with("displacement") {
            natural = natural.max(size);
        }
        if is_stress(found) {
            natural = natural.max(modulus);
        }
        Ok(Some(Field { name: found.clone(), label: told.0, unit: told.1, natural, largest }))
    }

    /// Whether all its values are round-off.
    pub fn is_round_off(&self) -> bool {
        self.largest > 0.0 && self.largest <= ROUND_OFF * self.natural
    }

    /// The values at the points of a piece, as they are drawn; none where the piece does not have the field.
    pub fn values(&self, piece: &Piece) -> Option<Vec<f64>> {
        let values = values(&self.name, piece)?;
        Some(if self.is_round_off() { vec![0.0; values.len()] } else { values })
    }

    /// A short name with the unit, for a colour bar.
    pub fn caption(&self) -> String {
        let symbol = match self.name.as_str() {
            "von_mises" => "σ",
            "contact_pressure" => "p",
            "displacement" => "u",
            "displacement_x" => "u x",
            "displacement_y" => "u y",
            "displacement_z" => "u z",
            "normal_force" => "normal force",
            "friction_traction" => "friction",
            "axial_force" => "axial force",
            "shear_force" => "shear force",
            _ => &self.label,
        };
        if self.unit.is_empty() { symbol.to_string() } else { format!("{symbol} [{}]", self.unit) }
    }
}

/// Whether a field is a stress or a pressure of a body with a modulus.
fn is_stress(name: &str) -> bool {
    name == "von_mises" || name.starts_with("stress_") || name == "contact_pressure" || name == "friction_traction"
}

/// Label and unit.
fn of_name(name: &str, context: &Context) -> (String, String) {
    if let Some(axis) = name.strip_prefix("displacement_") {
        let unit = context.units.map_or(String::new(), |u| u.length.clone());
        return (format!("Displacement along {axis}"), unit);
    }
    match named(name, context.units, context.carries) {
        Some(named) => (named.label, named.unit),
        None => (crate::naming::sentence(name), String::new()),
    }
}

/// All fields of pieces, in the order of the alphabet.
fn names(frames: &[Vec<Piece>]) -> BTreeSet<String> {
    let mut out = BTreeSet::new();
    for piece in frames.iter().flatten().filter(|p| p.look != Look::Outline) {
        out.extend(piece.fields.iter().map(|f| f.0.clone()));
        if piece.displacement.is_some() {
            out.insert("displacement".to_string());
            out.extend(COMPONENTS.map(String::from));
        }
    }
    out.remove("body");
    out
}

/// The field that a reader wants to see first: of those that are not zero everywhere.
fn first<'a>(known: &'a BTreeSet<String>, frames: &[Vec<Piece>], context: &Context) -> Option<&'a String> {
    let is_named = |name: &str| named(name, context.units, context.carries).is_some();
    // Arrows have no colours.
    let bodies = || frames.iter().flatten().filter(|p| p.look != Look::Arrows && p.look != Look::Pair);
    let is_seen = |name: &str| bodies().filter_map(|p| values(name, p)).flatten().any(|v| v != 0.0);
    let is_shown = |name: &str| is_named(name) && is_seen(name);
    let wanted = WANTED.iter().filter_map(|name| known.get(*name)).find(|name| is_shown(name));
    wanted.or_else(|| known.get("displacement"))
}

fn values(name: &str, piece: &Piece) -> Option<Vec<f64>> {
    let u = || piece.displacement.as_ref();
    if name == "displacement" {
        return Some(u()?.iter().map(|u| u.iter().map(|c| c * c).sum::<f64>().sqrt()).collect());
    }
    if let Some(axis) = COMPONENTS.iter().position(|c| *c == name) {
        return Some(u()?.iter().map(|u| u[axis]).collect());
    }
    piece.fields.iter().find(|f| f.0 == name).map(|f| f.1.clone())
}

/// The largest size of the values of a field.
fn largest(name: &str, frames: &[Vec<Piece>]) -> f64 {
    let all = frames.iter().flatten().filter_map(|piece| values(name, piece)).flatten();
    all.filter(|v| v.is_finite()).fold(0.0, |m, v| m.max(v.abs()))
}
