//! Free rigid bodies that hang together by contact: balance tells of their forces only together.

use crate::place::Place;
use crate::state::{Form, Setting, State, Touch};
use signorini_geometry::Vector;

/// Gap relative to the larger body below which places touch, though they carry nothing: rounding of their places over an
/// increment of many steps, far below what any tolerance leaves open.
const TOUCHES: f64 = 1e-9;

/// Free rigid bodies that touch each other, and the contacts that hold them.
pub struct Group {
    pub members: Vec<usize>,
    /// Contacts of members in which places touch.
    pub contacts: Vec<usize>,
}

/// The groups of which only balance tells the forces: those that touch nothing that deforms, and on which nothing acts of which
/// the moment is unknown.
pub fn groups(setting: &Setting, state: &State) -> Vec<Group> {
    let count = setting.bodies.len();
    let touches = |k: usize| touching(setting, state, k).next().is_some();
    let mut own: Vec<usize> = (0..count).collect();
    for (k, contact) in setting.contacts.iter().enumerate() {
        let [a, b] = contact.bodies.map(|body| own[body]);
        if contact.bodies.iter().all(|body| is_free(setting, *body)) && touches(k) {
            own.iter_mut().filter(|g| **g == b).for_each(|g| *g = a);
        }
    }
    let of = |first: usize| {
        let members: Vec<usize> = (0..count).filter(|k| is_free(setting, *k) && own[*k] == first).collect();
        let holds = |k: &usize| setting.contacts[*k].bodies.iter().any(|b| members.contains(b)) && touches(*k);
        let contacts = (0..setting.contacts.len()).filter(holds).collect();
        Group { members, contacts }
    };
    (0..count).map(of).filter(|g| g.is_told_by_balance(setting, state)).collect()
}

impl Group {
    fn is_told_by_balance(&self, setting: &Setting, state: &State) -> bool {
        let rigid = |k: usize| setting.contacts[k].bodies.iter().all(|b| is_rigid(setting, *b));
        let is_held = |k: &usize| state.forces.iter().any(|a| a.body == *k && a.moment.is_none());
        let is_empty = self.members.is_empty() || self.contacts.is_empty();
        !is_empty
            && self.contacts.iter().all(|k| rigid(*k) && is_finite(state, *k))
            && !self.members.iter().any(|k| is_held(k) || !has_finite_loads(state, *k))
    }

    /// Some places of each of its contacts.
    pub fn places<'a, I: Iterator<Item = &'a Touch>>(
        &self,
        setting: &Setting,
        of: impl Fn(usize) -> I,
    ) -> Vec<Place<'a>> {
        let own = |k: &usize| of(*k).map(|t| Place::new(setting, *k, t)).collect::<Vec<_>>();
        self.contacts.iter().flat_map(own).collect()
    }

    /// Whether a support acts on a member: what it gives is no load, but whatever balances.
    pub fn is_supported(&self, state: &State) -> bool {
        state.forces.iter().any(|a| a.reacts && self.members.contains(&a.body))
    }
}

/// Whether all that is told of a contact are numbers; the check of tractions tells else.
fn is_finite(state: &State, contact: usize) -> bool {
    let vectors = |t: &Touch| t.x.sum() + t.foot.sum() + t.normal.sum() + t.friction.sum();
    let own = state.contacts.get(contact).into_iter().flatten();
    own.map(|t| vectors(t) + t.pressure + t.weight).all(f64::is_finite)
}

fn has_finite_loads(state: &State, body: usize) -> bool {
    let own = state.forces.iter().filter(|a| a.body == body);
    own.map(|a| a.force.sum() + a.moment.map_or(0.0, |m| m.sum())).all(f64::is_finite)
}

fn is_rigid(setting: &Setting, body: usize) -> bool {
    matches!(&setting.bodies[body].form, Form::Rigid(_))
}

fn is_free(setting: &Setting, body: usize) -> bool {
    matches!(&setting.bodies[body].form, Form::Rigid(rigid) if rigid.is_free)
}

/// The places of a contact that carry a force.
pub fn carrying(state: &State, contact: usize) -> impl Iterator<Item = &Touch> {
    state.contacts.get(contact).into_iter().flatten().filter(|t| t.is_closed && t.pressure > 0.0)
}

/// The places of a contact that may carry one: of rigid bodies also those that touch and were told to carry nothing, as others
/// that balance may be there.
pub fn touching<'a>(setting: &'a Setting, state: &'a State, contact: usize) -> impl Iterator<Item = &'a Touch> {
    let [a, b] = setting.contacts[contact].bodies;
    let both = a != b && is_rigid(setting, a) && is_rigid(setting, b);
    let size = setting.bodies[a].form.size().max(setting.bodies[b].form.size());
    // Places with nothing within reach have no normal.
    let is_near = move |t: &Touch| t.normal != Vector::<3>::zeros() && (t.x - t.foot).norm() <= TOUCHES * size;
    let touches = move |t: &&Touch| match t.is_closed {
        true => both || t.pressure > 0.0,
        false => both && is_near(t),
    };
    state.contacts.get(contact).into_iter().flatten().filter(touches)
}
