//! What a run of solids goes on from, as JSON: the state of the solids, and the frames of the film.

use crate::output::solid_state::SolidFrame;
use crate::output::{Folder, OutputError};
use crate::run::checkpoint::BESIDE;
use serde_json::{Value, json};
use signorini_geometry::Point;
use signorini_solid::{FrictionHistory, Memory};
use std::path::Path;

/// The state between two increments.
pub fn to_json(memory: Memory) -> Value {
    let friction = memory.friction.map(|FrictionHistory { u, motion, traction, slip }| {
        json!({"u": u, "motion": motion, "traction": traction, "slip": slip})
    });
    json!({"active": memory.active, "friction": friction})
}

/// Reads what [`to_json`] wrote; none where it is damaged.
pub fn from_json(mut v: Value) -> Option<Memory> {
    fn take<T: serde::de::DeserializeOwned>(v: &mut Value) -> Option<T> {
        serde_json::from_value(v.take()).ok()
    }
    let friction = match v["friction"].take() {
        Value::Null => None,
        mut f => Some(FrictionHistory {
            u: take(&mut f["u"])?,
            motion: take(&mut f["motion"])?,
            traction: take(&mut f["traction"])?,
            slip: take(&mut f["slip"])?,
        }),
    };
    Some(Memory { active: take(&mut v["active"])?, friction })
}

pub fn frame_file(index: usize) -> String {
    format!("{BESIDE}/frame_{index:05}.json")
}

/// Writes the frame of an increment beside the checkpoint.
///
/// # Errors
/// A file that cannot be written.
pub fn write_frame<const D: usize>(folder: &Folder, index: usize, frame: &SolidFrame<D>) -> Result<(), OutputError> {
    folder.write(&frame_file(index), frame_json(frame).to_string().as_bytes())
}

/// The frames of the increments before one; without pictures there are none. None where one is damaged.
pub fn frames<const D: usize>(folder: &Path, next: usize) -> Option<Vec<SolidFrame<D>>> {
    let texts = (0..next).filter_map(|index| std::fs::read_to_string(folder.join(frame_file(index))).ok());
    texts.map(|text| frame_from(&serde_json::from_str(&text).ok()?)).collect()
}

fn frame_json<const D: usize>(frame: &SolidFrame<D>) -> Value {
    let entries = |x: &Point<D>| x.iter().copied().collect::<Vec<f64>>();
    json!({
        "time": frame.time,
        "von_mises": frame.von_mises,
        "displacement": frame.displacement.iter().map(entries).collect::<Vec<_>>(),
        "zones": frame.zones.iter().flatten().map(entries).collect::<Vec<_>>(),
    })
}

fn frame_from<const D: usize>(v: &Value) -> Option<SolidFrame<D>> {
    let points = |key: &str| -> Option<Vec<Point<D>>> {
        let list: Vec<Vec<f64>> = serde_json::from_value(v[key].clone()).ok()?;
        list.iter().map(|x| (x.len() == D).then(|| Point::<D>::from_fn(|k, _| x[k]))).collect()
    };
    Some(SolidFrame {
        time: v["time"].as_f64()?,
        displacement: points("displacement")?,
        von_mises: serde_json::from_value(v["von_mises"].clone()).ok()?,
        zones: points("zones")?.chunks_exact(2).map(|ends| [ends[0], ends[1]]).collect(),
    })
}
