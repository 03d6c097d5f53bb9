//! Whether the forces that were told balance, body by body: of supports, of loads, of contacts on both sides; moments where
//! all parts of them are known.

use crate::finding::{Check, Finding, Outcome};
use crate::nearest::mean;
use crate::state::{Body, Contact, Form, Placement, Setting, State, Touch};
use signorini_geometry::{Point, Vector};

/// Part of the forces on a body that iterations may leave, and from which the state is none.
const TOLD: f64 = 1e-4;
const REFUSED: f64 = 1e-3;
/// Least arm of the forces on a body, relative to how far from the origin they act and to its size: where all pass by it moments
/// are rounding.
const LEAST_ARM: f64 = 1e-2;

/// Way of a point of a body relative to its size from which it turns rather than strains.
const FAR: f64 = 1e-2;

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
        b if b == first => closed.map(Touch::force).collect(),
        b if b == second => closed.map(on_second).collect(),
        _ => Vec::new(),
    }
}

/// Where and with which force a contact acts on its second body.
fn on_second(touch: &Touch) -> (Point<3>, Vector<3>) {
    let (x, force) = touch.force();
    // What acts on a centre line acts on the other body along the same line.
    (if touch.on_centre_line.is_some() { x } else { touch.foot }, -force)
}

/// The curvature of the rigid one of two bodies.
fn curvature(setting: &Setting, state: &State, contact: &Contact, x: &Point<3>) -> f64 {
    let of = |k: &usize| match &setting.bodies[*k].form {
        Form::Rigid(rigid) => rigid.gap_now(&state.bodies[*k].motion(), x).hessian.norm(),
        _ => 0.0,
    };
    let found = contact.bodies.iter().map(of).fold(0.0, f64::max);
    if found.is_finite() { found } else { 0.0 }
}

/// How far a body of small strains has turned or stretched: its moments balance about where its points were at rest.
fn turned(setting: &Setting, state: &State, body: usize) -> f64 {
    let (Form::Solid(solid), Placement::Points(now)) = (&setting.bodies[body].form, &state.bodies[body]) else {
        return 0.0;
    };
    if solid.strain_limit.is_none() || solid.rest.len() != now.len() || now.is_empty() {
        return 0.0;
    }
    let [from, to] = [mean(&solid.rest), mean(now)];
    let apart = |(a, b): (&Point<3>, &Point<3>)| ((b - to) - (a - from)).norm();
    let most = solid.rest.iter().zip(now).map(apart).fold(0.0, f64::max);
    let size = solid.rest.iter().map(|x| (x - from).norm()).fold(f64::MIN_POSITIVE, f64::max);
    most / size
}

fn of_body(setting: &Setting, state: &State, body: usize) -> Option<Finding> {
    let name = &setting.bodies[body].name;
    let (mut force, mut size) = (Vector::<3>::zeros(), 0.0);
    let (mut moment, mut arms, mut off, mut known) = (Vector::<3>::zeros(), 0.0, 0.0, true);
    let (mut bent, mut reach) = (0.0, 0.0f64);
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
        if !contact.bodies.contains(&body) || contact.bodies[0] == contact.bodies[1] {
            continue;
        }
        for touch in state.contacts[number].iter().filter(|t| t.is_closed) {
            let (x, f) = if contact.bodies[0] == body { touch.force() } else { on_second(touch) };
            let gap = (touch.x - touch.foot).norm();
            force += f;
            size += f.norm();
            let own = x.cross(&f);
            moment += own;
            arms += own.norm();
            reach += x.norm() * f.norm();
            off += gap * f.norm();
            known &= contact.at_places;
            // What slides along a surface of some curvature at a distance from it goes another way than its foot there, and so
            // the friction on it is another one by as much.
            bent += gap * curvature(setting, state, contact, &touch.foot) * touch.friction.norm() * touch.weight;
        }
    }
    if !size.is_finite() {
        let message = format!("forces on `{name}` are not finite numbers");
        return Some(Finding::new(Check::Balance, Outcome::Refused, message).on(name));
    }
    let Body { rounding, form, .. } = &setting.bodies[body];
    if size <= *rounding {
        return None;
    }
    let lack = setting.space.directions().iter().map(|i| force[*i].abs()).fold(0.0, f64::max);
    let lack = (lack - bent - rounding).max(0.0) / size;
    let turns = setting.space.axes().iter().map(|i| moment[*i].abs()).fold(0.0, f64::max);
    let arms = arms.max(LEAST_ARM * reach.max(form.size() * size));
    // Small strains balance moments about places at rest: where they are now off by forces times displacements, `Σ u·f` of what is
    // elastic.
    let turned = turned(setting, state, body);
    let off = off + turned * arms + if turned > 0.0 { 2.0 * state.stored.unwrap_or(0.0) } else { 0.0 };
    let turning = if known && arms > 0.0 { (turns - off).max(0.0) / arms } else { 0.0 };
    let (value, what) = if turning > lack { (turning, "moments") } else { (lack, "forces") };
    let (outcome, limit) = match value {
        v if v > REFUSED => (Outcome::Refused, REFUSED),
        v if v > TOLD => (Outcome::Doubt, TOLD),
        _ => (Outcome::Fine, TOLD),
    };
    let message = format!("the sum of the {what} on `{name}` is {value:.1e} of their magnitudes");
    let finding = Finding::new(Check::Balance, outcome, message).measured(value, limit).on(name);
    Some(if outcome == Outcome::Fine {
        finding
    } else if turning > lack && turned > FAR {
        finding.remedy("small strains do not follow a rotation: use strain = \"finite\" for a body that turns")
    } else {
        finding.remedy("use more increments, or another contact method")
    })
}
