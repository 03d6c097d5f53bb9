//! Scenes: rigid bodies made of named points, edges and faces, moved along prescribed paths, with the closest pair of
//! every kind at every frame. No mechanics.
//!
//! A scene is a TOML file with `analysis = "closest_pairs"`; the parts of its bodies are written like the partners of
//! [queries](crate::queries).

pub(crate) mod case;
pub(crate) mod output;
pub(crate) mod picture;

use std::collections::BTreeMap;
use std::path::Path;

use rayon::prelude::*;
use serde_json::{Value, json};

use crate::output::{Folder, OutputError};
use crate::problem::CaseError;
use crate::run::Progress;
pub use case::{Camera, Frame, KINDS, Scene, SceneBody, ScenePair, is_scene};

/// Why a scene could not be run.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    #[error(transparent)]
    Case(#[from] CaseError),
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// Runs a scene into a folder and returns its summary.
///
/// # Errors
/// A motion that is not finite, or files that cannot be written.
pub fn run(scene: &Scene, folder: &Path, progress: &mut dyn Progress) -> Result<Value, SceneError> {
    // The first frame shows whether the scene can be run at all.
    scene.at(scene.times[0])?;
    run_into(scene, &Folder::create(folder)?, progress)
}

/// The same into a folder that exists, or that is in memory.
///
/// # Errors
/// Those of [`run`].
pub fn run_into(scene: &Scene, folder: &Folder, progress: &mut dyn Progress) -> Result<Value, SceneError> {
    let start = std::time::Instant::now();
    folder.write("case.toml", scene.text.as_bytes())?;
    let count = scene.times.len();
    progress.step(0, count, scene.times[0]);
    let frames: Result<Vec<Frame>, CaseError> = scene.times.par_iter().map(|&t| scene.at(t)).collect();
    let frames = frames?;
    output::write(scene, &frames, folder)?;
    progress.step(count, count, scene.times[count - 1]);
    picture::draw(scene, &frames, folder)?;
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    for frame in &frames {
        *kinds.entry(KINDS[frame.pairs[frame.governing].kind].1).or_default() += 1;
    }
    let least = frames
        .iter()
        .min_by(|p, q| p.pairs[p.governing].pair.distance.total_cmp(&q.pairs[q.governing].pair.distance))
        .map(|f| json!({"time": f.time, "gap": f.pairs[f.governing].pair.distance, "pair": output::describe(scene, f, f.governing)}));
    let summary = json!({
        "title": scene.title,
        "status": "done",
        "frames": count,
        "contact_pair_kinds": kinds,
        "closest": least,
        "seconds": start.elapsed().as_secs_f64(),
    });
    folder.write("summary.json", format!("{summary:#}\n").as_bytes())?;
    Ok(summary)
}
