//! Ropes, beams, free rigid bodies and solids in one system, beside closed forms; mistakes told at their place.

use super::{error, example, last_step, number, set, summary};
use serde_json::Value;

/// A rope along a parallel of a sphere, orthotropic, pulled to a part of what the theorem of Euler and Eytelwein admits.
fn parallel(colatitude: f64, tension: f64) -> Value {
    let case = format!(
        r#"
space = "3d"
[constants]
psi = "{colatitude}*pi/180"
[bodies.rope.rope]
path.helix = {{ center = [0, 0, "cos(psi)"], radius = "sin(psi)", pitch = 0, turns = 0.5, towards = [1, 0, 0] }}
cells = 64
stiffness = 1e5
pretension = 1.0
[bodies.ball.rigid]
shape.sphere = {{ center = [0, 0, 0], radius = 1 }}
[supports.held]
on = "rope:start"
displacement = [0, 0, 0]
[loads.pull]
on = "rope:end"
tension = "exp(t*log({tension}))"
[contacts.wrap]
between = ["rope", "ball"]
friction.coulomb = {{ mu = [0.25, 0.6], axis = "tangent" }}
[[steps]]
to = 1
increments = 5
"#
    );
    summary(&case, &set(&[]))
}

#[test]
fn a_rope_on_a_parallel_holds_where_the_theorem_says_so() {
    // ln T/T0 = μ_τ φ sin ψ √(1 - (cot ψ/μ_g)²) at 80 degrees; at 55 the geodesic curvature asks for more than μ_g.
    let most = 0.739_312_134f64;
    let held = parallel(80.0, (0.99 * most).exp());
    let rope = &last_step(&held)["curves"]["rope"];
    assert!((number(&rope["end_tension"]) / (0.99 * most).exp() - 1.0).abs() < 1e-8, "{rope}");
    // With everything slipping, the held end keeps what friction leaves.
    assert!((number(&rope["start_tension"]) - 1.0).abs() < 0.02, "{rope}");
    assert_eq!(last_step(&parallel(62.0, 1.0005))["contacts"]["wrap"]["slip_area"], 0.0);
    assert_eq!(parallel(55.0, 1.01)["converged"], false);
}

#[test]
fn a_rope_round_a_drum_slips_as_far_as_its_tension_says() {
    let case = example("capstan");
    let found = summary(case, &set(&[("constants.pull", "2.4".into())]));
    let step = last_step(&found);
    let rope = &step["curves"]["rope"];
    assert!((number(&rope["start_tension"]) - 1.0).abs() < 1e-4, "{rope}");
    // The slip zone ends where exp(-μ φ) brings the tension down to the one at the start: to a cell.
    let (cells, whole) = (60.0, 1.5 * std::f64::consts::PI);
    let slips = number(&step["contacts"]["wrap"]["slip_area"]) / 1.02;
    assert!((slips - 2.4f64.ln() / 0.3).abs() < 1.5 * whole / cells, "{slips}");
    for step in found["steps"].as_array().unwrap() {
        assert!(number(&step["equilibrium_residual"]) < 1e-8);
    }
}

/// The 45-degree bend (Bathe & Bolourchi 1979) against the converged tip of 32 elements.
#[test]
fn the_bend_of_45_degrees_comes_to_its_tip() {
    let case = r#"
space = "3d"
[bodies.arm.beam]
path.arc = { points = [[0, 0, 0], ["100*sin(pi/8)", "100*(1 - cos(pi/8))", 0], ["100*sin(pi/4)", "100*(1 - cos(pi/4))", 0]] }
cells = 16
section.stiffness = { EA = 1e7, GA = 5e6, EI = 833333.3333333333, GJ = 833333.3333333333 }
[supports.clamp]
on = "arm:start"
displacement = [0, 0, 0]
rotation = [0, 0, 0]
[loads.tip]
on = "arm:end"
force = [0, 0, "600*t"]
[[steps]]
to = 1
[output]
probes.tip = ["100*sin(pi/4)", "100*(1 - cos(pi/4))", 0]
"#;
    let found = summary(case, &set(&[]));
    let tip = &last_step(&found)["probes"]["tip"];
    let at = [0, 1, 2].map(|k| number(&tip["at"][k]) + number(&tip["displacement"][k]));
    // The curve is along x here, along y in the literature.
    for (found, wanted) in at.iter().zip([47.150_44, 15.684_8, 53.474_86]) {
        assert!((found - wanted).abs() < 2e-2, "{at:?}");
    }
}

#[test]
fn a_neo_hookean_bar_is_stretched_as_its_law_says() {
    let case = r#"
space = "3d"
[bodies.bar.solid]
mesh.box = { min = [0, 0, 0], max = [1, 1, 1], cells = [2, 1, 1] }
degree = 1
strain = "finite"
material.neo_hooke = { youngs_modulus = 2.6, poissons_ratio = 0.3 }
[supports.x]
on = "bar:left"
normal = "0.25*t"
[supports.y]
on = "bar:front"
normal = 0
[supports.z]
on = "bar:bottom"
displacement = ["free", "free", 0]
[supports.pull]
on = "bar:right"
normal = "0.25*t"
[[steps]]
to = 1
increments = 2
"#;
    let mapped =
        |x: &str| case.replace("cells = [2, 1, 1]", &format!("cells = [2, 1, 1], map = [\"{x}\", \"y\", \"z\"]"));
    assert!(
        error(&mapped("x + 0.2*y^2").replace("cells = [2, 1, 1]", "cells = [2, 2, 1]"))
            .message
            .contains("`normal` requires a flat group")
    );
    // Pulled along the normals of slanted ends, in balance and with the work that is stored.
    let slanted = summary(&mapped("x + 0.2*y"), &set(&[]));
    let pull: Vec<f64> = (0..2).map(|k| number(&last_step(&slanted)["support_forces"]["pull"][k])).collect();
    assert!(pull[0] > 0.0 && (pull[1] / pull[0] + 0.2).abs() < 1e-9, "{pull:?}");
    let found = summary(case, &set(&[]));
    let force = number(&last_step(&found)["support_forces"]["pull"][0]);
    // μ = 1, λ = 1.5: the stretch across makes its stress vanish.
    let (mu, lambda, stretch) = (1.0f64, 1.5f64, 1.5f64);
    let across = |b: f64| mu * (b - 1.0 / b) + 0.5 * lambda * ((stretch * b * b).powi(2) - 1.0) / b;
    let (mut low, mut high) = (0.5, 1.0);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if across(middle) < 0.0 { low = middle } else { high = middle }
    }
    let b = 0.5 * (low + high);
    let wanted = mu * (stretch - 1.0 / stretch) + 0.5 * lambda * ((stretch * b * b).powi(2) - 1.0) / stretch;
    assert!((force - wanted).abs() < 1e-8, "{force} {wanted}");
}

#[test]
fn a_system_goes_on_to_the_same_digits() {
    use signorini::run::{Silent, resume, run};
    use signorini_solve::{Iteration, Progress};
    struct Stop(usize);
    impl Progress for Stop {
        fn iteration(&mut self, i: &Iteration) {
            self.0 = self.0.max(i.step);
        }
        fn interrupted(&self) -> bool {
            self.0 >= 3
        }
    }
    let case =
        signorini::case::read("case.toml", &example("capstan").replace("increments = 10", "increments = 5"), &set(&[]))
            .unwrap_or_else(|e| panic!("{}", e.one_line()));
    let folder = tempfile::tempdir().unwrap();
    let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
    run(&case, &whole, &mut Silent).unwrap();
    run(&case, &parts, &mut Stop(0)).unwrap();
    resume(&case, &parts, &mut Silent).unwrap();
    let read = |path: &std::path::Path| std::fs::read_to_string(path.join("history.csv")).unwrap();
    assert_eq!(read(&whole), read(&parts));
}

/// A rope that a winch takes in, and one that runs through a pulley: straight, by the law of its material.
const WINCH: &str = r#"
space = "3d"
[bodies.rope.rope]
path.points = [[0, 0, 0], [4, 0, 3]]
cells = 20
stiffness = 1e4
pretension = 10
winch = { at = "end", length = "-0.3*t" }
[supports.start]
on = "rope:start"
displacement = [0, 0, 0]
[supports.winch]
on = "rope:end"
displacement = [0, 0, 0]
[[steps]]
to = 1
increments = 3
"#;

const PULLEY: &str = r#"
space = "3d"
[bodies.rope.rope]
path.points = [[0, 0, 0], [3, 0, 0], [3, -1, 0]]
cells = 4
stiffness = 100
pulleys = [[3, 0, 0]]
[supports.start]
on = "rope:start"
displacement = [0, 0, 0]
[supports.pulley]
on = "rope:pulley_1"
displacement = [0, 0, 0]
[supports.end]
on = "rope:end"
displacement = [0, "-0.2*t", 0]
[[steps]]
to = 1
increments = 2
"#;

#[test]
fn winches_and_pulleys_keep_account_of_the_rope() {
    let found = summary(WINCH, &set(&[]));
    let rope = &last_step(&found)["curves"]["rope"];
    let length = 5.0 / 1.001 - 0.3;
    assert!((number(&rope["unstrained_length"]) / length - 1.0).abs() < 1e-12, "{rope}");
    let tension = 1e4 * (5.0 / length - 1.0);
    assert!((number(&rope["start_tension"]) / tension - 1.0).abs() < 1e-8, "{rope}");
    assert!((number(&rope["end_tension"]) / tension - 1.0).abs() < 1e-8, "{rope}");
    let found = summary(PULLEY, &set(&[]));
    let rope = &last_step(&found)["curves"]["rope"];
    for key in ["start_tension", "end_tension"] {
        assert!((number(&rope[key]) / (100.0 * (4.2 / 4.0 - 1.0)) - 1.0).abs() < 1e-8, "{rope}");
    }
    assert!((number(&rope["unstrained_length"]) - 4.0).abs() < 1e-12, "{rope}");
    // The mistakes that can be made with them.
    let table = [
        (WINCH, "\"rope:end\"", "\"rope:start\"", "has a winch but no support", "end"),
        (WINCH, "-0.3*t", "-6*t", "are taken in", "-6*t"),
        (WINCH, "-0.3*t", "1/(t - t)", "not a finite number", "1/(t - t)"),
        (WINCH, "cells = 20", "cells = 20\ncontinuity = \"C1\"", "straight elements", "end"),
        (PULLEY, "[[3, 0, 0]]", "[[2.9, 0, 0]]", "the nearest one is at (3.0", "[2.9, 0, 0]"),
        (PULLEY, "[[3, 0, 0]]", "[[0, 0, 0]]", "an end of the rope", "[[0, 0, 0]]"),
        (PULLEY, "pulley_1", "pulley_2", "valid are start, end, boundary, pulleys, pulley_1", "pulley_2"),
    ];
    for (case, from, to, message, at) in table {
        told(&case.replacen(from, to, 1), to, message, at);
    }
}

/// Checks that a mistake is told at its value.
fn told(case: &str, to: &str, message: &str, at: &str) {
    let error = error(case);
    let place = error.place.clone().unwrap_or_else(|| panic!("no place: {}", error.message));
    let shown = place.text[place.span.start..place.span.end.min(place.text.len())].to_string();
    assert!(error.message.contains(message), "{to}: `{}` has no `{message}`", error.message);
    assert!(shown.contains(at), "{to}: points at `{shown}`, not `{at}`");
}

#[test]
fn mistakes_of_curves_are_told_at_their_place() {
    let friction = "friction.coulomb = { mu = 0.2 }";
    let table = [
        (friction, "friction.viscous = { mu = -0.1, velocity = 0.01 }", "must not be negative", "-0.1"),
        (friction, "friction.viscous = { mu = 0.1, velocity = 0 }", "must be positive", "0"),
        (friction, "friction.viscous = { mu = 0.1, velocity = nan }", "not a finite number", "nan"),
        (friction, "friction.viscous = { mu = 0.1 }", "missing key `velocity`", "{ mu = 0.1 }"),
        ("\"point\"", "\"poynt\"", "unknown word `poynt`", "poynt"),
        ("\"point\"", "3", "expected a choice", "3"),
        ("\"0.7*(u^4 - 4*u^2)\", ", "", "3 coordinates, found 2", "u^3"),
        ("from = -2.1", "from = 2.1", "begins and ends at u = 2.1", "2.1"),
        ("u^3 - 3*u", "sqrt(u)", "NaN at u = -2.1", "sqrt(u)"),
        ("u^3 - 3*u", "u^3 - 3*t", "unknown name `t`", "t"),
        ("u^3 - 3*u", "0*u", "crosses itself", "path"),
    ];
    for (from, to, message, at) in table {
        let case = example("knot");
        assert!(case.contains(from), "`{from}` is not in the case");
        told(&case.replacen(from, to, 1), to, message, at);
    }
    let drum = example("capstan").replacen("shape.cylinder", "smooth = true\nshape.cylinder", 1);
    told(&drum, "smooth", "only triangle meshes", "shape");
}

#[test]
fn what_would_do_nothing_is_told() {
    let held = "on = \"rope:start\"\ndisplacement = [0, 0, 0]";
    let table = [
        (held, "on = \"rope:start\"\nspring = [0, 0, 0]", "all stiffnesses of the spring are zero", "[0, 0, 0]"),
        ("space = \"3d\"", "space = \"3d\"\nview.from = [1, 1, 1]", "`view` is only for pictures of paths", "view"),
    ];
    for (from, to, message, at) in table {
        let case = example("edge");
        assert!(case.contains(from), "`{from}` is not in the case");
        told(&case.replacen(from, to, 1), to, message, at);
    }
    for (to, message) in [
        ("from = [0, 0, 0]", "are parallel, or one of them is zero"),
        ("from = [0, 0, nan]", "three finite components"),
        ("from = [1, 0]", "three finite components"),
    ] {
        let case = example("helix");
        let line = case.lines().find(|l| l.starts_with("view")).unwrap().to_string();
        let case = case.replacen(&line, &format!("view = {{ {to} }}"), 1);
        let error = signorini::paths::PathCase::parse("case.toml", &case, &[]).err().unwrap_or_else(|| panic!("{to}"));
        assert!(error.message.contains(message), "{to}: `{}` has no `{message}`", error.message);
    }
}

#[test]
fn mistakes_of_edges_are_told_at_their_place() {
    let between = "[\"top\", \"right\"]";
    let table = [
        (between, "[\"top\"]", "between 2 groups of sides, found 1", "[\"top\"]"),
        ("\"right\"", "\"rihgt\"", "no group `rihgt`", "rihgt"),
        (between, "[\"left\", \"right\"]", "have no common edge", "[\"left\", \"right\"]"),
        (between, "[\"top\", \"boundary\"]", "it branches at", "[\"top\", \"boundary\"]"),
        (between, "[\"top\", \"top\"]", "have no common edge", "[\"top\", \"top\"]"),
        ("radius = 0.06 }", "radius = -0.2 }", "valid are 0 and larger", "-0.2"),
        ("radius = 0.06 }", "radius = nan }", "not a finite number", "nan"),
        ("radius = 0.06 }", "radios = 0.06 }", "unknown key `radios`", "radios"),
        ("edges.rim", "edges.top", "a group with this name already exists", "between"),
        ("\"block:rim\"", "\"block:rum\"", "has no group `rum`", "block:rum"),
        ("\"block:bottom\"", "\"block:rim\"", "`rim` is an edge, which is only for contact", "block:rim"),
        (
            "[\"rope\", \"block:rim\"]",
            "[\"block:top\", \"block:rim\"]",
            "its own body is possible with other edges",
            "block:top",
        ),
    ];
    for (from, to, message, at) in table {
        let case = example("edge");
        assert!(case.contains(from), "`{from}` is not in the case");
        told(&case.replacen(from, to, 1), to, message, at);
    }
}

#[test]
fn each_mistake_is_told_at_its_place() {
    let table = [
        ("stiffness = 1e4", "stiffness = -1e4", "must be positive", "-1e4"),
        ("pretension = 1.0", "pretension = -1.0", "carries tension only", "-1.0"),
        ("pretension = 1.0", "pretension = nan", "not a finite number", "nan"),
        ("pretension = 1.0", "pretension = 1.0\nunstrained_length = 4.0", "are alternatives", "4.0"),
        ("radius = 0.02", "radius = -0.02", "the radius is -0.02", "-0.02"),
        ("cells = 60", "cells = 0", "is not between 1 and", "0"),
        ("radius = \"R + 0.02\"", "radius = \"0.5*R\"", "deep inside `drum`", "path"),
        ("\"rope:start\"", "\"rope:begin\"", "has no group `begin`", "rope:begin"),
        ("\"rope:end\"", "\"ripe:end\"", "no body `ripe`", "ripe:end"),
        ("tension = \"1 + (pull - 1)*t\"", "force = [0, 0]", "expected 3 components", "[0, 0]"),
        ("tension = \"1 + (pull - 1)*t\"", "tension = \"1/(t - t)\"", "not a finite number", "1/(t - t)"),
        ("{ mu = \"mu\" }", "{ mu = -0.1 }", "must not be negative", "-0.1"),
        ("space = \"3d\"", "space = \"plane_strain\"", "is not possible in this space", "plane_strain"),
        ("friction.coulomb", "method.mortar = {}\nfriction.coulomb", "has no faces", "method"),
        ("[\"rope\", \"drum\"]", "[\"drum\", \"drum\"]", "names `drum` twice", "drum"),
    ];
    for (from, to, message, at) in table {
        let case = example("capstan");
        assert!(case.contains(from), "`{from}` is not in the case");
        told(&case.replacen(from, to, 1), to, message, at);
    }
    // A corner where a smooth curve is asked for.
    let kink = example("capstan").replacen(
        "path.helix = { radius = \"R + 0.02\", axis = [0, 1, 0], towards = [1, 0, 0], pitch = 0.0, turns = 0.75 }",
        "continuity = \"C1\"\npath.points = [[0, 0, 2], [1, 0, 2], [1, 1, 2]]",
        1,
    );
    assert!(error(&kink).message.contains("turns by 90"), "{}", error(&kink).message);
}

#[test]
fn a_body_that_nothing_holds_is_named() {
    let case = example("groove").replace("-0.5*t", "0.5*t");
    let found = summary(&case, &set(&[]));
    assert!(found["converged"] == false && found["reason"] == "free_body", "{}", found["verdict"]);
    assert!(found["verdict"].as_str().unwrap().contains("`ball` is free"), "{}", found["verdict"]);
}

/// Mortar contact where nodes have no function of their own: on the axis of revolution at degree 2, and at a corner that a
/// support holds, which a roller touches first. Fields of friction stay within the cone.
#[test]
fn a_mortar_has_an_equation_for_every_node() {
    let ball = "space = \"axisymmetric\"\n[bodies.b.solid]\n\
                mesh.box = { axes = [{ from = 0, to = [0.2, 4], cells = [8, 8], growth = [1, 1.5] }, \
                { from = -4, to = [-0.2, 0], cells = [8, 5], growth = [0.65, 1] }] }\ndegree = 2\n\
                material.linear_elastic = { youngs_modulus = 1, poissons_ratio = 0.3 }\n\
                [bodies.s.rigid]\nshape.sphere = { center = [0, 1], radius = 1 }\n\
                motion.prescribed = { displacement = [0, \"-0.01*t\"] }\n[supports.b]\non = \"b:bottom\"\ndisplacement = [0, 0]\n\
                [contacts.c]\nbetween = [\"b:top\", \"s\"]\nsliding = \"finite\"\n[[steps]]\nto = 1\n";
    let found = summary(ball, &set(&[]));
    let force = -number(&last_step(&found)["contacts"]["c"]["force"][1]);
    let hertz = 4.0 / 3.0 / (1.0 - 0.09) * 1e-3;
    assert!((force / hertz - 1.03).abs() < 0.03, "{force}, {hertz}");
    let hook = "space = \"plane_strain\"\n[bodies.hook.solid]\nstrain = \"finite\"\ndegree = 1\n\
                material.saint_venant_kirchhoff = { youngs_modulus = 2000, poissons_ratio = 0.38 }\n\
                mesh.box = { min = [0, 0], max = [20, 2], cells = [10, 2] }\n\
                [bodies.catch.rigid]\nshape.cylinder = { point = [22.5, 3], radius = 2 }\n\
                motion.prescribed = { displacement = [\"-t\", 0] }\n[supports.root]\non = \"hook:left\"\ndisplacement = [0, 0]\n\
                [contacts.slide]\nbetween = [\"hook:top\", \"catch\"]\n[[steps]]\nto = 1.2\nincrements = 3\n";
    let found = summary(hook, &set(&[]));
    assert!(number(&last_step(&found)["contacts"]["slide"]["force"][1]) < 0.0);
}

/// A cantilever pressed on a cylinder that is much smaller than its cells passes through it between its points: told.
#[test]
fn cells_longer_than_what_they_touch_are_told() {
    let case = r#"
space = "3d"
[bodies.b.beam]
path.points = [[0, 0, 0], [1000, 0, 0]]
cells = 20
section.stiffness = { EA = 1e8, GA = 1e8, EI = 1e8, GJ = 1e8 }
radius = 5
[bodies.p.rigid]
shape.cylinder = { point = [500, 0, -15.2], axis = [0, 1, 0], radius = 10 }
[supports.c]
on = "b:start"
displacement = [0, 0, 0]
rotation = [0, 0, 0]
[loads.p]
on = "b:end"
force = [0, 0, -2]
[contacts.c]
between = ["b", "p"]
"#;
    let doubts = |cells: &str| summary(case, &set(&[("bodies.b.beam.cells", cells.into())]))["answer"].to_string();
    assert!(doubts("20").contains("of radius 1.500e1 with its own"), "{}", doubts("20"));
    let fine = summary(case, &set(&[("bodies.b.beam.cells", "160".into())]));
    assert_eq!(fine["answer"]["verdict"], "right_within", "{}", fine["answer"]);
    // R = P (3 L/a - 1) a³/… of a cantilever with a stop at its half, of gap .2.
    let force = number(&last_step(&fine)["contacts"]["c"]["force"][2]);
    let [p, l, a, stiffness, gap] = [2.0, 1000.0, 500.0, 1e8, 0.2f64];
    let exact = (p * a * a * (3.0 * l - a) / (6.0 * stiffness) - gap) * 3.0 * stiffness / (a * a * a);
    assert!((force / exact - 1.0).abs() < 0.01, "{force} {exact}");
}
