//! Boxes and rectangles that slide, topple and fall, events and errors in time, against closed forms of mechanics.

use super::{error, last_step, number, set, summary};
use serde_json::Value;
use signorini_geometry::Vector;

fn close(value: &Value, expected: f64, tolerance: f64) {
    assert!((number(value) - expected).abs() <= tolerance, "{value} for {expected}");
}

fn vector(value: &Value) -> Vector<3> {
    Vector::<3>::from_fn(|i, _| number(&value[i]))
}

/// A rotated box on a slope in space, and two rectangles on each other in the plane, slide `g (sin α - μ cos α) t²/2`.
#[test]
fn boxes_slide() {
    let angle = 0.5f64.atan();
    let exact = 0.5 * 9.81 * (angle.sin() - 0.49 * angle.cos()) * 2.5f64.powi(2);
    let case = r#"
space = "3d"
gravity = [0, 0, -9.81]
[constants]
A = "atan(0.5)"
[bodies.slope.rigid]
shape.plane = { point = [0, 0, 0], normal = ["sin(A)", 0, "cos(A)"] }
[bodies.block.rigid]
shape.box = { min = ["0.05*sin(A) - 0.2", -0.1, "0.05*cos(A) - 0.05"], max = ["0.05*sin(A) + 0.2", 0.1, "0.05*cos(A) + 0.05"], rotate = [0, "A", 0] }
motion.free = { density = 1000 }
[contacts.touch]
between = ["block", "slope"]
friction.coulomb = { mu = 0.49 }
[[steps]]
to = 2.5
increments = 7
dynamics = {}
"#;
    let found = summary(case, &set(&[]));
    let step = last_step(&found);
    let moved = vector(&step["free_bodies"]["block"]["displacement"]);
    assert!((moved - Vector::<3>::new(angle.cos(), 0.0, -angle.sin()) * exact).norm() < 1e-9, "{moved}");
    close(&step["motion"]["block"]["mass"], 8.0, 1e-12);
    let case = r#"
space = "plane_strain"
gravity = ["9.81*sin(atan(0.5))", "-9.81*cos(atan(0.5))"]
[bodies.slope.rigid]
shape.box = { min = [-9, -1], max = [9, 0] }
[bodies.low.rigid]
shape.box = { min = [-0.2, 0], max = [0.2, 0.1] }
motion.free = { density = 1000 }
[bodies.up.rigid]
shape.box = { min = [-0.1, 0.1], max = [0.1, 0.2] }
motion.free = { density = 500 }
[contacts.all]
all = true
friction.coulomb = { mu = 0.49 }
[[steps]]
to = 2.5
increments = 5
dynamics = {}
"#;
    let found = summary(case, &set(&[]));
    let step = last_step(&found);
    for body in ["low", "up"] {
        close(&step["free_bodies"][body]["displacement"][0], exact, 1e-9);
        close(&step["free_bodies"][body]["displacement"][1], 0.0, 1e-10);
    }
    close(&step["motion"]["low"]["mass"], 40.0, 1e-12);
    let upside_down = case.replace("max = [0.2, 0.1]", "max = [0.2, -0.1]");
    let found = error(&upside_down);
    assert!(found.message.contains("ends at y = -0.1 and begins at y = 0"), "{}", found.message);
    let found = error(&case.replace("plane_strain", "axisymmetric"));
    assert!(found.message.contains("not round about the axis"), "{}", found.message);
}

/// The uppermost of three boxes topples about an edge of the next one, which stays but for the error of the increments: its energy
/// is that of its fall.
#[test]
fn a_stack_topples() {
    let case = |offset: f64, to: f64, increments: usize| {
        format!(
            r#"
space = "3d"
gravity = [0, 0, -9.81]
[bodies.floor.rigid]
shape.plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
[bodies.low.rigid]
shape.box = {{ min = [0, 0, 0], max = [0.4, 0.2, 0.1] }}
motion.free = {{ density = 600 }}
[bodies.middle.rigid]
shape.box = {{ min = [0.1, 0, 0.1], max = [0.5, 0.2, 0.2] }}
motion.free = {{ density = 600 }}
[bodies.top.rigid]
shape.box = {{ min = ["0.3 + {offset}", 0, 0.2], max = ["0.7 + {offset}", 0.2, 0.3] }}
motion.free = {{ density = 600 }}
[contacts.all]
all = true
friction.coulomb = {{ mu = 0.5 }}
[[steps]]
to = {to}
increments = {increments}
dynamics = {{}}
"#
        )
    };
    let found = summary(&case(-0.01, 1e3, 1), &set(&[]));
    close(&last_step(&found)["kinetic_energy"], 0.0, 0.0);
    let offset = 0.05;
    let found = summary(&case(offset, 0.1, 20), &set(&[]));
    let step = last_step(&found);
    let turned = number(&step["free_bodies"]["top"]["rotation"][1]);
    let fall = 0.05 * (1.0 - turned.cos()) + offset * turned.sin();
    assert!(turned > 0.1, "{turned}");
    close(&step["kinetic_energy"], 4.8 * 9.81 * fall, 1e-4);
    for body in ["low", "middle"] {
        assert!(vector(&step["free_bodies"][body]["displacement"]).norm() < 1e-6);
    }
}

/// A house of cards without one of them begins to fall at once.
#[test]
fn a_house_with_one_card_less_falls() {
    let text = include_str!("../../../../gallery/cards/case.toml");
    let (before, rest) = text.split_once("[bodies.right_2.rigid]").unwrap();
    let (_, after) = rest.split_once("[bodies.flat.rigid]").unwrap();
    let case = format!("{before}[bodies.flat.rigid]{after}").replace("\"1000 s\"", "0.01").replace("= 2\n", "= 1\n");
    let found = summary(&case, &set(&[]));
    let step = last_step(&found);
    assert!(number(&step["kinetic_energy"]) > 1e-8, "{}", step["kinetic_energy"]);
    // The card that has lost its partner takes the one above along.
    let moved = vector(&step["free_bodies"]["flat"]["displacement"]);
    assert!(moved[0] > 1e-6, "{moved}");
}

/// Without moments the axis of a symmetric body goes round the angular momentum `L` with `L/I`: the error keeps to the tolerance,
/// and falls with it.
#[test]
fn rigid_bodies_keep_to_a_tolerance() {
    let [about, across] =
        [0.4f64.powi(2) * 2.0, 0.4f64.powi(2) + 0.8f64.powi(2)].map(|squares| 1000.0 * 0.128 * squares / 12.0);
    let [spin, beside, duration] = [7.0, 3.0, 2.0];
    let momentum = Vector::<3>::new(across * beside, 0.0, about * spin);
    let round = nalgebra::Rotation3::new(momentum / across * duration);
    let exact = round * Vector::<3>::z();
    let case = |tolerance: f64| {
        format!(
            r#"
space = "3d"
[bodies.top.rigid]
shape.box = {{ min = [-0.2, -0.2, -0.4], max = [0.2, 0.2, 0.4] }}
motion.free = {{ density = 1000, angular_velocity = [{beside}, 0, {spin}] }}
[[steps]]
to = {duration}
increments = 3
dynamics = {{ tolerance = {tolerance:e} }}
"#
        )
    };
    let energy = (across * beside * beside + about * spin * spin).sqrt();
    let errors = [1e-3, 1e-4, 1e-5].map(|tolerance| {
        let found = summary(&case(tolerance), &set(&[]));
        let turned = nalgebra::Rotation3::new(vector(&last_step(&found)["free_bodies"]["top"]["rotation"]));
        let error = (turned * Vector::<3>::z() - exact).norm() * across.sqrt();
        assert!(error < tolerance * energy * duration, "{tolerance}: {error}");
        error
    });
    // Parts as long as the root of the tolerance.
    assert!(errors[0] / errors[2] > 50.0, "{errors:?}");
}

/// A ball strikes the floor after the times of its flights: each touch and each rebound is an event.
#[test]
fn impacts_are_events() {
    let case = r#"
space = "3d"
gravity = [0, 0, -9.81]
[bodies.floor.rigid]
shape.plane = { point = [0, 0, 0], normal = [0, 0, 1] }
[bodies.ball.rigid]
shape.sphere = { center = [0, 0, 1.1], radius = 0.1 }
motion.free = { density = 7800 }
[contacts.touch]
between = ["ball", "floor"]
restitution = 0.5
[[steps]]
to = 1
increments = 4
events = 1e-6
dynamics = {}
"#;
    let found = summary(case, &set(&[]));
    last_step(&found);
    let fall = (2.0f64 / 9.81).sqrt();
    let expected = [("touch", fall), ("lift_off", fall), ("touch", 2.0 * fall), ("lift_off", 2.0 * fall)];
    let events = found["contact_events"].as_array().unwrap();
    assert_eq!(events.len(), expected.len(), "{events:?}");
    for (event, (kind, time)) in events.iter().zip(expected) {
        assert_eq!(event["kind"], kind);
        close(&event["time"], time, 2e-6);
        assert!(number(&event["within"]) <= 1e-6);
    }
}

/// A block between two plates, pressed with twenty times the force that holds it, does not sink.
#[test]
fn a_pinched_block_stays() {
    let case = r#"
space = "3d"
gravity = [0, 0, -9.81]
[bodies.wall.rigid]
shape.box = { min = [-0.4, -0.5, -0.5], max = [-0.2, 0.5, 0.5] }
[bodies.block.rigid]
shape.box = { min = [-0.2, -0.1, -0.05], max = [0.2, 0.1, 0.05] }
motion.free = { density = 1000 }
[bodies.plate.rigid]
shape.box = { min = [0.2, -0.5, -0.5], max = [0.4, 0.5, 0.5] }
motion.free = { density = 50 }
[supports.guide]
on = "plate"
displacement = ["free", 0, 0]
[loads.press]
on = "plate"
force = ["-20*8*9.81", 0, 0]
[contacts.left]
between = ["block", "wall"]
friction.coulomb = { mu = 0.5 }
[contacts.right]
between = ["block", "plate"]
friction.coulomb = { mu = 0.5 }
[[steps]]
to = 1e4
increments = 3
dynamics = {}
"#;
    let found = summary(case, &set(&[]));
    let step = last_step(&found);
    assert!(vector(&step["free_bodies"]["block"]["displacement"]).norm() < 1e-12);
    close(&step["kinetic_energy"], 0.0, 0.0);
    close(&step["contacts"]["left"]["force"][0], 20.0 * 8.0 * 9.81, 1e-7);
}

/// A spun top rises on its way to standing on its head: `L·r` does not change (Jellett 1872), with an error of second order.
#[test]
fn a_tippe_top_keeps_the_integral_of_jellett() {
    let text = include_str!("../../../../gallery/tippe_top/case.toml");
    let error = |increments: usize| {
        let pairs = [("steps.0.to", "0.8".to_string()), ("steps.0.increments", increments.to_string())];
        let found = summary(text, &set(&pairs));
        let step = last_step(&found);
        let (radius, mass) = (20.0, 2e-5);
        let (offset, about) = (0.3 * radius, 0.4 * mass * radius * radius);
        let moved = vector(&step["free_bodies"]["top"]["displacement"]);
        assert!(moved[2] > 7.0, "{moved}");
        let x = moved + Vector::<3>::z() * (radius - offset);
        let own = vector(&step["motion"]["top"]["angular_momentum"])
            - x.cross(&(vector(&step["motion"]["top"]["velocity"]) * mass));
        let axis = nalgebra::Rotation3::new(vector(&step["free_bodies"]["top"]["rotation"])) * Vector::<3>::z();
        let way = axis * offset - Vector::<3>::z() * radius;
        (own.dot(&way) / (155.0 * about * (offset - radius)) - 1.0).abs()
    };
    let [coarse, fine] = [80, 160].map(error);
    assert!(fine < 0.03, "{fine}");
    assert!(coarse / fine > 3.5, "{coarse} {fine}");
}
