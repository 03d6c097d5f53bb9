//! Elastic solids: what a run of a case must give whatever the theory.

use super::{error, example, last_step, number, set, summary};
use serde_json::Value;

/// Supports that meet at an edge agree on it; all forces are counted once, and balance.
#[test]
fn supports_that_share_edges_agree() {
    let case = |degree: usize, second: &str| {
        format!(
            r#"
space = "3d"
[bodies.b.solid]
mesh.box = {{ min = [0,0,0], max = [1,1,1], cells = [2,2,2] }}
degree = {degree}
material.linear_elastic = {{ youngs_modulus = 1, poissons_ratio = 0.3 }}
[bodies.p.rigid]
shape.plane = {{ point = [0,0,0], normal = [0,0,1] }}
[supports.first]
on = "b:right"
displacement = ["1e-3*y/(1 + z^2)", "1e-3*y/(1 + z^2)", "free"]
[supports.second]
{second}
[supports.bed]
on = "b:top"
spring = [0.1, 0.2, 0.3]
[loads.down]
on = "b:top"
pressure = 1e-2
[contacts.c]
between = ["b:bottom","p"]
[output]
pictures = false
"#
        )
    };
    for degree in [1, 2, 3] {
        for second in [
            "on = \"b:front\"\nnormal = 0",
            "on = \"b:back\"\ndisplacement = [\"1e-3*y/(1 + z^2)\", \"1e-3*y/(1 + z^2)\", \"free\"]",
        ] {
            let found = summary(&case(degree, second), &set(&[]));
            assert_eq!(found["converged"], true, "degree {degree}, {second}: {}", found["verdict"]);
            let step = last_step(&found);
            for axis in 0..3 {
                let of = |kind: &str| {
                    let list = step[kind].as_object().unwrap().values();
                    list.map(|v| number(v.get("force").unwrap_or(v).get(axis).unwrap())).sum::<f64>()
                };
                let sum = of("support_forces") + of("load_forces") + of("contacts");
                // Newton's method ends at 1e-10 of the largest force.
                assert!(sum.abs() < 1e-11, "degree {degree}, {second}, axis {axis}: {sum:e}");
            }
        }
    }
    let contradiction = case(2, "on = \"b:back\"\ndisplacement = [\"1.001e-3*y/(1 + z^2)\", 0, 0]");
    let told = error(&contradiction).message;
    assert!(told.contains("contradict each other"), "{told}");
}

/// Conditions at quadrature points are more than the surface can follow: repeated penalties end at the force of the multipliers,
/// or say what to use instead.
#[test]
fn augmented_lagrangians_at_quadrature_points_end_or_say_so() {
    let case: Vec<&str> = example("patch_test").lines().filter(|line| !line.starts_with("method")).collect();
    let at_points = "$0\nmethod.gauss_point = { enforcement.augmented_lagrangian = {} }";
    let line = case.iter().find(|line| line.starts_with("between")).unwrap();
    let found = summary(&case.join("\n").replace(line, &at_points.replace("$0", line)), &set(&[]));
    let verdict = found["verdict"].as_str().unwrap();
    if found["converged"] == false {
        assert!(found["reason"] == "contact" && verdict.contains("enforcement.multiplier"), "{verdict}");
    } else {
        assert!((at(last_step(&found), "/contacts/interface/force/2") / -10.0 - 1.0).abs() < 1e-6, "{verdict}");
    }
}

pub fn at(step: &Value, place: &str) -> f64 {
    number(step.pointer(place).unwrap_or_else(|| panic!("{place} is not there")))
}

/// A force on a head that is kept straight is the force of the contact, and the same in all units.
#[test]
fn one_case_in_three_units() {
    // The theory of Hertz is that of small sliding.
    let small = set(&[("contacts.touch.sliding", "\"small\"".to_string())]);
    let plain = summary(example("cylinder_on_block"), &small);
    let millimetres = last_step(&plain);
    assert!((at(millimetres, "/contacts/touch/force/1") / 17500.0 - 1.0).abs() < 1e-9);
    // NAFEMS CB-1: Hertz has 6.2146 mm and 3585.4 N/mm²; the finite bodies differ by what they are.
    assert!((at(millimetres, "/contacts/touch/max_pressure") / 3585.37 - 1.0).abs() < 5e-3);
    let case = example("cylinder_on_block")
        .replace("\"mm-N-MPa\"", "\"m-N-Pa\"")
        .replace("R = 50", "R = 0.05")
        .replace("y/50*(50 - R", "y/0.05*(0.05 - R")
        .replace("youngs_modulus = 70000", "youngs_modulus = \"70 GPa\"")
        .replace("youngs_modulus = 210000", "youngs_modulus = \"210 GPa\"")
        .replace("-17500*t", "(-17.5e6*t) N/m")
        .replace("from = 0, to = [8, 100]", "from = 0, to = [\"8 mm\", \"100 mm\"]")
        .replace("from = -200, to = [-5, 0]", "from = \"-200 mm\", to = [\"-5 mm\", 0]")
        .replace("from = 0, to = [10, 45]", "from = 0, to = [\"10 mm\", \"45 mm\"]")
        .replace("from = 0, to = [6, 50]", "from = 0, to = [\"6 mm\", \"50 mm\"]");
    let other = summary(&case, &small);
    let metres = last_step(&other);
    for (place, factor) in
        [("/contacts/touch/area", 1e3), ("/contacts/touch/max_pressure", 1e-6), ("/contacts/touch/force/1", 1e-3)]
    {
        let (a, b) = (at(millimetres, place), factor * at(metres, place));
        assert!((a / b - 1.0).abs() < 1e-9, "{place}: {a} and {b}");
    }
    assert_eq!(millimetres["iterations"], metres["iterations"]);
}

/// Results do not depend on the number of threads.
#[test]
fn one_and_two_threads() {
    let [one, two] = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| summary(example("torus"), &set(&[("bodies.block.solid.degree", "1".into())])))
    });
    assert_eq!(one["steps"], two["steps"]);
}

/// A parabola as a height and as a level set, and the circle and the ellipse that osculate it, press a block alike; a
/// rotation about its own centre does not move a circle.
#[test]
fn rigid_shapes_of_one_curvature_agree() {
    let case = |shape: &str, motion: &str| {
        format!(
            "space = \"plane_strain\"\n[bodies.block.solid]\n\
             mesh.box = {{ min = [-1, 0], max = [1, 1], cells = [20, 5] }}\ndegree = 2\n\
             material.linear_elastic = {{ youngs_modulus = 10, poissons_ratio = 0.3 }}\n\
             [bodies.bump.rigid]\n{shape}\n{motion}\n\
             [supports.top]\non = \"block:top\"\ndisplacement = [0, \"-0.02*t\"]\n\
             [contacts.touch]\nbetween = [\"block:bottom\", \"bump\"]\n[[steps]]\nto = 1\n"
        )
    };
    let force =
        |shape: &str, motion: &str| at(last_step(&summary(&case(shape, motion), &set(&[]))), "/contacts/touch/force/1");
    let height = force("shape.height = \"-0.3*x^2\"", "");
    let level_set = "shape.level_set = { negative_inside = \"y + 0.3*x^2\", min = [-2, -2], max = [2, 1] }";
    assert!((force(level_set, "") / height - 1.0).abs() < 1e-9);
    let circle = "shape.cylinder = { point = [0, -1.6666666666666667], radius = 1.6666666666666667 }";
    let plain = force(circle, "");
    assert!((plain / height - 1.0).abs() < 1e-3);
    assert!((force(circle, "motion.prescribed = { rotation = [\"2*t\"] }") / plain - 1.0).abs() < 1e-10);
    let ellipse = "shape.ellipsoid = { center = [0, -1], semi_axes = [1.2909944487358056, 1] }";
    assert!((force(ellipse, "") / height - 1.0).abs() < 1e-3);
    // Upside down it is itself too, on its side it is not.
    let turned = |angle: f64| force(ellipse, &format!("motion.prescribed = {{ rotation = [\"{angle}*t\"] }}"));
    assert!((turned(std::f64::consts::PI) / force(ellipse, "") - 1.0).abs() < 1e-8);
    assert_eq!(turned(0.0), force(ellipse, ""));
    // Lifted by a hundredth instead of the block lowered by as much more.
    let lifted = force(circle, "motion.prescribed = { displacement = [0, \"0.01*t\"] }");
    assert!(lifted > 1.3 * plain);
}

/// The half width of `hertz` is 2.444551 by other means (see the tests of the crate for solids).
#[test]
fn errors_and_large_strains_are_told() {
    let found = summary(example("hertz"), &set(&[]));
    let step = last_step(&found);
    let estimate = at(step, "/contacts/touch/error_estimate/area");
    assert!((at(step, "/contacts/touch/area") - 2.444551).abs() < estimate && estimate < 0.02, "{estimate}");
    assert!(found["verdict"].as_str().is_some_and(|v| v.contains("over length 2.439 ± 1e-2")), "{}", found["verdict"]);
    let slides = summary(
        example("hertz"),
        &set(&[("contacts.touch.sliding", "\"finite\"".to_string()), ("steps", "[{ to = 1.0 }]".to_string())]),
    );
    let contact = &last_step(&slides)["contacts"]["touch"];
    let estimate = at(contact, "/error_estimate/area");
    assert!((at(contact, "/area") - 2.444551).abs() < estimate && estimate < 0.02, "sliding: {estimate}");
    // The finer functions of linear cells stand on curves of degree 2 too, not on the facets.
    let linear = [("bodies.block.solid.degree", "1".to_string()), ("steps", "[{ to = 1.0 }]".to_string())];
    let linear = summary(example("hertz"), &set(&linear));
    let contact = &last_step(&linear)["contacts"]["touch"];
    let estimate = at(contact, "/error_estimate/max_pressure");
    assert!((at(contact, "/max_pressure") - 13.5745).abs() < estimate && estimate < 0.2, "linear: {estimate}");
    let strained = |v: &Value| v["warnings"].to_string().contains("the strain is not small: ");
    assert!(!strained(&found) && strained(&summary(example("punch"), &set(&[]))));
}

/// The heights of a function on a grid, as a CSV file; the entry of a case that names it.
pub fn height_map(folder: &std::path::Path, n: usize, half: f64, height: impl Fn(f64, f64) -> f64) -> String {
    let at = |k: usize| half * (2.0 * k as f64 / (n - 1) as f64 - 1.0);
    let row = |j: usize| (0..n).map(|i| height(at(i), at(j)).to_string()).collect::<Vec<_>>().join(",");
    let path = folder.join(format!("map{n}.csv"));
    std::fs::write(&path, (0..n).map(|j| row(j) + "\n").collect::<String>()).unwrap();
    let h = 2.0 * half / (n - 1) as f64;
    format!("shape.height_map = {{ file = {path:?}, spacing = [{h}, {h}], origin = [{}, {}] }}", -half, -half)
}

/// A height map presses a block as the height does that it samples.
#[test]
fn height_maps_against_solids() {
    let case = |shape: &str| {
        format!(
            "space = \"3d\"\n[bodies.block.solid]\n\
             mesh.box = {{ min = [-1, -1, 0], max = [1, 1, 1], cells = [8, 8, 4] }}\ndegree = 2\n\
             material.linear_elastic = {{ youngs_modulus = 10, poissons_ratio = 0.3 }}\n\
             [bodies.ground.rigid]\n{shape}\n[supports.top]\non = \"block:top\"\ndisplacement = [0, 0, -0.1]\n\
             [contacts.touch]\nbetween = [\"block:bottom\", \"ground\"]\n"
        )
    };
    let force = |shape: &str| at(last_step(&summary(&case(shape), &set(&[]))), "/contacts/touch/force/2");
    let exact = force("shape.height = \"0.05*(cos(2*x)*cos(3*y) - 1)\"");
    let folder = tempfile::tempdir().unwrap();
    let errors = [12, 24].map(|n| {
        let map = height_map(folder.path(), n, 1.3, |x, y| 0.05 * ((2.0 * x).cos() * (3.0 * y).cos() - 1.0));
        (force(&map) / exact - 1.0).abs()
    });
    assert!(errors.iter().all(|e| *e < 2e-5), "{errors:?}");
}

/// Whole bodies, and all bodies: only sides that look at each other meet, however thin the bodies are; and of two plates
/// that lie behind each other the nearer one is met.
#[test]
fn only_what_looks_at_each_other_meets() {
    let case = |height: f64, contacts: &str| {
        format!(
            "space = \"3d\"\n\
             [bodies.lower.solid]\nmesh.box = {{ min = [0, 0, 0], max = [1, 1, {height}], cells = [3, 3, 1] }}\n\
             material.linear_elastic = {{ youngs_modulus = 1000, poissons_ratio = 0.3 }}\n\
             [bodies.upper.solid]\nmesh.box = {{ min = [0, 0, {height}], max = [1, 1, {top}], cells = [2, 2, 1] }}\n\
             material.linear_elastic = {{ youngs_modulus = 1000, poissons_ratio = 0.3 }}\n\
             [bodies.floor.rigid]\nshape.plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}\n\
             [supports.x]\non = \"lower:left\"\ndisplacement = [0, 0, \"free\"]\n\
             [supports.y]\non = \"upper:left\"\ndisplacement = [0, 0, \"free\"]\n\
             [loads.press]\non = \"upper:top\"\npressure = 10\n{contacts}",
            top = 2.0 * height
        )
    };
    let named = "[contacts.a]\nbetween = [\"upper\", \"lower\"]\n[contacts.b]\nbetween = [\"lower\", \"floor\"]\n";
    for height in [0.5, 0.1] {
        let found = summary(&case(height, named), &set(&[]));
        assert!((at(last_step(&found), "/contacts/a/force/2") - 10.0).abs() < 1e-8);
        assert!((at(last_step(&found), "/contacts/b/force/2") - 10.0).abs() < 1e-8);
        let found = summary(&case(height, "[contacts.any]\nall = true\n"), &set(&[]));
        assert!((at(last_step(&found), "/contacts/any_lower_upper/force/2") + 10.0).abs() < 1e-8);
        assert!((at(last_step(&found), "/contacts/any_floor_lower/force/2") + 10.0).abs() < 1e-8);
        assert_eq!(at(last_step(&found), "/contacts/any_floor_upper/area"), 0.0);
        assert_eq!(found["warnings"].as_array().map(Vec::len), Some(0));
    }
}

/// An axisymmetric block under a rigid body on its axis.
fn round(shape: &str, between: &str) -> Value {
    summary(
        &format!(
            r#"
space = "axisymmetric"
[bodies.block.solid]
mesh.box = {{ min = [0, -4], max = [4, 0], cells = [16, 12] }}
degree = 2
material.linear_elastic = {{ youngs_modulus = 100, poissons_ratio = 0.3 }}
[bodies.punch.rigid]
shape.{shape}
motion.prescribed = {{ displacement = [0, "-0.02*t"] }}
[supports.base]
on = "block:bottom"
displacement = [0, 0]
[contacts.touch]
between = {between}
[[steps]]
to = 1
"#
        ),
        &set(&[]),
    )
}

#[test]
fn shapes_stand_on_the_axis_and_come_in_any_order() {
    let force = |shape: &str, between: &str| {
        let summary = round(shape, between);
        number(&last_step(&summary)["contacts"]["touch"]["force"][1])
    };
    let pair = "[\"block:top\", \"punch\"]";
    let ball = force("sphere = { center = [0, 10], radius = 10 }", pair);
    assert!(ball.abs() > 1.0, "{ball}");
    // What is told acts on the first.
    assert_eq!(force("sphere = { center = [0, 10], radius = 10 }", "[\"punch\", \"block:top\"]"), -ball);
    let parabola = force("paraboloid = { apex = [0, 0], axis = [0, 1], radius = 10 }", pair);
    assert!((parabola / ball - 1.0).abs() < 5e-3, "{parabola} and {ball}");
    for other in [
        "cone = { apex = [0, 0], axis = [0, 1], half_angle = 1.54 }",
        "torus = { center = [0, 1], axis = [0, 1], major_radius = 2, minor_radius = 1 }",
    ] {
        assert!(force(other, pair).abs() > 0.1, "{other}");
    }
    for (off, word) in [
        ("cone = { apex = [1, 0], axis = [0, 1], half_angle = 1.4 }", "centred on the axis"),
        ("torus = { center = [0, 1], axis = [1, 1], major_radius = 2, minor_radius = 1 }", "centred on the axis"),
    ] {
        let case = format!(
            "space = \"axisymmetric\"\n[bodies.block.solid]\nmesh.box = {{ min = [0, -4], max = [4, 0], cells = [4, 4] }}\n\
             material.linear_elastic = {{ youngs_modulus = 1, poissons_ratio = 0.3 }}\n[bodies.punch.rigid]\nshape.{off}\n\
             [contacts.touch]\nbetween = {pair}\n"
        );
        assert!(super::error(&case).message.contains(word), "{off}");
    }
}

/// On triangles of degree 2 the ± comes from cells of half the size; the same mesh with cells of half the size is as far off
/// as it says.
#[test]
fn quadratic_triangles_tell_their_error() {
    let case = |degree: usize| {
        format!(
            r#"
space = "plane_strain"
[bodies.ring.solid]
mesh.gmsh = {{ file = "drum.msh", group = "film" }}
degree = {degree}
material.linear_elastic = {{ youngs_modulus = 1000, poissons_ratio = 0.3 }}
[bodies.floor.rigid]
shape.plane = {{ point = [0, -1], normal = [0, 1] }}
[supports.hub]
on = "ring:hole"
displacement = [0, "-0.02*t"]
[contacts.touch]
between = ["ring:rim", "floor"]
[[steps]]
to = 1
[output]
pictures = false
"#
        )
    };
    let of = |degree: usize| {
        let found = summary(&case(degree), &set(&[]));
        let contact = &last_step(&found)["contacts"]["touch"];
        (number(&contact["force"][1]), number(&contact["error_estimate"]["force"]))
    };
    let [(linear, of_linear), (quadratic, of_quadratic)] = [1, 2].map(of);
    // The error at degree 1 is known from degree 2, and that of degree 2 is a part of it.
    assert!(
        (linear - quadratic).abs() < of_linear + of_quadratic,
        "{linear} ± {of_linear}, {quadratic} ± {of_quadratic}"
    );
    assert!(of_quadratic > 1e-6 * quadratic && of_quadratic < 0.3 * of_linear, "{of_quadratic}, {of_linear}");
}

/// A box that a map bends to a ring is closed: a shaft that is too thick presses on it as Lame says, all around.
#[test]
fn a_ring_by_a_map_is_closed() {
    let case = "space = \"plane_strain\"\n[bodies.hub.solid]\ndegree = 2\n\
                material.linear_elastic = { youngs_modulus = 210e3, poissons_ratio = 0.3 }\n\
                mesh.box = { min = [10, 0], max = [20, \"2*pi\"], cells = [4, 48], map = [\"x*cos(y)\", \"x*sin(y)\"] }\n\
                [bodies.shaft.rigid]\nshape.cylinder = { point = [0, 0], radius = 10.02 }\n\
                [supports.rim]\non = \"hub:right\"\ndisplacement = [0, 0]\n\
                [contacts.fit]\nbetween = [\"hub:left\", \"shaft\"]\n[[steps]]\nto = 1\n";
    let found = summary(case, &set(&[]));
    let fit = &last_step(&found)["contacts"]["fit"];
    // u = A r + B / r with u(10) = 0.02, u(20) = 0; the pressure is -sigma_r there.
    let (e, nu) = (210e3, 0.3);
    let b = 0.02 / (1.0 / 10.0 - 10.0 / 400.0);
    let a = -b / 400.0;
    let stiffness = e / ((1.0 + nu) * (1.0 - 2.0 * nu));
    let exact = -stiffness * (a - (1.0 - 2.0 * nu) * b / 100.0);
    for key in ["max_pressure", "min_pressure"] {
        let pressure = number(&fit[key]);
        assert!((pressure / exact - 1.0).abs() < 0.01, "{key}: {pressure}, not {exact}");
    }
    let force = (0..2).map(|k| number(&fit["force"][k]).abs()).fold(0.0, f64::max);
    assert!(force < 1e-6 * exact * 60.0, "{force}");
}

/// Two quarters of rings of NURBS with unlike cells and degrees, glued on their common circle: displacements of Lamé.
#[test]
fn unlike_patches_of_nurbs_are_tied() {
    let ring = |name: &str, [a, b]: [f64; 2], cells: [usize; 2], degree: usize| {
        format!(
            "[bodies.{name}.solid]
mesh.nurbs.degree = [2, 1]
mesh.nurbs.knots = [[0, 0, 0, 1, 1, 1], [0, 0, 1, 1]]
mesh.nurbs.points = [[0, {a}], [{a}, {a}], [{a}, 0], [0, {b}], [{b}, {b}], [{b}, 0]]
mesh.nurbs.weights = [1, 0.7071067811865476, 1, 1, 0.7071067811865476, 1]
mesh.nurbs.cells = {cells:?}
degree = {degree}
material.linear_elastic = {{ youngs_modulus = 1, poissons_ratio = 0.3 }}
[supports.{name}_x]
on = \"{name}:left\"
displacement = [0, \"free\"]
[supports.{name}_y]
on = \"{name}:right\"
displacement = [\"free\", 0]
"
        )
    };
    let case = format!(
        "space = \"plane_strain\"\n{}{}[loads.p]\non = \"inner:bottom\"\npressure = 0.01\n[contacts.weld]
between = [\"inner:top\", \"outer:bottom\"]\ntied = true
[output.probes]\nat_1 = [1, 0]\nat_1_5 = [1.5, 0]\nat_2 = [2, 0]\n",
        ring("inner", [1.0, 1.5], [7, 4], 2),
        ring("outer", [1.5, 2.0], [5, 3], 3)
    );
    let found = summary(&case, &set(&[]));
    for (name, r) in [("at_1", 1.0), ("at_1_5", 1.5), ("at_2", 2.0)] {
        let exact = 0.01 / 3.0 * 1.3 * (0.4 * r + 4.0 / r);
        let moved = number(&last_step(&found)["probes"][name]["displacement"][0]);
        assert!((moved / exact - 1.0).abs() < 1e-4, "{name}: {moved}, not {exact}");
    }
}

/// A stiff curved block of small cells as slave of a soft one of larger cells: the master cannot follow each node of the slave, and
/// the pressure oscillates between its nodes. It is told. Left to the program the soft block is the slave, in whatever order the bodies
/// stand, and what is told acts on the first.
#[test]
fn pressures_that_oscillate_are_told() {
    let case = |contact: &str| {
        format!(
            r#"
space = "plane_strain"
[bodies.stiff.solid]
mesh.box = {{ min = [-1, 0], max = [1, 1], cells = [40, 4], map = ["x", "y + 0.2*x^2*(1 - y)"] }}
degree = 2
material.linear_elastic = {{ youngs_modulus = 1e6, poissons_ratio = 0.3 }}
[bodies.soft.solid]
mesh.box = {{ min = [-2, -1], max = [2, 0], cells = [50, 4] }}
degree = 2
material.linear_elastic = {{ youngs_modulus = 1, poissons_ratio = 0.3 }}
[supports.below]
on = "soft:bottom"
displacement = [0, 0]
[supports.above]
on = "stiff:top"
displacement = [0, -0.02]
[contacts.c]
{contact}
"#
        )
    };
    let told = |contact: &str| {
        let found = summary(&case(contact), &set(&[]));
        let list = found["warnings"].as_array().expect("warnings").clone();
        let is_told = list.iter().any(|w| w["kind"] == "pressure_oscillates");
        let text = found["answer"]["text"].as_str().expect("an answer");
        assert_eq!(is_told, text.contains("oscillates"), "{text}");
        let contact = &found["steps"][0]["contacts"]["c"];
        (
            is_told,
            contact["slave"].as_str().expect("a slave").to_string(),
            contact["force"][1].as_f64().expect("a force"),
        )
    };
    let stiff_first = r#"between = ["stiff:bottom", "soft:top"]"#;
    let (is_told, slave, _) = told(&format!("{stiff_first}\nslave = \"stiff\""));
    assert!(is_told && slave == "stiff");
    let (is_told, slave, up) = told(stiff_first);
    assert!(!is_told && slave == "soft" && up > 0.0);
    let (is_told, slave, down) = told(r#"between = ["soft:top", "stiff:bottom"]"#);
    assert!(!is_told && slave == "soft" && down == -up, "{down}, {up}");
    let message = error(&case(&format!("{stiff_first}\nslave = \"soft:top\"")));
    assert!(message.message.contains("has no body `soft:top`"), "{message}");
}

/// A block with friction that is pushed at its top tips over before it slides, and a rope whose ends pull apart by more than
/// friction holds slides: both are told by name.
#[test]
fn what_tips_and_what_slides_is_named() {
    let tips = r#"
space = "plane_strain"
[bodies.block.solid]
mesh.box = { min = [-5, 0], max = [5, 30], cells = [4, 12] }
degree = 2
material.linear_elastic = { youngs_modulus = 1e6, poissons_ratio = 0.2 }
[bodies.floor.rigid]
shape.plane = { point = [0, 0], normal = [0, 1] }
[loads.weight]
on = "block"
body_force = [0, -0.1]
[loads.push]
on = "block:top"
force = ["6*t", 0]
[contacts.foot]
between = ["block:bottom", "floor"]
friction.coulomb = { mu = 0.5 }
[[steps]]
to = 1
increments = 2
"#;
    let verdict = summary(tips, &set(&[]))["verdict"].as_str().expect("a verdict").to_string();
    assert!(verdict.contains("against turning about (0.000, 0.000, -1.000)"), "{verdict}");
    let slides = r#"
space = "3d"
[bodies.line.rope]
path.helix = { radius = 1, pitch = 0, turns = 0.5, towards = [1, 0, 0] }
cells = 40
stiffness = 1e5
pretension = 1
[bodies.drum.rigid]
shape.cylinder = { point = [0, 0, 0], axis = [0, 0, 1], radius = 1 }
[loads.low]
on = "line:start"
tension = 1
[loads.high]
on = "line:end"
tension = "1 + 2*t"
[contacts.wrap]
between = ["line", "drum"]
friction.coulomb = { mu = 0.3 }
[[steps]]
to = 1
increments = 4
"#;
    let found = summary(slides, &set(&[]));
    let verdict = found["verdict"].as_str().expect("a verdict");
    // e^(0.3 π) = 2.57 at t = 0.78.
    assert!(
        found["converged"] == false && verdict.contains("`wrap` uses 9") && verdict.contains("slides"),
        "{verdict}"
    );
}
