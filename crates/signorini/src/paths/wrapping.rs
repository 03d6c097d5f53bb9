//! Shortest paths over moving bodies, frame by frame.

use super::Found;
use super::case::PathCase;
use super::output::{self, Line, LinePoint};
use super::picture;
use super::surface::{box_around, surfaces};
use crate::output::Folder;
use crate::plan::LocatedExpression;
use crate::plan::paths::{PlannedEnd, PlannedPath, PlannedStation};
use crate::problem::CaseError;
use crate::report::{
    MomentArm, PathContact, PathEvent, PathEventKind, PathFrame, PathReport, SidewaysReport, StepReport, Warning,
    WarningKind,
};
use crate::run::Progress;
use crate::scene::SceneError;
use signorini_geometry::{Point, Vector};
use signorini_paths::wrapping::{Anchor, Body, EventKind, Minimal, Route, Sideways, Station, WrappedPath, Wrapping};
use std::fmt::Write as _;

/// Pieces of each contact that are written and drawn.
const PIECES: usize = 24;
/// Unknowns of a contact: where it begins along and across, its direction and its length.
const UNKNOWNS: usize = 4;

impl PathCase {
    fn anchor(&self, end: &PlannedEnd, time: f64) -> Result<Anchor, CaseError> {
        match end {
            PlannedEnd::OnBody(body, point) => Ok(Anchor::on(*body, *point)),
            PlannedEnd::Space(x) => {
                let [x, y, z] = [0, 1, 2].map(|k| x[k].at(self.problem(), time));
                Ok(Anchor::fixed(Point::<3>::new(x?, y?, z?)))
            }
        }
    }

    /// The route of a path at a time.
    fn route(&self, path: &PlannedPath, time: f64) -> Result<Route, CaseError> {
        let stations = (path.stations.iter())
            .map(|station| match station {
                PlannedStation::Via(end) => self.anchor(end, time).map(Station::Via),
                PlannedStation::Around { body, turns } => Ok(Station::Around { body: *body, turns: *turns }),
            })
            .collect::<Result<_, _>>()?;
        Ok(Route { start: self.anchor(&path.from, time)?, stations, end: self.anchor(&path.to, time)? })
    }

    fn places(&self, time: f64) -> Result<Vec<Body<'_>>, CaseError> {
        let place = |b: &'_ crate::plan::RigidBody| b.motion(self.problem(), time);
        self.plan.bodies.iter().map(|b| Ok(Body { shape: b.shape().as_ref(), motion: place(b)? })).collect()
    }
}

/// Runs all paths through all frames.
pub(super) fn run(
    case: &PathCase,
    (frames, paths): (usize, &[PlannedPath]),
    folder: &Folder,
    progress: &mut dyn Progress,
) -> Result<Found, SceneError> {
    let times: Vec<f64> = (0..frames).map(|k| if frames > 1 { k as f64 / (frames - 1) as f64 } else { 0.0 }).collect();
    let mut searches: Vec<Wrapping> =
        paths.iter().map(|p| Ok(Wrapping::new(case.route(p, 0.0)?))).collect::<Result<_, CaseError>>()?;
    let mut written: Vec<Vec<Line>> = Vec::new();
    let named = |p: &PlannedPath| PathReport { name: p.name.clone(), ..PathReport::default() };
    let mut found = Found::default();
    found.reports.paths = paths.iter().map(named).collect();
    for (frame, &time) in times.iter().enumerate() {
        progress.step(frame, frames, time);
        let bodies = case.places(time)?;
        let mut lines = Vec::new();
        let mut step = StepReport { index: frame, time, converged: true, ..StepReport::default() };
        let mut unknowns = 0;
        for (k, key) in paths.iter().enumerate() {
            let route = case.route(key, time)?;
            let same = route.stations == searches[k].route().stations;
            if same {
                searches[k].set_start(route.start);
                searches[k].set_end(route.end);
            } else {
                // Via points of space that move: the stations are others, their contacts the same.
                searches[k].set_route(route);
            }
            let path = searches[k].solve(&bodies).map_err(|e| case.failed(&key.key, &key.name, &e))?;
            odd(case, key, &path, &bodies, time, &mut found.warnings)?;
            let (line, row) = line(case, key, &path, &bodies, time)?;
            step.iterations += row.iterations;
            unknowns += UNKNOWNS * row.contacts.len();
            let report = &mut found.reports.paths[k];
            report.iterations += row.iterations;
            report.frames.push(row);
            lines.push(line);
            report.events.extend(path.events.iter().map(|e| {
                let touches = e.kind == EventKind::Touchdown;
                let kind = if touches { PathEventKind::Touchdown } else { PathEventKind::LiftOff };
                let body = match searches[k].route().stations[e.station] {
                    Station::Around { body, .. } => case.plan.bodies[body].name.clone(),
                    Station::Via(_) => String::new(),
                };
                PathEvent { kind, time, frame, body }
            }));
        }
        found.unknowns = found.unknowns.max(unknowns);
        found.steps.push(step);
        written.push(lines);
    }
    output::write_lines(&times, &written, folder)?;
    let around = box_around(written.iter().flatten().flat_map(|l| l.points.iter().map(|p| p.x)), 0.15);
    // Bodies at rest are drawn once.
    let shown = if case.plan.bodies.iter().all(|b| b.is_at_rest()) { &times[..1] } else { &times[..] };
    let bodies = surfaces(case, shown, &around)?;
    output::write_bodies(shown, &bodies, folder)?;
    if let (Some(lines), Some(surfaces)) = (written.last(), bodies.last()) {
        picture::draw(case, surfaces, lines, folder)?;
    }
    if frames > 1 {
        histories(case, &times, &found.reports.paths, folder)?;
    }
    progress.step(frames, frames, times[frames - 1]);
    Ok(found)
}

/// The paths at the first time.
pub(super) fn at_start(case: &PathCase, paths: &[PlannedPath]) -> Result<Vec<Line>, SceneError> {
    let bodies = case.places(0.0)?;
    let each = paths.iter().map(|key| {
        let path = Wrapping::new(case.route(key, 0.0)?).solve(&bodies);
        let path = path.map_err(|e| case.failed(&key.key, &key.name, &e))?;
        Ok(line(case, key, &path, &bodies, 0.0)?.0)
    });
    each.collect()
}

/// Warns, once for each path, where its bodies do not stand in the order in which it meets them, and where it goes through one
/// that it is not said to go around.
fn odd(
    case: &PathCase,
    key: &PlannedPath,
    path: &WrappedPath,
    bodies: &[Body<'_>],
    time: f64,
    warnings: &mut Vec<Warning>,
) -> Result<(), CaseError> {
    let name = &key.name;
    let body_of =
        |station: &PlannedStation| if let PlannedStation::Around { body, .. } = station { Some(*body) } else { None };
    let mut told = |message: String, start: &str| {
        if !warnings.iter().any(|w| w.message.starts_with(start)) {
            warnings.push(Warning::new(WarningKind::Path, message).at_time(time));
        }
    };
    if !path.order.is_sorted() {
        let met = path.order.iter().filter_map(|station| body_of(&key.stations[*station]));
        let met: Vec<String> = met.map(|body| format!("`{}`", case.plan.bodies[body].name)).collect();
        let start = format!("`{name}` is in contact with its bodies in another order");
        told(format!("{start} than in `around`; in that order it would pass through one: {}", met.join(", ")), &start);
    }
    for (number, body) in case.plan.bodies.iter().enumerate() {
        if key.stations.iter().any(|station| body_of(station) == Some(number)) {
            continue;
        }
        let crosses = path.crosses(bodies, number).map_err(|e| case.failed(&key.key, name, &e))?;
        if let Some((x, depth)) = crosses {
            let start = format!("`{name}` passes through `{}`", body.name);
            let at = x.iter().map(|v| format!("{v:.4}")).collect::<Vec<_>>().join(", ");
            let remedy = "its `around` does not contain this body";
            told(format!("{start}, {depth:.4e} deep at ({at}), t = {time}: {remedy}"), &start);
        }
    }
    Ok(())
}

/// The lengths of paths in time, and what their changes do at a turn of the unit time: a table, and a picture.
fn histories(case: &PathCase, times: &[f64], paths: &[PathReport], folder: &Folder) -> Result<(), SceneError> {
    let (mut curves, mut arms) = (Vec::new(), Vec::new());
    let mut text = String::from("path,time,length,length_rate\n");
    for path in paths {
        let lengths: Vec<(f64, f64)> = path.frames.iter().map(|f| (f.time, f.length)).collect();
        let last = lengths.len() - 1;
        for (k, (time, length)) in lengths.iter().enumerate() {
            // Central differences, one-sided at the ends.
            let (a, b) = (lengths[k.saturating_sub(1)], lengths[(k + 1).min(last)]);
            let _ = writeln!(text, "{},{time},{length},{}", path.name, (b.1 - a.1) / (b.0 - a.0));
        }
        curves.push((path.name.clone(), lengths));
        for body in case.plan.bodies.iter().filter(|b| !b.rotation.is_empty()) {
            let axis = rotation_axis(case, body, times)?;
            let arm = |f: &PathFrame| Vector::<3>::from(f.moment_arms[&body.name].turn).dot(&axis);
            let values = path.frames.iter().map(|f| (f.time, arm(f))).collect();
            arms.push((format!("{} about {}", path.name, body.name), values));
        }
    }
    if !arms.is_empty() {
        let name = crate::output::labels::Labels(case.plan.head.unit_names()).length("moment arm");
        picture::history(case, ("moment_arm", "Moment arm", &name), &arms, folder)?;
    }
    folder.write("history.csv", text.as_bytes())?;
    let name = crate::output::labels::Labels(case.plan.head.unit_names()).length("length");
    picture::history(case, ("length", "Length", &name), &curves, folder)?;
    Ok(())
}

/// The axis about which a body turns from the first time to the last.
fn rotation_axis(case: &PathCase, body: &crate::plan::RigidBody, times: &[f64]) -> Result<Vector<3>, CaseError> {
    let at = |time: f64| -> Result<Vector<3>, CaseError> {
        let mut out = Vector::<3>::zeros();
        for (k, value) in body.rotation.iter().enumerate() {
            out[k] = value.at(case.problem(), time)?;
        }
        Ok(out)
    };
    let turned = at(times[times.len() - 1])? - at(times[0])?;
    Ok(turned.try_normalize(0.0).unwrap_or_default())
}

/// A tension at a time, which is positive.
fn tension(case: &PathCase, value: Option<&LocatedExpression>, time: f64) -> Result<Option<f64>, CaseError> {
    let Some(value) = value else { return Ok(None) };
    let found = value.at(case.problem(), time)?;
    if found > 0.0 {
        return Ok(Some(found));
    }
    let message = format!("the tension is {found} at t = {time}: it must be positive");
    Err(case.problem().error(&value.key, message))
}

/// A path as it is written, and what is told of it.
fn line(
    case: &PathCase,
    key: &PlannedPath,
    path: &WrappedPath,
    bodies: &[Body<'_>],
    time: f64,
) -> Result<(Line, PathFrame), CaseError> {
    let failed = |e| case.failed(&key.key, &key.name, &e);
    let start = tension(case, key.tension.as_ref(), time)?;
    let end = tension(case, key.end_tension.as_ref(), time)?;
    let contacts = path.contacts.iter().map(|c| PathContact {
        body: case.plan.bodies[c.body].name.clone(),
        from: c.s,
        to: c.s + c.length,
        length: c.length,
        start: c.p.into(),
        end: c.q.into(),
        minimal: c.minimal == Minimal::Locally,
    });
    let arms = case.plan.bodies.iter().enumerate().map(|(k, b)| {
        let centre = bodies[k].motion.point(&b.shape().centre());
        let found = path.body_gradient(k, &centre);
        (b.name.clone(), MomentArm { about: centre.into(), shift: (-found.shift).into(), turn: (-found.turn).into() })
    });
    let mut frame = PathFrame {
        time,
        length: path.length,
        iterations: path.iterations,
        residual: path.residual,
        contacts: contacts.collect(),
        moment_arms: arms.collect(),
        ..PathFrame::default()
    };
    if let Some(friction) = &key.friction {
        let found = path.tensions(bodies, friction).map_err(failed)?;
        frame.log_ratio = Some(found.log_ratio);
        let sideways = |s: &Sideways| SidewaysReport { drift: s.drift, rotation: s.rotation };
        frame.sideways = Some(found.contacts.iter().map(|c| c.1.as_ref().map(sideways)).collect());
        frame.tension_limits = start.map(|start| found.end_tensions(start));
        frame.utilisation = start.zip(end).map(|(start, end)| found.utilisation(start, end));
        frame.slips = frame.utilisation.map(|used| used > 1.0);
    }
    let slips = frame.slips == Some(true);
    let points = path.points(bodies, PIECES).map_err(failed)?;
    let start = start.unwrap_or(1.0);
    let points = points.into_iter().map(|p| LinePoint::of_path(&p, start, slips)).collect();
    Ok((Line { name: key.name.clone(), points }, frame))
}
