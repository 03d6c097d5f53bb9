//! Ropes that come to rest far from where they are laid out.

use crate::{last_step, number, set, summary};
use std::f64::consts::PI;

/// A rope that hangs from one end, laid out along the vertical or across it: nothing holds it across itself before it hangs.
#[test]
fn a_rope_hangs_from_one_end() {
    for end in ["0, 0, -1", "1, 0, 0"] {
        let case = format!(
            r#"
space = "3d"
units = "m-N-Pa"
gravity = [0, 0, -9.81]
[bodies.rope.rope]
path.points = [[0, 0, 0], [{end}]]
cells = 20
stiffness = 1e5
mass_per_length = 0.1
[supports.top]
on = "rope:start"
displacement = [0, 0, 0]
"#
        );
        let found = summary(&case, &set(&[]));
        assert_eq!(found["converged"], true, "{}", found["verdict"]);
        // What the support carries, not the mean of the first cell.
        let rope = &last_step(&found)["curves"]["rope"];
        assert!((number(&rope["start_tension"]) / 0.981 - 1.0).abs() < 1e-8, "{rope}");
    }
}

/// A rope beside a drum, held at one end and pulled at the other by a dead force: it comes to lie on the drum, whatever the play
/// and the cells, though it hardly stretches. Without friction the force is the same all along.
#[test]
fn a_rope_comes_to_lie_on_a_drum() {
    let (radius, pull) = (20.0, 10.0);
    for (play, cells, mu) in [(0.3, 60, 0.0), (1.0, 60, 0.0), (5.0, 100, 0.0), (1.0, 60, 0.1)] {
        let at = |k: usize| (radius + play) * (PI - k as f64 * PI / 24.0).cos();
        let above = |k: usize| (radius + play) * (PI - k as f64 * PI / 24.0).sin();
        let arc: Vec<String> = (0..=24).map(|k| format!("[{}, 0, {}]", at(k), above(k))).collect();
        let (arc, side) = (arc.join(", "), radius + play);
        let case = format!(
            r#"
units = "mm-N-MPa"
space = "3d"
[bodies.rope.rope]
path.points = [[-{side}, 0, -60], {arc}, [{side}, 0, -60]]
cells = {cells}
stiffness = 1e5
pretension = 10
[bodies.drum.rigid]
shape.cylinder = {{ point = [0, 0, 0], axis = [0, 1, 0], radius = {radius} }}
[supports.held]
on = "rope:start"
displacement = [0, 0, 0]
[supports.plane]
on = "rope"
displacement = ["free", 0, "free"]
[loads.pull]
on = "rope:end"
force = [0, 0, -{pull}]
[contacts.wrap]
between = ["rope", "drum"]
friction.coulomb = {{ mu = {mu} }}
"#
        );
        let found = summary(&case, &set(&[]));
        assert_eq!(found["converged"], true, "{play} {cells} {mu}: {}", found["verdict"]);
        let step = last_step(&found);
        let held = number(&step["curves"]["rope"]["start_tension"]);
        // The held leg leans towards the drum, which it touches that much later.
        let lean = (side / 60.0).atan() - (radius / side.hypot(60.0)).asin();
        // The rope slips towards its free end.
        let ratio = (-mu * (PI - lean)).exp();
        // Where the rope leaves the drum the chords beside a node are not alike: an angle of 0.15 squared.
        assert!((held / pull / ratio - 1.0).abs() < if mu == 0.0 { 5e-3 } else { 2e-2 }, "{play} {cells}: {held}");
        let force = number(&step["contacts"]["wrap"]["force"][2]);
        assert!((force / pull / (1.0 + ratio * lean.cos()) - 1.0).abs() < 1e-2, "{play} {cells}: {force}");
    }
}

/// Half a turn of a thick rope on a drum with friction, held at one end and pulled at the other: force and moment of support, load
/// and contact add up to nothing. Friction acts on the surface of the drum, tension along the centre line, which is longer: of
/// the friction `R/(R + r)` acts on it, so that the tension grows by `exp(μ φ R/(R + r))`.
#[test]
fn the_forces_on_a_thick_rope_balance() {
    for radius in [0.05, 0.5] {
        let case = format!(
            r#"
space = "3d"
[bodies.drum.rigid]
shape.cylinder = {{ point = [0, 0, 0], axis = [0, 0, 1], radius = 1 }}
[bodies.line.rope]
path.helix = {{ radius = {}, pitch = 0, turns = 0.5, towards = [1, 0, 0] }}
radius = {radius}
cells = 60
stiffness = 1e4
pretension = 1
[supports.hold]
on = "line:start"
displacement = [0, 0, 0]
[loads.pull]
on = "line:end"
tension = "1 + t"
[contacts.c]
between = ["line", "drum"]
friction.coulomb = {{ mu = 0.3 }}
[[steps]]
to = 1
increments = 4
"#,
            1.0 + radius
        );
        let found = summary(&case, &set(&[]));
        let step = last_step(&found);
        let contact = &step["contacts"]["c"];
        let sum = |parts: [&serde_json::Value; 3], k: usize| parts.map(|v| number(&v[k])).iter().sum::<f64>();
        for k in 0..3 {
            let force = [&step["support_forces"]["hold"], &step["load_forces"]["pull"], &contact["force"]];
            let moment = [&step["support_moments"]["hold"], &step["load_moments"]["pull"], &contact["moment"]];
            let off = [sum(force, k), sum(moment, k)];
            assert!(off.iter().all(|o| o.abs() < 1e-8), "{radius}: {off:?}");
        }
        // Where it all slips, from the free end on.
        let held = number(&step["curves"]["line"]["start_tension"]);
        let ratio = (0.3 * PI / (1.0 + radius)).exp();
        assert!(2.0 / held < ratio * 1.01, "{radius}: {held}");
    }
}
