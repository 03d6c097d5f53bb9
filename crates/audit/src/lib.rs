//! Whether a state of bodies in contact is an answer.
//!
//! Converged equations are no proof: wrong states balance too. This crate takes a state and the problem as plain data - where
//! bodies are, what forces were told - and none of the pairs, laws or caches with which it was found, and checks from scratch
//! what makes it an answer:
//!
//! - [`gaps`], [`jumps`]: bodies lie outside of each other, at the end of the increment and on the way;
//! - [`tractions`]: pressure pushes, friction stays within its limit and acts against the slip;
//! - [`balance`]: forces and moments on each body sum to zero;
//! - [`path`]: friction takes the energy that is given and not stored;
//! - [`uniqueness`]: whether statics leave one state, and else the bounds of the forces ([`mod@bounds`]);
//! - [`resolution`]: whether cells are small enough for the zone of contact;
//! - [`range`]: whether strains, slips and rotations are those of the theory;
//! - [`stability`]: what is known of it.
//!
//! Limits are relative to the sizes of bodies, cells and forces: a change of units changes no finding.

pub mod balance;
pub mod boundary;
pub mod bounds;
mod crossings;
pub mod finding;
pub mod gaps;
pub mod groups;
pub mod jumps;
pub mod nearest;
pub mod obstacle;
pub mod path;
pub mod place;
pub mod range;
pub mod resolution;
pub mod samples;
pub mod stability;
pub mod state;
pub mod statics;
pub mod tractions;
pub mod uniqueness;
pub mod verdict;

pub use boundary::Boundary;
pub use bounds::{ForceBounds, bounds};
pub use finding::{Check, Finding, Outcome, worst};
pub use stability::Stability;
pub use state::{
    Acting, Body, Carries, Contact, Curve, Form, Law, Placement, Rigid, Setting, Solid, Space, State, Surfaces, Touch,
};
pub use verdict::{Answer, Verdict};

/// What was found of the end of an increment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Audited {
    pub findings: Vec<Finding>,
    /// Of contacts whose forces are not unique.
    pub bounds: Vec<ForceBounds>,
}

/// Checks the end of an increment, from the state before it, or the start.
pub fn audit(setting: &Setting, before: Option<&State>, now: &State, stability: &Stability) -> Vec<Finding> {
    audited(setting, before, now, stability).findings
}

/// The same, with the bounds of forces that are not unique.
pub fn audited(setting: &Setting, before: Option<&State>, now: &State, stability: &Stability) -> Audited {
    let bounds = bounds(setting, now);
    let mut out = gaps::check(setting, now);
    if let Some(before) = before {
        out.extend(crossings::check(setting, before, now));
        out.extend(jumps::check(setting, before, now));
        out.extend(path::check(setting, before, now));
    }
    let resolution = resolution::check(setting, before, now);
    out.extend(tractions::check(setting, before, now, &resolution));
    out.extend(balance::check(setting, now));
    out.extend(uniqueness::check(setting, now, &bounds));
    out.extend(resolution);
    out.extend(range::check(setting, now));
    out.extend(stability::check(stability));
    Audited { findings: worst(out), bounds }
}
