//! States that are no answer, or less of one than they look, are told by the independent check: with the reason, and no
//! status of success.

use crate::summary;
use serde_json::Value;

fn answer(case: &str) -> (Value, String, String) {
    let found = summary(case, &["output.pictures=false".to_string()]);
    let text = found["answer"]["text"].as_str().unwrap_or_default().to_string();
    let verdict = found["answer"]["verdict"].as_str().unwrap_or_default().to_string();
    (found, verdict, text)
}

fn is_refused(case: &str, word: &str) {
    let (found, verdict, text) = answer(case);
    assert_eq!(verdict, "not_an_answer", "{text}");
    assert_eq!((&found["reason"], &found["converged"]), (&"refused".into(), &false.into()));
    assert_eq!(found["verdict"], text.as_str());
    assert!(text.contains(word), "{text}");
}

fn is_doubted(case: &str, word: &str) {
    let (found, verdict, text) = answer(case);
    assert_eq!((verdict.as_str(), &found["converged"]), ("right_but", &true.into()), "{text}");
    assert!(text.contains(word), "{text}");
}

const BLOCK: &str = r#"
space = "plane_strain"
[bodies.block.solid]
strain = "finite"
degree = 1
material.neo_hooke = { youngs_modulus = 8, poissons_ratio = 0.35 }
mesh.box = { min = [-3, 0], max = [3, 2], cells = [12, 4] }
[supports.base]
on = "block:bottom"
displacement = [0, 0]
[contacts.press]
between = ["block:top", "stamp"]
friction.coulomb = { mu = 0.3 }
[[steps]]
to = 1
increments = 2
[bodies.stamp.rigid]
"#;

#[test]
fn a_stamp_that_starts_or_jumps_inside_is_refused() {
    // One that starts 1 deep in the block is told before anything is solved.
    let start = "shape.cylinder = { point = [0.1, 1.1], radius = 2.1 }\nmotion.prescribed = { displacement = [0, \"-0.25*t\"] }";
    let told = crate::error(&format!("{BLOCK}{start}\n"));
    assert!(told.message.contains("deep inside `stamp`"), "{}", told.message);
    // And one that comes as deep in one increment is no answer.
    let jump =
        "shape.cylinder = { point = [0.1, 4.2], radius = 2.1 }\nmotion.prescribed = { displacement = [0, \"-5.2*t\"] }";
    let (found, _, text) = answer(&format!("{BLOCK}{jump}\n"));
    assert_eq!(found["converged"], false, "{text}");
}

#[test]
fn a_body_on_the_wrong_side_of_a_plane_is_refused_before_it_is_solved() {
    let plane = "shape.plane = { point = [0, 2.1], normal = [0, 1] }\n";
    is_refused(&format!("{BLOCK}{plane}"), "starts");
}

#[test]
fn a_plate_that_passes_through_the_side_of_a_box_of_cells_is_no_success() {
    let case = r#"
        space = "plane_strain"
        [bodies.post.cells]
        geometry.implicit = { negative_inside = "abs(x - 5) - 4", min = [0, 0], max = [10, 10] }
        mesh.grid = { cells = [3, 3] }
        degree = 2
        material.linear_elastic = { youngs_modulus = 900, poissons_ratio = 0.3 }
        [bodies.plate.rigid]
        shape.plane = { point = [0, 10], normal = [0, -1] }
        motion.prescribed = { displacement = [0, "-0.2*t"] }
        [supports.base]
        on = "post:bottom"
        displacement = [0, 0]
        [contacts.press]
        between = ["post", "plate"]
        [[steps]]
        to = 1"#;
    let (found, verdict, text) = answer(case);
    let force = found["steps"][0]["contacts"]["press"]["force"][1].as_f64().unwrap_or(0.0).abs();
    // Either the side of the box is met, or the state is refused.
    assert!(verdict == "not_an_answer" || force > 50.0, "{text} {force}");
}

#[test]
fn small_sliding_is_refused_where_bodies_slide_or_turn_far() {
    let drum = r#"
        space = "plane_strain"
        [bodies.shoe.solid]
        mesh.box = { min = [-0.1, 2], max = [0.1, 2.2], cells = [5, 5] }
        material.linear_elastic = { youngs_modulus = 2e4, poissons_ratio = 0.3 }
        [bodies.drum.rigid]
        shape.ellipsoid = { center = [0, 0], semi_axes = [2.005, 2] }
        motion.prescribed = { rotation = ["1.5*max(t - 1, 0)"] }
        [supports.head]
        on = "shoe:top"
        displacement = [0, "-0.001*min(t, 1)"]
        [contacts.brake]
        between = ["shoe:bottom", "drum"]
        sliding = "small"
        friction.coulomb = { mu = 0.3 }
        [[steps]]
        to = 1
        [[steps]]
        to = 2
        increments = 2"#;
    is_refused(drum, "sliding");
    let shoe = r#"
        space = "plane_strain"
        [bodies.block.solid]
        mesh.box = { min = [-2, -1], max = [2, 0], cells = [24, 6] }
        material.linear_elastic = { youngs_modulus = 200, poissons_ratio = 0.3 }
        [bodies.shoe.solid]
        mesh.box = { min = [-0.5, 0], max = [0.5, 0.6], cells = [10, 5], map = ["x", "y + 0.6*x^2*(1 - y/0.6)"] }
        material.linear_elastic = { youngs_modulus = 600, poissons_ratio = 0.3 }
        [supports.base]
        on = "block:bottom"
        displacement = [0, 0]
        [supports.head]
        on = "shoe:top"
        displacement = ["0.5*max(0, t - 1)", "-0.06*min(t, 1)"]
        [contacts.touch]
        between = ["shoe:bottom", "block:top"]
        sliding = "small"
        friction.coulomb = { mu = 0.2 }
        [[steps]]
        to = 1
        [[steps]]
        to = 2
        increments = 2"#;
    is_refused(shoe, "has slipped by");
}

#[test]
fn a_large_strain_of_a_beam_is_told() {
    let bar = r#"
        space = "3d"
        [bodies.bar.beam]
        path.points = [[0, 0, 0], [50, 0, 0]]
        cells = 4
        section.circle = { radius = 2 }
        material.linear_elastic = { youngs_modulus = 1000, poissons_ratio = 0.3 }
        [supports.root]
        on = "bar:start"
        displacement = [0, 0, 0]
        rotation = [0, 0, 0]
        [loads.tip]
        on = "bar:end"
        force = [2000, 0, 0]"#;
    is_doubted(bar, "strain of `bar`");
}

#[test]
fn contact_on_a_few_points_of_coarse_cells_is_told_with_the_cells_that_it_needs() {
    let case = r#"
        space = "3d"
        [bodies.plate.cells]
        geometry.box = { min = [0, 0, 0], max = [40, 40, 9] }
        mesh.grid = { min = [0, 0, 0], max = [40, 40, 10], cells = [5, 5, 2] }
        degree = 2
        material.linear_elastic = { youngs_modulus = 7e4, poissons_ratio = 0.3 }
        [bodies.ball.rigid]
        shape.sphere = { center = [21, 20, 14], radius = 5 }
        motion.prescribed = { displacement = [0, 0, "-0.4*t"] }
        [supports.base]
        on = "plate:bottom"
        displacement = [0, 0, 0]
        [contacts.touch]
        between = ["plate", "ball"]
        friction.coulomb = { mu = 0.2 }
        [[steps]]
        to = 1
        increments = 2"#;
    let (_, verdict, text) = answer(case);
    assert_eq!(verdict, "right_but", "{text}");
    assert!(text.contains("cells wide") && text.contains("instead of"), "{text}");
}

/// A disc of finite cells whose whole surface is held, pressed by a plane: nothing can give way, and what supports and contact
/// share out between them is no state.
#[test]
fn a_held_surface_that_is_pressed_is_no_answer() {
    let case = r#"
space = "plane_strain"
[bodies.disc.cells]
geometry.sphere = { center = [0, 0], radius = 1 }
mesh.grid = { cells = [6, 6] }
degree = 2
material.linear_elastic = { youngs_modulus = 10, poissons_ratio = 0.3 }
groups.all = "y > -5"
[bodies.plane.rigid]
shape.plane = { point = [0, 1], normal = [0, -1] }
motion.prescribed = { displacement = [0, "-0.05*t"] }
[supports.hold]
on = "disc:all"
displacement = [0, 0]
[contacts.c]
between = ["disc", "plane"]
[[steps]]
to = 1
"#;
    let (found, verdict, text) = answer(case);
    assert_eq!(verdict, "not_an_answer", "{text}");
    assert_eq!(found["reason"], "refused", "{text}");
    assert!(text.contains("the surface does not give way"), "{text}");
}
