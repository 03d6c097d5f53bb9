//! Shortest paths over moving bodies, frame by frame.

use super::output::{self, Line, LinePoint};
use super::statement::{Around, Coefficients, Friction as FrictionKey, Number, Path, Place};
use super::{PathCase, at_time, box_around, picture};
use crate::expression::Expression;
use crate::output::Folder;
use crate::problem::CaseError;
use crate::run::Progress;
use crate::scene::SceneError;
use serde_json::{Map, Value, json};
use signorini_geometry::{Aabb, Point, Vector};
use signorini_paths::friction::Friction;
use signorini_paths::wrapping::{Anchor, Body, EventKind, Minimal, Route, Station, WrappedPath, Wrapping};

/// Pieces of each contact that are written and drawn.
const PIECES: usize = 24;
/// Frames where none are stated.
const FRAMES: usize = 2;

impl PathCase {
    pub(super) fn check_wrapping(&self) -> Result<(), CaseError> {
        if let Some(frames) = self.statement.frames.filter(|n| !(1..=100_000).contains(n)) {
            return Err(self.error(&["frames"], format!("`frames` is {frames}, valid are 1 to 100000")));
        }
        for (name, path) in &self.statement.paths {
            self.route(name, path, 0.0)?;
            self.friction(name, path)?;
            for (key, value) in [("tension", &path.tension), ("end_tension", &path.end_tension)] {
                if let Some(value) = value {
                    self.expression(&["paths", name, key], value, &["t"])?;
                }
            }
        }
        Ok(())
    }

    fn friction(&self, name: &str, path: &Path) -> Result<Option<Friction>, CaseError> {
        let Some(FrictionKey::Coulomb(key)) = &path.friction else { return Ok(None) };
        let friction = match key.mu {
            Coefficients::Isotropic(mu) => Friction::isotropic(mu),
            Coefficients::Orthotropic([along, across]) => Friction::Carried { along, across },
        };
        friction.check().map_err(|e| self.error(&["paths", name, "friction", "coulomb", "mu"], e.to_string()))?;
        Ok(Some(friction))
    }

    fn anchor(&self, key: &[&str], place: &Place, time: f64) -> Result<Anchor, CaseError> {
        match place {
            Place::OnBody(on) => Ok(Anchor::on(self.body(key, &on.body)?, Point::<3>::from(on.point))),
            Place::Space(x) => {
                let mut point = Point::<3>::zeros();
                for (k, value) in x.iter().enumerate() {
                    point[k] = at_time(&self.expression(key, value, &["t"])?, time);
                    if !point[k].is_finite() {
                        return Err(self.error(key, format!("coordinate {k} is {} at t = {time}", point[k])));
                    }
                }
                Ok(Anchor::fixed(point))
            }
        }
    }

    /// The route of a path at a time.
    fn route(&self, name: &str, path: &Path, time: f64) -> Result<Route, CaseError> {
        let start = self.anchor(&["paths", name, "from"], &path.from, time)?;
        let end = self.anchor(&["paths", name, "to"], &path.to, time)?;
        for body in path.turns.keys() {
            self.body(&["paths", name, "turns"], body)?;
        }
        let around = ["paths", name, "around"];
        let part = |k: usize| match &path.around {
            Around::All(bodies) => bodies.as_slice(),
            Around::Parts(parts) => parts.get(k).map_or(&[][..], Vec::as_slice),
        };
        if let Around::Parts(parts) = &path.around
            && parts.len() != path.via.len() + 1
        {
            let (given, wanted) = (parts.len(), path.via.len() + 1);
            return Err(self.error(&around, format!("{given} lists of bodies for {wanted} parts between fixed points")));
        }
        let mut stations = Vec::new();
        for k in 0..=path.via.len() {
            if k > 0 {
                stations.push(Station::Via(self.anchor(&["paths", name, "via"], &path.via[k - 1], time)?));
            }
            for body in part(k) {
                let turns = path.turns.get(body).copied().unwrap_or(0);
                stations.push(Station::Around { body: self.body(&around, body)?, turns });
            }
        }
        Ok(Route { start, stations, end })
    }

    fn places(&self, time: f64) -> Result<Vec<Body<'_>>, CaseError> {
        let place = |b: &'_ crate::plan::RigidBody| b.motion(&self.problem, time);
        self.bodies.iter().map(|b| Ok(Body { shape: b.shape().as_ref(), motion: place(b)? })).collect()
    }
}

/// Runs all paths through all frames.
pub(super) fn run(case: &PathCase, folder: &Folder, progress: &mut dyn Progress) -> Result<Value, SceneError> {
    let frames = case.statement.frames.unwrap_or(FRAMES);
    let times: Vec<f64> = (0..frames).map(|k| if frames > 1 { k as f64 / (frames - 1) as f64 } else { 0.0 }).collect();
    let mut searches: Vec<Wrapping> = case
        .statement
        .paths
        .iter()
        .map(|(n, p)| Ok(Wrapping::new(case.route(n, p, 0.0)?)))
        .collect::<Result<_, CaseError>>()?;
    let mut written: Vec<Vec<Line>> = Vec::new();
    let mut summaries: Vec<Map<String, Value>> = vec![Map::new(); searches.len()];
    let mut rows: Vec<Vec<Value>> = vec![Vec::new(); searches.len()];
    let mut events: Vec<Vec<Value>> = vec![Vec::new(); searches.len()];
    for (frame, &time) in times.iter().enumerate() {
        progress.step(frame, frames, time);
        let bodies = case.places(time)?;
        let mut lines = Vec::new();
        for (k, (name, key)) in case.statement.paths.iter().enumerate() {
            let route = case.route(name, key, time)?;
            let same = route.stations == searches[k].route().stations;
            if same {
                searches[k].set_start(route.start);
                searches[k].set_end(route.end);
            } else {
                // Via points of space that move: the stations are others, their contacts the same.
                searches[k].set_route(route);
            }
            let path = searches[k].solve(&bodies).map_err(|e| case.failed("paths", name, &e))?;
            let line = line(case, name, key, &path, &bodies, time)?;
            rows[k].push(line.1);
            lines.push(line.0);
            events[k].extend(path.events.iter().map(|e| {
                let kind = if e.kind == EventKind::Touchdown { "touchdown" } else { "lift_off" };
                let body = match searches[k].route().stations[e.station] {
                    Station::Around { body, .. } => case.bodies[body].name.as_str(),
                    Station::Via(_) => "",
                };
                json!({"kind": kind, "time": time, "frame": frame, "body": body})
            }));
        }
        written.push(lines);
    }
    output::write_lines(&times, &written, folder)?;
    let around = box_around(written.iter().flatten().flat_map(|l| l.points.iter().map(|p| p.x)), 0.15);
    let shown = |time: f64| -> Result<Vec<picture::Surface>, CaseError> { surfaces(case, time, &around) };
    let surfaces = times.iter().map(|t| shown(*t)).collect::<Result<Vec<_>, _>>()?;
    output::write_bodies(&times, &surfaces, folder)?;
    if let (Some(lines), Some(surfaces)) = (written.last(), surfaces.last()) {
        picture::draw(case, surfaces, lines, folder)?;
    }
    progress.step(frames, frames, times[frames - 1]);
    for (k, (summary, (rows, events))) in summaries.iter_mut().zip(rows.into_iter().zip(events)).enumerate() {
        let iterations: u64 = rows.iter().filter_map(|r| r["iterations"].as_u64()).sum();
        summary.insert("name".into(), case.statement.paths.keys().nth(k).cloned().into());
        summary.insert("iterations".into(), iterations.into());
        summary.insert("events".into(), events.into());
        summary.insert("frames".into(), rows.into());
    }
    Ok(json!({"title": case.name(), "analysis": "wrapping", "status": "done", "frames": frames, "paths": summaries}))
}

/// The surfaces of all bodies in a box.
pub(super) fn surfaces(case: &PathCase, time: f64, around: &Aabb<3>) -> Result<Vec<picture::Surface>, CaseError> {
    case.bodies
        .iter()
        .map(|b| Ok(picture::Surface::new(&b.gap_at(&case.problem, time)?, [around.min, around.max])))
        .collect()
}

fn value(case: &PathCase, name: &str, key: &str, number: Option<&Number>, time: f64) -> Result<Option<f64>, CaseError> {
    let Some(number) = number else { return Ok(None) };
    let expression: Expression = case.expression(&["paths", name, key], number, &["t"])?;
    let found = at_time(&expression, time);
    if found.is_finite() && found > 0.0 {
        return Ok(Some(found));
    }
    Err(case
        .error(&["paths", name, key], format!("the tension is {found} at t = {time}: it must be greater than zero")))
}

/// A path as it is written, and its row of the summary.
fn line(
    case: &PathCase,
    name: &str,
    key: &Path,
    path: &WrappedPath,
    bodies: &[Body<'_>],
    time: f64,
) -> Result<(Line, Value), CaseError> {
    let failed = |e| case.failed("paths", name, &e);
    let tension = value(case, name, "tension", key.tension.as_ref(), time)?;
    let end = value(case, name, "end_tension", key.end_tension.as_ref(), time)?;
    let array = |v: &Vector<3>| json!([v.x, v.y, v.z]);
    let contacts: Vec<Value> = (path.contacts.iter())
        .map(|c| {
            let minimal = c.minimal == Minimal::Locally;
            json!({"body": case.bodies[c.body].name, "from": c.s, "to": c.s + c.length, "length": c.length,
                "start": array(&c.p), "end": array(&c.q), "minimal": minimal})
        })
        .collect();
    let arms: Map<String, Value> = (case.bodies.iter().enumerate())
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
    if let Some(friction) = case.friction(name, key)? {
        let found = path.tensions(bodies, &friction).map_err(failed)?;
        row["log_ratio"] = json!(found.log_ratio);
        let sideways =
            found.contacts.iter().map(|c| c.1.as_ref().map(|s| json!({"drift": s.drift, "rotation": s.rotation})));
        row["sideways"] = sideways.collect::<Vec<_>>().into();
        if let Some(start) = tension {
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
    let tension = tension.unwrap_or(1.0);
    let points = points.into_iter().map(|p| LinePoint::of_path(&p, tension, slips)).collect();
    Ok((Line { name: name.to_string(), points }, row))
}
