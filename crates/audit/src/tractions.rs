//! Whether the tractions that were told are those of contact: pressure pushes, friction stays within its limit, is at it where
//! bodies slip, and acts against the slip; whether rough surfaces are as far apart as their pressure says. All in the mean over
//! a contact, by what each place stands for.

use crate::finding::{Check, Finding, Outcome};
use crate::state::{Contact, Form, Law, Setting, State, Touch};

/// Part of the forces that iterations may leave, and from which the state is none.
const TOLD: f64 = 1e-3;
const REFUSED: f64 = 1e-2;
/// Part of the friction that may be missing where bodies slip: on a curved face its directions differ, and sums of them are
/// shorter than their parts.
const TOLD_MISSING: f64 = 0.05;
const REFUSED_MISSING: f64 = 0.2;
/// Part of the friction of a contact below which what slips is its edge.
const EDGE: f64 = 0.1;
/// Part of the dissipation that may have the wrong sign: slips of penalties are elastic in part.
const REFUSED_SIGN: f64 = 0.05;

/// Way of a free body in an increment, relative to its size, on which its slip may change its direction.
const FAR: f64 = 1e-2;
/// Part of the largest force below which the force of a contact is what iterations leave of none.
const NOTHING: f64 = 1e-8;

/// Checks the tractions of all contacts.
///
/// Slip is that of the whole increment. Of a free rigid body that moved far in it, the last slip may have had another direction:
/// friction along the slip is then only reported; so is that in a zone that the cells do not resolve, as `resolution` tells,
/// where the direction of friction is as rough as its pressure.
pub fn check(setting: &Setting, before: Option<&State>, state: &State, resolution: &[Finding]) -> Vec<Finding> {
    let of_contacts = state.contacts.iter().map(|touches| size_of(touches));
    let largest = of_contacts.chain(state.forces.iter().map(|a| a.force.norm())).fold(0.0, f64::max);
    let list = setting.contacts.iter().zip(&state.contacts);
    let of = |(contact, touches): (&Contact, &Vec<Touch>)| {
        let turns = contact.bodies.iter().any(|body| moved_far(setting, before, state, *body));
        let is_rough = |f: &Finding| f.outcome != Outcome::Fine && f.on.as_deref() == Some(contact.name.as_str());
        let is_told = turns || resolution.iter().any(is_rough);
        of_contact(contact, touches, NOTHING * largest, if is_told { f64::INFINITY } else { REFUSED_SIGN })
    };
    list.flat_map(of).collect()
}

/// Whether a body is a free rigid one that moved far in the increment.
fn moved_far(setting: &Setting, before: Option<&State>, now: &State, body: usize) -> bool {
    let (Form::Rigid(rigid), Some(before)) = (&setting.bodies[body].form, before) else { return false };
    let [from, to] = [before, now].map(|state| state.bodies[body].motion().point(&rigid.centre));
    rigid.is_free && (to - from).norm() > FAR * rigid.size
}

fn size_of(touches: &[Touch]) -> f64 {
    touches.iter().map(|t| t.weight * t.force_size()).sum()
}

/// Checks the tractions of a contact; forces up to `nothing` are rounding, and beyond `refused` of the friction along the slip
/// the state is none.
fn of_contact(contact: &Contact, touches: &[Touch], nothing: f64, refused: f64) -> Vec<Finding> {
    let mut out = Vec::new();
    let size = size_of(touches);
    if size <= nothing {
        return out;
    }
    let name = &contact.name;
    if touches.iter().any(|t| !t.force().1.iter().all(|v| v.is_finite())) {
        out.push(
            Finding::new(
                Check::Tractions,
                Outcome::Refused,
                format!("`{name}` has contact forces that are not finite numbers"),
            )
            .on(name),
        );
        return out;
    }
    let mut tell = |part: Part, limits: [f64; 2], what: &str| {
        let (outcome, limit) = match part.share {
            s if s > limits[1] => (Outcome::Refused, limits[1]),
            s if s > limits[0] => (Outcome::Doubt, limits[0]),
            _ => (Outcome::Fine, limits[0]),
        };
        let message = format!("`{name}`: {:.2e} of {what}", part.share);
        let finding = Finding::new(Check::Tractions, outcome, message).measured(part.share, limit).on(name);
        let finding = if outcome == Outcome::Fine {
            finding
        } else {
            finding.remedy("use smaller cells at the contact, or another method or enforcement")
        };
        out.push(match part.worst {
            Some(t) => finding.at(t.x),
            None => finding,
        });
    };
    let surfaces = &contact.surfaces;
    let [strength, bond] = surfaces.strength;
    let pulls = if strength > 0.0 {
        "the contact force pulls by more than the strength"
    } else {
        "the contact force is tensile"
    };
    tell(part(touches, |t| (-t.pressure - strength).max(0.0), |_| size), [TOLD, REFUSED], pulls);
    let available = |t: &Touch| bond + contact.law.map_or(0.0, |law| law.most(t.pressure.max(0.0)));
    let whole = |_: f64| match contact.law.is_some() || bond > 0.0 {
        true => touches.iter().map(|t| t.weight * available(t)).sum(),
        false => size,
    };
    if let Some(gap_at) = &surfaces.gap_at {
        // By gaps, as a pressure that follows from them may be steep in them.
        let depth = |t: &Touch| gap_at(t.pressure.max(f64::MIN_POSITIVE)).abs();
        let off = |t: &Touch| if t.pressure > 0.0 { t.pressure * (t.gap() - gap_at(t.pressure)).abs() } else { 0.0 };
        let all: f64 = touches.iter().map(|t| t.weight * t.pressure.max(0.0)).sum();
        let largest = touches.iter().filter(|t| t.pressure > 0.0).map(depth).fold(f64::MIN_POSITIVE, f64::max);
        tell(part(touches, off, |_| largest * all), [TOLD, REFUSED], "the gap is not that of its pressure");
    }
    let beyond = |t: &Touch| (t.friction.norm() - available(t)).max(0.0);
    tell(part(touches, beyond, whole), [TOLD, REFUSED], "the friction exceeds its limit");
    let slipping: Vec<Touch> = touches.iter().filter(|t| t.slips && t.slip.norm() > 0.0).copied().collect();
    let taken = |t: &Touch| t.friction.norm() * t.slip.norm();
    // What a bond holds acts against all of its slip, and may act along that of the increment.
    let wrong = |t: &Touch| if bond > 0.0 { 0.0 } else { t.friction.dot(&t.slip).max(0.0) };
    let all: f64 = slipping.iter().map(|t| t.weight * taken(t)).sum();
    tell(
        part(&slipping, wrong, |_| all),
        [TOLD, refused],
        "the friction acts in the direction of slip, not against it",
    );
    if let Some(Law::PerPressure([a, b])) = contact.law
        && a == b
        && bond == 0.0
    {
        let could = |t: &Touch| available(t) * t.slip.norm();
        // At the edge little is available, and what has just closed slipped before it touched.
        let farthest = slipping.iter().map(|t| t.slip.norm()).fold(0.0, f64::max);
        let all: f64 = slipping.iter().map(|t| t.weight * could(t)).sum();
        let all = all.max(EDGE * farthest * touches.iter().map(|t| t.weight * available(t)).sum::<f64>());
        let lacks = |t: &Touch| (could(t) - taken(t)).max(0.0);
        let limits = [TOLD_MISSING, REFUSED_MISSING];
        tell(part(&slipping, lacks, |_| all), limits, "the friction is below its limit where bodies slip");
    }
    out
}

/// A part of a whole, and where most of it is.
struct Part<'a> {
    share: f64,
    worst: Option<&'a Touch>,
}

fn part(touches: &[Touch], value: impl Fn(&Touch) -> f64, whole: impl Fn(f64) -> f64) -> Part<'_> {
    let sum: f64 = touches.iter().map(|t| t.weight * value(t)).sum();
    let worst = touches.iter().max_by(|a, b| (a.weight * value(a)).total_cmp(&(b.weight * value(b))));
    let whole = whole(sum);
    let share = if sum == 0.0 { 0.0 } else { sum / whole.max(f64::MIN_POSITIVE) };
    Part { share, worst: worst.filter(|_| sum > 0.0) }
}

impl Law {
    /// The most friction under a pressure: of an ellipse along its longer axis.
    pub fn most(&self, pressure: f64) -> f64 {
        match self {
            Law::PerPressure(mu) | Law::AtMost(mu) => mu[0].max(mu[1]) * pressure,
            Law::Limit(limit) if pressure > 0.0 => *limit,
            Law::Limit(_) => 0.0,
        }
    }
}

impl Touch {
    fn force_size(&self) -> f64 {
        self.pressure.hypot(self.friction.norm())
    }
}
