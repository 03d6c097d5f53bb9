//! The cosine floor of Graveleau, Chevaugeon & Moës (2015), whose zones appear, merge and fill; areas and forces from a
//! spectral boundary integral method.

use super::{CELLS, DEGREE, REFINE, example, last_step, number, reference, set, summary};
use serde_json::Value;

fn row(name: &str, f: f64) -> Value {
    let reference = reference();
    let rows = reference["wavy_floor"]["cases"].as_array().expect("rows").clone();
    rows.into_iter().find(|r| r["name"] == name && number(&r["f"]) == f).expect("a row")
}

fn compare(contact: &Value, row: &Value, tolerance: f64) {
    for (found, exact) in [(&contact["area"], &row["contact_area"]), (&contact["force"][2], &row["contact_force"])] {
        let (found, exact) = (number(found), number(exact));
        assert!((found / exact - 1.0).abs() <= tolerance, "{found} instead of {exact}: {:.1e}", found / exact - 1.0);
    }
    assert_eq!(contact["zones"], row["components"]);
    assert_eq!(contact["holes"], row["free_holes_in_contact"]);
}

#[test]
fn the_disc_as_its_load_grows() {
    // As accurate without dividing cells.
    let summary = summary(example("cosine_disc"), &set(&[(REFINE, "{ most = 0 }".into())]));
    assert!(summary["unknowns"].as_u64().expect("unknowns") <= 20_000);
    last_step(&summary);
    let steps = summary["steps"].as_array().expect("steps");
    let zones: Vec<(u64, u64)> = steps
        .iter()
        .map(|s| &s["contacts"]["touch"])
        .map(|c| (c["zones"].as_u64().unwrap_or(0), c["holes"].as_u64().unwrap_or(0)))
        .collect();
    assert_eq!(zones, [(4, 0), (1, 1), (1, 1), (1, 0)]);
    assert!(steps.iter().all(|s| number(&s["equilibrium_residual"]) <= 1e-10));
    compare(&steps[0]["contacts"]["touch"], &row("disc-wavy", 0.1), 1e-5);
    compare(&steps[3]["contacts"]["touch"], &row("disc-wavy", 0.4), 1e-6);
}

/// So is this one.
#[test]
fn the_square() {
    let summary = summary(example("cosine_square"), &set(&[(REFINE, "{ most = 0 }".into())]));
    assert!(summary["unknowns"].as_u64().expect("unknowns") <= 20_000);
    compare(&last_step(&summary)["contacts"]["touch"], &row("square-wavy", 0.4), 1e-6);
}

/// Trigonometric functions of the arc length instead of splines: the same zone, as far as few of them can draw it.
#[test]
fn the_square_with_fourier_modes() {
    let fourier = ("contacts.touch.method.inequality_level_set.modes", "\"fourier\"".to_string());
    let summary = summary(example("cosine_square"), &set(&[fourier]));
    let contact = &last_step(&summary)["contacts"]["touch"];
    let exact = row("square-wavy", 0.4);
    compare(contact, &exact, 1e-5);
    let estimate = number(&contact["error_estimate"]["area"]);
    let error = (number(&contact["area"]) - number(&exact["contact_area"])).abs();
    assert!(estimate > error / 3.0 && estimate < 30.0 * error, "{estimate:.1e} for {error:.1e}");
}

/// Small increments without an event take no more than five solves, whatever the cells, once there are states to go on
/// from.
#[test]
#[ignore = "takes 36 processor seconds"]
fn small_increments_take_few_solves() {
    for (cells, degree) in [("[104, 104]", "1"), ("[52, 52]", "2"), ("[40, 40]", "3"), ("[32, 32]", "4")] {
        let pairs = [
            (CELLS, cells.to_string()),
            (DEGREE, degree.to_string()),
            ("steps", "[{ to = 0.24 }, { to = 0.3, increments = 6 }]".to_string()),
        ];
        let summary = summary(example("cosine_disc"), &set(&pairs));
        last_step(&summary);
        let steps = summary["steps"].as_array().expect("steps");
        let solves: Vec<u64> = steps.iter().filter_map(|s| s["iterations"].as_u64()).collect();
        assert!(solves[2..].iter().all(|n| *n <= 5), "degree {degree}: {solves:?}");
        let coarser: Vec<u64> = steps.iter().filter_map(|s| s["iterations_before"].as_u64()).collect();
        assert!(coarser[2..].iter().all(|n| *n <= 1), "degree {degree}: {coarser:?}");
    }
}

/// So do long ones, from a single state and where cells are divided, once they were approached on larger cells.
#[test]
#[ignore = "takes 15 processor seconds"]
fn long_increments_take_few_solves() {
    for (cells, degree) in [("[40, 40]", "1"), ("[64, 64]", "1"), ("[64, 64]", "2"), ("[32, 32]", "3")] {
        let pairs = [
            (CELLS, cells.to_string()),
            (DEGREE, degree.to_string()),
            ("steps", "[{ to = 0.2 }, { to = 0.3 }]".to_string()),
        ];
        let summary = summary(example("cosine_disc"), &set(&pairs));
        let solves = last_step(&summary)["iterations"].as_u64().expect("a number");
        assert!(solves <= 5, "{cells} of degree {degree}: {solves}");
    }
}

/// And so do those beside a merger and a hole that closes, where fronts are as sharp as cells are small: of as many zones and
/// holes as the last, the second and third of a kind.
#[test]
#[ignore = "takes 20 processor seconds"]
fn increments_beside_events_take_few_solves() {
    for (from, to, increments, last) in
        [("0.1", "0.12", 2, (4, 0)), ("0.15", "0.17", 2, (1, 1)), ("0.37", "0.39", 2, (1, 1))]
    {
        let steps = ("steps", format!("[{{ to = {from} }}, {{ to = {to}, increments = {increments} }}]"));
        let summary = summary(example("cosine_disc"), &set(&[(CELLS, "[32, 32]".into()), steps]));
        let contact = &last_step(&summary)["contacts"]["touch"];
        assert_eq!((&contact["zones"], &contact["holes"]), (&last.0.into(), &last.1.into()));
        let steps = summary["steps"].as_array().expect("steps");
        let solves: Vec<u64> = steps.iter().filter_map(|s| s["iterations"].as_u64()).collect();
        assert!(solves[1..].iter().all(|n| *n <= 5), "to {to}: {solves:?}");
    }
}

/// Up and down again in steps of 0.01 at degree 1, where the slope jump is least smooth: through the merger, the closing of the hole and
/// both back no increment without an event takes more than five solves, and areas agree to what the cells resolve.
#[test]
#[ignore = "takes 31 processor seconds"]
fn a_path_up_and_down_takes_few_solves() {
    let steps = ("steps", "[{ to = 0.1 }, { to = 0.7, increments = 60 }]".to_string());
    let load = ("loads.press.normal", "\"-min(t, 0.8 - t)\"".to_string());
    let pairs = [(CELLS, "[32, 32]".to_string()), (DEGREE, "1".to_string()), load, steps];
    let summary = summary(example("cosine_disc"), &set(&pairs));
    last_step(&summary);
    let steps = summary["steps"].as_array().expect("steps");
    let counts = |s: &Value| ["zones", "holes"].map(|key| s["contacts"]["touch"][key].as_u64().expect("a number"));
    for pair in steps.windows(2).filter(|pair| counts(&pair[0]) == counts(&pair[1])) {
        let solves = pair[1]["iterations"].as_u64().expect("a number");
        assert!(solves <= 5, "{solves} at {}", pair[1]["time"]);
    }
    // Those on larger cells before too: away from events the fronts are where they are expected.
    let solves = |key: &str| steps.iter().map(|step| step[key].as_u64().expect("a number")).sum::<u64>();
    let solves = solves("iterations") + solves("iterations_before");
    assert!(solves <= 5 * steps.len() as u64, "{solves} for {} increments", steps.len());
    for (up, down) in steps.iter().zip(steps.iter().rev()) {
        let area = |s: &Value| number(&s["contacts"]["touch"]["area"]);
        assert_eq!(counts(up), counts(down), "{}", up["time"]);
        let off = (area(up) - area(down)).abs();
        assert!(off < 2e-4, "{off:e} at {}", up["time"]);
    }
}

/// Just before the square's ring meets itself its tips are like cusps, sharper than the smallest cells: no more than five solves
/// are made there, and the area is that of tips that were brought to rest.
#[test]
#[ignore = "takes 67 processor seconds"]
fn tips_like_cusps_take_few_solves() {
    let steps = ("steps", "[{ to = 0.25 }, { to = 0.28, increments = 3 }]".to_string());
    let case = example("cosine_square").replace("normal = -0.4", "normal = \"-t\"");
    let summary = summary(&case, &set(&[(CELLS, "[32, 32]".into()), (DEGREE, "3".into()), steps]));
    let contact = &last_step(&summary)["contacts"]["touch"];
    let solves: Vec<u64> =
        summary["steps"].as_array().expect("steps").iter().filter_map(|s| s["iterations"].as_u64()).collect();
    assert!(solves[1..].iter().all(|n| *n <= 5), "{solves:?}");
    assert_eq!((&contact["zones"], &contact["holes"]), (&1.into(), &1.into()));
    assert!((number(&contact["area"]) - 1.377_733_681).abs() < 1e-7, "{contact}");
}

/// Nor does Newton's method go round in circles on tips that cells cannot resolve: 0.12 is 0.9 % below the load at which the four
/// zones of the square merge. Reference: degree 3 on 32 x 32 cells, with an estimated error of 1e-8.
#[test]
#[ignore = "takes 15 processor seconds"]
fn tips_before_a_merger_take_few_solves() {
    let steps = ("steps", "[{ to = 0.1 }, { to = 0.12, increments = 2 }]".to_string());
    let load = ("loads.press.normal", "\"-t\"".to_string());
    let pairs = [(CELLS, "[32, 32]".to_string()), (DEGREE, "2".to_string()), load, steps];
    let summary = summary(example("cosine_square"), &set(&pairs));
    let last = last_step(&summary);
    let contact = &last["contacts"]["touch"];
    assert_eq!((&contact["zones"], &contact["holes"]), (&4.into(), &0.into()));
    let solves = ["iterations", "iterations_before"].map(|key| last[key].as_u64().expect("a number"));
    assert!(solves[0] <= 5 && solves[1] <= 20, "{solves:?}");
    let off = number(&contact["area"]) - 0.340_952_414;
    assert!(off.abs() < 1e-6, "{off:e}");
}

/// A path that turns goes on from the states that it came through: they depend on the load alone, whatever the time. Between
/// two drivers that do not keep in step there is no such line, and the path goes on in time.
#[test]
#[ignore = "takes 32 processor seconds"]
fn a_path_that_turns_takes_few_solves() {
    let steps = ("steps", "[{ to = 0.15 }, { to = 0.21, increments = 6 }]".to_string());
    let cells = [(CELLS, "[40, 40]".to_string()), (DEGREE, "3".to_string()), steps];
    let solve = |load: &str, floor: Option<&str>| {
        let mut pairs = cells.to_vec();
        pairs.push(("loads.press.normal", format!("\"{load}\"")));
        pairs.extend(floor.map(|f| ("bodies.floor.rigid.shape.height", format!("\"{f}\""))));
        let summary = summary(example("cosine_square"), &set(&pairs));
        last_step(&summary);
        let steps = summary["steps"].as_array().expect("steps").clone();
        let area = |s: &Value| number(&s["contacts"]["touch"]["area"]);
        let solves = |s: &Value| ["iterations", "iterations_before"].map(|key| s[key].as_u64().expect("a number"));
        steps.iter().map(|s| (solves(s), area(s))).collect::<Vec<_>>()
    };
    // On coarser cells one solve says that the start is near.
    let turned = solve("-min(t, 0.36 - t)", None);
    assert!(turned[2..].iter().all(|([n, coarser], _)| *n <= 5 && *coarser <= 1), "{turned:?}");
    // A path that only comes down knows nothing of the way up.
    let down = solve("-max(0.33 - t, 0.15)", None);
    for k in 0..=3 {
        let [up, back, down] = [turned[k].1, turned[6 - k].1, down[3 - k].1];
        assert!((up - back).abs() < 1e-6 && (up - down).abs() < 1e-6, "{up} {back} {down}");
    }
    // The floor goes on sinking by a thousandth of its depth while the load turns.
    let floor = "-(15 + 5*cos(2*pi*x)*cos(2*pi*y))/1000 - 1.5e-4*(t - 0.15)";
    let other = solve("-min(t, 0.36 - t)", Some(floor));
    assert!(other[2..].iter().all(|([n, _], _)| *n <= 6), "{other:?}");
}

/// Zones of the square at every load of the publication, and the force between the bounds of nodal methods.
#[test]
fn the_square_at_lower_loads() {
    for (f, zones, holes, force) in [(0.1, 4, 0, 0.0905091), (0.2, 1, 1, 0.28712), (0.3, 1, 5, 0.540594)] {
        let pairs = [("loads.press.normal", format!("{}", -f)), (CELLS, "[40,40]".into()), (DEGREE, "3".into())];
        let summary = summary(example("cosine_square"), &set(&pairs));
        let contact = &last_step(&summary)["contacts"]["touch"];
        assert_eq!((contact["zones"].as_u64(), contact["holes"].as_u64()), (Some(zones), Some(holes)), "f = {f}");
        assert!((number(&contact["force"][2]) - force).abs() < 2e-6, "f = {f}: {}", contact["force"][2]);
    }
}

/// The nodal method on the same floor: the force is near, the area a staircase.
#[test]
fn the_nodal_method_nested_and_cold() {
    let exact = row("square-wavy", 0.4);
    let run = |start: &str| {
        let case = example("active_set").replace("active_set = {}", &format!("active_set = {{ start = \"{start}\" }}"));
        let summary = summary(&case, &set(&[]));
        let step = last_step(&summary).clone();
        (step["contacts"]["touch"].clone(), step["iterations"].as_u64().unwrap_or(0))
    };
    let ((nested, few), (cold, many)) = (run("nested"), run("cold"));
    assert_eq!(nested["force"][2], cold["force"][2]);
    assert!(few < many);
    assert!((number(&nested["force"][2]) / number(&exact["contact_force"]) - 1.0).abs() < 1e-3);
    assert!((number(&nested["area"]) / number(&exact["contact_area"]) - 1.0).abs() < 0.06);
    assert_eq!((nested["zones"].as_u64(), nested["holes"].as_u64()), (Some(1), Some(0)));
}

/// The hemisphere of E. Bueler's obstacle problems: no load, boundary values from the exact solution.
#[test]
fn the_hemisphere_without_load() {
    let case = r#"
space = "plane"
[bodies.film.membrane]
domain.rectangle = { min = [-2, -2], max = [2, 2] }
mesh.grid = { cells = [30, 30] }
degree = 4
tension = 1.0
[bodies.ball.rigid]
shape.height = "if(x^2 + y^2 < 0.81, sqrt(1 - min(x^2 + y^2, 0.9)), sqrt(0.19) - 0.9/sqrt(0.19)*(sqrt(x^2 + y^2) - 0.9))"
[supports.frame]
on = "film:boundary"
displacement = "-0.680259411891717*log(sqrt(x^2 + y^2)) + 0.471519893402110"
[contacts.touch]
between = ["film", "ball"]
"#;
    let summary = summary(case, &set(&[]));
    let contact = &last_step(&summary)["contacts"]["touch"];
    assert!((number(&contact["radius"]) - 0.697965148223374).abs() < 1e-6, "{}", contact["radius"]);
    let force = 2.0 * std::f64::consts::PI * 0.680259411891717;
    assert!((number(&contact["force"][2]) - force).abs() < 1e-6);
}

/// The floor from a height map: the area of contact goes to that on the exact floor with the fourth power of the spacing.
#[test]
fn sampled_floors_converge() {
    let area = |shape: &str| {
        let height = "shape.height = \"-(15 + 5*cos(2*pi*x)*cos(2*pi*y))/1000\"";
        let case = example("cosine_square").replace(height, shape);
        assert!(case.contains(shape));
        let found = summary(&case, &set(&[(DEGREE, "3".into())]));
        last_step(&found).pointer("/contacts/touch/area").and_then(serde_json::Value::as_f64).unwrap()
    };
    let exact = area("shape.height = \"-(15 + 5*cos(2*pi*x)*cos(2*pi*y))/1000\"");
    let folder = tempfile::tempdir().unwrap();
    let errors = [65, 129].map(|n| {
        let pi = std::f64::consts::PI;
        let height = |x: f64, y: f64| -(15.0 + 5.0 * (2.0 * pi * x).cos() * (2.0 * pi * y).cos()) / 1000.0;
        (area(&crate::solids::height_map(folder.path(), n, 1.2, height)) / exact - 1.0).abs()
    });
    assert!(errors[1] < 1e-6 && errors[1] < errors[0] / 8.0, "{errors:?}");
}

/// Up and down again, through the merger of the four islands: without adhesion the state depends on the load alone.
#[test]
#[ignore = "takes 30 processor seconds"]
fn up_and_down_are_one() {
    let case = example("cosine_disc").replace("normal = \"-t\"", "normal = \"-min(t, 0.6 - t)\"").replace(
        "[[steps]]\nto = 0.4\nincrements = 4",
        "[[steps]]\nto = 0.12\n[[steps]]\nto = 0.3\nincrements = 6\n[[steps]]\nto = 0.48\nincrements = 6",
    );
    let found = summary(&case, &set(&[]));
    last_step(&found);
    let steps = found["steps"].as_array().expect("steps");
    for k in 0..6 {
        let (up, down) = (&steps[k]["contacts"]["touch"], &steps[12 - k]["contacts"]["touch"]);
        assert_eq!((&up["zones"], &up["holes"]), (&down["zones"], &down["holes"]), "{k}");
        let apart = (number(&up["area"]) - number(&down["area"])).abs();
        // Before the merger the islands have tips sharper than a cell, and the grid knows them to that only.
        assert!(apart < if k == 0 { 1e-3 } else { 1e-6 }, "{k}: {apart}");
    }
    // Warm starts where nothing happens.
    for step in &steps[3..6] {
        assert!(step["iterations"].as_u64().is_some_and(|n| n <= 9), "{step}");
    }
}
