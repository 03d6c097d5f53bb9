//! Numbers of a summary by their paths in it: `contacts.touch.force.z`, `steps.0.energy`, `paths.*.frames.-1.length`.
//!
//! What is no key of the summary is looked for in the last increment that has a state. Entries of lists are told by their
//! number, from the end if negative, or by their `name`; `*` stands for all entries; a table or a list stands for all numbers
//! in it; components of vectors are x, y and z.

use crate::problem::{CaseError, suggestion};
use crate::report::{StepReport, signed_size};
use serde_json::{Value, json};

/// Keys of the summary beside those of its increments.
const KEYS: [&str; 15] = [
    "answer",
    "case",
    "converged",
    "environment",
    "events",
    "contact_events",
    "method",
    "paths",
    "reason",
    "ropes",
    "steps",
    "unknowns",
    "verdict",
    "warnings",
    "winding",
];

/// What is collected if nothing else is wanted.
const MAIN: [&str; 34] = [
    "contacts.*.force",
    "contacts.*.force_size",
    "contacts.*.normal_force",
    "contacts.*.friction_force",
    "contacts.*.moment",
    "contacts.*.area",
    "contacts.*.radius",
    "contacts.*.zones",
    "contacts.*.max_pressure",
    "contacts.*.max_penetration",
    "contacts.*.max_slip",
    "contacts.*.stick_area",
    "contacts.*.slip_area",
    "contacts.*.max_friction_utilisation",
    "contacts.*.dissipation",
    "probes.*.displacement",
    "probes.*.pressure",
    "probes.*.von_mises",
    "energy",
    "energy_total",
    "support_forces",
    "load_forces",
    "curves.*.start_tension",
    "curves.*.end_tension",
    "curves.*.max_tension",
    "free_bodies",
    "kinetic_energy",
    "motion",
    "cells",
    "paths.*.frames.-1.length",
    "paths.*.frames.-1.tension_limits",
    "winding.*.length",
    "winding.*.largest_slippage",
    "ropes.*.tension_limits",
];

/// A number, word or truth value, by its path.
pub type Found = (String, Value);

/// Whether a summary can have such paths.
///
/// # Errors
/// A path that begins with no key.
pub fn check(paths: &[String]) -> Result<(), CaseError> {
    let step = serde_json::to_value(StepReport::default()).unwrap_or_default();
    let of_step = step.as_object().into_iter().flatten().map(|(key, _)| key.as_str());
    let keys: Vec<&str> = KEYS.into_iter().chain(of_step).collect();
    for path in paths {
        let first = path.split('.').next().unwrap_or("");
        if !keys.contains(&first) {
            let error = CaseError::new(format!("a summary has no `{first}`")).help(suggestion(first, &keys));
            return Err(error.at("--collect", path, 0..first.len()));
        }
    }
    Ok(())
}

/// What paths find in a summary; the main numbers, if there are none.
pub fn collected(summary: &Value, paths: &[String]) -> Vec<Found> {
    let mut step = last_state(summary).cloned().unwrap_or_default();
    add_sizes(&mut step);
    let mut found = Vec::new();
    let main = MAIN.map(String::from);
    for path in if paths.is_empty() { &main[..] } else { paths } {
        let first = path.split('.').next().unwrap_or("");
        let root = if summary.get(first).is_some() { summary } else { &step };
        find(root, path, String::new(), &mut found);
    }
    if paths.is_empty() { by_owner(found) } else { found }
}

/// Numbers of one contact, probe or curve stand together.
fn by_owner(found: Vec<Found>) -> Vec<Found> {
    let owner = |path: &str| {
        let grouped = ["contacts.", "probes.", "curves.", "paths.", "winding.", "ropes."];
        let rest = grouped.iter().find_map(|g| path.strip_prefix(g).map(|rest| (*g, rest)));
        rest.map_or(path.to_string(), |(group, rest)| format!("{group}{}", rest.split('.').next().unwrap_or("")))
    };
    let mut groups: Vec<(String, Vec<Found>)> = Vec::new();
    for entry in found {
        let owner = owner(&entry.0);
        match groups.iter_mut().find(|(name, _)| *name == owner) {
            Some((_, list)) => list.push(entry),
            None => groups.push((owner, vec![entry])),
        }
    }
    groups.into_iter().flat_map(|(_, list)| list).collect()
}

/// The last increment that has a state.
pub fn last_state(summary: &Value) -> Option<&Value> {
    let has_state = |step: &&Value| matches!(step["reason"].as_str(), Some("converged" | "no_contact"));
    summary["steps"].as_array()?.iter().rev().find(has_state)
}

/// Adds to contacts the size of the force, with the sign of its largest component, and its part without friction.
fn add_sizes(step: &mut Value) {
    let vector = |v: &Value| serde_json::from_value::<[f64; 3]>(v.clone()).ok();
    let Some(contacts) = step["contacts"].as_object_mut() else { return };
    for contact in contacts.values_mut() {
        let Some(force) = vector(&contact["force"]) else { continue };
        contact["force_size"] = json!(signed_size(&force));
        if let Some(friction) = vector(&contact["friction_force"]) {
            let normal = std::array::from_fn(|k| force[k] - friction[k]);
            contact["normal_force"] = json!(signed_size(&normal));
        }
    }
}

fn joined(before: &str, name: &str) -> String {
    if before.is_empty() { name.into() } else { format!("{before}.{name}") }
}

/// Names of the entries of a list or table.
fn entries(value: &Value) -> Vec<(String, &Value)> {
    match value {
        Value::Object(table) => table.iter().map(|(name, v)| (name.clone(), v)).collect(),
        Value::Array(list) => {
            let is_vector = list.len() == 3 && list.iter().all(Value::is_number);
            let name = |(k, v): (usize, &Value)| match (is_vector, v["name"].as_str()) {
                (true, _) => ["x", "y", "z"][k].to_string(),
                (false, Some(name)) => name.to_string(),
                (false, None) => k.to_string(),
            };
            list.iter().enumerate().map(|(k, v)| (name((k, v)), v)).collect()
        }
        _ => Vec::new(),
    }
}

/// Adds all that a path tells below a value.
fn find(value: &Value, rest: &str, before: String, found: &mut Vec<Found>) {
    let inner = entries(value);
    if rest.is_empty() {
        match value {
            Value::Null => {}
            Value::Object(_) | Value::Array(_) => {
                inner.into_iter().for_each(|(name, v)| find(v, "", joined(&before, &name), found));
            }
            scalar => found.push((before, scalar.clone())),
        }
        return;
    }
    let after = |name: &str| match rest.strip_prefix(name) {
        Some("") => Some(""),
        Some(tail) => tail.strip_prefix('.'),
        None => None,
    };
    if let Some(tail) = after("*") {
        inner.into_iter().for_each(|(name, v)| find(v, tail, joined(&before, &name), found));
        return;
    }
    // Names may contain points: the longest counts.
    let named = inner.iter().filter(|(name, _)| after(name).is_some()).max_by_key(|(name, _)| name.len());
    if let Some((name, v)) = named {
        return find(v, after(name).unwrap_or(""), joined(&before, name), found);
    }
    let first = rest.split('.').next().unwrap_or("");
    if let (Value::Array(list), Ok(k)) = (value, first.parse::<i64>()) {
        let k = if k < 0 { k + list.len() as i64 } else { k };
        if let Some(v) = usize::try_from(k).ok().and_then(|k| list.get(k)) {
            find(v, after(first).unwrap_or(""), joined(&before, first), found);
        }
    }
}
