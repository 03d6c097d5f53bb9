//! Whether bodies went through each other within an increment.
//!
//! A point that was outside and is outside again, on the other side, went through: the normals of what it met at both ends
//! look away from each other, and the straight way between them lies inside. One point may so have slid round something small;
//! a whole body, by its middle, may not.

use crate::finding::{Check, Finding, Outcome};
use crate::samples::middle;
use crate::state::{Form, Placement, Rigid, Setting, State};
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::{Point, Vector};

/// Places on the way that are looked at.
const STEPS: usize = 16;

/// Checks the way from one state to the next.
pub fn check(setting: &Setting, before: &State, now: &State) -> Vec<Finding> {
    let mut out = Vec::new();
    for contact in &setting.contacts {
        let [a, b] = contact.bodies;
        if a == b {
            continue;
        }
        for [own, other] in [[a, b], [b, a]] {
            let Form::Rigid(rigid) = &setting.bodies[other].form else { continue };
            let motions = [before, now].map(|s| s.bodies[other].motion());
            let form = &setting.bodies[own].form;
            let places = [before, now].map(|s| middle(form, &s.bodies[own]));
            let names = [own, other].map(|k| &setting.bodies[k].name);
            let remedy = "more increments";
            if let Some(x) = through(rigid, &motions, places) {
                let message = format!("`{}` went through `{}` within the increment", names[0], names[1]);
                let finding = Finding::new(Check::Gaps, Outcome::Refused, message);
                out.push(finding.at(x).on(&contact.name).remedy(remedy));
                continue;
            }
            let (Placement::Points(from), Placement::Points(to)) = (&before.bodies[own], &now.bodies[own]) else {
                continue;
            };
            let points: Vec<u32> = match form {
                Form::Solid(solid) => solid.boundary.points.clone(),
                _ => (0..from.len().min(to.len()) as u32).collect(),
            };
            let crossed = points.iter().find_map(|k| through(rigid, &motions, [from[*k as usize], to[*k as usize]]));
            if let Some(x) = crossed {
                let message =
                    format!("a point of `{}` came to the other side of `{}` within the increment", names[0], names[1]);
                let finding = Finding::new(Check::Gaps, Outcome::Doubt, message);
                out.push(finding.at(x).on(&contact.name).remedy(remedy));
            }
        }
    }
    out
}

/// Where the way of a point goes deepest through a rigid body to its other side; none where it does not.
fn through(rigid: &Rigid, motions: &[RigidMotion; 2], places: [Point<3>; 2]) -> Option<Point<3>> {
    let own = |k: usize| motions[k].rotation.transpose() * (places[k] - motions[k].translation);
    let (from, to) = (own(0), own(1));
    let way: Vector<3> = to - from;
    let start = (rigid.gap)(&from);
    // What lies farther away than the way is long was not met.
    if start.gap < 0.0 || start.gap > way.norm() {
        return None;
    }
    let end = (rigid.gap)(&to);
    if end.gap < 0.0 || start.normal.dot(&end.normal) >= 0.0 {
        return None;
    }
    let at = |k: usize| from + way * (k as f64 / STEPS as f64);
    let gap = |k: usize| (rigid.gap)(&at(k)).gap;
    let deepest = (1..STEPS).min_by(|a, b| gap(*a).total_cmp(&gap(*b)))?;
    // Beyond the rounding of places.
    (gap(deepest) < -1e-6 * way.norm()).then(|| motions[1].point(&at(deepest)))
}
