//! Warnings of what looks wrong with a state of a system, or happened in the increment before it.

use super::oscillation::oscillates;
use super::report::stability_report;
use crate::output::system::SystemShown;
use crate::plan::mechanics::MechanicsPlan;
use crate::problem::Space;
use crate::report::{StabilityReport, TractionKind, Warning, WarningKind, vector};
use crate::run::record::Record;
use crate::run::strain::{self, Strained};
use signorini_contact::Status;
use signorini_mechanics::{IncrementResult, SiteResult, UnstableMaterial};

/// Warns of states that are not stable, and of those that were left.
fn warn_of_stability(told: &StabilityReport, (time, on_path): (f64, bool), record: &mut Record) {
    let Some(body) = &told.body else { return };
    let when = told.critical_time.map_or(String::new(), |t| format!(", at t = {t:.6}"));
    let message = if told.stable {
        format!(
            "`{body}` became unstable{when}: the unstable state was left, and the stable state at t = {time} is \
             reported"
        )
    } else {
        let count = told.negative_eigenvalues;
        let plural = if count == 1 { "" } else { "s" };
        let remedy = match on_path {
            true => "under a load that follows the time alone the path ends at the fold before it",
            false => "with `stability = \"follow\"` a stable state is computed",
        };
        format!("`{body}` is unstable at t = {time}{when}: {count} negative eigenvalue{plural}; {remedy}")
    };
    record.warn_once(Warning::new(WarningKind::Unstable, message).at_time(time));
}

/// The largest strain of the bodies of small strains, and the body.
pub(super) fn most_strained<'a>(plan: &MechanicsPlan, shown: &'a SystemShown) -> Option<(&'a str, Strained)> {
    let small = shown.bodies.iter().filter(|body| strain::is_small(&plan.head.problem, &body.name));
    let strained = small.filter_map(|body| Some((body.name.as_str(), strain::largest(body)?)));
    strained.max_by(|a, b| a.1.strain.total_cmp(&b.1.strain))
}

/// Share of the contact that closes in one increment from which the way of its slip is not known well.
const CLOSES_AT_ONCE: f64 = 0.5;
/// Gap relative to the size of all bodies at which sides that lie on each other touch but for rounding.
const LIES_ON: f64 = 1e-9;

/// Warns of contacts with friction of which much was apart before: until it closed nothing is known of slip.
fn warn_of_closing(plan: &MechanicsPlan, [before, now]: [&IncrementResult; 2], time: f64, record: &mut Record) {
    let near = LIES_ON * plan.system.size();
    for (k, (contact, sites)) in plan.system.contacts.iter().zip(&now.sites).enumerate() {
        let of_surface = plan.contacts[k].carries == TractionKind::Pressure && !plan.contacts[k].along_a_curve;
        if contact.friction().is_none() || !of_surface {
            continue;
        }
        let start = || plan.system.sites(k, &plan.system.start()).unwrap_or_default();
        let earlier = before.sites.get(k).cloned().unwrap_or_else(start);
        let was_apart =
            |i: usize| earlier.get(i).is_none_or(|s| s.status == Status::Open && s.gap.is_none_or(|gap| gap > near));
        let area = |list: &mut dyn Iterator<Item = &SiteResult>| list.map(SiteResult::contact_area).sum::<f64>();
        let whole = area(&mut sites.iter());
        let new = area(&mut sites.iter().enumerate().filter(|(i, _)| was_apart(*i)).map(|s| s.1));
        if new <= CLOSES_AT_ONCE * whole {
            continue;
        }
        let message = format!(
            "contact `{}`: {:.0} % of the contact closes in the increment to t = {time}, and its slip is measured from \
             positions before contact; use more increments if stick zones matter",
            contact.name(),
            100.0 * new / whole
        );
        record.warn_once(Warning::new(WarningKind::ClosesAtOnce, message).at_time(time));
    }
}

/// Warns of pressures between bodies that deform which are those of single nodes.
fn warn_of_oscillation(plan: &MechanicsPlan, result: &IncrementResult, shown: &SystemShown, record: &mut Record) {
    let contacts = plan.system.contacts.iter().zip(&shown.contacts).zip(&result.sites);
    for ((contact, seen), sites) in contacts {
        let [slave, master] = contact.bodies().map(|k| &plan.system.bodies[k]);
        let Some(surface) = &seen.surface else { continue };
        if slave.is_rigid() || master.is_rigid() || !oscillates(surface, sites) {
            continue;
        }
        let of_case = plan.head.problem.contacts.get(contact.name());
        let (why, remedy) = match of_case.is_some_and(|c| c.slave.is_some()) {
            true => (
                format!(", which is stiffer than the master `{}` or has smaller cells", master.name()),
                "leave `slave` out, or use smaller cells in the master",
            ),
            false => (
                String::new(),
                "use smaller cells in the master; cells on curved sides that touch should match, or be splines (`mesh.nurbs`)",
            ),
        };
        let message = format!(
            "contact `{}`: the pressure oscillates from node to node of the slave `{}`{why}; {remedy}",
            contact.name(),
            slave.name()
        );
        record.warn_once(Warning::new(WarningKind::PressureOscillates, message).at_time(shown.time));
    }
}

/// Warns of what looks wrong with a state, and of what happened in the increment before it.
pub fn warn(plan: &MechanicsPlan, [before, result]: [&IncrementResult; 2], shown: &SystemShown, record: &mut Record) {
    let time = shown.time;
    warn_of_closing(plan, [before, result], time, record);
    warn_of_oscillation(plan, result, shown, record);
    if let Some(told) = &result.stability {
        warn_of_stability(&stability_report(&plan.system, told), (time, plan.follows_a_path()), record);
    }
    for ((contact, tested), sites) in plan.system.contacts.iter().zip(&plan.contacts).zip(&result.sites) {
        let by_mortar = tested.method == "mortar";
        if !plan.head.problem.contacts.contains_key(contact.name()) || sites.iter().any(|s| s.status != Status::Open) {
            continue;
        }
        let [own, other] = contact.bodies();
        // A body may be far from folding onto itself, and bodies that move come and go.
        if own == other || result.moved.is_some() {
            continue;
        }
        if by_mortar && sites.iter().all(|s| s.gap.is_none()) {
            let message = format!(
                "contact `{}`: no part of the slave faces the master; check the directions of the normals",
                contact.name()
            );
            record.warn_once(Warning::new(WarningKind::NotFacing, message).at_time(time));
            continue;
        }
        // Once for each contact.
        let opening = format!("contact `{}`: the bodies are not in contact", contact.name());
        if record.warnings.iter().any(|w| w.kind == WarningKind::Apart && w.message.starts_with(&opening)) {
            continue;
        }
        let gap = sites.iter().filter_map(|s| s.gap).reduce(f64::min);
        let gap = gap.map_or("no point is within the search distance".to_string(), |g| format!("smallest gap {g:.6e}"));
        let message = format!("{opening} at t = {time} ({gap})");
        record.warnings.push(Warning::new(WarningKind::Apart, message).at_time(time));
    }
    if let Some((body, strained)) = most_strained(plan, shown) {
        let dimension = if plan.space == Space::ThreeD { 3 } else { 2 };
        strained.warning(body, time, dimension).into_iter().for_each(|w| record.warn_once(w));
    }
    for (body, unstable) in plan.system.bodies.iter().zip(&result.unstable_materials) {
        let Some(UnstableMaterial { x, stretches }) = unstable else { continue };
        let opening = format!("the material of `{}` is not stable", body.name());
        if record.warnings.iter().any(|w| w.kind == WarningKind::UnstableMaterial && w.message.starts_with(&opening)) {
            continue;
        }
        let dimension = if plan.space == Space::ThreeD { 3 } else { 2 };
        let place: Vec<String> = x.iter().take(dimension).map(|v| format!("{v:.4}")).collect();
        let stretches = stretches.map(|s| format!("{s:.4}")).join(", ");
        let message = format!(
            "{opening} at t = {time}: at ({}), with the principal stretches {stretches}, it softens; fit its constants \
             to data of larger stretches, or use another law",
            place.join(", ")
        );
        record.warnings.push(Warning::new(WarningKind::UnstableMaterial, message).at_time(time).at(vector(x)));
    }
    warn_of_inverted_cells(shown, record);
    for curve in &shown.curves {
        let slack = curve.slack_cells();
        // What moves is where its inertia takes it.
        if slack > 0 && result.moved.is_none() {
            let message = format!(
                "`{}` is slack at t = {time}: {slack} of {} cells have no tension, so their position is not \
                 determined",
                curve.name, curve.elements
            );
            record.warn_once(Warning::new(WarningKind::NotUnique, message).at_time(time));
        }
    }
    if result.is_indeterminate {
        let message = "the contact forces of rigid bodies are statically indeterminate: other sets of forces within \
                       the friction cones balance the loads too; those with the least sum of squares are reported";
        record.warn_once(Warning::new(WarningKind::NotUnique, message).at_time(time));
    }
    if result.lost_sites > 0 {
        let message = format!(
            "{} points are beyond the centre of curvature of the other body, where the closest point is not defined: \
             they have no contact force at t = {time}",
            result.lost_sites
        );
        record.warn_once(Warning::new(WarningKind::NotFacing, message).at_time(time));
    }
}

/// Warns of cells that are inside out at a point where fields are evaluated: their stress is not defined there.
fn warn_of_inverted_cells(shown: &SystemShown, record: &mut Record) {
    for fields in shown.solids() {
        let stress = fields.array("von_mises").unwrap_or_default();
        let undefined = |k: &usize| !stress[*k].is_finite();
        let Some(first) = (0..stress.len()).find(undefined) else { continue };
        let x = fields.points[first];
        let message = format!(
            "`{}`: cells are inverted at {} points of their boundary, such as the one that was at ({:.4}, {:.4}, {:.4}): \
             stresses are not defined there; use a mesh without sharp corners, or smaller cells",
            fields.name,
            (first..stress.len()).filter(undefined).count(),
            x[0],
            x[1],
            x[2]
        );
        record.warn_once(Warning::new(WarningKind::InvertedCell, message).at_time(shown.time).at(x));
    }
}
