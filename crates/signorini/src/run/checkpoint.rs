//! What an interrupted run needs to go on: written after every increment, whole or not at all, and read by
//! `run --resume`. Numbers are read as they were written, to the last bit.

use super::Begun;
use super::events::Known;
use super::increment::Saved;
use crate::output::{Folder, OutputError};
use crate::report::{Event, StepReport, Summary, Warning};
use crate::snapshot::Snapshot;
use serde_json::{Value, json};
use signorini_fem::Grid;
use signorini_geometry::Point;
use signorini_membrane::zone::Zone;
use std::path::Path;

/// The file, within the folder of results.
pub const FILE: &str = "checkpoint.json";
/// The folder of the frames of the film.
const FRAMES: &str = "checkpoint";
const VERSION: u64 = 2;

/// The state of a run between two increments.
pub struct Checkpoint<const D: usize, Z> {
    /// The next increment.
    pub next: usize,
    pub engine: Saved<Z>,
    pub known: Option<Known<Z>>,
    pub steps: Vec<StepReport>,
    pub warnings: Vec<Warning>,
    pub frames: Vec<(f64, String)>,
    pub unknowns: usize,
    pub events: Vec<Event>,
    pub film: Vec<Snapshot<D>>,
}

/// Writes a state with what it is the state of.
pub fn write(folder: &Folder, case: &str, state: &mut Value) -> Result<(), OutputError> {
    (state["version"], state["case"]) = (json!(VERSION), json!(case));
    folder.write(FILE, state.to_string().as_bytes())
}

/// Reads the state of a run of the same case.
///
/// # Errors
/// In words: no checkpoint, or one of another case or version, or no JSON.
pub fn read(path: &Path, case: &str) -> Result<Value, String> {
    let file = path.join(FILE);
    let text = std::fs::read_to_string(&file)
        .map_err(|e| format!("there is no run to go on with: cannot read `{}`: {e}", file.display()))?;
    let v: Value = serde_json::from_str(&text).map_err(|e| format!("{}: {e}", damaged(path)))?;
    if v["version"] != VERSION {
        return Err(format!("`{}` is of another version of this program", file.display()));
    }
    if v["case"] != case {
        return Err(of_another_case(&file));
    }
    Ok(v)
}

/// Where a run of a case would go on in the folder of an earlier one.
///
/// # Errors
/// In words: no run, or one of another case.
pub fn begun(path: &Path, case: &str) -> Result<Begun, String> {
    if path.join(FILE).exists() {
        return Ok(Begun::Resumed);
    }
    let file = path.join("case.toml");
    let text = std::fs::read_to_string(&file)
        .map_err(|e| format!("there is no run to go on with: cannot read `{}`: {e}", file.display()))?;
    if text != case {
        return Err(of_another_case(&file));
    }
    let done = summary(path).is_ok_and(|summary| summary.converged);
    Ok(if done { Begun::Done } else { Begun::Anew })
}

/// The summary of an earlier run.
///
/// # Errors
/// In words: a file that cannot be read, or is no summary of this version.
pub fn summary(path: &Path) -> Result<Summary, String> {
    let file = path.join("summary.json");
    let text = std::fs::read_to_string(&file).map_err(|e| format!("cannot read `{}`: {e}", file.display()))?;
    serde_json::from_str(&text).map_err(|e| format!("`{}` is damaged: {e}", file.display()))
}

fn of_another_case(file: &Path) -> String {
    format!("`{}` is of another case, or of this one before it was changed", file.display())
}

pub fn damaged(path: &Path) -> String {
    format!("`{}` is damaged", path.join(FILE).display())
}

impl<const D: usize, Z: Zone<D>> Checkpoint<D, Z> {
    /// Writes the state; the frame of its last increment stands in a file of its own.
    pub fn write(&self, folder: &Folder, case: &str) -> Result<(), OutputError> {
        if let Some(frame) = self.film.last() {
            let name = format!("{FRAMES}/frame_{:05}.json", self.next - 1);
            folder.write(&name, frame_json(frame).to_string().as_bytes())?;
        }
        let mut state = json!({
            "next": self.next,
            "engine": self.engine.to_json(|z: &Z| z.to_json()),
            "known": self.known.as_ref().map(|k| json!({
                "time": k.time, "zone": k.zone.to_json(), "area": k.area, "force": k.force,
                "energy_total": k.energy_total, "margin": k.margin,
            })),
            "steps": self.steps,
            "warnings": self.warnings,
            "frames": self.frames,
            "unknowns": self.unknowns,
            "events": self.events,
        });
        write(folder, case, &mut state)
    }

    /// Reads the state of a run of the same case.
    ///
    /// # Errors
    /// In words: no checkpoint, one of another case, or a damaged one.
    pub fn read(path: &Path, case: &str, grid: &Grid<D>) -> Result<Self, String> {
        let v = read(path, case)?;
        let damaged = || damaged(path);
        let zone = |v: &Value| Z::from_json(grid, v).ok_or_else(damaged);
        let next = v["next"].as_u64().ok_or_else(damaged)? as usize;
        let number = |v: &Value| v.as_f64().ok_or_else(damaged);
        let known = match &v["known"] {
            Value::Null => None,
            k => Some(Known {
                time: number(&k["time"])?,
                zone: zone(&k["zone"])?,
                area: number(&k["area"])?,
                force: number(&k["force"])?,
                energy_total: k["energy_total"].as_f64().unwrap_or(f64::NAN),
                margin: k["margin"].as_f64(),
            }),
        };
        let mut film = Vec::new();
        for index in 0..next {
            // Without pictures there are none.
            let Ok(text) = std::fs::read_to_string(path.join(format!("{FRAMES}/frame_{index:05}.json"))) else {
                continue;
            };
            let frame: Value = serde_json::from_str(&text).map_err(|_| damaged())?;
            film.push(frame_from(&frame).ok_or_else(damaged)?);
        }
        Ok(Self {
            next,
            engine: Saved::from_json(&v["engine"], |z| Z::from_json(grid, z)).ok_or_else(damaged)?,
            known,
            steps: serde_json::from_value(v["steps"].clone()).map_err(|_| damaged())?,
            warnings: serde_json::from_value(v["warnings"].clone()).map_err(|_| damaged())?,
            frames: serde_json::from_value(v["frames"].clone()).map_err(|_| damaged())?,
            unknowns: v["unknowns"].as_u64().ok_or_else(damaged)? as usize,
            events: serde_json::from_value(v["events"].clone()).map_err(|_| damaged())?,
            film,
        })
    }
}

fn frame_json<const D: usize>(s: &Snapshot<D>) -> Value {
    let outlines: Vec<Vec<Vec<f64>>> =
        s.outlines.iter().map(|o| o.iter().map(|x| x.iter().copied().collect()).collect()).collect();
    json!({
        "time": s.time, "displacement": s.displacement, "gap": s.gap, "pressure": s.pressure,
        "in_contact": s.in_contact, "floor": s.floor, "ceiling": s.ceiling, "outlines": outlines, "within": s.within,
    })
}

fn frame_from<const D: usize>(v: &Value) -> Option<Snapshot<D>> {
    let numbers = |key: &str| serde_json::from_value::<Vec<f64>>(v[key].clone()).ok();
    let outlines: Vec<Vec<Vec<f64>>> = serde_json::from_value(v["outlines"].clone()).ok()?;
    let point = |x: &Vec<f64>| (x.len() == D).then(|| Point::<D>::from_fn(|k, _| x[k]));
    Some(Snapshot {
        time: v["time"].as_f64()?,
        displacement: numbers("displacement")?,
        gap: numbers("gap")?,
        pressure: numbers("pressure")?,
        in_contact: serde_json::from_value(v["in_contact"].clone()).ok()?,
        floor: numbers("floor"),
        ceiling: numbers("ceiling"),
        within: serde_json::from_value(v["within"].clone()).ok()?,
        outlines: outlines.iter().map(|o| o.iter().map(point).collect()).collect::<Option<_>>()?,
    })
}
