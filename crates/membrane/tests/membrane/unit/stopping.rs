//! Of `rest`.

use signorini_membrane::front::StepKind;
use signorini_membrane::testing::{Decision, IterationHistory, Observation, StoppingRule};

/// Blunt fronts that move by a hundredth of a cell.
fn seen(residual: f64) -> Observation<'static> {
    Observation {
        residual,
        step: 0.01,
        kind: StepKind::Local,
        bend: 0.1,
        tips: false,
        divided: true,
        shifted: false,
        adhering: false,
        kinks: false,
        last: false,
        unseen: &|_| false,
        farthest: &|| 1.0,
    }
}

#[test]
fn tips_rest_once_the_area_does() {
    let verdict = |areas: [f64; 2], [tips, divided, kinks]: [bool; 3]| {
        let mut course = IterationHistory::default();
        areas.iter().zip([1e5, 1e3]).for_each(|(a, r)| course.take(r, *a, StepKind::Local, false));
        let sight = Observation { bend: 1.5, tips, divided, kinks, ..seen(1e3) };
        StoppingRule::Final.judge(&course, &sight)
    };
    assert_eq!(verdict([1.0, 1.0 + 5e-7], [true, true, false]), Decision::Settled);
    assert_eq!(verdict([1.0, 1.0 + 5e-6], [true, true, false]), Decision::Moving);
    for other in [[false, true, false], [true, false, false], [true, true, true]] {
        assert_eq!(verdict([1.0, 1.0 + 5e-7], other), Decision::Moving);
    }
}

#[test]
fn a_jump_of_the_slope_is_put_up_with_where_there_are_such_jumps() {
    let verdict = |residuals: &[f64], kinks: bool| {
        let mut course = IterationHistory::default();
        residuals.iter().for_each(|r| course.take(*r, 1.0, StepKind::Local, false));
        let sight = Observation { kinks, ..seen(*residuals.last().expect("a residual")) };
        StoppingRule::Final.judge(&course, &sight)
    };
    assert_eq!(verdict(&[90.0, 4.0, 4.5], true), Decision::AtRest);
    // While steps gain, where there are no such jumps, and where too much is lacking, they go on.
    assert_eq!(verdict(&[90.0, 4.0], true), Decision::Moving);
    assert_eq!(verdict(&[90.0, 4.0, 4.5], false), Decision::Moving);
    assert_eq!(verdict(&[90.0, 40.0, 45.0], true), Decision::Moving);
}
