//! What came of a membrane, in a sentence.

use crate::output::figure::told;
use crate::plan::{Contact, MembranePlan, MethodChoice};
use crate::problem::Space;
use crate::report::{ContactReport, Reason, UnitNames};
use crate::run::outcome::Ending;
use crate::run::record::Record;
use crate::run::sizes;
use signorini_membrane::obstacle::Side;
use std::collections::BTreeMap;

/// The result in a sentence, with what to try where there is none.
pub fn verdict<const D: usize>(plan: &MembranePlan<D>, record: &Record, reason: Reason) -> String {
    let done = record.done();
    let count = plan.increments.len();
    match Ending::of(reason) {
        Ending::Interrupted => format!("Interrupted: {done} of {count} increments are done and on disk."),
        Ending::NotConverged => {
            let advice = match reason {
                Reason::LinearSolver => {
                    "the linear system could not be solved; check that the membrane is supported and that the data do \
                     not differ by many orders of magnitude"
                }
                Reason::Input => "a value became invalid during the run",
                Reason::NoSuchState => {
                    "there is no equilibrium with contact near `initial_zone`; at this load an adhesive contact may \
                     not exist; use another zone, a larger adhesion energy, or a load at which the contact exists"
                }
                Reason::PathLost => "the last warning states where; use smaller increments or more cells",
                _ => {
                    "use more cells where the zones are small or close to each other, a lower degree, or smaller \
                     increments; method.active_set = {} gives a coarse picture of the zones"
                }
            };
            let residuals = record.steps.last().map_or(&[][..], |s| &s.residual_history);
            let last: Vec<String> =
                residuals[residuals.len().saturating_sub(3)..].iter().map(|v| format!("{v:.1e}")).collect();
            let history = match last.is_empty() {
                true => String::new(),
                false => format!(" (last residuals relative to the tolerance: {})", last.join(", ")),
            };
            let number = record.steps.len().max(1);
            let time = record.steps.last().map(|s| s.time).or_else(|| Some(plan.increments.get(number - 1)?.time));
            let time = time.map_or(String::new(), |t| format!(", at t = {t}"));
            format!("Not converged in increment {number} of {count}{time}{history}: {advice}.")
        }
        Ending::Converged => {
            let Some(step) = record.steps.last() else { return "No increment was requested.".into() };
            if plan.contacts.is_empty() {
                return "The membrane is in equilibrium; the case has no contact.".into();
            }
            let found = |c: &Contact| step.contacts.get(&c.name).filter(|found| found.zones > 0);
            let told: Vec<(&Contact, &ContactReport)> =
                plan.contacts.iter().filter_map(|c| Some((c, found(c)?))).collect();
            let balance = step.equilibrium_residual.unwrap_or(f64::NAN);
            let unstable = told.iter().any(|(_, found)| found.stable == Some(false));
            let sentences: Vec<String> = told.iter().map(|(c, found)| of_contact(plan, c, found)).collect();
            match sentences.is_empty() {
                true if !was_touched(record).is_empty() => {
                    let times = was_touched(record);
                    let [first, last] = [times.first(), times.last()].map(|t| t.copied().unwrap_or_default());
                    let when =
                        if first == last { format!("at t = {first}") } else { format!("from t = {first} to {last}") };
                    format!("At the end the membrane is not in contact; it was in contact {when}.")
                }
                true => {
                    let why = sizes::clearance(plan, step.time);
                    // A hint may be a question.
                    why.map_or("The membrane is not in contact.".into(), |why| {
                        let end = if why.ends_with('?') { "" } else { "." };
                        format!("The membrane is not in contact: {why}{end}")
                    })
                }
                false => format!(
                    "{}; forces balance to {balance:.0e}.{}",
                    sentences.join("; ").replacen('i', "I", 1),
                    if unstable { " This equilibrium is unstable." } else { "" }
                ),
            }
        }
    }
}

/// The times at which there was contact.
fn was_touched(record: &Record) -> Vec<f64> {
    let touches = |contacts: &BTreeMap<String, ContactReport>| contacts.values().any(|c| c.zones > 0);
    record.steps.iter().filter(|s| touches(&s.contacts)).map(|s| s.time).collect()
}

/// One contact in a clause.
fn of_contact<const D: usize>(plan: &MembranePlan<D>, contact: &Contact, c: &ContactReport) -> String {
    let units = plan.head.unit_names();
    let unit = |of: fn(&UnitNames) -> &String| units.as_ref().map_or("", |u| of(u));
    let measure = if D == 1 && plan.space == Space::Line { "length" } else { "area" };
    let staircase = if let MethodChoice::ActiveSet(_) = plan.method { " (with a staircase boundary)" } else { "" };
    format!(
        "in contact{} over {measure} {}{staircase} in {} zone{}{}, pushed {} by {}",
        if plan.contacts.len() > 1 { format!(" with {}", contact.body) } else { String::new() },
        told(c.area, c.error_estimate.map(|e| e.area), unit(|u| &u.area)),
        c.zones,
        if c.zones == 1 { "" } else { "s" },
        match c.holes.unwrap_or(0) {
            0 => String::new(),
            1 => " with 1 hole".into(),
            n => format!(" with {n} holes"),
        },
        if contact.side == Side::Below { "up" } else { "down" },
        told(contact.side.sign() * c.force[2], c.error_estimate.map(|e| e.force), unit(|u| &u.force)),
    )
}
