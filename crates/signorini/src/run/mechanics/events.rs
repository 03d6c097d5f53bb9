//! What a contact does as a whole, and the events between.

use crate::report::ContactEventKind;
use serde::{Deserialize, Serialize};
use signorini_contact::Status;
use signorini_mechanics::{SiteResult, System};

/// What a contact does as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Condition {
    Apart,
    /// Without friction.
    Touches,
    Sticks,
    /// Some of it sticks, some slips.
    SlipsInPart,
    Slips,
}

/// The conditions of all contacts at the sites of a state.
pub fn conditions(system: &System, sites: &[Vec<SiteResult>]) -> Vec<Condition> {
    let of = |(contact, sites): (usize, &Vec<SiteResult>)| {
        let is = |status: Status| sites.iter().any(|site| site.status == status);
        match [is(Status::Stick), is(Status::Slip)] {
            [false, false] => Condition::Apart,
            _ if system.contacts[contact].friction().is_none() => Condition::Touches,
            [true, false] => Condition::Sticks,
            [true, true] => Condition::SlipsInPart,
            [false, true] => Condition::Slips,
        }
    };
    sites.iter().enumerate().map(of).collect()
}

/// The event between two conditions of a contact; none between the same.
pub fn event(before: Condition, after: Condition) -> Option<ContactEventKind> {
    if before == after {
        return None;
    }
    Some(match (before, after) {
        (Condition::Apart, _) => ContactEventKind::Touch,
        (_, Condition::Apart) => ContactEventKind::LiftOff,
        (_, Condition::SlipsInPart) => ContactEventKind::PartialSlip,
        (_, Condition::Slips) => ContactEventKind::Slip,
        (_, Condition::Sticks | Condition::Touches) => ContactEventKind::Stick,
    })
}
