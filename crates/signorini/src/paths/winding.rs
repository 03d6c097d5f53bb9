//! Paths of yarns on mandrels: slippage, openings, circuits, patterns.

use super::case::PathCase;
use super::output::{self, Line, LinePoint};
use super::picture;
use super::surface::{box_around, surfaces};
use super::{Found, points};
use crate::output::Folder;
use crate::plan::paths::PlannedWinding;
use crate::report::{CircuitReport, CoverageReport, PathReports, PatternReport, TurnReport, WindingReport};
use crate::run::Progress;
use crate::scene::SceneError;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::{Point, Vector};
use signorini_paths::winding::{
    At, Axis, Ended, Lead, Mandrel, Slippage, Start, Until, WindingPath, WindingPoint, circuit, coverage, patterns,
    slippage_for_opening, wind,
};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Points per length of the mandrel's reach where no spacing is stated.
const POINTS: f64 = 400.0;
/// The greatest length of a path to a turn, in circumferences at its start.
const TURNS: f64 = 50.0;
/// The slippage that is sought where no friction limits it.
const SOUGHT: f64 = 0.6;
/// Circuits beyond those that cover the mandrel among which a pattern is sought: an overlap of bands of 15 %.
const OVERLAP: f64 = 0.15;

/// The point of the mandrel at a height and an angle around the axis, farthest from the axis.
fn start_point(mandrel: &Mandrel<'_>, z: f64, theta: f64) -> Option<Point<3>> {
    let k = mandrel.axis.direction;
    let mut across = Vector::<3>::zeros();
    across[if k.x.abs() < 0.9 { 0 } else { 1 }] = 1.0;
    let e1 = (across - k * k.dot(&across)).normalize();
    let e2 = k.cross(&e1);
    let way = e1 * theta.cos() + e2 * theta.sin();
    let on_axis = mandrel.axis.origin + k * z;
    // Outwards along the ray from inside, by the distance to the surface.
    let mut reach = 0.0;
    for _ in 0..200 {
        let gap = mandrel.surface.gap(&(on_axis + way * reach));
        let slope = gap.normal.dot(&way);
        if !gap.gap.is_finite() {
            return None;
        }
        let step = if slope > 0.3 { -gap.gap / slope } else { gap.gap.abs() };
        reach += step;
        if step.abs() <= 1e-13 * reach.abs() {
            return (reach > 0.0).then(|| on_axis + way * reach);
        }
    }
    None
}

/// Winds all paths.
pub(super) fn run(
    case: &PathCase,
    list: &[PlannedWinding],
    folder: &Folder,
    progress: &mut dyn Progress,
) -> Result<Found, SceneError> {
    let count = list.len();
    let (lines, winding) = all(case, list, &mut |k| progress.step(k, count, 0.0))?;
    output::write_winding(&lines, folder)?;
    let around = box_around(points(&lines), 0.1);
    let bodies = surfaces(case, &[0.0], &around)?;
    output::write_bodies(&[0.0], &bodies, folder)?;
    picture::draw(case, &bodies[0], &lines, folder)?;
    progress.step(count, count, 0.0);
    Ok(Found::at_once(PathReports { winding, ..PathReports::default() }))
}

/// All yarns as lines, with the other circuits of their patterns, and what is told of them.
pub(super) fn all(
    case: &PathCase,
    list: &[PlannedWinding],
    begun: &mut dyn FnMut(usize),
) -> Result<(Vec<Line>, Vec<WindingReport>), SceneError> {
    let mut lines = Vec::new();
    let mut reports = Vec::new();
    for (k, yarn) in list.iter().enumerate() {
        begun(k);
        let (line, report) = one(case, yarn)?;
        let circuits = other_circuits(case, yarn, &line, &report);
        lines.push(line);
        lines.extend(circuits);
        reports.push(report);
    }
    Ok((lines, reports))
}

/// The other circuits of a pattern: the first one turned about the axis, `k` places of `n` after each.
fn other_circuits(case: &PathCase, key: &PlannedWinding, line: &Line, report: &WindingReport) -> Vec<Line> {
    let Some(n) = report.pattern.as_ref().map(|p| p.n) else { return Vec::new() };
    let origin = case.plan.bodies[key.body].shape().centre();
    (1..n)
        .map(|k| {
            let angle = TAU * f64::from(k) / f64::from(n);
            let turn = RigidMotion::new(key.axis * angle, origin, Vector::<3>::zeros());
            let turned =
                |p: &LinePoint| LinePoint { x: turn.point(&p.x), frame: p.frame.map(|v| turn.rotation * v), ..*p };
            Line { name: String::new(), points: line.points.iter().map(turned).collect() }
        })
        .collect()
}

fn one(case: &PathCase, key: &PlannedWinding) -> Result<(Line, WindingReport), SceneError> {
    let name = &key.name;
    let failed = |e| case.failed(&key.key, name, &e);
    let body = &case.plan.bodies[key.body];
    let direction = key.axis;
    let mandrel = Mandrel { surface: body.shape().as_ref(), axis: Axis { origin: body.shape().centre(), direction } };
    let [z, theta, angle] = key.start;
    let Some(point) = start_point(&mandrel, z, theta) else {
        let message = format!("the mandrel has no surface around the axis at z = {z}");
        return Err(case.problem().error(&key.key, message).into());
    };
    let start = Start { point, angle };
    let from_axis = point - mandrel.axis.origin;
    let radius = (from_axis - direction * direction.dot(&from_axis)).norm();
    let longest = key.length.unwrap_or(TURNS * TAU * radius);
    let spacing = key.spacing.unwrap_or(TAU * radius / POINTS * 4.0);
    let half_band = 0.5 * key.band.unwrap_or(0.0);
    let mut report = WindingReport {
        name: name.clone(),
        start_radius: radius,
        start_angle: start.angle,
        ..WindingReport::default()
    };
    let slippage = match (key.slippage.clone(), key.opening) {
        (Some(slippage), _) => slippage,
        (None, None) => Slippage::Constant(0.0),
        (None, Some(opening)) => {
            let most = key.friction.unwrap_or(SOUGHT);
            let middle = opening + half_band;
            let found = slippage_for_opening(&mandrel, &start, middle, [-most, most], longest).map_err(failed)?;
            report.slippage_sought = Some(found.slippage);
            Slippage::Constant(found.slippage)
        }
    };
    let points: Vec<WindingPoint>;
    let halves: Vec<WindingPath>;
    if let Some(circuits) = key.pattern {
        let opposite = match &slippage {
            Slippage::Constant(v) => Slippage::Constant(-v),
            Slippage::Variable(f) => {
                let f = Arc::clone(f);
                Slippage::Variable(Arc::new(move |at: &At| -f(at)))
            }
        };
        let found = circuit(&mandrel, &start, &[slippage, opposite], longest, spacing).map_err(failed)?;
        let band = 2.0 * half_band;
        let cover = |angle: f64, n: u32| coverage(band, start.angle, radius, angle, n).map_err(failed);
        let least = cover(found.angle, 1)?.circuits;
        let range = match circuits {
            Some(n) => n..=n,
            None => least..=(f64::from(least) * (1.0 + OVERLAP)).floor() as u32,
        };
        let best = patterns(found.angle, range).map_err(failed)?[0];
        let laid = cover(found.angle + best.dwell, best.n)?;
        let lead = if best.lead == Lead::Leading { "leading" } else { "lagging" };
        report.circuit = Some(CircuitReport {
            angle: found.angle,
            length: found.length,
            mismatch: found.mismatch,
            turn_radii: found.turns.map(|t| t.radius),
            opening_radii: found.turns.map(|t| t.radius - half_band),
        });
        report.pattern = Some(PatternReport {
            n: best.n,
            k: best.k,
            m: best.m,
            dwell: best.dwell,
            neighbour_after: best.neighbour_after,
            lead: lead.into(),
        });
        report.coverage = Some(CoverageReport {
            circuits_for_full: laid.circuits,
            covered: laid.covered,
            gap: laid.gap * radius,
            overlap: laid.overlap * radius,
            length_of_all: found.length * f64::from(best.n),
        });
        let [up, down] = &found.halves;
        let shifted = down.points.iter().skip(1).map(|p| WindingPoint {
            theta: p.theta + up.end().theta,
            frame: signorini_paths::darboux::Darboux { s: p.frame.s + up.end().frame.s, ..p.frame },
            ..*p
        });
        points = up.points.iter().copied().chain(shifted).collect();
        halves = found.halves.to_vec();
    } else {
        let until = if key.opening.is_some() { Until::Turn } else { Until::Length };
        let path = wind(&mandrel, &start, &slippage, until, longest, spacing).map_err(failed)?;
        if until == Until::Turn {
            let end = path.end();
            let reached = path.ended == Ended::AsAsked;
            report.turn = Some(TurnReport {
                reached,
                radius: end.radius,
                opening_radius: end.radius - half_band,
                theta: end.theta,
            });
        }
        points = path.points.clone();
        halves = vec![path];
    }
    let mut offset = 0.0;
    let (mut bridges, mut slipping) = (Vec::new(), Vec::new());
    for half in &halves {
        let shifted = |i: &[f64; 2]| i.map(|s| s + offset);
        bridges.extend(half.bridges.iter().map(shifted));
        if let Some(friction) = key.friction {
            slipping.extend(half.slipping(friction).iter().map(shifted));
        }
        offset += half.end().frame.s;
    }
    let largest = halves.iter().map(|h| h.largest_slippage().0).fold(0.0, f64::max);
    report.length = points[points.len() - 1].frame.s;
    report.theta = points[points.len() - 1].theta;
    report.largest_slippage = largest;
    report.utilisation = key.friction.map(|mu| largest / mu);
    report.stable = bridges.is_empty() && slipping.is_empty();
    report.bridges = bridges;
    report.slips = slipping;
    let points = points.iter().map(|p| LinePoint::of_winding(p, key.friction)).collect();
    Ok((Line { name: name.clone(), points }, report))
}
