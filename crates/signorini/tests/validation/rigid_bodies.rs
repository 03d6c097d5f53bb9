//! Free rigid bodies by themselves and between elastic ones, stated as cases, against statics.

use super::{last_step, number, set, summary};
use serde_json::Value;

fn close(value: &Value, expected: f64, tolerance: f64) {
    assert!((number(value) - expected).abs() <= tolerance, "{value} for {expected}");
}

/// A disc that sticks to a floor turns as far as it rolls, whatever the increment.
#[test]
fn a_disc_rolls_without_slip() {
    // A cylinder is a disc in the plane.
    for (distance, shape) in
        [(0.9, "sphere = { center = [0, 1], radius = 1 }"), (5.0, "cylinder = { point = [0, 1], radius = 1 }")]
    {
        let case = format!(
            r#"
space = "plane_strain"
[bodies.floor.rigid]
shape.plane = {{ point = [0, 0], normal = [0, 1] }}
[bodies.disc.rigid]
shape.{shape}
motion.free = {{}}
[loads.weight]
on = "disc"
force = [0, -1]
[supports.hand]
on = "disc"
displacement = ["{distance}*t", "free"]
[contacts.foot]
between = ["disc", "floor"]
friction.coulomb = {{ mu = 0.5 }}
[[steps]]
to = 1
"#
        );
        let found = summary(&case, &set(&[]));
        let step = last_step(&found);
        close(&step["free_bodies"]["disc"]["rotation"][2], -distance, 1e-9);
        close(&step["contacts"]["foot"]["force"][1], 1.0, 1e-9);
        close(&step["contacts"]["foot"]["max_slip"], 0.0, 1e-9);
        assert_eq!(found["answer"]["verdict"], "right_within", "{}", found["answer"]["text"]);
    }
}

/// A ladder as a prism of little thickness: it leans in any unit, and other forces would hold it as well.
#[test]
fn a_ladder_leans_in_any_unit() {
    for (length, weight) in [(1.0, 1.0), (1e4, 1e6), (1e-3, 1e3)] {
        let (s, c) = 49.4f64.to_radians().sin_cos();
        let at = |x: f64, y: f64, z: f64| format!("[{:?}, {:?}, {:?}]", x * length, y * length, z * length);
        let (foot, head, across) = ([0.0, 0.0], [4.0 * c, 4.0 * s], [-0.01 * s, 0.01 * c]);
        let points: Vec<String> = [foot, head]
            .iter()
            .flat_map(|p| {
                let other = [p[0] + across[0], p[1] + across[1]];
                [-0.2, 0.2].map(|y| [at(p[0], y, p[1]), at(other[0], y, other[1])]).into_iter().flatten()
            })
            .collect();
        let case = format!(
            r#"
space = "3d"
[bodies.floor.rigid]
shape.plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
[bodies.wall.rigid]
shape.plane = {{ point = {}, normal = [-1, 0, 0] }}
[bodies.ladder.rigid]
shape.triangles = {{ points = [{}], triangles = [[0, 3, 2], [1, 3, 0], [1, 0, 5], [5, 0, 4], [5, 3, 1], [7, 3, 5], [6, 0, 2], [4, 0, 6], [6, 5, 4], [7, 5, 6], [2, 3, 6], [6, 3, 7]] }}
motion.free = {{ center = {} }}
[loads.weight]
on = "ladder"
force = [0, 0, -{weight:?}]
[contacts.foot]
between = ["ladder", "floor"]
friction.coulomb = {{ mu = 0.45 }}
[contacts.head]
between = ["ladder", "wall"]
friction.coulomb = {{ mu = 0.45 }}
[[steps]]
to = 1
"#,
            at(4.0 * c, 0.0, 0.0),
            points.join(", "),
            at(2.0 * c, 0.0, 2.0 * s)
        );
        let found = summary(&case, &set(&[]));
        let step = last_step(&found);
        let foot = &step["contacts"]["foot"]["force"];
        let head = &step["contacts"]["head"]["force"];
        let unit = 1e-8 * weight;
        close(&step["free_bodies"]["ladder"]["rotation"][1], 0.0, 1e-9);
        close(&head[0], -number(&foot[0]), unit);
        close(&foot[2], weight - number(&head[2]), unit);
        // Moments about the foot: the weight in the middle, the head across and along.
        let moment = 2.0 * c * weight - 4.0 * s * number(&foot[0]) - 4.0 * c * number(&head[2]);
        assert!(moment.abs() < 1e-8 * weight, "{moment}");
        // The head presses between the cones of foot and wall: with `|T| ≤ μ N` at each.
        let (slope, mu) = (s / c, 0.45);
        let least = 0.5 * weight / (slope + mu);
        let largest = (0.5 * weight / (slope - mu)).min(0.5 * weight * mu / (1.0 - mu * slope));
        let bounds = &step["contacts"]["head"]["force_bounds"];
        close(&bounds["least"], least, unit);
        close(&bounds["largest"], largest, unit);
        assert!(number(&head[0]).abs() > least - unit && number(&head[0]).abs() < largest + unit, "{head}");
        let unique = |w: &Value| w["kind"] == "not_unique";
        assert!(found["warnings"].as_array().unwrap().iter().any(unique), "{}", found["warnings"]);
    }
}

/// A disc in a groove of two walls with friction: by moments about its centre both friction forces `T` are the same, and the
/// normal forces `W sin β / sin(α + β) - T tan((α + β) / 2)`; the one that carries less limits `T`.
#[test]
fn forces_that_friction_leaves_open_are_told_by_their_bounds() {
    let (slopes, weight, mu) = ([30.0f64, 55.0].map(f64::to_radians), 3.0, 0.4);
    let case = |mu: f64| {
        format!(
            r#"
space = "plane_strain"
[constants]
a = "30*pi/180"
b = "55*pi/180"
[bodies.slope.rigid]
shape.plane = {{ point = [0, 0], normal = ["sin(a)", "cos(a)"] }}
[bodies.steep.rigid]
shape.plane = {{ point = [0, 0], normal = ["-sin(b)", "cos(b)"] }}
[bodies.disc.rigid]
shape.sphere = {{ center = ["(cos(b) - cos(a))/sin(a + b)", "(sin(a) + sin(b))/sin(a + b)"], radius = 1 }}
motion.free = {{}}
[loads.weight]
on = "disc"
force = [0, -{weight}]
[contacts.left]
between = ["disc", "slope"]
friction.coulomb = {{ mu = {mu} }}
[contacts.right]
between = ["disc", "steep"]
friction.coulomb = {{ mu = {mu} }}
[[steps]]
to = 1
"#
        )
    };
    let [a, b] = slopes;
    let k = (0.5 * (a + b)).tan();
    let open = [b, a].map(|other| weight * other.sin() / (a + b).sin());
    let lighter = open[0].min(open[1]);
    let found = summary(&case(mu), &set(&[]));
    let step = last_step(&found);
    for ((name, slope), force) in ["left", "right"].iter().zip([a, -b]).zip(open) {
        let contact = &step["contacts"][name];
        let bounds = &contact["force_bounds"];
        let [least, largest] = [force - k * mu * lighter / (1.0 + mu * k), force + k * mu * lighter / (1.0 - mu * k)];
        close(&bounds["least"], least, 1e-8);
        close(&bounds["largest"], largest, 1e-8);
        let [x, y] = [0, 1].map(|i| number(&contact["force"][i]));
        let normal = x * slope.sin() + y * slope.cos();
        assert!(normal >= least - 1e-8 && normal <= largest + 1e-8, "{name}: {normal} beyond {bounds}");
    }
    let text = found["answer"]["text"].as_str().unwrap();
    assert!(text.contains("the normal force of `left` may be anything from 2.063 to 3.338"), "{text}");
    // More friction clamps without limit, which is no number.
    let clamped = summary(&case(1.2), &set(&[]));
    assert!(last_step(&clamped)["contacts"]["left"]["force_bounds"]["largest"].is_null(), "{clamped}");
    assert!(number(&last_step(&clamped)["contacts"]["left"]["force_bounds"]["least"]) > 0.0);
    // Without friction balance tells all.
    let smooth = summary(&case(mu).replace(&format!("friction.coulomb = {{ mu = {mu} }}"), ""), &set(&[]));
    assert!(last_step(&smooth)["contacts"]["left"]["force_bounds"].is_null(), "{smooth}");
    // Summaries of earlier versions have no such key.
    let mut old = found.clone();
    for contact in ["left", "right"] {
        old["steps"][0]["contacts"][contact].as_object_mut().unwrap().remove("force_bounds").unwrap();
    }
    let old: signorini::report::Summary = serde_json::from_value(old).expect("a summary");
    assert_eq!(old.steps[0].contacts["left"].force_bounds, None);
}

/// A ball in a groove of two blocks so stiff that Newton's method from the start loses it: forces by statics.
#[test]
fn a_free_ball_rests_between_stiff_blocks() {
    let case = r#"
space = "plane_strain"
[constants]
a = "70*pi/180"
b = "40*pi/180"
R = 2.5
[bodies.left.solid]
mesh.box = { min = [-1, -1], max = [1, 0], cells = [8, 4], map = ["R*(x*sin(a) + y*cos(a) - cos(a))", "R*(-x*cos(a) + y*sin(a) - sin(a))"] }
degree = 1
material.linear_elastic = { youngs_modulus = 1e6, poissons_ratio = 0.3 }
[bodies.right.solid]
mesh.box = { min = [-1, -1], max = [1, 0], cells = [8, 4], map = ["R*(x*sin(b) - y*cos(b) + cos(b))", "R*(x*cos(b) + y*sin(b) - sin(b))"] }
degree = 1
material.linear_elastic = { youngs_modulus = 1e6, poissons_ratio = 0.3 }
[bodies.ball.rigid]
shape.sphere = { center = [0, 0], radius = "R" }
motion.free = {}
[supports.l]
on = "left:bottom"
displacement = [0, 0]
[supports.r]
on = "right:bottom"
displacement = [0, 0]
[supports.spin]
on = "ball"
rotation = [0]
[loads.weight]
on = "ball"
force = [0, -0.4]
[contacts.left]
between = ["left:top", "ball"]
method.node = {}
[contacts.right]
between = ["right:top", "ball"]
method.node = {}
"#;
    let found = summary(case, &set(&[]));
    let step = last_step(&found);
    let normal = |name: &str| {
        let force = &step["contacts"][name]["force"];
        number(&force[0]).hypot(number(&force[1]))
    };
    let whole = 0.4 / 110f64.to_radians().sin();
    assert!((normal("left") - whole * 40f64.to_radians().cos()).abs() < 2e-5, "{}", normal("left"));
    assert!((normal("right") - whole * 70f64.to_radians().cos()).abs() < 2e-5, "{}", normal("right"));
}
