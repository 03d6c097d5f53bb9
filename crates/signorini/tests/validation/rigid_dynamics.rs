//! Rigid bodies that move with inertia, stated as cases, against closed forms of mechanics.

use super::{error, last_step, number, set, summary};
use serde_json::Value;

fn close(value: &Value, expected: f64, tolerance: f64) {
    assert!((number(value) - expected).abs() <= tolerance, "{value} for {expected}");
}

/// A block as triangles, with its corners.
fn block([low, high]: [[f64; 3]; 2]) -> String {
    let corner = |k: usize| -> String {
        let x: Vec<String> = (0..3).map(|i| format!("{:?}", if k >> i & 1 == 1 { high[i] } else { low[i] })).collect();
        format!("[{}]", x.join(", "))
    };
    let corners: Vec<String> = (0..8).map(corner).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces = faces.map(|f| format!("[{}, {}, {}], [{}, {}, {}]", f[0], f[1], f[2], f[0], f[2], f[3]));
    format!("shape.triangles = {{ points = [{}], triangles = [{}] }}", corners.join(", "), faces.join(", "))
}

/// A block on a slope of slope one half.
fn on_slope(mu: &str, to: f64, increments: usize) -> Value {
    let case = format!(
        r#"
space = "3d"
gravity = ["9.81*sin(atan(0.5))", 0, "-9.81*cos(atan(0.5))"]
[bodies.slope.rigid]
shape.plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
[bodies.block.rigid]
{}
motion.free = {{ density = 1000 }}
[contacts.touch]
between = ["block", "slope"]
friction.coulomb = {{ mu = "{mu}" }}
[[steps]]
to = {to}
increments = {increments}
dynamics = {{}}
"#,
        block([[-0.2, -0.1, 0.0], [0.2, 0.1, 0.1]])
    );
    summary(&case, &set(&[]))
}

/// Friction that is just enough holds for ever, a little less does not, and what slides is where mechanics says.
#[test]
fn a_block_on_a_slope() {
    let moved = |found: &Value| number(&last_step(found)["free_bodies"]["block"]["displacement"][0]);
    assert!(moved(&on_slope("0.5", 1e4, 50)).abs() < 1e-12);
    assert!(moved(&on_slope("0.500001", 1e4, 5)).abs() < 1e-12);
    let normal = 9.81 * 0.5f64.atan().cos();
    for (mu, excess, to) in [("0.499999", 1e-6, 10.0), ("0.49", 0.01, 2.5)] {
        let found = on_slope(mu, to, 7);
        let exact = 0.5 * normal * excess * to * to;
        assert!((moved(&found) / exact - 1.0).abs() < 1e-8, "{mu}: {} for {exact}", moved(&found));
        let step = last_step(&found);
        close(&step["contacts"]["touch"]["force"][2], normal * 8.0, 1e-9);
        close(&step["contacts"]["touch"]["max_penetration"], 0.0, 1e-11);
    }
}

/// A ball falls from 1 m and rebounds to `e²` of its height; in the end it rests.
#[test]
fn a_ball_rebounds_to_the_square_of_its_coefficient() {
    let case = |to: f64, increments: usize| {
        format!(
            r#"
space = "3d"
units = "m-N-Pa"
gravity = [0, 0, "-9.81 m/s^2"]
[bodies.floor.rigid]
shape.plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
[bodies.ball.rigid]
shape.sphere = {{ center = [0, 0, "1.1 m"], radius = "10 cm" }}
motion.free = {{ density = "7800 kg/m^3" }}
[contacts.touch]
between = ["ball", "floor"]
restitution = 0.5
[[steps]]
to = {to:?}
increments = {increments}
dynamics = {{}}
"#
        )
    };
    // Heights of the first and second rebound.
    let fall = (2.0f64 / 9.81).sqrt();
    for (top, height) in [(1.5, 0.25), (2.25, 0.0625)] {
        let found = summary(&case(top * fall, 7), &set(&[]));
        close(&last_step(&found)["free_bodies"]["ball"]["displacement"][2], height - 1.0, 1e-9);
        close(&last_step(&found)["motion"]["ball"]["velocity"][2], 0.0, 1e-8);
    }
    let found = summary(&case(2.0, 10), &set(&[]));
    let step = last_step(&found);
    close(&step["free_bodies"]["ball"]["displacement"][2], -1.0, 1e-9);
    close(&step["kinetic_energy"], 0.0, 0.0);
    let weight = 9.81 * 7800.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-3;
    close(&step["contacts"]["touch"]["force"][2], weight, 1e-9 * weight);
}

/// A ball that slides comes to roll with 5/7 of its velocity, a disc that spins with 1/3 of that of its rim, whatever the
/// increments.
#[test]
fn what_slides_comes_to_roll() {
    let case = |space: &str, shape: &str, motion: &str, [gravity, point, normal]: [&str; 3], increments: usize| {
        format!(
            r#"
space = "{space}"
gravity = {gravity}
[bodies.floor.rigid]
shape.plane = {{ point = {point}, normal = {normal} }}
[bodies.wheel.rigid]
shape.sphere = {shape}
motion.free = {{ density = 100, {motion} }}
[contacts.touch]
between = ["wheel", "floor"]
friction.coulomb = {{ mu = 0.2 }}
[[steps]]
to = 2
increments = {increments}
dynamics = {{}}
"#
        )
    };
    for increments in [3, 16] {
        let (shape, motion) = ("{ center = [0, 0, 0.1], radius = 0.1 }", "velocity = [3.5, 0, 0]");
        let place = ["[0, 0, -10]", "[0, 0, 0]", "[0, 0, 1]"];
        let found = summary(&case("3d", shape, motion, place, increments), &set(&[]));
        close(&last_step(&found)["motion"]["wheel"]["velocity"][0], 2.5, 1e-11);
        let (shape, motion) = ("{ center = [0, 0.5], radius = 0.5 }", "angular_velocity = 12");
        let place = ["[0, -10]", "[0, 0]", "[0, 1]"];
        let found = summary(&case("plane_strain", shape, motion, place, increments), &set(&[]));
        close(&last_step(&found)["motion"]["wheel"]["velocity"][0], -2.0, 1e-11);
    }
}

/// A belt takes a block with it: it slides until it has the velocity of the belt.
#[test]
fn a_belt_takes_a_block_along() {
    let case = format!(
        r#"
space = "3d"
gravity = [0, 0, -10]
[bodies.belt.rigid]
shape.plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
motion.prescribed = {{ displacement = ["2*t", 0, 0] }}
[bodies.block.rigid]
{}
motion.free = {{ density = 1000 }}
[contacts.touch]
between = ["block", "belt"]
friction.coulomb = {{ mu = 0.4 }}
[[steps]]
to = 1
increments = 8
dynamics = {{}}
"#,
        block([[-0.2, -0.1, 0.0], [0.2, 0.1, 0.1]])
    );
    let found = summary(&case, &set(&[]));
    let step = last_step(&found);
    close(&step["motion"]["block"]["velocity"][0], 2.0, 1e-10);
    // After 0.5 s without slip.
    close(&step["free_bodies"]["block"]["displacement"][0], 1.5, 1e-9);
}

/// Blocks as meshes: a bar that falls flat across another one rebounds to where it came from, though neither has a corner over
/// the other; a wide block does so on a narrow one, whichever is named first; a block on one of its size, corner on corner, rests.
#[test]
fn blocks_meet_by_facets_edges_and_corners() {
    let case = |upper: [[f64; 3]; 2], lower: [[f64; 3]; 2], between: &str, to: f64, restitution: f64| {
        format!(
            r#"
space = "3d"
gravity = [0, 0, -10]
[bodies.upper.rigid]
{}
motion.free = {{ density = 1000 }}
[bodies.lower.rigid]
{}
[contacts.touch]
between = {between}
restitution = {restitution:?}
[[steps]]
to = {to:?}
increments = 4
dynamics = {{}}
"#,
            block(upper),
            block(lower)
        )
    };
    let bar = [[-1.0, -0.1, 0.2], [1.0, 0.1, 0.4]];
    let across = [[-0.1, -1.0, -0.2], [0.1, 1.0, 0.0]];
    let wide = [[-1.0, -1.0, 0.2], [1.0, 1.0, 0.6]];
    for (upper, lower) in [(bar, across), (wide, across)] {
        for between in ["[\"upper\", \"lower\"]", "[\"lower\", \"upper\"]"] {
            let found = summary(&case(upper, lower, between, 0.4, 1.0), &set(&[]));
            close(&last_step(&found)["free_bodies"]["upper"]["displacement"][2], 0.0, 1e-9);
            close(&last_step(&found)["kinetic_energy"], 0.0, 1e-9);
        }
    }
    let (cube, base) = ([[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]], [[0.0, 0.0, -1.0], [1.0, 1.0, 0.0]]);
    let found = summary(&case(cube, base, "[\"upper\", \"lower\"]", 100.0, 0.0), &set(&[]));
    close(&last_step(&found)["contacts"]["touch"]["force"][2], 1e4, 1e-6);
    close(&last_step(&found)["kinetic_energy"], 0.0, 0.0);
    // Bars that overlap without a corner of one in the other, and friction per area.
    let deep = [[-1.0, -0.1, -0.1], [1.0, 0.1, 0.1]];
    let both = "[\"upper\", \"lower\"]";
    let found = error(&case(deep, across, both, 1.0, 0.0));
    assert!(found.message.contains("deep inside `lower`"), "{}", found.message);
    let tresca = case(cube, base, both, 1.0, 0.0).replace("restitution = 0.0", "friction.tresca = { limit = 1 }");
    let found = error(&tresca);
    assert!(found.message.contains("does not grow with pressure"), "{}", found.message);
}

/// What cannot move is told at its place, with what would be valid.
#[test]
fn wrong_statements_are_refused() {
    let case = |motion: &str, contact: &str| {
        format!(
            r#"
space = "3d"
gravity = [0, 0, -10]
[bodies.floor.rigid]
shape.plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
[bodies.ball.rigid]
shape.sphere = {{ center = [0, 0, 0.1], radius = 0.1 }}
motion.free = {{ {motion} }}
[contacts.touch]
between = ["ball", "floor"]
{contact}
[[steps]]
to = 1
dynamics = {{}}
"#
        )
    };
    for (motion, contact, message, help) in [
        ("", "", "no mass", "density"),
        ("density = -1", "", "must be positive", ""),
        ("mass = 0", "", "must be positive", ""),
        ("mass = 1, density = 1", "", "a density and a mass", "leave one"),
        ("inertia = 1", "", "moments of inertia and no mass", "mass"),
        ("mass = 1, inertia = [1, 1, 3]", "", "no body has the moments", "sum"),
        ("mass = 1, center = [0, 0, 0.05]", "", "centre of mass, at", "inertia"),
        ("density = 1", "restitution = 1.5", "not between 0 and 1", "rebound"),
        ("density = 1", "wear = 1e-3", "a law or a method that rigid bodies in motion do not have", "wear"),
    ] {
        let found = error(&case(motion, contact));
        assert!(found.message.contains(message), "{motion} {contact}: {}", found.message);
        assert!(found.help.clone().unwrap_or_default().contains(help), "{motion} {contact}: {:?}", found.help);
        assert!(found.place.is_some(), "{motion} {contact}");
    }
    let found = error(&case("density = 1", "").replace("center = [0, 0, 0.1]", "center = [0, 0, 0.09]"));
    assert!(found.message.contains("starts 1.0000e-2 deep inside `floor`"), "{}", found.message);
}
