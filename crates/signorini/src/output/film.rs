//! The history as an animated picture.

use super::chart::{Shot, animation};
use super::{Folder, OutputError};

/// More frames than this are thinned out: every other one goes.
const MOST_FRAMES: usize = 48;
/// Size of the frames, relative to that of pictures at their plain size.
const ZOOM: f32 = 0.8;
/// Milliseconds for which a frame is shown at least, for which a film lasts at least, and for which its end stays.
const FRAME: usize = 150;
const WHOLE: usize = 3000;
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
fn times(count: usize) -> impl Iterator<Item = u16> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_film_lasts_three_seconds_and_keeps_its_frames_evenly() {
        for count in [2, 5, 11, 48] {
            let whole: usize = times(count).map(usize::from).sum();
            assert!((WHOLE..10_000).contains(&whole), "{count}: {whole}");
        }
        let mut film = Film::default();
        (0..1000).for_each(|k| film.add(&k));
        assert!(film.frames().len() <= MOST_FRAMES && film.frames().len() > MOST_FRAMES / 2);
        assert!(film.frames().windows(2).all(|w| w[1] - w[0] == film.frames()[1]));
    }

    #[test]
    fn an_animation_states_its_frames_and_their_times() {
        let picture = |x: u32| {
            format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"40\" height=\"30\"><rect width=\"40\" height=\"30\" fill=\"white\"/><rect x=\"{x}\" y=\"5\" width=\"6\" height=\"6\" fill=\"rgb(255,0,0)\"/></svg>"
            )
        };
        let folder = tempfile::tempdir().unwrap();
        let own = Folder::create(&folder.path().join("out")).unwrap();
        write(&own, (0..4).map(|k| picture(5 * k)).collect()).unwrap();
        let file = std::io::BufReader::new(std::fs::File::open(own.path().unwrap().join("pictures/film.png")).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        assert_eq!(reader.info().animation_control.unwrap().num_frames, 4);
        let mut milliseconds = 0;
        let mut canvas = vec![255u8; 32 * 24 * 3];
        let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
        for _ in 0..4 {
            reader.next_frame(&mut buffer).unwrap();
            let frame = *reader.info().frame_control().unwrap();
            milliseconds += u32::from(frame.delay_num) * 1000 / u32::from(frame.delay_den);
            let (w, h) = (frame.width as usize, frame.height as usize);
            for y in 0..h {
                let at = ((y + frame.y_offset as usize) * 32 + frame.x_offset as usize) * 3;
                canvas[at..at + 3 * w].copy_from_slice(&buffer[3 * y * w..3 * (y + 1) * w]);
            }
        }
        assert!(milliseconds >= 3000, "{milliseconds}");
        // The last frame: red from 15 to 21, white where the first was red.
        let at = |x: usize, y: usize| &canvas[(y * 32 + x) * 3..][..3];
        assert_eq!((at(14, 6), at(2, 6)), (&[255, 0, 0][..], &[255, 255, 255][..]));
    }
}
