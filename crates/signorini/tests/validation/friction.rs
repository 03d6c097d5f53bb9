//! Friction of solids, from the case file to the summary.

use super::{error, example, last_step, number, set, summary};

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

/// A slider on a spring with rate-and-state friction that is drawn ten times faster than it slid: friction after 3 s by the
/// differential equations (Runge-Kutta, 200 000 steps), at nodes and by mortar, with an error of first order.
#[test]
fn a_slider_follows_rate_and_state_friction() {
    let case = |evolution: &str, method: &str, increments: usize| {
        format!(
            "space = \"plane_strain\"
[bodies.block.solid]
mesh.box = {{ min = [0, 0], max = [1, 0.1], cells = [1, 1] }}
material.linear_elastic = {{ youngs_modulus = 1e6, poissons_ratio = 0 }}
[bodies.floor.rigid]
shape.plane = {{ point = [0, 0], normal = [0, 1] }}
[supports.spring]
on = \"block:top\"
spring = [0.75, 0]
[loads.press]
on = \"block:top\"
pressure = 1
[loads.draw]
on = \"block:top\"
traction = [\"0.6 + 0.0075*t\", 0]
[contacts.rub]
between = [\"block:bottom\", \"floor\"]
method.{method} = {{}}
friction.rate_and_state = {{ mu = 0.6, a = 0.01, b = 0.015, velocity = 1e-3, distance = 0.02, evolution = \"{evolution}\" }}
[[steps]]
to = 3
increments = {increments}
"
        )
    };
    for (evolution, method, exact) in [("aging", "mortar", 0.6152502193534), ("slip", "node", 0.6139387678523)] {
        let errors = [25, 50].map(|n| {
            let found = summary(&case(evolution, method, n), &set(&[]));
            let force = &last_step(&found)["contacts"]["rub"]["friction_force"];
            (-number(&force[0]) - exact).abs()
        });
        assert!(errors[1] < 4e-4 && errors[0] / errors[1] > 1.8, "{evolution}: {errors:?}");
    }
    let both = case("aging", "mortar", 1).replace("method.mortar = {}", "wear = 1e-9");
    let told = error(&both);
    assert!(told.message.contains("`friction.rate_and_state` and `wear` in one contact"), "{}", told.message);
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
    assert!(slides["reason"] == "free_body" && verdict.contains("against sliding along (0.97"), "{verdict}");
    assert_eq!(slides["steps"].as_array().expect("steps").len(), 4, "the state before is kept");
}

/// NAFEMS CB-1 with friction, beside a program with functions of two degrees: the block carries the pressures, so that normals
/// and gaps are vertical as there. What sticks depends on the number of increments, which is part of the problem.
#[test]
fn a_cylinder_on_a_softer_block_sticks_in_the_middle() {
    // μ, increments, approach at which half of the cylinder carries 17 500, pressure in the middle, part that sticks; cells
    // along the zone of contact.
    let rows = [
        (0.1, 4, 1.258858880546848, 3671.5, 0.3417, 16),
        (0.3, 4, 1.25704106881198, 3665.8, 0.8900, 16),
        (0.3, 8, 1.2572346395967626, 3666.3, 0.9174, 32),
    ];
    for (mu, increments, approach, pressure, sticks, cells) in rows {
        let case = format!(
            r#"
space = "plane_strain"
[bodies.block.solid]
mesh.box = {{ axes = [
  {{ from = 0, to = [8, 100], cells = [{cells}, 10], growth = [1, 1.4] }},
  {{ from = -100, to = [-6, 0], cells = [9, 12], growth = [0.7, 1] }} ] }}
degree = 2
material.linear_elastic = {{ youngs_modulus = 70000, poissons_ratio = 0.3 }}
[bodies.cylinder.solid]
mesh.box = {{ axes = [
  {{ from = 0, to = [8, 38], cells = [{cells}, 8], growth = [1, 1.25] }},
  {{ from = 0, to = [6, 40], cells = [12, 8], growth = [1, 1.25] }} ],
  map = ["x", "y + (1 - y/40)*(50 - sqrt(50^2 - x^2))"] }}
degree = 2
material.linear_elastic = {{ youngs_modulus = 210000, poissons_ratio = 0.3 }}
[supports.base]
on = "block:bottom"
displacement = [0, 0]
[supports.block_symmetry]
on = "block:left"
normal = 0
[supports.cylinder_symmetry]
on = "cylinder:left"
normal = 0
[supports.head]
on = "cylinder:top"
displacement = [0, "-{approach}*t"]
[contacts.touch]
sliding = "small"
between = ["block:top", "cylinder:bottom"]
friction.coulomb = {{ mu = {mu} }}
[[steps]]
to = 1
increments = {increments}
"#
        );
        let found = summary(&case, &set(&[]));
        let contact = &last_step(&found)["contacts"]["touch"];
        let force = number(&contact["force"][1]);
        assert!((force / -17500.0 - 1.0).abs() < 5e-4, "μ = {mu}: {force}");
        let largest = number(&contact["max_pressure"]);
        assert!((largest / pressure - 1.0).abs() < 2e-3, "μ = {mu}: {largest}, not {pressure}");
        let stick = number(&contact["stick_area"]) / number(&contact["area"]);
        assert!((stick - sticks).abs() < 0.05, "μ = {mu}, {increments} increments: {stick} sticks, not {sticks}");
    }
}

/// A drum that turns under a held block rubs along the arc by any angle in one increment or many, whatever measures the contact,
/// and friction takes the force times the way.
#[test]
fn a_brake_drum_rubs_by_the_angle_times_the_radius() {
    let block = "[bodies.b.solid]\nmesh.box = { min = [-0.1, 1.0], max = [0.1, 1.2], cells = [4, 4] }\ndegree = 1\n";
    let cells = "[bodies.b.cells]\ngeometry.box = { min = [-0.1, 1.0], max = [0.1, 1.2] }\nmesh.grid = { cells = [3, 3] }\n\
                 degree = 2\n";
    let rubbed = |body: &str, contact: &str, angle: f64, increments: usize| {
        let case = format!(
            "space = \"plane_strain\"\n{body}material.linear_elastic = {{ youngs_modulus = 1e4, poissons_ratio = 0.3 }}\n\
             [bodies.d.rigid]\nshape.sphere = {{ center = [0, 0], radius = 1 }}\n\
             motion.prescribed = {{ rotation = [\"{angle}*max(t-1,0)\"] }}\n\
             [supports.s]\non = \"b:top\"\ndisplacement = [0, \"-0.001*min(t,1)\"]\n\
             [contacts.c]\nbetween = [\"b:bottom\", \"d\"]\nfriction.coulomb = {{ mu = 0.3 }}\n{contact}\n\
             [[steps]]\nto = 1\n[[steps]]\nto = 2\nincrements = {increments}\n"
        );
        let found = summary(&case, &set(&[]));
        let last = &last_step(&found)["contacts"]["c"];
        let steps = found["steps"].as_array().expect("steps");
        let taken: f64 = steps.iter().map(|s| number(&s["contacts"]["c"]["dissipation"])).sum();
        let along = steps[1..].iter().map(|s| number(&s["contacts"]["c"]["force"][0]));
        assert!(along.clone().all(|f| f * angle < 0.0), "{contact}: {:?}", along.collect::<Vec<_>>());
        let exact = 0.3 * number(&last["force"][1]) * angle.abs();
        assert!((taken / exact - 1.0).abs() < 0.012, "{contact}, {angle} in {increments}: {taken}, not {exact}");
    };
    rubbed(block, "", 4.0, 2);
    for angle in [4.0, -14.0] {
        rubbed(block, "sliding = \"finite\"", angle, 1);
        rubbed(block, "sliding = \"finite\"\nmethod.node = {}", angle, 2);
    }
    // This one is cut.
    rubbed(cells, "", 1.5, 1);
}

/// A block is pushed up a wedge, farther in each increment than a cell is long: `W tan(α + atan μ)`, whichever side is tested. On the
/// wedge friction has to reach points that the end of the block has slid over since the increment began.
#[test]
fn friction_reaches_what_the_end_of_a_body_slides_over() {
    let exact = (0.1f64.atan() + 0.3f64.atan()).tan();
    for slave in ["block", "wedge"] {
        for method in ["mortar = {}", "node = {}", "gauss_point = {}"] {
            let case =
                example("wedge").replace("sliding = \"finite\" ", &format!("slave = \"{slave}\"\nmethod.{method} "));
            let case = case.replace("2.4*t", "0.9*t").replace("increments = 8", "increments = 2");
            let case = case.replace("cells = [25, 5]", "cells = [12, 2]").replace("cells = [8, 6]", "cells = [4, 2]");
            let found = summary(&case, &set(&[]));
            let push = number(&last_step(&found)["support_forces"]["push"][0]);
            assert!((push / exact - 1.0).abs() < 1e-5, "{slave}, {method}: {push} for {exact}");
        }
    }
}

/// A block 0.7 long on a longer one, pressed and then moved along it by half a unit.
fn block_on_a_longer_one(between: &str, more: &str) -> [f64; 3] {
    let case = format!(
        r#"
space = "plane_strain"
[bodies.blk.solid]
mesh.box = {{ min = [-0.5, 0], max = [0.2, 0.6], cells = [3, 2] }}
degree = 1
material.linear_elastic = {{ youngs_modulus = 1100, poissons_ratio = 0 }}
[bodies.base.solid]
mesh.box = {{ min = [-2, -1], max = [2, 0], cells = [16, 2] }}
degree = 1
material.linear_elastic = {{ youngs_modulus = 1000, poissons_ratio = 0 }}
[supports.head]
on = "blk:top"
displacement = ["0.5*max(t - 1, 0)", "-0.01*min(t, 1)"]
[supports.ground]
on = "base:bottom"
displacement = [0, 0]
[contacts.c]
between = {between}
{more}
[[steps]]
to = 1
[[steps]]
to = 2
increments = 4
"#
    );
    let found = summary(&case, &set(&[]));
    let force = last_step(&found)["contacts"]["c"]["force"].clone();
    [0, 1, 2].map(|k| number(&force[k]))
}

/// Whole bodies of small strain are met where they slide to as well, and a node at an edge carries once: as with the faces named.
#[test]
fn whole_bodies_slide_far() {
    let friction = "friction.coulomb = { mu = 0.3 }\n";
    for more in [friction, "slave = \"base\"\n", "slave = \"blk\"\nmethod.node = {}\n"] {
        let [whole, faces] = ["[\"blk\", \"base\"]", "[\"blk:bottom\", \"base:top\"]"]
            .map(|between| block_on_a_longer_one(between, more));
        let apart = (0..2).map(|k| (whole[k] - faces[k]).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-6 * faces[1].abs() && faces[1] > 5.0, "{more}: {whole:?} and {faces:?}");
    }
}

/// Friction of a block on a plane that closes and slides in one increment: the sides of the block, which looked away before, add
/// nothing to it, neither pressure nor friction.
#[test]
fn a_node_at_an_edge_slips() {
    let case = r#"
space = "plane_strain"
[bodies.blk.solid]
mesh.box = { min = [0, 0], max = [1, 1], cells = [6, 6] }
degree = 1
material.linear_elastic = { youngs_modulus = 1000, poissons_ratio = 0 }
[bodies.base.rigid]
shape.plane = { point = [0, 0], normal = [0, 1] }
[supports.head]
on = "blk:top"
displacement = ["0.3*t", "-0.01*t"]
[contacts.c]
between = ["blk", "base"]
method.node = {}
friction.coulomb = { mu = 0.3 }
[[steps]]
to = 1
"#;
    let found = summary(case, &set(&[]));
    let force = last_step(&found)["contacts"]["c"]["force"].clone();
    let [along, across] = [0, 1].map(|k| number(&force[k]));
    assert!((across - 10.0).abs() < 1e-2 && (along + 0.3 * across).abs() < 1e-3 * across, "{along} and {across}");
}

/// A block of cells comes down on a solid while it moves along it, in one increment, over points that were beside it: friction acts
/// against its motion.
#[test]
fn friction_acts_against_the_motion_over_an_edge() {
    let case = r#"
space = "3d"
[bodies.blk.cells]
geometry.box = { min = [-0.5, -0.4, 0.3], max = [0.2, 0.4, 0.9] }
mesh.grid = { cells = [3, 2, 2], min = [-0.5, -0.4, 0.3], max = [0.2, 0.4, 0.9] }
degree = 1
material.linear_elastic = { youngs_modulus = 1100, poissons_ratio = 0 }
[supports.head]
on = "blk:top"
displacement = ["0.3*t", "0.1*t", "-0.31*t"]
[bodies.base.solid]
mesh.box = { min = [-2, -1, -1], max = [2, 1, 0], cells = [8, 4, 2] }
degree = 1
material.linear_elastic = { youngs_modulus = 1000, poissons_ratio = 0 }
[supports.ground]
on = "base:bottom"
displacement = [0, 0, 0]
[contacts.c]
between = ["blk", "base"]
slave = "base"
friction.coulomb = { mu = 0.3 }
[[steps]]
to = 1
"#;
    let found = summary(case, &set(&[]));
    let friction = last_step(&found)["contacts"]["c"]["friction_force"].clone();
    let [x, y] = [0, 1].map(|k| number(&friction[k]));
    let angle = y.atan2(x).abs().to_degrees();
    let exact = 180.0 - (0.1f64 / 0.3).atan().to_degrees();
    assert!((angle - exact).abs() < 0.5, "{angle} for {exact} degrees");
}

/// Newton's method goes round among nodes of a belt that stick and slip; from states with more friction it finds the one that the
/// theorem of Euler and Eytelwein tells, with the radius in the middle of the belt.
#[test]
fn a_belt_that_slides_is_found_from_one_that_sticks() {
    let case = r#"
space = "plane_strain"
[bodies.belt.solid]
mesh.box = { min = [0, 2], max = [1, 2.05], cells = [40, 1], map = ["-y*cos(pi*x)", "y*sin(pi*x)"] }
degree = 2
material.linear_elastic = { youngs_modulus = 2000, poissons_ratio = 0 }
[bodies.drum.rigid]
shape.sphere = { center = [0, 0], radius = 2 }
[supports.hold]
on = "belt:right"
displacement = ["free", 0]
[loads.pull]
on = "belt:left"
force = [0, "-0.5*t"]
[contacts.wrap]
between = ["belt:bottom", "drum"]
friction.coulomb = { mu = 0.3 }
[[steps]]
to = 0.5
"#;
    let found = summary(case, &set(&[]));
    let held = -number(&last_step(&found)["support_forces"]["hold"][1]);
    let exact = 0.25 * (-0.3 * std::f64::consts::PI * 2.0 / 2.025).exp();
    assert!((held / exact - 1.0).abs() < 0.03, "{held} for {exact}");
}
