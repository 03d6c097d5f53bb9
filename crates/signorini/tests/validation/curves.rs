//! Ropes and beams: what a user may get wrong, and ends, slack and friction beside closed forms.

use super::{error, last_step, number, set, summary};

fn rope_on_a_drum(more: &str) -> String {
    format!(
        r#"
units = "mm-N-MPa"
space = "3d"
[bodies.drum.rigid]
shape.cylinder = {{ point = [0, 0, 0], axis = [0, 0, 1], radius = 100 }}
[bodies.line.rope]
path.helix = {{ radius = 105, pitch = 25, turns = 0.5 }}
radius = 5
cells = 20
stiffness = "400 kN"
pretension = 100
[supports.hold]
on = "line:start"
displacement = [0, 0, 0]
{more}
[[steps]]
to = 1
increments = 2
"#
    )
}

const GRIP: &str =
    "[contacts.grip]\nbetween = [\"line\", \"drum\"]\nfriction.coulomb = { mu = 0.3, axis = \"tangent\" }\n";

#[test]
fn loads_on_ends_are_those_of_their_place_and_never_push() {
    // The end is at x = -105.
    let pull =
        |tension: &str| rope_on_a_drum(&format!("[loads.pull]\non = \"line:end\"\ntension = \"{tension}\"\n{GRIP}"));
    let found = summary(&pull("205 + x"), &set(&[]));
    assert!((number(&last_step(&found)["curves"]["line"]["end_tension"]) - 100.0).abs() < 1e-6);
    let told = error(&pull("100 - 150*t"));
    assert!(told.message.contains("loads.pull.tension") && told.message.contains("at t = 1"), "{}", told.message);
    let whole = "[loads.all]\non = \"line\"\nforce = [0, 0, \"x\"]\n";
    let told = error(&rope_on_a_drum(&format!("{whole}{GRIP}")));
    assert!(told.message.contains("`x` in a resultant"), "{}", told.message);
}

#[test]
fn a_curve_touches_itself_within() {
    let told = error(&rope_on_a_drum("[contacts.grip]\nbetween = [\"line\", \"line\"]\n"));
    assert!(told.message.contains("twice") && told.help.unwrap_or_default().contains("self_contact = \"line\""));
}

#[test]
fn a_curve_that_starts_deep_inside_is_told() {
    let case = rope_on_a_drum(GRIP).replace("radius = 5\n", "radius = 50\n");
    let problem = signorini::case::read("case.toml", &case, &[]).expect("a case");
    let plan = signorini::plan::plan(&problem).expect("a plan");
    let sizes = signorini::run::sizes(&plan).expect("sizes");
    assert!(sizes["warnings"].to_string().contains("starts 4.5000e1 deep inside `drum`"), "{}", sizes["warnings"]);
}

/// Of a beam held at both ends, one of which turns freely about two axes alone, the middle sags by `5qL⁴/384EI`.
#[test]
fn a_hinge_of_a_beam_holds_about_one_axis() {
    let case = r#"
space = "3d"
[bodies.b.beam]
path.points = [[0, 0, 0], [1, 0, 0]]
cells = 10
section.stiffness = { EA = 1e4, GA = 1e6, EI = 1, GJ = 1 }
[supports.a]
on = "b:start"
displacement = [0, 0, 0]
rotation = [0, "free", "free"]
[supports.e]
on = "b:end"
displacement = ["free", 0, 0]
[loads.w]
on = "b"
body_force = [0, 0, -0.1]
[output]
probes.m = [0.5, 0, 0]
[[steps]]
to = 1
"#;
    let found = summary(case, &set(&[]));
    let sag = number(&last_step(&found)["probes"]["m"]["displacement"][2]);
    assert!((sag / (-5.0 * 0.1 / 384.0) - 1.0).abs() < 1e-3, "{sag}");
    assert_eq!(last_step(&found)["curves"]["b"]["slack_cells"], 0);
}

/// A beam is pushed head on against a wall: its very end touches, and its force is that of a bar shortened by the whole push.
#[test]
fn the_end_of_a_beam_stays_out_of_the_wall() {
    let case = r#"
space = "3d"
[bodies.wall.rigid]
shape.plane = { point = [1, 0, 0], normal = [-1, 0, 0] }
[bodies.bar.beam]
path.points = [[0, 0, 0], [1, 0, 0]]
cells = 4
section.stiffness = { EA = 100, GA = 100, EI = 10, GJ = 10 }
[supports.push]
on = "bar:start"
displacement = ["0.01*t", 0, 0]
rotation = [0, 0, 0]
[contacts.head]
between = ["bar", "wall"]
[[steps]]
to = 1
"#;
    let step = summary(case, &set(&[]));
    let wall = number(&last_step(&step)["contacts"]["head"]["force"][0]);
    assert!((wall + 1.0).abs() < 0.02, "{wall}");
}

/// A rope that was drawn over a drum is let down: only the last `ln(T₁/T₂)/2μ` of it slips back.
#[test]
fn what_does_not_slip_back_does_not_count_as_slipping() {
    let case = r#"
space = "3d"
[bodies.rope.rope]
path.formula = { position = ["if(u < 0, 1, if(u > pi, -1, cos(u)))", "if(u < 0, u, if(u > pi, pi - u, sin(u)))", "0"], from = -0.05, to = "pi + 0.05" }
cells = 65
stiffness = 100
pretension = 1
[bodies.drum.rigid]
shape.cylinder = { point = [0, 0, 0], axis = [0, 0, 1], radius = 1 }
[supports.anchor]
on = "rope:start"
displacement = [0, 0, 0]
[loads.pull]
on = "rope:end"
force = [0, "-(1 + 0.8*min(t, 1) - 0.9*max(0, t - 1))", 0]
[contacts.touch]
between = ["rope", "drum"]
method.node = {}
friction.coulomb = { mu = 0.3 }
[[steps]]
to = 1
increments = 4
[[steps]]
to = 2
increments = 4
"#;
    let found = summary(case, &set(&[]));
    let slips = number(&last_step(&found)["contacts"]["touch"]["slip_area"]);
    assert!((slips - 2f64.ln() / 0.6).abs() < 0.06, "{slips}");
}

/// A catenary of span 7, rise 2, length 11 and weight 2 per length that hardly stretches: `a = 2.1209` gives the tensions.
#[test]
fn a_catenary_may_be_as_stiff_as_steel() {
    for stiffness in ["1e3", "1e5", "1e7"] {
        let case = format!(
            r#"
space = "3d"
[bodies.rope.rope]
path.points = [[0, 0, 0], [7, 0, 2]]
cells = 40
stiffness = {stiffness}
unstrained_length = 11
[supports.ends]
on = "rope:boundary"
displacement = [0, 0, 0]
[loads.weight]
on = "rope"
body_force = [0, 0, -2]
"#
        );
        let found = summary(&case, &set(&[]));
        let rope = &last_step(&found)["curves"]["rope"];
        // Of the first and last cell: half a cell from the ends.
        let (start, end) = (number(&rope["start_tension"]), number(&rope["end_tension"]));
        assert!((start / 9.7 - 1.0).abs() < 0.03 && (end / 13.7 - 1.0).abs() < 0.03, "{stiffness}: {start} {end}");
    }
}

/// Where no equilibrium exists that is said before long.
#[test]
fn a_rope_that_nothing_holds_is_given_up() {
    let case = r#"
space = "3d"
[bodies.rope.rope]
path.formula = { position = ["1.969615506024416*cos(u)", "1.969615506024416*sin(u)", "0.34729635533386083"], from = 0, to = "pi" }
cells = 15
stiffness = 1e5
pretension = 1
[bodies.ball.rigid]
shape.sphere = { center = [0, 0, 0], radius = 2 }
[loads.first]
on = "rope:start"
force = [0, -1, 0]
[loads.last]
on = "rope:end"
force = [0, "-(1 + 1.4*t)", 0]
[contacts.touch]
between = ["rope", "ball"]
method.node = {}
friction.coulomb = { mu = [0.25, 0.6], axis = "tangent" }
[[steps]]
to = 1
increments = 2
"#;
    let found = summary(case, &set(&[]));
    assert_eq!(found["converged"], false);
    let last = found["steps"].as_array().and_then(|s| s.last()).expect("a step");
    assert!(number(&last["iterations"]) <= 1000.0, "{}", last["iterations"]);
}
