//! Whether bodies went through each other within an increment.
//!
//! A point that was outside and is outside again, on the other side, went through: the normals of what it met at both ends
//! look away from each other, and the straight way between them lies inside. One point may so have slid round something small;
//! a whole body, by its middle, may not.

use crate::finding::{Check, Finding, Outcome};
use crate::samples::middle;
use crate::state::{Form, Placement, Rigid, Setting, State};
use nalgebra::Rotation3;
use signorini_geometry::Point;
use signorini_geometry::rigid::RigidMotion;

/// Places on the way that are looked at.
const STEPS: usize = 16;
/// Part of the way that a place may be off by rounding.
const ROUNDING: f64 = 1e-6;

/// Checks the way from one state to the next: of each contact what is found first.
pub fn check(setting: &Setting, before: &State, now: &State) -> Vec<Finding> {
    let mut states: Vec<&[Placement]> = vec![&before.bodies];
    states.extend(now.way.iter().map(Vec::as_slice));
    states.push(&now.bodies);
    let mut out: Vec<Finding> = Vec::new();
    for pair in states.windows(2) {
        let found = between(setting, [pair[0], pair[1]]);
        let is_new = |new: &Finding| out.iter().all(|f| f.message != new.message);
        let new: Vec<Finding> = found.into_iter().filter(is_new).collect();
        out.extend(new);
    }
    out
}

/// Checks a straight way.
fn between(setting: &Setting, states: [&[Placement]; 2]) -> Vec<Finding> {
    let mut out = Vec::new();
    for contact in &setting.contacts {
        let [a, b] = contact.bodies;
        if a == b {
            continue;
        }
        for [own, other] in [[a, b], [b, a]] {
            let Form::Rigid(rigid) = &setting.bodies[other].form else { continue };
            let motions = states.map(|s| s[other].motion());
            let form = &setting.bodies[own].form;
            // What has no end has no middle.
            if matches!(form, Form::Rigid(rigid) if rigid.size == 0.0) {
                continue;
            }
            let places = states.map(|s| middle(form, &s[own]));
            let names = [own, other].map(|k| &setting.bodies[k].name);
            let remedy = "use more increments";
            let crossed = points_through(form, rigid, &motions, states.map(|s| &s[own]));
            let is_full = matches!(form, Form::Rigid(own) if !own.balls.is_empty());
            // What is hollow may move along both sides of something, with its middle through it.
            if let Some(x) = through(rigid, &motions, places).filter(|_| is_full || crossed.is_some()) {
                let message = format!("`{}` passed through `{}` within the increment", names[0], names[1]);
                let finding = Finding::new(Check::Gaps, Outcome::Refused, message);
                out.push(finding.at(x).on(&contact.name).remedy(remedy));
                continue;
            }
            if let Some(x) = crossed {
                let message = format!(
                    "a point of `{}` passed to the other side of `{}` within the increment",
                    names[0], names[1]
                );
                let finding = Finding::new(Check::Gaps, Outcome::Doubt, message);
                out.push(finding.at(x).on(&contact.name).remedy(remedy));
            }
        }
    }
    out
}

/// Where a point of a body goes through a rigid body to its other side.
fn points_through(form: &Form, rigid: &Rigid, motions: &[RigidMotion; 2], places: [&Placement; 2]) -> Option<Point<3>> {
    match form {
        Form::Rigid(own) => {
            let moves = places.map(Placement::motion);
            own.surface.iter().find_map(|x| through(rigid, motions, moves.map(|m| m.point(x))))
        }
        _ => {
            let [from, to] = places.map(Placement::points);
            let count = from.len().min(to.len()) as u32;
            let at = |k: u32| through(rigid, motions, [from[k as usize], to[k as usize]]);
            match form {
                Form::Solid(solid) => solid.boundary.points.iter().find_map(|k| at(*k)),
                _ => (0..count).find_map(at),
            }
        }
    }
}

/// Where the way of a point goes deepest through a rigid body to its other side; none where it does not. Both move steadily.
fn through(rigid: &Rigid, motions: &[RigidMotion; 2], places: [Point<3>; 2]) -> Option<Point<3>> {
    let turn = Rotation3::from_matrix_unchecked(motions[1].rotation * motions[0].rotation.transpose()).scaled_axis();
    let centres = motions.map(|m| m.point(&rigid.centre));
    let ways = [places[1] - places[0], centres[1] - centres[0]];
    // As far as a point of the body at that distance may have come by turning.
    let arm = (places[0] - centres[0]).norm();
    let way = (ways[0] - ways[1]).norm();
    if way == 0.0 {
        return None;
    }
    let start = rigid.gap_now(&motions[0], &places[0]);
    // What lies farther away than that was not met.
    if start.gap < 0.0 || start.gap > way + turn.norm() * arm {
        return None;
    }
    let end = rigid.gap_now(&motions[1], &places[1]);
    if end.gap < 0.0 || start.normal.dot(&end.normal) >= 0.0 {
        return None;
    }
    let gap = |k: usize| {
        let share = k as f64 / STEPS as f64;
        let rotation = Rotation3::new(turn * share).into_inner() * motions[0].rotation;
        let translation = centres[0] + ways[1] * share - rotation * rigid.centre;
        // A motion between both, as a place in the axes of the body.
        let x = rotation.transpose() * (places[0] + ways[0] * share - translation);
        (rigid.gap)(&x).gap
    };
    let deepest = (1..STEPS).min_by(|a, b| gap(*a).total_cmp(&gap(*b)))?;
    // Beyond the rounding of places.
    (gap(deepest) < -ROUNDING * way).then(|| places[0] + ways[0] * (deepest as f64 / STEPS as f64))
}
