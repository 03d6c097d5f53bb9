//! Of `history::seek`.

use signorini_membrane::testing::{AreaController, Control, PlannedIncrement};

fn planned(control: Control) -> PlannedIncrement {
    PlannedIncrement { step: 0, range: [0.0, 1.0], time: 1.0, control, events: None }
}

/// The time at which an area is `to`, from a time at which it is known, and the looks that it took.
fn sought(from: f64, to: f64, of: impl Fn(f64) -> f64) -> (Result<f64, String>, usize) {
    let planned = planned(Control::Area { to, part: 1, parts: 1 });
    let mut looks = 0;
    let mut area = |t: f64| {
        looks += 1;
        Some(of(t))
    };
    let time = AreaController::begin(&planned, of(from), 1.0).advance(&planned, [from, of(from)], &mut area);
    (time, looks)
}

#[test]
fn an_area_is_found_on_either_side() {
    let touching = |t: f64| (t - 0.3).max(0.0).sqrt();
    for (from, to) in [(0.0, 0.5), (0.4, 0.5), (0.9, 0.5), (0.4, 1.5), (2.0, 0.01)] {
        let (time, looks) = sought(from, to, touching);
        let time = time.expect("a time");
        assert!((touching(time) - to).abs() < 1e-9 && looks <= 24, "{time} after {looks} looks");
    }
}

#[test]
fn areas_that_are_not_there_are_told() {
    let jump = |t: f64| if t < 0.7 { 0.1 * t } else { 0.5 + 0.1 * t };
    let why = sought(0.1, 0.3, jump).0.expect_err("a jump");
    assert!(why.contains("the area jumps from 0.0699") && why.contains("to 0.57000"), "{why}");
    let why = sought(0.1, 0.9, |t| (4.0 * t).sin().powi(2) * 0.5).0.expect_err("a turn");
    assert!(why.contains("was found"), "{why}");
    let why = sought(0.5, 0.1, |t| 0.3 + t).0.expect_err("before the beginning");
    assert!(why.contains("it is 0.3 at t = 0"), "{why}");
}

#[test]
fn a_length_has_a_part_in_area_and_one_in_time() {
    let planned = planned(Control::ArcLength(0.1));
    let mut seeker = AreaController::begin(&planned, 0.0, 1.0);
    let (mut at, mut times) = ([0.0, 0.0], Vec::new());
    while !seeker.done {
        let time = seeker.advance(&planned, at, &mut |t| Some(2.0 * t)).expect("a time");
        at = [time, 2.0 * time];
        times.push(time);
    }
    assert_eq!((times.len(), times[times.len() - 1]), (23, 1.0));
    assert!((times[21] - 2.2 / f64::sqrt(5.0)).abs() < 1e-4, "{times:?}");
}
