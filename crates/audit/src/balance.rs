//! Whether the forces that were told balance, body by body: of supports, of loads, of contacts on both sides; moments where
//! all parts of them are known.

use crate::finding::{Check, Finding, Outcome};
use crate::state::{Form, Setting, State};
use signorini_geometry::{Point, Vector};

/// Part of the forces on a body that iterations may leave, and from which the state is none.
const TOLD: f64 = 1e-5;
const REFUSED: f64 = 1e-3;

/// Checks the balance of all bodies that are not moved as prescribed.
pub fn check(setting: &Setting, state: &State) -> Vec<Finding> {
    let moves = |k: &usize| !matches!(&setting.bodies[*k].form, Form::Rigid(rigid) if !rigid.is_free);
    (0..setting.bodies.len()).filter(moves).filter_map(|body| of_body(setting, state, body)).collect()
}

/// Force and moment about the origin of a contact on a body.
pub fn of_contact(setting: &Setting, state: &State, contact: usize, body: usize) -> Vec<(Point<3>, Vector<3>)> {
    let [first, second] = setting.contacts[contact].bodies;
    if first == second {
        return Vec::new();
    }
    let closed = state.contacts.get(contact).into_iter().flatten().filter(|t| t.is_closed);
    match body {
        b if b == first => closed.map(|t| (t.x, t.force())).collect(),
        b if b == second => closed.map(|t| (t.foot, -t.force())).collect(),
        _ => Vec::new(),
    }
}

fn of_body(setting: &Setting, state: &State, body: usize) -> Option<Finding> {
    let name = &setting.bodies[body].name;
    let (mut force, mut size) = (Vector::<3>::zeros(), 0.0);
    let (mut moment, mut arms, mut off, mut known) = (Vector::<3>::zeros(), 0.0, 0.0, true);
    for acting in state.forces.iter().filter(|a| a.body == body) {
        force += acting.force;
        size += acting.force.norm();
        match acting.moment {
            Some(own) => {
                moment += own;
                arms += own.norm();
            }
            None => known = false,
        }
    }
    for (number, contact) in setting.contacts.iter().enumerate() {
        let gap = |k: usize| state.contacts[number].get(k).map_or(0.0, |t| (t.x - t.foot).norm());
        let list = of_contact(setting, state, number, body);
        known &= contact.at_places || list.is_empty();
        for (k, (x, f)) in list.iter().enumerate() {
            force += f;
            size += f.norm();
            let own = x.cross(f);
            moment += own;
            arms += own.norm();
            off += gap(k).min(x.norm()) * f.norm();
        }
    }
    if !size.is_finite() {
        let message = format!("forces on `{name}` are no numbers");
        return Some(Finding::new(Check::Balance, Outcome::Refused, message).on(name));
    }
    if size == 0.0 {
        return None;
    }
    let lack = setting.space.directions().iter().map(|i| force[*i].abs()).fold(0.0, f64::max) / size;
    let turns = setting.space.axes().iter().map(|i| moment[*i].abs()).fold(0.0, f64::max);
    let turning = if known && arms > 0.0 { (turns - off).max(0.0) / arms } else { 0.0 };
    let (value, what) = if turning > lack { (turning, "moments") } else { (lack, "forces") };
    let (outcome, limit) = match value {
        v if v > REFUSED => (Outcome::Refused, REFUSED),
        v if v > TOLD => (Outcome::Doubt, TOLD),
        _ => (Outcome::Fine, TOLD),
    };
    let message = format!("{what} on `{name}` sum to {value:.1e} of their sizes");
    let finding = Finding::new(Check::Balance, outcome, message).measured(value, limit).on(name);
    Some(if outcome == Outcome::Fine { finding } else { finding.remedy("more increments, or another method of contact") })
}
