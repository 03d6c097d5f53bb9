//! Ropes on curves that are given: where they are pressed on, whether they slide sideways, which tensions friction holds.

use super::case::PathCase;
use super::output::{self, Line, LinePoint};
use super::picture;
use super::surface::{box_around, surfaces};
use crate::output::Folder;
use crate::plan::paths::PlannedRope;
use crate::run::Progress;
use crate::scene::SceneError;
use serde_json::{Value, json};
use signorini_paths::darboux::darboux;
use signorini_paths::theorem::{Condition, Verdict, reactions, tension_limits};

/// Pieces of each curve that are written and drawn.
const PIECES: usize = 240;

/// Asks for all ropes.
pub(super) fn run(
    case: &PathCase,
    list: &[PlannedRope],
    folder: &Folder,
    progress: &mut dyn Progress,
) -> Result<Value, SceneError> {
    let mut lines = Vec::new();
    let mut summaries = Vec::new();
    for (k, rope) in list.iter().enumerate() {
        progress.step(k, list.len(), 0.0);
        let (line, summary) = one(case, rope)?;
        lines.push(line);
        summaries.push(summary);
    }
    output::write_ropes(&lines, folder)?;
    let around = box_around(lines.iter().flat_map(|l| l.points.iter().map(|p| p.x)), 0.15);
    let bodies = surfaces(case, &[0.0], &around)?;
    output::write_bodies(&[0.0], &bodies, folder)?;
    picture::draw(case, &bodies[0], &lines, folder)?;
    progress.step(list.len(), list.len(), 0.0);
    Ok(json!({"title": case.name(), "analysis": "euler_eytelwein", "status": "done", "ropes": summaries}))
}

fn one(case: &PathCase, rope: &PlannedRope) -> Result<(Line, Value), SceneError> {
    let failed = |e| case.failed(&rope.key, &rope.name, &e);
    let shape = case.plan.bodies[rope.body].shape().as_ref();
    let curve = rope.curve.as_ref();
    let limits = tension_limits(shape, curve, &rope.friction).map_err(failed)?;
    if limits.off_surface > OFF * limits.length {
        let message = format!(
            "the path `{}` leaves the surface by {:.3e}, {:.1e} of its length {:.6e}",
            rope.name,
            limits.off_surface,
            limits.off_surface / limits.length,
            limits.length
        );
        return Err(case.problem().error(&rope.key, message).help("all its points have to lie on the surface").into());
    }
    let end = rope.end_tension.unwrap_or(rope.tension);
    let verdict = limits.verdict(rope.tension, end).map_err(failed)?;
    let holds = matches!(verdict, Verdict::Holds { .. });
    let violations: Vec<Value> = (limits.violations.iter())
        .map(|v| {
            let condition = if v.condition == Condition::Pressed { "lifts_off" } else { "slides_sideways" };
            json!({"condition": condition, "from": v.from, "to": v.to, "at": v.at, "value": v.value, "limit": v.limit})
        })
        .collect();
    let utilisation = if let Verdict::Holds { utilisation } = verdict { Some(utilisation) } else { None };
    let summary = json!({"name": rope.name, "length": limits.length, "log_ratio": limits.log_ratio,
        "tension": rope.tension, "end_tension": rope.end_tension, "tension_limits": limits.end_tensions(rope.tension),
        "holds": holds, "utilisation": utilisation, "verdict": verdict.to_string(), "violations": violations,
        "largest_tan_alpha": {"s": limits.steepest.s, "value": limits.steepest.value},
        "largest_normal_curvature": {"s": limits.least_pressed.s, "value": limits.least_pressed.value},
        "off_surface": limits.off_surface});
    let [from, to] = curve.domain();
    let parameters: Vec<f64> = (0..=PIECES).map(|k| from + (to - from) * k as f64 / PIECES as f64).collect();
    let frames = darboux(shape, curve, &parameters).map_err(failed)?;
    let forces = if holds {
        Some(reactions(shape, curve, &rope.friction, [rope.tension, end], &parameters).map_err(failed)?)
    } else {
        None
    };
    let slides = matches!(verdict, Verdict::SlidesAlong { .. });
    let points = (frames.iter().enumerate())
        .map(|(k, frame)| {
            let mut point = LinePoint::of_rope(frame, &rope.friction, rope.tension, forces.as_ref().map(|f| &f[k]));
            if slides {
                // All along.
                point.utilisation = f64::INFINITY;
            }
            point
        })
        .collect();
    Ok((Line { name: rope.name.clone(), points }, summary))
}

/// A curve that is farther from its surface than this part of its length was not meant to lie on it.
const OFF: f64 = 1e-2;
