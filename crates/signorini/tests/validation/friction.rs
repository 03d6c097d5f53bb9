//! Friction of solids, from the case file to the summary.

use super::{example, last_step, number, set, summary};

/// Two alike bodies pressed together and shifted to and fro, beside a reference on a finer mesh that was computed by another
/// program with functions of two degrees: the force across follows the loop, and its area is what friction takes.
#[test]
fn alike_bodies_that_are_shifted_follow_the_loop_of_cattaneo_and_mindlin() {
    let found = summary(example("cattaneo_mindlin"), &set(&[]));
    assert_eq!(found["converged"], true, "{}", found["verdict"]);
    // Time, force across, friction by the reference, of the way to and fro.
    let rows = [
        (1.0, 0.0307467, 0.0),
        (4.0, 0.0307460, 0.0092339),
        (5.0, 0.0307459, 0.0044303),
        (7.0, 0.0307459, -0.0048363),
        (8.0, 0.0307459, -0.0092349),
        (10.0, 0.0307458, -0.0028525),
        (12.0, 0.0307459, 0.0048353),
        (13.0, 0.0307459, 0.0092349),
    ];
    let steps = found["steps"].as_array().expect("steps");
    for (time, normal, across) in rows {
        let step = steps.iter().find(|s| (number(&s["time"]) - time).abs() < 1e-9).expect("a step");
        let contact = &step["contacts"]["touch"];
        let [x, y] = [0, 1].map(|k| number(&contact["force"][k]));
        assert!((y / normal - 1.0).abs() < 5e-4, "t = {time}: {y} across, not {normal}");
        assert!((x + across).abs() < 5e-3 * 0.0092349, "t = {time}: {x} along, not {}", -across);
        // Of the width in contact the part that sticks, to the distance of two nodes on each side.
        if time == 4.0 || time == 8.0 || time == 13.0 {
            let stick = number(&contact["stick_area"]) / number(&contact["area"]);
            let exact = (1.0 - across.abs() / (0.4 * normal)).sqrt();
            assert!((stick - exact).abs() < 0.09, "t = {time}: {stick} sticks, not {exact}");
        }
    }
}

/// A block on an incline with a grain holds up to the angle of the closed form, and the run says that it slides beyond it, and
/// where to: deflected towards the smoother direction.
#[test]
fn a_block_on_an_incline_holds_up_to_the_angle_of_orthotropic_friction() {
    let (heading, mu) = (0.6f64, [0.3, 0.5]);
    let critical = 1.0 / (heading.cos() / mu[0]).hypot(heading.sin() / mu[1]);
    let tilted = |share: f64| {
        let tilt = ("functions.tilt.expression", format!("{}*t", (share * critical).atan()));
        let coarse = ("bodies.block.solid.mesh.box.cells", "[4, 3, 2]".to_string());
        summary(example("incline"), &set(&[tilt, coarse]))
    };
    let held = tilted(0.995);
    let contact = &last_step(&held)["contacts"]["foot"];
    let force: Vec<f64> = (0..3).map(|k| number(&contact["force"][k])).collect();
    let used = (force[0] / (mu[0] * force[2])).hypot(force[1] / (mu[1] * force[2]));
    assert!((used - 0.995).abs() < 1e-6, "{used}");
    let slides = tilted(1.005);
    let verdict = slides["verdict"].as_str().expect("a verdict");
    assert!(slides["reason"] == "free_body" && verdict.contains("`block` slides away"), "{verdict}");
    assert_eq!(slides["steps"].as_array().expect("steps").len(), 4, "the state before is kept");
}
