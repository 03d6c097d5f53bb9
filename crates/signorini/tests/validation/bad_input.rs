//! Bad input: every answer names the place, the value and what would be right.

use super::{error, example};
use proptest::prelude::*;

/// Replaces a line of the flat disc, and returns the error with the text it points at.
fn spoiled(from: &str, to: &str) -> (String, String, String) {
    let case = example("flat_disc");
    assert!(case.contains(from), "`{from}` is not in the case");
    let error = error(&case.replace(from, to));
    let place = error.place.clone().unwrap_or_else(|| panic!("no place: {}", error.message));
    let at = place.text[place.span.start..place.span.end.min(place.text.len())].to_string();
    (error.message, at, error.help.unwrap_or_default())
}

#[test]
fn each_mistake_is_told_at_its_place() {
    let table = [
        // what stands, what a user writes, a word of the message, the text pointed at, a word of the help
        ("tension = 1.0\n", "", "missing key `tension`", "[bodies.film.membrane]", "tension"),
        (
            "[contacts.touch]",
            "[contacts.touch]\nfriction = 0.3",
            "expected a choice",
            "0.3",
            "friction.coulomb = { mu = … }",
        ),
        ("tension = 1.0", "tensoin = 1.0", "unknown key `tensoin`", "tensoin", "did you mean `tension`"),
        ("tension = 1.0", "tension = [1]", "expected a number", "[1]", ""),
        ("tension = 1.0", "tension = 0.0", "tension must be positive", "0.0", ""),
        ("tension = 1.0", "tension = \"-1 + x\"", "tension must be positive", "\"-1 + x\"", ""),
        ("tension = 1.0", "tension = \"1 N/m\"", "no `units`", "N/m", "units ="),
        ("tension = 1.0", "tension = \"1 + coss(x)\"", "unknown function `coss`", "coss", "`cos`"),
        ("tension = 1.0", "tension = \"1 + (x\"", "expected `)`", "", "not closed"),
        ("tension = 1.0", "tension = nan", "not a finite number", "nan", ""),
        ("tension = 1.0", "tension = \"1 + z\"", "unknown name `z`", "z", ""),
        ("degree = 4", "degree = 9", "between 1 and 6", "9", ""),
        ("degree = 4", "degree = 2.5", "a whole number", "2.5", ""),
        ("cells = [20, 20]", "cells = [0, 20]", "at least one", "0", ""),
        ("cells = [20, 20]", "cells = [20]", "expected 2", "[20]", ""),
        ("cells = [20, 20]", "cells = [1000000, 1000]", "GiB", "[1000000, 1000]", "fewer cells"),
        ("cells = [20, 20]", "cells = [9223372036854775807, 9]", "GiB", "9223372036854775807", "fewer cells"),
        ("cells = [20, 20]", "", "`cells` or `cell_size`", "", "cells ="),
        ("radius = 1.0", "radius = -1.0", "must be positive", "-1.0", ""),
        ("domain.disc = { radius = 1.0 }", "domain.dsic = { radius = 1.0 }", "unknown key `dsic`", "dsic", "`disc`"),
        (
            "domain.disc = { radius = 1.0 }",
            "domain.implicit = { negative_inside = \"x^2 + 1\", min = [-1,-1], max = [1,1] }",
            "domain is empty",
            "",
            "negative inside",
        ),
        (
            "domain.disc = { radius = 1.0 }",
            "domain.polygon = { points = [[0,0],[1,1],[1,0],[0,1]] }",
            "cross each other",
            "",
            "order",
        ),
        ("shape.height = \"-0.1\"", "shape.height = \"0.1\"", "`floor` lies above", "\"0.1\"", "lower the body there"),
        (
            "shape.height = \"-0.1\"",
            "shape.height = \"-1/(x-0.3)^2*0 - 0.1 + sqrt(x-0.2)*0\"",
            "it must be finite",
            "",
            "",
        ),
        ("shape.height = \"-0.1\"", "shape.hieght = \"-0.1\"", "unknown key `hieght`", "hieght", "`height`"),
        ("displacement = 0.0", "displacement = \"t\"", "depends on t", "\"t\"", "[[steps]]"),
        ("on = \"film:boundary\"", "on = \"film:edge\"", "no group `edge`", "\"film:edge\"", "boundary"),
        ("on = \"film:boundary\"", "on = \"flim:boundary\"", "no body `flim`", "\"flim:boundary\"", "`film`"),
        ("between = [\"film\", \"floor\"]", "between = [\"film\", \"flor\"]", "no body `flor`", "\"flor\"", "`floor`"),
        ("space = \"plane\"", "space = \"plain\"", "unknown word `plain`", "\"plain\"", "`plane`"),
        ("space = \"plane\"", "space = \"3d\"", "is for solids", "\"3d\"", "plane"),
        ("space = \"plane\"", "space = \"plane", "string", "", ""),
    ];
    for (from, to, word, place, help) in table {
        let (message, at, remedy) = spoiled(from, to);
        assert!(message.contains(word), "`{to}`: {message}");
        assert!(at.contains(place), "`{to}`: points at `{at}`");
        assert!(remedy.contains(help), "`{to}`: {remedy}");
    }
}

#[test]
fn functions_and_constants_may_not_go_in_circles() {
    let case = example("flat_disc");
    let with = |text: &str| error(&case.replace("space = \"plane\"", &format!("space = \"plane\"\n{text}"))).message;
    assert!(
        with("[functions.a]\nexpression = \"b(t)\"\n[functions.b]\nexpression = \"a(t)\"").contains("calls itself")
    );
    assert!(with("[functions.a]\nexpression = \"a(t) + 1\"").contains("calls itself"));
    assert!(with("[constants]\na = \"b\"\nb = \"a\"").contains("depends on itself"));
    assert!(with("[functions.a]\ntable = { t = [0, 0], value = [1, 2] }").contains("does not increase"));
    assert!(with("[functions.a]\ntable = { t = [0], value = [1, 2] }").contains("entries"));
}

#[test]
fn a_load_that_becomes_invalid_later_keeps_what_was_found() {
    let case = example("flat_disc").replace("normal = -1.0", "normal = \"-sqrt(1 - t)\"")
        + "\n[[steps]]\nto = 2.0\nincrements = 4\n";
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let problem = signorini::case::read("case.toml", &case, &[]).expect("a case");
    let result = signorini::run::run(&problem, &out, &mut signorini_solve::Silent);
    assert!(result.is_err());
    let text = std::fs::read_to_string(out.join("summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(summary["converged"], false);
    assert_eq!(summary["steps"].as_array().map(Vec::len), Some(2));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]
    #[test]
    fn no_text_makes_the_reader_panic(text in "\\PC{0,200}") {
        let _ = signorini::case::read("case.toml", &text, &[]);
    }

    #[test]
    fn no_damaged_case_makes_the_planner_panic(at in 0usize..600, cut in 0usize..12, put in "[-=.\"a-z0-9\\[\\]{}()*^ ]{0,6}") {
        let case = example("tilted_floor");
        let at = at.min(case.len());
        let end = (at + cut).min(case.len());
        if case.is_char_boundary(at) && case.is_char_boundary(end) {
            let text = format!("{}{}{}", &case[..at], put, &case[end..]);
            if let Ok(problem) = signorini::case::read("case.toml", &text, &[]) {
                let _ = signorini::plan::plan(&problem);
            }
        }
    }
}

/// A block under a ball in space, as coarse as can be.
fn ball(height: f64, motion: &str, more: &str) -> String {
    format!(
        r#"
space = "3d"
[bodies.block.solid]
mesh.box = {{ min = [-2, -2, -2], max = [2, 2, 0], cells = [4, 4, 2] }}
material.linear_elastic = {{ youngs_modulus = 100, poissons_ratio = 0.3 }}
[bodies.ball.rigid]
shape.sphere = {{ center = [0, 0, {height}], radius = 5 }}
motion.prescribed = {{ displacement = [0, 0, "{motion}"] }}
[supports.base]
on = "block:bottom"
displacement = [0, 0, 0]
[contacts.touch]
between = ["ball", "block:top"]
[[steps]]
to = 1
increments = 2
{more}
"#
    )
}

/// What `check` says of a case: the message of an error, or its warnings.
fn checked(case: &str) -> Result<String, String> {
    let check = || {
        let problem = signorini::case::read("case.toml", case, &[])?;
        signorini::run::sizes(&signorini::plan::plan(&problem)?)
    };
    check().map(|sizes| sizes["warnings"].to_string()).map_err(|e| e.message)
}

#[test]
fn a_check_refuses_what_a_run_refuses() {
    let twice = "[supports.more]\non = \"block:bottom\"\ndisplacement = [0, 0, \"t*(t - 0.5)\"]";
    for (case, word) in [
        (ball(3.0, "-0.1*t", ""), "starts 2."),
        // Where they first contradict each other is the end of the second increment.
        (ball(5.0, "-0.1*t", twice), "contradict each other"),
    ] {
        let message = checked(&case).expect_err(word);
        assert!(message.contains(word), "{message}");
        assert_eq!(error(&case).message, message);
    }
    assert!(checked(&ball(5.0, "-0.1*t", "")).is_ok());
    // At t = 0 alone nothing that depends on time would happen.
    let without_steps = ball(5.0, "-0.1*t", "").replace("[[steps]]\nto = 1\nincrements = 2\n", "");
    assert!(checked(&without_steps).is_err_and(|m| m.contains("depends on t, but there are no steps")));
    // Increments that are too large are cut.
    let found = super::summary(&ball(5.0, "-0.9*t", ""), &super::set(&[]));
    assert_ne!(found["steps"][0]["reason"], "increment", "{}", found["verdict"]);
    // The height of this ball is sought: it lies above the membrane at the end of the step, which is never reached.
    assert!(checked(example("ball")).is_ok());
    // A field that is invalid between the first time and the last.
    let dip = example("flat_disc").replace("tension = 1.0", "tension = \"abs(t - 0.5) - 0.01\"")
        + "\n[[steps]]\nto = 1.0\nincrements = 4\n";
    assert!(checked(&dip).is_err_and(|m| m.contains("tension must be positive")));
}

#[test]
fn a_body_without_a_kind_is_told_which_there_are() {
    for body in ["[bodies.x]", "bodies.x = {}", "[bodies]\nx = {}", "[bodies.x]\nsolid = {}\nrigid = {}"] {
        let e = error(&format!("space = \"plane\"\n{body}\n"));
        assert!(e.message.contains("`x`"), "{body}: {}", e.message);
        assert!(e.help.is_some_and(|h| h.contains("membrane, ") && h.contains("solid")), "{body}");
    }
}

#[test]
fn errors_of_settings_are_told_at_them() {
    let case = example("flat_disc");
    let told = |settings: &[&str]| {
        let settings: Vec<String> = settings.iter().map(|s| s.to_string()).collect();
        let found = signorini::case::read("case.toml", case, &settings)
            .and_then(|d| signorini::run::sizes(&signorini::plan::plan(&d)?));
        let place = found.expect_err("an error").place.expect("a place");
        (place.name.clone(), place.text[place.span.clone()].to_string(), place.line_and_column().0)
    };
    let setting = |s: &[&str], part: &str| assert_eq!(told(s), ("--set".into(), part.into(), 1), "{s:?}");
    setting(&["loads.press.normall=3"], "normall");
    setting(&["bodies.film.membrane.tension=-2"], "-2");
    setting(&["bodies.film.membrane.tension=1 + q"], "q");
    setting(&["title=text", "bodies.film.membrane.degree=77"], "77");
    // What stands in the file keeps its line, also behind what was added.
    let file = case.lines().count();
    let wrong = case.replace("shape.height = \"-0.1\"", "shape.height = \"0.1\"");
    let line = wrong.lines().position(|l| l.contains("shape.height")).expect("a line") + 1;
    let add = ["constants.a=1".to_string(), "bodies.film.membrane.degree=2".to_string()];
    let problem = signorini::case::read("case.toml", &wrong, &add).expect("a case");
    let e = signorini::plan::plan(&problem).and_then(|p| signorini::run::sizes(&p)).expect_err("a floor above");
    let place = e.place.expect("a place");
    assert_eq!((place.name.as_str(), place.line_and_column().0), ("case.toml", line));
    assert!(line <= file);
}

#[test]
fn what_touches_nothing_is_told_why() {
    let flat = |from: &str, to: &str| example("flat_disc").replace(from, to);
    let told = |case: &str| {
        let run = super::summary(case, &super::set(&[]))["verdict"].to_string();
        (checked(case).expect("a case"), run)
    };
    for (case, word) in [
        (flat("normal = -1.0", "normal = 1.0"), "away from the bodies below"),
        (flat("radius = 1.0", "radius = 0.001"), "reduces the gap by only"),
        (flat("normal = -1.0", "normal = -0.2"), "the smallest gap at t = 0 is 5.0000e-2"),
    ] {
        let (check, run) = told(&case);
        assert!(check.contains(word) && run.contains(word), "{word}: {check} {run}");
    }
    assert!(!told(example("flat_disc")).0.contains("is not in contact"));
    let probe =
        |at: &str| checked(&(example("flat_disc").to_string() + "\n[output.probes]\np = " + at)).expect("a case");
    assert!(probe("[3, 0]").contains("probe `p` at (3, 0) lies outside `film`"));
    assert!(!probe("[0.5, 0]").contains("probe"));
    let solid = |at: &str| checked(&ball(5.0, "-0.1*t", &format!("[output.probes]\np = {at}"))).expect("a case");
    assert!(solid("[0, 0, 9]").contains("outside all bodies") && !solid("[0, 0, -1]").contains("outside"));
}

/// A string on few cells of degree 1 does not hang through the floor, nor says a single one that it touches nothing.
#[test]
fn coarse_cells_do_not_let_a_membrane_through() {
    let verdict = |cells: usize| {
        let case = format!(
            "space = \"line\"\n[bodies.film.membrane]\ndomain.interval = [0, 1]\nmesh.grid = {{ cells = [{cells}] }}\ndegree = 1\n\
             tension = 1\n[bodies.floor.rigid]\nshape.height = -1\n[supports.rim]\non = \"film:boundary\"\ndisplacement = 0\n\
             [loads.weight]\non = \"film\"\nnormal = -20\n[contacts.touch]\nbetween = [\"film\", \"floor\"]\n"
        );
        super::summary(&case, &super::set(&[]))
    };
    assert!(verdict(1)["verdict"].to_string().contains("which degree 1 cannot represent"));
    for cells in [2, 3] {
        let length = verdict(cells)["steps"][0]["contacts"]["touch"]["area"].as_f64().expect("a length");
        assert!((length - (1.0 - 2.0 * 0.1f64.sqrt())).abs() < 1e-3, "{length}");
    }
}

/// The volume of a closed surface tells which way round it is: one inside out is turned, told once, by `check` and `run`.
#[test]
fn a_surface_inside_out_is_turned_round_and_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let corner = |k: usize| [6 * (k & 1) as i32 - 3, 3 * (k & 2) as i32 - 3, (k >> 2) as i32];
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let case = |name: &str, order: [usize; 3]| {
        let mut text = String::from("solid box\n");
        for triangle in faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]) {
            let vertex = |k: usize| corner(triangle[order[k]]).map(|x| x.to_string()).join(" ");
            let [a, b, c] = [0, 1, 2].map(vertex);
            text += &format!("facet normal 0 0 0\nouter loop\nvertex {a}\nvertex {b}\nvertex {c}\nendloop\nendfacet\n");
        }
        let path = folder.path().join(name);
        std::fs::write(&path, text + "endsolid\n").expect("a file");
        let stl = format!("shape.stl = {{ file = \"{}\" }}", path.display());
        ball(5.0, "-0.1*t", "").replace("shape.sphere = { center = [0, 0, 5], radius = 5 }", &stl)
    };
    let (outward, inward) = (case("outward.stl", [0, 1, 2]), case("inward.stl", [0, 2, 1]));
    let told = checked(&inward).expect("a case that runs");
    assert_eq!(told.matches("inside out").count(), 1, "{told}");
    assert!(told.contains("inward.stl"), "{told}");
    assert!(!checked(&outward).expect("a case that runs").contains("inside out"));
    let force = |case: &str| {
        let found = super::summary(case, &super::set(&[]));
        (super::last_step(&found)["contacts"]["touch"]["force"].clone(), found["warnings"].to_string())
    };
    let (right, turned) = (force(&outward), force(&inward));
    assert_eq!(right.0, turned.0);
    assert!(turned.1.contains("inside out") && !right.1.contains("inside out"), "{}", turned.1);
}

const ROPE: &str = "space = \"3d\"\n[bodies.drum.rigid]\nshape.cylinder = { point = [0, 0, 0], axis = [0, 0, 1], radius = 1 }\n\
    [bodies.line.rope]\npath.helix = { radius = 1, pitch = 0.2, turns = 0.5 }\ncells = 20\nstiffness = 400\npretension = 1\n\
    [supports.hold]\non = \"line:start\"\ndisplacement = [0, 0, 0]\n[loads.pull]\non = \"line:end\"\ntension = 2\n\
    [contacts.grip]\nbetween = [\"line\", \"drum\"]\n";

const CELLS: &str = "space = \"plane_strain\"\n[bodies.egg.cells]\ngeometry.box = { min = [0, 0], max = [1, 1] }\n\
    mesh.grid = { cells = [2, 2] }\ndegree = 1\nmaterial.linear_elastic = { youngs_modulus = 1, poissons_ratio = 0.3 }\n\
    groups.low = \"y < 0.1\"\n[bodies.plate.rigid]\nshape.plane = { point = [0, 1], normal = [0, -1] }\n\
    motion.prescribed = { displacement = [0, \"-0.01*t\"] }\n[supports.base]\non = \"egg:low\"\ndisplacement = [0, 0]\n\
    [contacts.press]\nbetween = [\"egg:top\", \"plate\"]\n[[steps]]\nto = 1\n";

#[test]
fn mistakes_in_systems_are_told_at_their_places() {
    let twice = "[supports.two]\non = \"line:start\"\ndisplacement = [1, 0, 0]\n[loads.pull]";
    let table = [
        // the case, what stands, what a user writes, a word of the message, the text pointed at, a word of the help
        (ROPE, "[\"line\", ", "[\"line:strat\", ", "no group `strat`", "\"line:strat\"", "did you mean `start`"),
        (CELLS, "egg:top", "egg:tpo", "no group `tpo`", "\"egg:tpo\"", "did you mean `top`"),
        (CELLS, "\"egg:low\"", "\"egg:lwo\"", "no group `lwo`", "\"egg:lwo\"", "did you mean `low`"),
        (
            ROPE,
            "[loads.pull]",
            twice,
            "`hold` and `two` contradict each other",
            "[supports.two]",
            "the same displacement",
        ),
        (ROPE, "displacement = [0, 0, 0]", "displacement = [0, 0]", "expected 3 components", "[0, 0]", "free"),
        (ROPE, "displacement = [0, 0, 0]", "displacement = 0", "expected 3 components", "0", "free"),
        (ROPE, "cells = 20", "cells = 1000000000", "between 1 and 1000000", "1000000000", ""),
        (CELLS, "\"y < 0.1\"", "\"y + 11\"", "must be a condition", "\"y + 11\"", "a comparison"),
        (CELLS, "\"y < 0.1\"", "\"y > 0 && x\"", "must be a condition", "\"y > 0 && x\"", "a comparison"),
    ];
    for (case, from, to, word, at, help) in table {
        assert!(case.contains(from), "`{from}` is not in the case");
        let error = error(&case.replace(from, to));
        let place = error.place.clone().unwrap_or_else(|| panic!("no place: {}", error.message));
        assert!(error.message.contains(word), "{to}: {}", error.message);
        assert_eq!(&place.text[place.span.clone()], at, "{to}");
        assert!(error.help.unwrap_or_default().contains(help), "{to}");
    }
    assert!(checked(&CELLS.replace("\"y < 0.1\"", "\"(y < 0.1)*(x > 0)\"")).is_ok());
}

/// With `all = true` what cannot be tested is left out, and said; stated, it is refused.
#[test]
fn rigid_bodies_without_points_are_not_tested_against_each_other() {
    let case = "space = \"plane_strain\"\n[bodies.inner.rigid]\nshape.ellipsoid = { center = [0, 0], semi_axes = [1, 1] }\n\
        motion.free = { center = [0, 0] }\n[bodies.outer.rigid]\nshape.ellipsoid = { center = [0, 0], semi_axes = [3, 3] }\n\
        side = \"inside\"\n[bodies.roller.solid]\nmaterial.linear_elastic = { youngs_modulus = 100, poissons_ratio = 0.3 }\n\
        mesh.box = { min = [-0.5, -3], max = [0.5, -1], cells = [2, 4] }\n[supports.cage]\non = \"roller\"\nspring = [1, 1]\n\
        [supports.axle]\non = \"inner\"\ndisplacement = [\"free\", \"free\"]\nrotation = [0]\n[contacts.touch]\nall = true\n";
    let told = checked(case).expect("a case that runs");
    assert!(told.contains("contact between `inner` and `outer` is not tested"), "{told}");
    let error = error(&case.replace("all = true", "between = [\"inner\", \"outer\"]"));
    assert!(error.message.contains("neither of the two rigid bodies"), "{}", error.message);
    assert_eq!(error.place.expect("a place").line_and_column().0, 18);
}

/// Where a function has no value is told at its key; where its derivative alone has none, away from the surface, it serves.
#[test]
fn level_sets_need_derivatives_at_the_surface_only() {
    let case = "analysis = \"euler_eytelwein\"\n[bodies.drum.rigid]\nshape.level_set = { negative_inside = \
        \"hypot(x, y) - (1 + 0.05*cos(3*atan2(y, x)))\", min = [-1.5, -1.5, -1.0], max = [1.5, 1.5, 1.0], cells = 12 }\n\
        [ropes.rope]\non = \"drum\"\npath.formula = { position = [\"(1 + 0.05*cos(3*u))*cos(u)\", \
        \"(1 + 0.05*cos(3*u))*sin(u)\", \"0\"], from = 0, to = 1 }\nfriction.coulomb = { mu = 0.3 }\n";
    let read = |case: &str| signorini::paths::PathCase::parse("case.toml", case, &[]);
    assert!(read(case).is_ok());
    let error = read(&case.replace("hypot(x, y)", "sqrt(x - y)")).err().expect("no value where x < y");
    assert!(error.message.contains("`negative_inside`: it is NaN at ("), "{}", error.message);
    let place = error.place.expect("a place");
    assert!(place.text[place.span.clone()].starts_with("\"sqrt(x - y)"), "{:?}", place.span);
}

/// A membrane that a body touches and leaves again is not said to touch nothing.
#[test]
fn what_touches_in_between_is_not_said_to_touch_nothing() {
    let case = "space = \"line\"\n[bodies.film.membrane]\ndomain.interval = [0, 1]\nmesh.grid = { cells = [8] }\ndegree = 2\n\
        tension = 1\n[bodies.ball.rigid]\nshape.sphere = { center = [0.5, -0.55], radius = 0.5 }\n\
        motion.prescribed = { displacement = [0, \"0.1*min(t, 2 - t)\"] }\n[supports.rim]\non = \"film:boundary\"\n\
        displacement = 0\n[contacts.touch]\nbetween = [\"film\", \"ball\"]\n[[steps]]\nto = 1\nincrements = 2\n\
        [[steps]]\nto = 2\nincrements = 2\n";
    assert!(!checked(case).expect("a case that runs").contains("is not in contact"));
    let found = super::summary(case, &super::set(&[]));
    let verdict = found["verdict"].to_string();
    assert!(verdict.contains("it was in contact at t = 1"), "{verdict}");
    // A body that stays away is told.
    let away = case.replace("0.1*min", "0.01*min");
    assert!(checked(&away).expect("a case that runs").contains("is not in contact"));
}
