//! The history as an animated picture.

use super::chart::{Shot, animation};
use super::{Folder, OutputError};

/// More frames than this are thinned out: every other one goes.
#[doc(hidden)]
pub const MOST_FRAMES: usize = 24;
/// Size of the frames, relative to that of pictures at their plain size.
const ZOOM: f32 = 0.8;
/// Milliseconds for which a frame is shown at least, for which a film lasts at least, and for which its end stays.
const FRAME: usize = 150;
#[doc(hidden)]
pub const WHOLE: usize = 3000;
const END: usize = 1000;

/// The frames of a history, kept until their common range is known.
pub struct Film<F> {
    frames: Vec<F>,
    /// How often every other one was dropped, and how many came.
    halvings: u32,
    seen: usize,
}

impl<F> Default for Film<F> {
    fn default() -> Self {
        Film { frames: Vec::new(), halvings: 0, seen: 0 }
    }
}

impl<F: Clone> Film<F> {
    /// Takes a state as a frame, unless the film is thinner than that.
    pub fn add(&mut self, frame: &F) {
        if self.seen.is_multiple_of(1 << self.halvings) {
            self.frames.push(frame.clone());
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

    /// The frames that are kept, in order.
    pub fn frames(&self) -> &[F] {
        &self.frames
    }
}

/// Milliseconds for which each of a number of frames is shown.
#[doc(hidden)]
pub fn times(count: usize) -> impl Iterator<Item = u16> {
    let each = FRAME.max((WHOLE - END).div_ceil(count.max(1)));
    (1..=count).map(move |k| if k == count { each + END } else { each } as u16)
}

/// Writes an animation of frames, if there is more than one.
///
/// # Errors
/// Frames that cannot be drawn, and files that cannot be written.
pub fn write(folder: &Folder, drawn: Vec<String>) -> Result<(), OutputError> {
    if drawn.len() < 2 {
        return Ok(());
    }
    let milliseconds = times(drawn.len());
    let shots: Vec<Shot> = drawn.into_iter().zip(milliseconds).map(|(svg, shown)| Shot { svg, shown }).collect();
    folder.write("pictures/film.png", &animation(&shots, ZOOM)?)
}
