//! Of `output::film`.

use signorini::output::Folder;
use signorini::output::film::{Film, MOST_FRAMES, WHOLE, times, write};

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
