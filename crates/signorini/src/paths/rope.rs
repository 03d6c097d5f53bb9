//! Ropes on curves that are given: where they are pressed on, whether they slide sideways, which tensions friction holds.

use super::case::PathCase;
use super::output::{self, Line, LinePoint};
use super::picture;
use super::surface::{box_around, surfaces};
use super::{Found, points};
use crate::output::Folder;
use crate::plan::paths::PlannedRope;
use crate::report::{ExtremeReport, PathReports, RopeCondition, RopeReport, ViolationReport};
use crate::run::Progress;
use crate::scene::SceneError;
use signorini_paths::darboux::darboux;
use signorini_paths::theorem::{Condition, Extreme, Verdict, reactions, tension_limits};

/// Pieces of each curve that are written and drawn.
const PIECES: usize = 240;

/// Asks for all ropes.
pub(super) fn run(
    case: &PathCase,
    list: &[PlannedRope],
    folder: &Folder,
    progress: &mut dyn Progress,
) -> Result<Found, SceneError> {
    let (lines, ropes) = all(case, list, &mut |k| progress.step(k, list.len(), 0.0))?;
    output::write_ropes(&lines, folder)?;
    let around = box_around(points(&lines), 0.15);
    let bodies = surfaces(case, &[0.0], &around)?;
    output::write_bodies(&[0.0], &bodies, folder)?;
    picture::draw(case, &bodies[0], &lines, folder)?;
    progress.step(list.len(), list.len(), 0.0);
    Ok(Found::at_once(PathReports { ropes, ..PathReports::default() }))
}

/// All ropes as lines, and what is told of them.
pub(super) fn all(
    case: &PathCase,
    list: &[PlannedRope],
    begun: &mut dyn FnMut(usize),
) -> Result<(Vec<Line>, Vec<RopeReport>), SceneError> {
    let each = list.iter().enumerate().map(|(k, rope)| {
        begun(k);
        one(case, rope)
    });
    Ok(each.collect::<Result<Vec<_>, _>>()?.into_iter().unzip())
}

fn one(case: &PathCase, rope: &PlannedRope) -> Result<(Line, RopeReport), SceneError> {
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
        return Err(case
            .problem()
            .error(&rope.key, message)
            .help("all points of the path must lie on the surface")
            .into());
    }
    let end = rope.end_tension.unwrap_or(rope.tension);
    let verdict = limits.verdict(rope.tension, end).map_err(failed)?;
    let holds = matches!(verdict, Verdict::Holds { .. });
    let finite = |v: f64| v.is_finite().then_some(v);
    let violations = limits.violations.iter().map(|v| {
        let lifts = v.condition == Condition::Pressed;
        let condition = if lifts { RopeCondition::LiftsOff } else { RopeCondition::SlidesSideways };
        let (value, limit) = (finite(v.value), finite(v.limit));
        ViolationReport { condition, from: v.from, to: v.to, at: v.at, value, limit }
    });
    let extreme = |e: Extreme| ExtremeReport { s: e.s, value: finite(e.value) };
    let report = RopeReport {
        name: rope.name.clone(),
        length: limits.length,
        log_ratio: limits.log_ratio,
        tension: rope.tension,
        end_tension: rope.end_tension,
        tension_limits: limits.end_tensions(rope.tension),
        holds,
        utilisation: if let Verdict::Holds { utilisation } = verdict { Some(utilisation) } else { None },
        verdict: verdict.to_string(),
        violations: violations.collect(),
        largest_tan_alpha: extreme(limits.steepest),
        largest_normal_curvature: extreme(limits.least_pressed),
        off_surface: limits.off_surface,
    };
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
    Ok((Line { name: rope.name.clone(), points }, report))
}

/// A curve that is farther from its surface than this part of its length was not meant to lie on it.
const OFF: f64 = 1e-2;
