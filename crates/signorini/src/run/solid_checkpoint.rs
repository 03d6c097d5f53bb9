//! What an interrupted run of solids needs to go on; see [`checkpoint`].

use super::checkpoint;
use crate::output::{Folder, OutputError};
use crate::report::{StepReport, Warning};
use serde_json::{Value, json};
use signorini_solid::{Memory, Settled};
use std::path::Path;

/// The state of a run between two increments.
pub struct SolidCheckpoint {
    /// The next increment.
    pub next: usize,
    pub memory: Memory,
    pub steps: Vec<StepReport>,
    pub warnings: Vec<Warning>,
    pub frames: Vec<(f64, String)>,
}

impl SolidCheckpoint {
    /// Writes the state.
    pub fn write(&self, folder: &Folder, case: &str) -> Result<(), OutputError> {
        let settled = self.memory.settled.as_ref().map(|Settled { u, pressure }| {
            let mut pressure: Vec<_> = pressure.iter().map(|(key, p)| (*key, *p)).collect();
            pressure.sort_by_key(|(key, _)| *key);
            json!({"u": u, "pressure": pressure})
        });
        let mut state = json!({
            "next": self.next,
            "active": self.memory.active,
            "settled": settled,
            "steps": self.steps,
            "warnings": self.warnings,
            "frames": self.frames,
        });
        checkpoint::write(folder, case, &mut state)
    }

    /// Reads the state of a run of the same case.
    ///
    /// # Errors
    /// In words: no checkpoint, one of another case, or a damaged one.
    pub fn read(path: &Path, case: &str) -> Result<Self, String> {
        let mut v = checkpoint::read(path, case)?;
        let mut state = || -> Option<Self> {
            fn take<T: serde::de::DeserializeOwned>(v: &mut Value) -> Option<T> {
                serde_json::from_value(v.take()).ok()
            }
            let settled = match v["settled"].take() {
                Value::Null => None,
                mut s => {
                    let pressure: Vec<_> = take(&mut s["pressure"])?;
                    Some(Settled { u: take(&mut s["u"])?, pressure: pressure.into_iter().collect() })
                }
            };
            Some(Self {
                next: take(&mut v["next"])?,
                memory: Memory { active: take(&mut v["active"])?, settled },
                steps: take(&mut v["steps"])?,
                warnings: take(&mut v["warnings"])?,
                frames: take(&mut v["frames"])?,
            })
        };
        state().ok_or_else(|| checkpoint::damaged(path))
    }
}
