//! Frames of the film of a system, kept beside its checkpoint.

use crate::output::system::SystemShown;
use crate::output::{Folder, OutputError};
use crate::plan::mechanics::MechanicsPlan;
use crate::run::checkpoint;
use serde_json::{Value, json};
use signorini_geometry::Vector;
use signorini_mechanics::BodyState;
use std::path::Path;

/// What a frame of the film shows: the bodies as they are, and in the plane the intervals in contact.
#[derive(Clone)]
pub struct Frame {
    pub time: f64,
    pub bodies: Vec<BodyState>,
    pub zones: Vec<[Vector<3>; 2]>,
}

impl Frame {
    fn file(index: usize) -> String {
        format!("{}/frame_{index:05}.json", checkpoint::BESIDE)
    }

    /// The bodies as they are shown.
    pub fn shown(&self, plan: &MechanicsPlan) -> SystemShown {
        SystemShown { time: self.time, zones: self.zones.clone(), ..SystemShown::of_bodies(plan, &self.bodies) }
    }

    /// Writes the frame of an increment beside the checkpoint.
    pub fn write(&self, folder: &Folder, index: usize) -> Result<(), OutputError> {
        let bodies: Vec<[&[f64]; 2]> = self.bodies.iter().map(|b| [&b.configuration[..], &b.internal[..]]).collect();
        let zones: Vec<[[f64; 3]; 2]> = self.zones.iter().map(|ends| ends.map(Into::into)).collect();
        let text = json!({"time": self.time, "bodies": bodies, "zones": zones}).to_string();
        folder.write(&Self::file(index), text.as_bytes())
    }

    /// The frames of the increments before one; without pictures there are none. None where one is damaged.
    pub fn read_all(folder: &Path, next: usize) -> Option<Vec<Frame>> {
        let texts = (0..next).filter_map(|index| std::fs::read_to_string(folder.join(Self::file(index))).ok());
        let frame = |text: String| {
            let mut value: Value = serde_json::from_str(&text).ok()?;
            let bodies: Vec<[Vec<f64>; 2]> = take(&mut value["bodies"])?;
            let body = |[configuration, internal]: [Vec<f64>; 2]| BodyState { configuration, internal };
            let zones: Vec<[[f64; 3]; 2]> = take(&mut value["zones"])?;
            Some(Frame {
                time: value["time"].as_f64()?,
                bodies: bodies.into_iter().map(body).collect(),
                zones: zones.into_iter().map(|ends| ends.map(Into::into)).collect(),
            })
        };
        texts.map(frame).collect()
    }
}

/// A part of what was saved; none where it is damaged.
pub fn take<T: serde::de::DeserializeOwned>(v: &mut Value) -> Option<T> {
    serde_json::from_value(v.take()).ok()
}
