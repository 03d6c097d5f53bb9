//! What must not change the answer: units, threads, the place of the problem on its grid.

use super::{example, last_step, number, set, summary};
use serde_json::Value;

/// One physical problem, stated in three systems of units.
fn in_units(system: &str, length: f64, pressure: f64) -> Value {
    let case = format!(
        r#"
units = "{system}"
space = "plane"
[bodies.film.membrane]
domain.disc = {{ radius = "0.5 mm" }}
mesh.grid = {{ cells = [30, 30] }}
degree = 2
tension = "(40*(1 + 0.3*x/({length}))) N/m"
[bodies.floor.rigid]
shape.height = "(-4 - 0.8*cos(5*x/({length}))) um"
[supports.rim]
on = "film:boundary"
displacement = "0 um"
[loads.gas]
on = "film"
normal = "-({pressure})*4000*(1 + 0.2*y/({length}))"
[contacts.touch]
between = ["film", "floor"]
"#
    );
    summary(&case, &set(&[]))
}

#[test]
fn units_change_neither_digits_nor_iterations() {
    // The length of 0.5 mm and the pressure of 1 Pa in each system.
    let metre = in_units("m-N-Pa", 0.5e-3, 1.0);
    let base = last_step(&metre);
    let contact = &base["contacts"]["touch"];
    assert!(number(&contact["area"]) > 0.0);
    for (system, length, pressure, unit_length, unit_force) in
        [("mm-N-MPa", 0.5, 1e-6, 1e-3, 1.0), ("um-uN-MPa", 500.0, 1e-6, 1e-6, 1e-6)]
    {
        let other = in_units(system, length, pressure);
        let step = last_step(&other);
        let here = &step["contacts"]["touch"];
        assert_eq!(step["iterations"], base["iterations"], "{system}");
        let same = |a: f64, b: f64| assert!((a / b - 1.0).abs() <= 1e-9, "{system}: {a} and {b}");
        same(number(&here["area"]) * unit_length * unit_length, number(&contact["area"]));
        same(number(&here["force"][2]) * unit_force, number(&contact["force"][2]));
        same(number(&step["energy"]) * unit_length * unit_force, number(&base["energy"]));
    }
}

/// A film over a dish or beside a wall, every quantity with its unit.
fn film(system: &str, space: &str, degree: usize, method: &str, steps: &str) -> Value {
    let load = if steps.is_empty() { "1" } else { "t" };
    let case = format!(
        r#"
units = "{system}"
space = "{space}"
[bodies.film.membrane]
domain.interval = {{ from = 0, to = "150 um" }}
mesh.grid = {{ cells = [60] }}
degree = {degree}
tension = "20 N/m"
[bodies.floor.rigid]
shape.height = "-3 um"
[supports.rim]
on = "film:boundary"
displacement = 0
[loads.gas]
on = "film"
normal = "-(20*{load}) kPa"
[contacts.touch]
between = ["film", "floor"]
{method}
{steps}
"#
    );
    summary(&case, &set(&[]))
}

#[test]
fn units_change_nothing_in_one_dimension() {
    let sticky = "adhesion.energy = \"1 mN/m\"";
    let by_arc = "control.arc_length = { size = 0.1 }";
    let steps = [
        "[[steps]]\nto = 2\nincrements = 3\nevents = 1e-3".to_string(),
        format!("[[steps]]\nto = 1\n[[steps]]\nto = 2\nincrements = 2\n{by_arc}"),
    ];
    let published = "method.inequality_level_set.formulation = \"published\"";
    let cases = [
        ("axisymmetric", 3, "", ""),
        ("axisymmetric", 1, "", &steps[0]),
        ("axisymmetric", 3, sticky, &steps[1]),
        ("axisymmetric", 2, published, ""),
        ("line", 1, "", &steps[0]),
    ];
    for (space, degree, method, steps) in cases {
        let base = film("m-N-Pa", space, degree, method, steps);
        for (system, length, force) in [("mm-N-MPa", 1e-3f64, 1.0), ("um-uN-MPa", 1e-6, 1e-6)] {
            let what = format!("{space}, degree {degree}, {method}, {steps}, {system}");
            let other = film(system, space, degree, method, steps);
            let list = |s: &Value| s["steps"].as_array().cloned().expect("steps");
            let power = if space == "line" { 1 } else { 2 };
            assert_eq!(list(&base).len(), list(&other).len(), "{what}");
            for (a, b) in list(&base).iter().zip(&list(&other)) {
                for key in ["iterations", "iterations_before"] {
                    assert_eq!(a[key], b[key], "{what}");
                }
                let same = |a: f64, b: f64| assert!((a - b).abs() <= 1e-9 * a.abs(), "{what}: {a} and {b}");
                let [here, there] = [a, b].map(|step| &step["contacts"]["touch"]);
                same(number(&here["area"]), number(&there["area"]) * length.powi(power));
                // The force on a string is one per length across it.
                same(number(&here["force"][2]), number(&there["force"][2]) * force * length.powi(power - 2));
                same(number(&a["time"]), number(&b["time"]));
            }
            let events = |s: &Value| s["events"].as_array().map_or(0, Vec::len);
            assert_eq!(events(&base), events(&other), "{what}");
        }
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let mut summary = pool.install(|| summary(example("flat_disc"), &set(&[])));
        summary["environment"] = Value::Null;
        summary
    };
    assert_eq!(run(1), run(2));
}

#[test]
fn moving_the_problem_over_its_grid_changes_less_than_the_discretisation_error() {
    // The same disc in a box that is not centred on it.
    let area = |dx: f64, dy: f64| {
        let case = example("flat_disc").replace(
            "domain.disc = { radius = 1.0 }",
            &format!(
                "domain.implicit = {{ negative_inside = \"x^2 + y^2 - 1\", min = [{}, {}], max = [{}, {}] }}",
                -1.1 + dx,
                -1.1 + dy,
                1.1 + dx,
                1.1 + dy
            ),
        );
        number(&last_step(&summary(&case, &set(&[])))["contacts"]["touch"]["area"])
    };
    let exact = std::f64::consts::PI * 0.502474357083085f64.powi(2);
    for (dx, dy) in [(0.0, 0.0), (0.031, -0.017), (0.05, 0.0499)] {
        assert!((area(dx, dy) - exact).abs() < 1e-8, "shift {dx}, {dy}");
    }
}

/// Three balls that fall into a narrow box with friction, in a unit of length.
fn balls(unit: f64) -> Value {
    let mut case = String::from("space = \"3d\"\n");
    let list = [[0.505, 0.5, 0.012, 0.428], [1.592, 0.5, -0.04, 0.44], [0.53, 1.51, 0.006, 0.474]];
    for (k, [x, z, y, radius]) in list.iter().enumerate() {
        let [center, radius, weight] = [
            format!("[{}, {}, {}]", x * unit, y * unit, z * unit),
            (radius * unit).to_string(),
            (8.0 * radius.powi(3)).to_string(),
        ];
        case += &format!(
            "[bodies.ball{k}.rigid]\nshape.sphere = {{ center = {center}, radius = {radius} }}\nmotion.free = {{}}\n"
        );
        case += &format!("[loads.weight{k}]\non = \"ball{k}\"\nforce = [0, 0, -{weight}]\n");
    }
    let walls: [[f64; 6]; 5] = [
        [0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
        [2.1, 0.0, 0.0, -1.0, 0.0, 0.0],
        [0.0, -0.5, 0.0, 0.0, 1.0, 0.0],
        [0.0, 0.5, 0.0, 0.0, -1.0, 0.0],
    ];
    for (k, [x, y, z, a, b, c]) in walls.iter().enumerate() {
        let point = format!("[{}, {}, {}]", x * unit, y * unit, z * unit);
        case += &format!("[bodies.wall{k}.rigid]\nshape.plane = {{ point = {point}, normal = [{a}, {b}, {c}] }}\n");
    }
    case += "[contacts.all]\nall = true\nfriction.coulomb = { mu = 0.3 }\n";
    summary(&case, &set(&[]))
}

#[test]
fn the_unit_of_length_does_not_choose_where_balls_come_to_rest() {
    let [metre, millimetre] = [1.0, 1000.0].map(balls);
    for k in 0..3 {
        let place = |found: &Value, unit: f64| {
            let moved = last_step(found)["free_bodies"][format!("ball{k}")]["displacement"].clone();
            [0, 1, 2].map(|i| number(&moved[i]) / unit)
        };
        let [a, b] = [place(&metre, 1.0), place(&millimetre, 1000.0)];
        let apart = (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-11 && a[2].abs() > 1e-3, "ball {k}: {a:?} and {b:?}");
    }
}

/// A curved block pressed on another one by nodes, in units in which areas are much larger than forces.
#[test]
fn units_do_not_decide_when_solids_are_solved() {
    let pressed = |length: f64, modulus: f64| {
        let [l, e] = [length, modulus];
        let case = format!(
            r#"
space = "plane_strain"
[constants]
l = {l:?}
[bodies.top.solid]
mesh.box = {{ min = ["-0.5*l", 0], max = ["0.5*l", "0.6*l"], cells = [6, 3], map = ["x", "y + 0.4*x^2/l*(1 - y/(0.6*l))"] }}
material.linear_elastic = {{ youngs_modulus = {}, poissons_ratio = 0.3 }}
[bodies.low.solid]
mesh.box = {{ min = ["-l", "-l"], max = ["l", 0], cells = [11, 3] }}
material.linear_elastic = {{ youngs_modulus = {}, poissons_ratio = 0.2 }}
[supports.head]
on = "top:top"
displacement = [0, "-0.03*l*t"]
[supports.ground]
on = "low:bottom"
displacement = [0, 0]
[contacts.c]
between = ["top:bottom", "low:top"]
method.node = {{}}
friction.coulomb = {{ mu = 0.3 }}
[[steps]]
to = 1
"#,
            1000.0 * e,
            700.0 * e
        );
        let found = summary(&case, &set(&[]));
        let step = last_step(&found).clone();
        (number(&step["contacts"]["c"]["force"][1]) / (l * e), step["iterations"].clone())
    };
    let [usual, tiny] = [(1.0, 1.0), (1e6, 1e-6)].map(|(l, e)| pressed(l, e));
    assert!((usual.0 - tiny.0).abs() < 1e-9 * usual.0 && usual.1 == tiny.1, "{usual:?} and {tiny:?}");
}
