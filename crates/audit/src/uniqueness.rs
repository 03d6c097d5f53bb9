//! Whether statics leave one state: forces between rigid bodies are unknowns that nothing but balance determines. Where there
//! are more of them than equations of balance, those that were told are one of many; with friction they depend on the path.

use crate::finding::{Check, Finding, Outcome};
use crate::state::{Form, Setting, Space, State};

/// Counts the forces on free rigid bodies that touch nothing that deforms.
pub fn check(setting: &Setting, state: &State) -> Vec<Finding> {
    let free = |k: usize| matches!(&setting.bodies[k].form, Form::Rigid(rigid) if rigid.is_free);
    let rigid = |k: usize| matches!(&setting.bodies[k].form, Form::Rigid(_));
    let is_held = |k: usize| state.forces.iter().any(|a| a.body == k && a.moment.is_none());
    let [components, equations] = match setting.space {
        Space::ThreeD => [3, 6],
        Space::Plane => [2, 3],
        Space::Axisymmetric => [1, 1],
    };
    // Bodies that hang together are counted together.
    let mut group: Vec<usize> = (0..setting.bodies.len()).collect();
    let carrying = |k: usize| state.contacts[k].iter().filter(|t| t.is_closed && t.pressure > 0.0);
    for (k, contact) in setting.contacts.iter().enumerate() {
        let [a, b] = contact.bodies.map(|body| group[body]);
        if contact.bodies.iter().all(|body| free(*body)) && carrying(k).next().is_some() {
            group.iter_mut().filter(|g| **g == b).for_each(|g| *g = a);
        }
    }
    let mut out = Vec::new();
    for own in 0..setting.bodies.len() {
        let members: Vec<usize> = (0..setting.bodies.len()).filter(|k| free(*k) && group[*k] == own).collect();
        let touching =
            |k: usize| setting.contacts[k].bodies.iter().any(|b| members.contains(b)) && carrying(k).next().is_some();
        let contacts: Vec<usize> = (0..setting.contacts.len()).filter(|k| touching(*k)).collect();
        let elastic = contacts.iter().any(|k| setting.contacts[*k].bodies.iter().any(|b| !rigid(*b)));
        if members.is_empty() || contacts.is_empty() || elastic || members.iter().any(|k| is_held(*k)) {
            continue;
        }
        let unknowns: usize = contacts
            .iter()
            .flat_map(|k| {
                carrying(*k).map(|t| if setting.contacts[*k].law.is_some() && !t.slips { components } else { 1 })
            })
            .sum();
        let count = equations * members.len();
        let names: Vec<String> = members.iter().map(|k| format!("`{}`", setting.bodies[*k].name)).collect();
        let places: usize = contacts.iter().map(|k| carrying(*k).count()).sum();
        let rubs = contacts.iter().any(|k| setting.contacts[*k].law.is_some());
        let message = format!(
            "{unknowns} components of force at {places} places hold {}, and balance gives {count} equations",
            names.join(", ")
        );
        let finding = |outcome, message| {
            Finding::new(Check::Uniqueness, outcome, message).measured(unknowns as f64, count as f64)
        };
        out.push(if unknowns > count {
            let why = if rubs { "friction leaves others, by the path" } else { "others balance too" };
            finding(Outcome::Doubt, format!("{message}: the forces are one of many possible, {why}"))
                .on(&setting.bodies[members[0]].name)
                .remedy("take the motion for sure, and the forces as one of many")
        } else {
            finding(Outcome::Fine, message)
        });
    }
    out
}
