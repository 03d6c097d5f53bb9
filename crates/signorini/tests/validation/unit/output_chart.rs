//! Of `output::chart`.

use plotters::prelude::*;
use resvg::tiny_skia;
use signorini::output::chart::{Image, encoded, tick_labels, ticks, viridis};

#[test]
fn a_map_is_stored_by_a_palette_and_read_back_as_it_is() {
    let mut image = Image::new(300, 2).unwrap();
    (0..300).for_each(|x| image.set(x, 0, viridis(x as f64 / 299.0)));
    (0..300).for_each(|x| image.set(x, 1, RGBColor(228, 228, 228)));
    let bytes = encoded(&image.pixmap).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    assert_eq!(reader.info().color_type, png::ColorType::Indexed);
    let back = tiny_skia::Pixmap::decode_png(&bytes).unwrap();
    assert!(back.pixels() == image.pixmap.pixels());
    assert!(reader.next_row().is_ok());
}

#[test]
fn ticks_are_round_and_within_the_range() {
    assert_eq!(ticks(-1.0, 1.0, 4), [-1.0, -0.5, 0.0, 0.5, 1.0]);
    assert_eq!(ticks(0.0409, 19.5, 5), [5.0, 10.0, 15.0]);
    assert_eq!(ticks(0.0, 0.31, 4), [0.0, 0.1, 0.2, 0.3]);
    assert_eq!(ticks(2.0, 2.0, 4), [2.0]);
    assert_eq!(tick_labels(&ticks(-1.0, 1.0, 4)), ["-1.0", "-0.5", "0.0", "0.5", "1.0"]);
    assert_eq!(tick_labels(&[0.0, 5e-6, 1e-5, 1.5e-5]), ["0", "5e-6", "1.0e-5", "1.5e-5"]);
    assert_eq!(tick_labels(&[1e5, 1.05e5]), ["1.00e5", "1.05e5"]);
}
