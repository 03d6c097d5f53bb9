//! The history as an animated picture.

use super::chart::animation;
use super::{Folder, OutputError, pictures};
use crate::plan::MembranePlan;
use crate::snapshot::{DisplayMesh, Snapshot};
use rayon::prelude::*;

/// More frames than this are thinned out: every other one goes.
const MOST_FRAMES: usize = 48;
/// Size of the frames, relative to that of pictures at their plain size.
const ZOOM: f32 = 0.8;
/// Seconds for which a frame is shown, as a fraction.
const DELAY: (u16, u16) = (3, 20);

/// The frames of a history, kept until their common range is known.
#[derive(Default)]
pub struct Film<const D: usize> {
    frames: Vec<Snapshot<D>>,
    /// How often every other one was dropped, and how many came.
    halvings: u32,
    seen: usize,
}

impl<const D: usize> Film<D> {
    pub fn add(&mut self, s: &Snapshot<D>) {
        if self.seen.is_multiple_of(1 << self.halvings) {
            self.frames.push(s.clone());
        }
        self.seen += 1;
        if self.frames.len() > MOST_FRAMES {
            let mut index = 0;
            self.frames.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.halvings += 1;
        }
    }

    /// Writes the animation, if there is more than one frame.
    pub fn write(&self, folder: &Folder, plan: &MembranePlan<D>, mesh: &DisplayMesh<D>) -> Result<(), OutputError> {
        if self.frames.len() < 2 || mesh.cells.is_empty() {
            return Ok(());
        }
        let range = self
            .frames
            .iter()
            .map(pictures::frame_range)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |a, b| (a.0.min(b.0), a.1.max(b.1)));
        let drawn: Vec<String> = self
            .frames
            .par_iter()
            .map(|s| pictures::frame(plan, mesh, s, range))
            .collect::<Result<_, OutputError>>()?;
        folder.write("pictures/film.png", &animation(&drawn, ZOOM, DELAY)?)
    }
}
