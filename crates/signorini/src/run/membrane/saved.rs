//! The frames of a film that a run of a membrane goes on from, as JSON.

use crate::output::{Folder, OutputError};
use crate::run::checkpoint::BESIDE;
use crate::snapshot::Snapshot;
use serde_json::{Value, json};
use signorini_geometry::Point;
use std::path::Path;

fn frame_file(index: usize) -> String {
    format!("{BESIDE}/frame_{index:05}.json")
}

/// Writes the frame of an increment beside the checkpoint.
///
/// # Errors
/// A file that cannot be written.
pub fn write_frame<const D: usize>(folder: &Folder, index: usize, frame: &Snapshot<D>) -> Result<(), OutputError> {
    folder.write(&frame_file(index), frame_json(frame).to_string().as_bytes())
}

/// The frames of the increments before one; without pictures there are none. None where one is damaged.
pub fn frames<const D: usize>(folder: &Path, next: usize) -> Option<Vec<Snapshot<D>>> {
    let texts = (0..next).filter_map(|index| std::fs::read_to_string(folder.join(frame_file(index))).ok());
    texts.map(|text| frame_from(&serde_json::from_str(&text).ok()?)).collect()
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
