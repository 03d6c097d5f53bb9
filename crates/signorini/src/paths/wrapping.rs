//! Shortest paths over moving bodies, frame by frame.

use super::case::PathCase;
use super::output::{self, Line, LinePoint};
use super::picture;
use super::surface::{box_around, surfaces};
use crate::output::Folder;
use crate::plan::Placed;
use crate::plan::paths::{PlannedEnd, PlannedPath, PlannedStation};
use crate::problem::CaseError;
use crate::run::Progress;
use crate::scene::SceneError;
use serde_json::{Map, Value, json};
use signorini_geometry::{Point, Vector};
use signorini_paths::wrapping::{Anchor, Body, EventKind, Minimal, Route, Station, WrappedPath, Wrapping};
use std::fmt::Write as _;

/// Pieces of each contact that are written and drawn.
const PIECES: usize = 24;
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
) -> Result<Value, SceneError> {
    let times: Vec<f64> = (0..frames).map(|k| if frames > 1 { k as f64 / (frames - 1) as f64 } else { 0.0 }).collect();
    let mut searches: Vec<Wrapping> =
        paths.iter().map(|p| Ok(Wrapping::new(case.route(p, 0.0)?))).collect::<Result<_, CaseError>>()?;
    let mut written: Vec<Vec<Line>> = Vec::new();
    let mut summaries: Vec<Map<String, Value>> = vec![Map::new(); searches.len()];
    let mut rows: Vec<Vec<Value>> = vec![Vec::new(); searches.len()];
    let mut events: Vec<Vec<Value>> = vec![Vec::new(); searches.len()];
    for (frame, &time) in times.iter().enumerate() {
        progress.step(frame, frames, time);
        let bodies = case.places(time)?;
        let mut lines = Vec::new();
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
            let line = line(case, key, &path, &bodies, time)?;
            rows[k].push(line.1);
            lines.push(line.0);
            events[k].extend(path.events.iter().map(|e| {
                let kind = if e.kind == EventKind::Touchdown { "touchdown" } else { "lift_off" };
                let body = match searches[k].route().stations[e.station] {
                    Station::Around { body, .. } => case.plan.bodies[body].name.as_str(),
                    Station::Via(_) => "",
                };
                json!({"kind": kind, "time": time, "frame": frame, "body": body})
            }));
        }
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
        histories(case, &times, paths, &rows, folder)?;
    }
    progress.step(frames, frames, times[frames - 1]);
    for (k, (summary, (rows, events))) in summaries.iter_mut().zip(rows.into_iter().zip(events)).enumerate() {
        let iterations: u64 = rows.iter().filter_map(|r| r["iterations"].as_u64()).sum();
        summary.insert("name".into(), paths[k].name.clone().into());
        summary.insert("iterations".into(), iterations.into());
        summary.insert("events".into(), events.into());
        summary.insert("frames".into(), rows.into());
    }
    Ok(json!({"title": case.name(), "analysis": "wrapping", "status": "done", "frames": frames, "paths": summaries}))
}

/// The lengths of paths in time, and what their changes do at a turn of the unit time: a table, and a picture.
fn histories(
    case: &PathCase,
    times: &[f64],
    paths: &[PlannedPath],
    rows: &[Vec<Value>],
    folder: &Folder,
) -> Result<(), SceneError> {
    let (mut curves, mut arms) = (Vec::new(), Vec::new());
    let mut text = String::from("path,time,length,length_rate\n");
    for (path, rows) in paths.iter().zip(rows) {
        let lengths: Vec<(f64, f64)> =
            times.iter().zip(rows).map(|(t, row)| (*t, row["length"].as_f64().unwrap_or(f64::NAN))).collect();
        let last = lengths.len() - 1;
        for (k, (time, length)) in lengths.iter().enumerate() {
            // Central differences, one-sided at the ends.
            let (a, b) = (lengths[k.saturating_sub(1)], lengths[(k + 1).min(last)]);
            let _ = writeln!(text, "{},{time},{length},{}", path.name, (b.1 - a.1) / (b.0 - a.0));
        }
        curves.push((path.name.clone(), lengths));
        for body in case.plan.bodies.iter().filter(|b| !b.rotation.is_empty()) {
            let axis = rotation_axis(case, body, times)?;
            let arm = |row: &Value| {
                let turn = &row["moment_arms"][&body.name]["turn"];
                (0..3).map(|k| turn[k].as_f64().unwrap_or(f64::NAN) * axis[k]).sum::<f64>()
            };
            let values = times.iter().zip(rows).map(|(t, row)| (*t, arm(row))).collect();
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
fn tension(case: &PathCase, value: Option<&Placed>, time: f64) -> Result<Option<f64>, CaseError> {
    let Some(value) = value else { return Ok(None) };
    let found = value.at(case.problem(), time)?;
    if found > 0.0 {
        return Ok(Some(found));
    }
    let message = format!("the tension is {found} at t = {time}: it must be greater than zero");
    Err(case.problem().error(&value.key, message))
}

/// A path as it is written, and its row of the summary.
fn line(
    case: &PathCase,
    key: &PlannedPath,
    path: &WrappedPath,
    bodies: &[Body<'_>],
    time: f64,
) -> Result<(Line, Value), CaseError> {
    let failed = |e| case.failed(&key.key, &key.name, &e);
    let start = tension(case, key.tension.as_ref(), time)?;
    let end = tension(case, key.end_tension.as_ref(), time)?;
    let array = |v: &Vector<3>| json!([v.x, v.y, v.z]);
    let contacts: Vec<Value> = (path.contacts.iter())
        .map(|c| {
            let minimal = c.minimal == Minimal::Locally;
            json!({"body": case.plan.bodies[c.body].name, "from": c.s, "to": c.s + c.length, "length": c.length,
                "start": array(&c.p), "end": array(&c.q), "minimal": minimal})
        })
        .collect();
    let arms: Map<String, Value> = (case.plan.bodies.iter().enumerate())
        .map(|(k, b)| {
            let centre = bodies[k].motion.point(&b.shape().centre());
            let found = path.body_gradient(k, &centre);
            let arms = json!({"about": array(&centre), "shift": array(&-found.shift), "turn": array(&-found.turn)});
            (b.name.clone(), arms)
        })
        .collect();
    let mut row = json!({"time": time, "length": path.length, "iterations": path.iterations, "residual": path.residual,
        "contacts": contacts, "moment_arms": arms});
    let mut slips = false;
    if let Some(friction) = &key.friction {
        let found = path.tensions(bodies, friction).map_err(failed)?;
        row["log_ratio"] = json!(found.log_ratio);
        let sideways =
            found.contacts.iter().map(|c| c.1.as_ref().map(|s| json!({"drift": s.drift, "rotation": s.rotation})));
        row["sideways"] = sideways.collect::<Vec<_>>().into();
        if let Some(start) = start {
            row["tension_limits"] = json!(found.end_tensions(start));
            if let Some(end) = end {
                let utilisation = found.utilisation(start, end);
                slips = utilisation > 1.0;
                row["utilisation"] = utilisation.into();
                row["slips"] = slips.into();
            }
        }
    }
    let points = path.points(bodies, PIECES).map_err(failed)?;
    let start = start.unwrap_or(1.0);
    let points = points.into_iter().map(|p| LinePoint::of_path(&p, start, slips)).collect();
    Ok((Line { name: key.name.clone(), points }, row))
}
