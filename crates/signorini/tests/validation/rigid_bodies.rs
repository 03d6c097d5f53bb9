//! Free rigid bodies by themselves and between elastic ones, stated as cases, against statics.

use super::{last_step, number, set, summary};
use serde_json::Value;

fn close(value: &Value, expected: f64, tolerance: f64) {
    assert!((number(value) - expected).abs() <= tolerance, "{value} for {expected}");
}

/// A disc that sticks to a floor turns as far as it rolls, whatever the increment.
#[test]
fn a_disc_rolls_without_slip() {
    for distance in [0.9, 5.0] {
        let case = format!(
            r#"
space = "plane_strain"
[bodies.floor.rigid]
shape.plane = {{ point = [0, 0], normal = [0, 1] }}
[bodies.disc.rigid]
shape.sphere = {{ center = [0, 1], radius = 1 }}
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
        let unique = |w: &Value| w["kind"] == "not_unique";
        assert!(found["warnings"].as_array().unwrap().iter().any(unique), "{}", found["warnings"]);
    }
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
