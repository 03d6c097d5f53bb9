//! Solids that contact alone holds, or nothing: mistakes are told at their place, what can be solved is.

use super::solids::at;
use super::{error, example, last_step, number, set, summary};
use serde_json::Value;

/// Replaces a part of a gallery case, and returns the error with the text it points at.
fn spoiled(name: &str, from: &str, to: &str) -> (String, String, String) {
    let case = example(name);
    assert!(case.contains(from), "`{from}` is not in the case");
    let error = error(&case.replacen(from, to, 1));
    let place = error.place.clone().unwrap_or_else(|| panic!("no place: {}", error.message));
    let at = place.text[place.span.start..place.span.end.min(place.text.len())].to_string();
    (error.message, at, error.help.unwrap_or_default())
}

#[test]
fn each_mistake_is_told_at_its_place() {
    let table = [
        ("hertz", "\"block:top\"", "\"block:tpo\"", "has no group `tpo`", "block:tpo", "`top`"),
        ("hertz", "\"block:left\"", "\"blok:left\"", "no body `blok`", "blok:left", "`block`"),
        ("hertz", "youngs_modulus = 1000", "youngs_modulus = 0", "must be positive", "0", ""),
        (
            "hertz",
            "[bodies.plane.rigid]",
            "[bodies.plane.rigid]\nmotion.prescribed = { displacement = [0, \"0*log(-1)\"] }",
            "displacement[1]` is NaN",
            "\"0*log(-1)\"",
            "",
        ),
        (
            "hertz",
            "[bodies.plane.rigid]",
            "[bodies.plane.rigid]\nmotion.prescribed = { rotation = [\"1/(t-t)\"] }",
            "rotation[0]` is inf",
            "\"1/(t-t)\"",
            "",
        ),
        ("hertz", "poissons_ratio = 0.3", "poissons_ratio = 0.5", "ratio is 0.5", "0.5", "0.4999"),
        ("hertz", "degree = 2", "degree = 9", "between 1 and 8", "9", ""),
        ("hertz", "[0, \"-0.085*t\"]", "[0]", "expected 2 components", "[0]", ""),
        ("hertz", "[0, \"-0.085*t\"]", "0", "expected 2 components", "0", "free"),
        ("hertz", "\"-0.085*t\"", "\"-0.085/(t-t)\"", "not a finite number", "\"-0.085/(t-t)\"", ""),
        ("hertz", "normal = [0, 1]", "normal = [0, 0]", "vector is zero", "[0, 0]", ""),
        ("hertz", "normal = [0, 1]", "normal = [0, -1]", "deep inside `plane`", "[contacts.touch]", "normal"),
        ("hertz", "map = [\"x\", ", "map = [\"-x\", ", "inverted", "box", "positive volume"),
        ("hertz", "cells = [15, 16]", "cells = [15]", "`cells` 1", "{ from", ""),
        ("hertz", "[\"block:bottom\", \"plane\"]", "[\"plane\", \"plane\"]", "names `plane` twice", "plane", ""),
        (
            "hertz",
            "[\"block:bottom\", \"plane\"]",
            "[\"block:bottom\"]",
            "bodies of the contact are missing",
            "[contacts.touch]",
            "self_contact",
        ),
        ("incline", "mu = [0.3, 0.5]", "mu = -0.3", "must not be negative", "-0.3", "leave `friction` out"),
        ("incline", "mu = [0.3, 0.5]", "mu = [0.3, nan]", "not a finite number", "nan", ""),
        ("incline", "mu = [0.3, 0.5], axis = [1, 0, 0]", "mu = [0.3, 0.5]", "require an axis", "[0.3, 0.5]", "axis"),
        ("incline", "axis = [1, 0, 0]", "axis = [0, 0, 0]", "vector is zero", "[0, 0, 0]", ""),
        ("incline", "axis = [1, 0, 0]", "axis = [0, 0, 1]", "normal to the surface", "[0, 0, 1]", ""),
        (
            "incline",
            "coulomb = { mu = [0.3, 0.5], axis = [1, 0, 0] }",
            "tresca = { limit = -1 }",
            "must not be negative",
            "-1",
            "",
        ),
        ("incline", "coulomb = {", "colomb = {", "unknown key `colomb`", "colomb", "`coulomb`"),
        (
            "incline",
            "friction.coulomb",
            "sliding = \"finite\"\nmethod.active_set = {}\nfriction.coulomb",
            "for other bodies",
            "method",
            "gauss_point",
        ),
        ("cattaneo_mindlin", "mu = 0.4", "mu = [0.4, 0.2]", "one coefficient", "[0.4, 0.2]", "mu = 0.3"),
        (
            "hertz",
            "[contacts.touch]",
            "[contacts.touch]\nmethod.active_set = {}",
            "for other bodies",
            "method",
            "mortar",
        ),
        ("hertz", "space = \"plane_strain\"", "space = \"3d\"", "expected 3", "[", ""),
        (
            "hertz",
            "[supports.symmetry]",
            "[supports.other]\non = \"block:top\"\ndisplacement = [0.1, \"free\"]\n[supports.symmetry]",
            "contradict each other",
            "[supports.",
            "",
        ),
        ("hertz", "on = \"block:left\"", "on = \"block:bottom\"", "flat group", "0", ""),
        ("punch", "force = [0, \"-10*t\"]", "normal = -1", "load of a membrane", "-1", "pressure"),
        ("punch", "tied = true", "", "prescribes nothing", "[supports.punch_head]", "tied"),
        ("torus", "minor_radius = 0.3", "minor_radius = 1.3", "not smaller", "1.3", ""),
        ("hertz", "mesh.box", "mesh.gmsh = { file = \"none.msh\" }\n# mesh.box", "cannot be read", "none.msh", ""),
    ];
    for (name, from, to, message, at, help) in table {
        // A table may spread over several lines; commenting its first out needs the rest gone too.
        let (from, to) = if to.contains("gmsh") {
            let case = example(name);
            let start = case.find("mesh.box").unwrap();
            let end = case.find("degree").unwrap();
            (case[start..end].to_string(), "mesh.gmsh = { file = \"none.msh\" }\n".to_string())
        } else {
            (from.to_string(), to.to_string())
        };
        let (found, place, advice) = spoiled(name, &from, &to);
        assert!(found.contains(message), "{to}: `{found}` has no `{message}`");
        assert!(place.contains(at), "{to}: points at `{place}`, not `{at}`");
        assert!(advice.contains(help), "{to}: `{advice}` has no `{help}`");
    }
}

/// What nothing holds is named with its motion, what does not meet is said.
#[test]
fn failures_say_what_happened() {
    let case = example("punch")
        .replace("between = [\"punch:bottom\", \"block:top\"]", "between = [\"punch:top\", \"block:bottom\"]");
    let found = summary(&case, &set(&[]));
    assert_eq!(found["converged"], false);
    let verdict = found["verdict"].as_str().unwrap();
    assert!(verdict.contains("no part of the slave of contact `touch` faces the master"), "{verdict}");

    let far = example("hertz").replace("point = [0, 0]", "point = [0, -1]");
    let found = summary(&far, &set(&[]));
    let warnings = found["warnings"].to_string();
    assert!(warnings.contains("are not in contact") && warnings.contains("smallest gap"), "{warnings}");
    assert!(found["verdict"].as_str().unwrap().contains("open"));
}

/// Two blocks on each other, without friction; `a` is guided at its left side only.
const PAIR: &str = r#"
space = "plane_strain"
[bodies.a.solid]
mesh.box = { min = [-2, 0], max = [2, 2], cells = [4, 2] }
degree = 1
material.linear_elastic = { youngs_modulus = 100, poissons_ratio = 0.3 }
[bodies.b.solid]
mesh.box = { min = [-3, -2], max = [3, 0], cells = [6, 2] }
degree = 1
material.linear_elastic = { youngs_modulus = 100, poissons_ratio = 0.3 }
[supports.base]
on = "b:bottom"
displacement = [0, 0]
[supports.guide]
on = "a:left"
normal = 0
[loads.push]
on = "a:top"
pressure = "if(t > 1.5, -1, 1)"
[contacts.touch]
between = ["a:bottom", "b:top"]
[[steps]]
to = 2
increments = 2
[output]
pictures = false
"#;

/// Contact does not pull: a body that its load pulls off is named, and what was found before stays.
#[test]
fn what_is_pulled_off_is_named() {
    let on_a_plane = r#"
space = "3d"
[bodies.a.solid]
mesh.box = { min = [-1,-1,0], max = [1,1,1], cells = [2,2,1] }
degree = 1
material.linear_elastic = { youngs_modulus = 100, poissons_ratio = 0.3 }
[bodies.plate.rigid]
shape.plane = { point = [0,0,0], normal = [0,0,1] }
[supports.x]
on = "a:left"
normal = 0
[supports.y]
on = "a:front"
normal = 0
[loads.up]
on = "a:top"
force = [0, 0, "20*t - 21"]
[contacts.touch]
between = ["a:bottom", "plate"]
[[steps]]
to = 2
increments = 2
[output]
pictures = false
"#;
    for (case, axis) in [(PAIR, "(0.000, 1.000, 0.000)"), (on_a_plane, "(0.000, 0.000, 1.000)")] {
        for (degree, sliding) in [("1", "small"), ("3", "small"), ("1", "finite")] {
            let case = case.replace("degree = 1", &format!("degree = {degree}"));
            let case = case.replace("[[steps]]", &format!("sliding = \"{sliding}\"\n[[steps]]"));
            let found = summary(&case, &set(&[]));
            let verdict = found["verdict"].as_str().unwrap();
            assert_eq!((&found["converged"], &found["reason"]), (&Value::from(false), &Value::from("free_body")));
            let motion = format!("`a` is free: no support or contact restrains it against moving along {axis}");
            assert!(verdict.contains(&motion), "{degree} {sliding}: {verdict}");
            assert_eq!(found["steps"][0]["converged"], true, "{degree} {sliding}");
        }
    }
}

/// A stack is well posed with any gaps and overlaps: every contact carries the pressure on top.
#[test]
fn a_stack_of_three_bodies_settles() {
    let bodies = [("a", 1.0, 3), ("b", 2.0, 5), ("c", 5.0, 4)];
    for (gap, degree) in [(1e-9, 2), (-1e-9, 1), (0.3, 1), (-1e-3, 2)] {
        let mut case = String::from("space = \"plane_strain\"\n");
        for (k, (name, modulus, cells)) in bodies.iter().enumerate() {
            let below = k as f64 * (1.0 + gap);
            case += &format!(
                "[bodies.{name}.solid]\nmesh.box = {{ min = [0, {below:?}], max = [1, {:?}], cells = [{cells}, {cells}] }}\n\
                 degree = {degree}\nmaterial.linear_elastic = {{ youngs_modulus = {modulus:?}, poissons_ratio = 0.3 }}\n\
                 [supports.{name}]\non = \"{name}:left\"\nnormal = 0\n",
                below + 1.0
            );
        }
        case += "[supports.base]\non = \"a:bottom\"\nnormal = 0\n[loads.p]\non = \"c:top\"\npressure = 1e-3\n\
                 [contacts.ab]\nbetween = [\"a:top\", \"b:bottom\"]\nsliding = \"small\"\n\
                 [contacts.bc]\nbetween = [\"b:top\", \"c:bottom\"]\nsliding = \"small\"\n\
                 [output]\npictures = false\n";
        let found = summary(&case, &set(&[]));
        assert_eq!(found["converged"], true, "{gap}: {}", found["verdict"]);
        for contact in ["ab", "bc"] {
            for figure in ["max_pressure", "min_pressure"] {
                let p = at(last_step(&found), &format!("/contacts/{contact}/{figure}"));
                assert!((p / 1e-3 - 1.0).abs() < 1e-6, "{gap}, {contact}: {figure} {p}");
            }
        }
    }
}

/// A ladder, as a beam and as a solid, that leans at 60 degrees on a smooth wall: friction on the floor holds it, as its
/// coefficient is larger than half the cotangent, and so it stays. Moments about the foot give the force of the wall.
#[test]
fn what_friction_holds_leans_and_does_not_slide() {
    let (cosine, sine, length) = (0.5, 0.75f64.sqrt(), 4.0);
    let wall_at = cosine * length;
    let (radius, thick) = (0.01, 0.2);
    let beam = format!(
        r#"
space = "3d"
[bodies.l.beam]
path.points = [[0, 0, 0], [{wall_at}, 0, "4*sqrt(0.75)"]]
cells = 10
radius = {radius}
section.stiffness = {{ EA = 1e5, GA = 1e5, EI = 1e4, GJ = 1e4 }}
[bodies.floor.rigid]
shape.plane = {{ point = [0, 0, -{radius}], normal = [0, 0, 1] }}
[bodies.wall.rigid]
shape.plane = {{ point = ["{wall_at} + {radius}", 0, 0], normal = [-1, 0, 0] }}
[supports.plane]
on = "l:boundary"
displacement = ["free", 0, "free"]
[loads.w]
on = "l"
body_force = [0, 0, -0.25]
"#
    );
    let solid = format!(
        r#"
space = "plane_strain"
[constants]
s = "sqrt(0.75)"
[bodies.l.solid]
mesh.box = {{ min = [0, 0], max = [4, {thick}], cells = [40, 2], map = ["0.5*x - s*(y - {thick})", "s*x + 0.5*y"] }}
degree = 2
material.linear_elastic = {{ youngs_modulus = 1e6, poissons_ratio = 0.3 }}
[bodies.floor.rigid]
shape.plane = {{ point = [0, 0], normal = [0, 1] }}
[bodies.wall.rigid]
shape.plane = {{ point = ["{wall_at} + {thick}*s", 0], normal = [-1, 0] }}
[loads.w]
on = "l"
body_force = [0, "-1/(4*{thick})"]
"#
    );
    let contacts = r#"
[contacts.foot]
between = ["l", "floor"]
sliding = "finite"
friction.coulomb = { mu = 0.4 }
[contacts.head]
between = ["l", "wall"]
sliding = "finite"
[[steps]]
to = 1
"#;
    // Arms of the weight and of the wall about the place where the floor is touched.
    let of_beam = cosine * length / 2.0 / (sine * length + radius);
    let of_solid = (cosine * length - sine * thick) / 2.0 / (sine * length);
    for (case, exact, error) in [(beam, of_beam, 1e-4), (solid, of_solid, 1e-6)] {
        let found = summary(&(case + contacts), &set(&[]));
        let step = last_step(&found);
        let [head, foot] = ["head", "foot"].map(|name| step["contacts"][name]["force"][0].as_f64().unwrap());
        assert!((-head / exact - 1.0).abs() < error && (head + foot).abs() < 1e-8, "{head} {foot} {exact}");
    }
}

/// A rigid ball on a plane that is drawn along below it sinks by the wear of its force, in one increment or in two.
#[test]
fn a_ball_that_wears_sinks() {
    for increments in [1, 2] {
        let case = format!(
            "space = \"3d\"\n[bodies.ball.rigid]\nshape.sphere = {{ center = [0, 1, 0], radius = 1 }}\n\
             motion.free = {{}}\n[bodies.floor.rigid]\n\
             shape.plane = {{ point = [0, 0, 0], normal = [0, 1, 0] }}\n\
             motion.prescribed = {{ displacement = [\"t\", 0, 0] }}\n[supports.hold]\non = \"ball\"\n\
             displacement = [0, \"free\", 0]\nrotation = [0, 0, 0]\n[loads.weight]\non = \"ball\"\n\
             force = [0, -1, 0]\n[contacts.c]\nbetween = [\"ball\", \"floor\"]\nfriction.coulomb = {{ mu = 0.2 }}\n\
             wear = 1e-2\n[[steps]]\nto = 1\nincrements = {increments}\n"
        );
        let found = summary(&case, &set(&[]));
        let step = last_step(&found);
        let (force, depth) = (at(step, "/contacts/c/force/0"), at(step, "/free_bodies/ball/displacement/1"));
        assert!((force - 0.2).abs() < 1e-9 && (depth + 1e-2).abs() < 1e-9, "{force} {depth}");
    }
}

/// The centre of a free body of triangles without a mass is that of its volume: a weight acts there.
#[test]
fn a_free_mesh_has_its_centre_in_its_volume() {
    let case = r#"
space = "3d"
[bodies.cube.rigid]
motion.free = {}
[bodies.cube.rigid.shape.triangles]
points = [[3, 0, 0], [4, 0, 0], [4, 1, 0], [3, 1, 0], [3, 0, 1], [4, 0, 1], [4, 1, 1], [3, 1, 1]]
triangles = [[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4],
             [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7]]
[loads.weight]
on = "cube"
force = [0, 0, -1]
[supports.held]
on = "cube"
displacement = [0, 0, 0]
rotation = [0, 0, 0]
"#;
    let moment = last_step(&summary(case, &set(&[])))["support_moments"]["held"].clone();
    for (k, exact) in [0.5, -3.5, 0.0].iter().enumerate() {
        assert!((number(&moment[k]) - exact).abs() < 1e-12, "{moment}");
    }
    let ball = r#"
space = "3d"
[bodies.ball.rigid]
shape.level_set = { negative_inside = "hypot(x - 3, hypot(y, z)) - 1", min = [1, -2, -2], max = [5, 2, 2], cells = 8 }
motion.free = {}
[loads.weight]
on = "ball"
force = [0, 0, -1]
[supports.held]
on = "ball"
displacement = [0, 0, 0]
rotation = [0, 0, 0]
"#;
    assert!(error(ball).message.contains("where the centre of `ball` is"), "{}", error(ball).message);
}
