//! Whether statics leave one state: forces between rigid bodies are unknowns that nothing but balance determines. Where there
//! are more of them than equations of balance, those that were told are one of many; with friction they depend on the path.

use crate::bounds::ForceBounds;
use crate::finding::{Check, Finding, Outcome};
use crate::groups::{Group, carrying, groups, touching};
use crate::place::Place;
use crate::state::{Form, Setting, State};
use crate::statics::Statics;

/// Places of a group beyond which equations are counted only, whether they are the same or not: to tell takes the cube of it.
const MOST: usize = 300;
/// Part of the forces by which bounds that are apart tell of other forces, and by which forces may lie outside of them: what
/// the check of tractions lets pass.
const TOLD: f64 = 1e-3;

/// Counts the forces on free rigid bodies that touch nothing that deforms. With the bounds of the forces that are known.
pub fn check(setting: &Setting, state: &State, bounds: &[ForceBounds]) -> Vec<Finding> {
    let of = |group: &Group| {
        let own: Vec<ForceBounds> = bounds.iter().filter(|b| group.contacts.contains(&b.contact)).copied().collect();
        of_group(setting, state, group, &own)
    };
    groups(setting, state).iter().filter_map(of).collect()
}

fn of_group(setting: &Setting, state: &State, group: &Group, bounds: &[ForceBounds]) -> Option<Finding> {
    let carries = Count::new(setting, state, group, group.places(setting, |k| carrying(state, k)));
    let size: f64 = group.contacts.iter().map(|k| told(state, *k)).sum();
    let widest = widest(setting, bounds).filter(|b| b.width() > TOLD * size.max(b.least));
    // Others may lie where bodies touch and carry nothing.
    let count = match widest {
        Some(_) if !carries.leaves_others() => {
            Count::new(setting, state, group, group.places(setting, |k| touching(setting, state, k)))
        }
        _ => carries,
    };
    if count.places == 0 {
        return None;
    }
    let names: Vec<String> = group.members.iter().map(|k| format!("`{}`", setting.bodies[*k].name)).collect();
    let mut message = format!(
        "the contact forces on {} have {} unknown components at {} contact points, and balance gives {} independent \
         equations",
        names.join(", "),
        count.unknowns,
        count.places,
        count.equations
    );
    let finding = |outcome, message| {
        Finding::new(Check::Uniqueness, outcome, message).measured(count.unknowns as f64, count.equations as f64)
    };
    if !count.leaves_others() {
        return Some(finding(Outcome::Fine, message));
    }
    let rubs = group.contacts.iter().any(|k| setting.contacts[*k].law.is_some());
    let why = if rubs { "with friction they depend on the path" } else { "other forces are in balance too" };
    message += &format!(": the contact forces are statically indeterminate, {why}");
    if let Some(widest) = widest {
        let to = widest.largest.map_or("to ∞, without bound".into(), |largest| format!("to {}", number(largest)));
        let name = &setting.contacts[widest.contact].name;
        message += &format!("; the normal force of `{name}` may be anything from {} {to}", number(widest.least));
    }
    if let Some(outside) = outside(setting, state, bounds, size) {
        message += &outside;
    }
    let finding = finding(Outcome::Doubt, message).on(&setting.bodies[group.members[0]].name);
    // What found its place by a motion without inertia could have found another one.
    let has_moved = |body: &usize| match &setting.bodies[*body].form {
        Form::Rigid(rigid) => {
            (state.bodies[*body].motion().point(&rigid.centre) - rigid.centre).norm() > FAR * rigid.size
        }
        _ => false,
    };
    Some(finding.remedy(if group.members.iter().any(has_moved) {
        "the forces are one of many possible sets; where bodies that moved come to rest depends on the way"
    } else {
        "the motion is reliable; the forces are one of many possible sets"
    }))
}

/// Way of a body since the start, relative to its size, that is a motion.
const FAR: f64 = 1e-2;

/// The forces at places of a group, and the equations for them.
struct Count {
    places: usize,
    unknowns: usize,
    equations: usize,
}

impl Count {
    fn new(setting: &Setting, state: &State, group: &Group, list: Vec<Place<'_>>) -> Self {
        let places = list.len();
        let statics = Statics::new(setting, state, group, list);
        let equations = if places > MOST { statics.equations() } else { statics.independent().rows.nrows() };
        Count { places, unknowns: statics.unknowns, equations }
    }

    fn leaves_others(&self) -> bool {
        self.unknowns > self.equations
    }
}

/// The normal force of a contact as it was told.
fn told(state: &State, contact: usize) -> f64 {
    carrying(state, contact).map(|t| t.pressure * t.weight).sum()
}

/// The bounds that are farthest apart, of those equally far the ones whose contact comes first by name.
fn widest(setting: &Setting, bounds: &[ForceBounds]) -> Option<ForceBounds> {
    let most = bounds.iter().map(ForceBounds::width).fold(0.0, f64::max);
    let as_wide = bounds.iter().filter(|b| b.width() >= most * (1.0 - TOLD));
    as_wide.min_by_key(|b| &setting.contacts[b.contact].name).copied()
}

/// What is said where a force was told outside of its bounds, by more than forces on bodies that penetrate each other may be off.
fn outside(setting: &Setting, state: &State, bounds: &[ForceBounds], size: f64) -> Option<String> {
    let off = |b: ForceBounds| {
        let force = told(state, b.contact);
        let beyond = (b.least - force).max(b.largest.map_or(0.0, |largest| force - largest));
        let gap = carrying(state, b.contact).map(|t| (t.x - t.foot).norm()).fold(0.0, f64::max);
        let extent = setting.contacts[b.contact].bodies.map(|k| setting.bodies[k].form.size());
        let extent = extent.into_iter().fold(0.0, f64::max);
        (beyond > (TOLD + if extent > 0.0 { gap / extent } else { 0.0 }) * size).then_some((beyond, force, b))
    };
    let (_, force, b) = bounds.iter().copied().filter_map(off).max_by(|a, b| a.0.total_cmp(&b.0))?;
    let largest = b.largest.map_or("no bound".into(), number);
    let name = &setting.contacts[b.contact].name;
    let [force, least] = [force, b.least].map(number);
    Some(format!("; that of `{name}` was reported as {force}, which is not between {least} and {largest}"))
}

/// A number with four digits.
fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let digits = 3 - value.abs().log10().floor() as i32;
    match digits {
        -2..=6 => {
            let text = format!("{value:.*}", digits.max(0) as usize);
            if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
        }
        _ => format!("{value:.3e}"),
    }
}
