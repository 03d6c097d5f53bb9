//! Of `run::solid::saved`.

use signorini::output::Folder;
use signorini::output::solid_state::SolidFrame;
use signorini::testing::{frame_file, frames, write_frame};
use signorini_geometry::Point;

#[test]
fn a_frame_is_read_as_it_was_written() {
    let x = |a: f64, b: f64| Point::<2>::new(a, b);
    let frame = SolidFrame {
        time: 0.1 + 0.2,
        displacement: vec![x(1.0 / 3.0, -2e-17), x(0.0, 5.0)],
        von_mises: vec![1.0 / 7.0, 3e9],
        zones: vec![[x(0.1, 0.2), x(0.3, 0.7)]],
    };
    let folder = tempfile::tempdir().unwrap();
    let own = Folder::create(&folder.path().join("out")).unwrap();
    write_frame(&own, 1, &frame).unwrap();
    assert_eq!(frames::<2>(own.path().unwrap(), 2), Some(vec![frame]));
    std::fs::write(own.path().unwrap().join(frame_file(0)), "{}").unwrap();
    assert_eq!(frames::<2>(own.path().unwrap(), 2), None);
}
