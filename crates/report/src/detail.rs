//! How much of a view is kept, so that pages stay small.

use crate::collection::Source;

/// Files of fields beyond this size together are not all read, in bytes.
const READ: u64 = 500_000_000;
/// More states than this are not told apart on a slider.
const STATES: usize = 200;

/// A level of detail.
#[derive(Clone, Copy, Debug)]
pub struct Detail {
    pub keeps_stresses: bool,
    pub keeps_volume: bool,
    /// The most states.
    pub states: usize,
    /// The most triangles of a rigid body and of any other part.
    pub rigid_triangles: usize,
    pub triangles: usize,
}

const ALL: usize = usize::MAX;

/// From all to little: the first that fits is taken.
pub const LEVELS: [Detail; 8] = [
    Detail { keeps_stresses: true, keeps_volume: true, states: ALL, rigid_triangles: ALL, triangles: ALL },
    Detail { keeps_stresses: false, keeps_volume: true, states: ALL, rigid_triangles: ALL, triangles: ALL },
    Detail { keeps_stresses: false, keeps_volume: true, states: 60, rigid_triangles: 12_000, triangles: ALL },
    Detail { keeps_stresses: false, keeps_volume: false, states: 60, rigid_triangles: 8_000, triangles: ALL },
    Detail { keeps_stresses: false, keeps_volume: false, states: 25, rigid_triangles: 6_000, triangles: 60_000 },
    Detail { keeps_stresses: false, keeps_volume: false, states: 12, rigid_triangles: 5_000, triangles: 25_000 },
    Detail { keeps_stresses: false, keeps_volume: false, states: 6, rigid_triangles: 3_000, triangles: 12_000 },
    Detail { keeps_stresses: false, keeps_volume: false, states: 2, rigid_triangles: 2_000, triangles: 6_000 },
];

impl Detail {
    /// The numbers of the states that are kept: the last one always, the others evenly.
    pub fn frames(&self, count: usize) -> Vec<usize> {
        evenly(count, self.states)
    }

    /// What is left out, in words.
    pub fn note(&self, states: usize) -> Option<String> {
        let mut left_out = Vec::new();
        if !self.keeps_stresses {
            left_out.push("components of stresses".to_string());
        }
        if !self.keeps_volume {
            left_out.push("the inside of bodies".to_string());
        }
        if states > self.states {
            left_out.push(format!("{} of {states} states", states - self.states));
        }
        if self.triangles < ALL {
            left_out.push(format!("triangles beyond about {} of a body", self.triangles));
        }
        let text = left_out.join(", ");
        let is_are = "to keep the page small; the files of the folder contain all";
        (!text.is_empty()).then(|| format!("The view leaves out {text} {is_are}."))
    }
}

/// As many of the numbers below `count` as are wanted, evenly, the last one included.
pub fn evenly(count: usize, wanted: usize) -> Vec<usize> {
    if count <= wanted {
        return (0..count).collect();
    }
    let last = wanted.max(2) - 1;
    (0..=last).map(|k| k * (count - 1) / last).collect()
}

/// The times whose files are read, and a note where that is not all of them.
pub fn chosen(sources: &[Source], times: &[f64]) -> (Vec<f64>, Vec<String>) {
    let files = sources.iter().flat_map(|s| &s.files);
    let total: u64 = files.filter_map(|f| f.1.metadata().ok()).map(|m| m.len()).sum();
    let share = (READ as f64 / total.max(1) as f64 * times.len() as f64) as usize;
    let wanted = share.clamp(2, STATES);
    let kept: Vec<f64> = evenly(times.len(), wanted).into_iter().map(|k| times[k]).collect();
    let note = (kept.len() < times.len()).then(|| format!("The view shows {} of {} states.", kept.len(), times.len()));
    (kept, note.into_iter().collect())
}
