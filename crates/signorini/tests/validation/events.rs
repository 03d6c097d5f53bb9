//! Changes of topology along load paths, located.

use super::{CELLS, DEGREE, error, example, number, set, summary};
use serde_json::Value;

fn events(summary: &Value) -> Vec<(String, f64)> {
    let list = summary["events"].as_array().expect("events");
    list.iter().map(|e| (e["kind"].as_str().unwrap_or("").to_string(), number(&e["time"]))).collect()
}

/// A string touches a floor 0.1 below it at a load of 0.2, and leaves it at the same load.
#[test]
fn a_string_touches_and_leaves() {
    let case = example("string").replace("normal = -1.0", "normal = \"-0.5*min(t, 2 - t)\"")
        + "\n[[steps]]\nto = 1\nincrements = 2\nevents = 1e-4\n[[steps]]\nto = 2\nincrements = 2\nevents = 1e-4\n";
    let found = summary(&case, &set(&[]));
    assert_eq!(found["converged"], true, "{}", found["verdict"]);
    let events = events(&found);
    assert_eq!(events.iter().map(|e| e.0.as_str()).collect::<Vec<_>>(), ["nucleation", "release"]);
    assert!((events[0].1 - 0.4).abs() <= 1e-4 && (events[1].1 - 1.6).abs() <= 1e-4, "{events:?}");
    let first = &found["events"][0];
    assert!(number(&first["at"][0]).abs() < 1e-3 && first["zones_before"] == 0 && first["zones_after"] == 1);
    assert!(number(&first["within"]) <= 1e-4);
}

/// The ring of contact of the cosine floor closes at a load of 0.04 π² (Graveleau, Chevaugeon & Moës 2015).
#[test]
fn the_hole_of_the_ring_closes() {
    let exact = 0.04 * std::f64::consts::PI.powi(2);
    let case = example("cosine_disc")
        .replace("[[steps]]\nto = 0.4\nincrements = 4", "[[steps]]\nto = 0.37\n[[steps]]\nto = 0.4\nevents = 1e-3");
    let found = summary(&case, &set(&[(CELLS, "[24, 24]".into())]));
    let events = events(&found);
    assert_eq!(events.len(), 1, "{events:?}");
    assert!(events[0].0 == "hole_closed" && (events[0].1 - exact).abs() <= 1e-3, "{events:?}");
    let at = &found["events"][0]["at"];
    assert!(number(&at[0]).abs() < 1e-3 && number(&at[1]).abs() < 1e-3);
}

/// By the area of contact too, without adhesion: from an open hole to an area at which it has closed.
#[test]
fn the_hole_closes_on_the_way_to_an_area() {
    let steps =
        "[[steps]]\nto = 0.37\n[[steps]]\nto = 0.4\nevents = 1e-3\ncontrol.area = { of = \"touch\", to = 1.35 }";
    let case = example("cosine_disc").replace("[[steps]]\nto = 0.4\nincrements = 4", steps);
    let found = summary(&case, &set(&[(CELLS, "[24, 24]".into()), (DEGREE, "2".into())]));
    assert_eq!(found["converged"], true, "{}", found["verdict"]);
    let [first, last] = found["steps"].as_array().expect("steps").as_slice() else { panic!("two increments") };
    let touch = |step: &Value| step["contacts"]["touch"].clone();
    assert_eq!((&touch(first)["holes"], &touch(last)["holes"]), (&1.into(), &0.into()));
    assert!((number(&touch(last)["area"]) - 1.35).abs() < 1e-6, "{last}");
    let exact = 0.04 * std::f64::consts::PI.powi(2);
    let events = events(&found);
    assert!(events.len() == 1 && events[0].0 == "hole_closed", "{events:?}");
    assert!((events[0].1 - exact).abs() <= 1e-3 && number(&last["time"]) > exact, "{events:?}");
}

/// Without adhesion a length of contact tells the time, on the way up from no contact at all, and down; and so does the way in
/// length and time.
#[test]
fn a_string_by_its_length_of_contact_and_along_its_path() {
    let by_length = |to: f64, end: f64| {
        format!("[[steps]]\nto = {end}\nincrements = 2\ncontrol.area = {{ of = \"touch\", to = {to} }}\n")
    };
    let case = example("string").replace("normal = -1.0", "normal = \"-t\"")
        + "\n"
        + &by_length(1.0, 1.0)
        + &by_length(0.4, 2.0)
        + "[[steps]]\nto = 3\ncontrol.arc_length = { size = 0.25 }\n";
    let found = summary(&case, &set(&[]));
    assert_eq!(found["converged"], true, "{}", found["verdict"]);
    let states: Vec<[f64; 2]> = found["steps"]
        .as_array()
        .expect("steps")
        .iter()
        .map(|step| [number(&step["time"]), number(&step["contacts"]["touch"]["area"])])
        .collect();
    for (state, length) in states.iter().zip([0.5, 1.0, 0.7, 0.4]) {
        assert!((state[1] - length).abs() < 1e-8, "{states:?}");
    }
    for [time, length] in &states {
        // A parabola that meets the floor at the end of contact: t (1 - length / 2)² / 2 = depth.
        assert!((time - 0.2 / (1.0 - 0.5 * length).powi(2)).abs() < 1e-8, "{states:?}");
    }
    let along: Vec<f64> =
        states[3..].windows(2).map(|s| (0.5 * (s[1][1] - s[0][1])).hypot(s[1][0] - s[0][0])).collect();
    let [most @ .., last] = along.as_slice() else { panic!("no path") };
    assert!(most.len() >= 4 && most.iter().all(|length| (length - 0.25).abs() < 1e-4) && *last < 0.25, "{along:?}");
    assert_eq!(states[states.len() - 1][0], 3.0);
}

/// A load that is none beyond a time is named, where that is why an area is not reached.
#[test]
fn a_load_that_ends_on_the_way_to_an_area_is_named() {
    let case = example("string").replace("normal = -1.0", "normal = \"-0.25 - sqrt(0.1 - t)\"")
        + "\n[[steps]]\nto = 1\ncontrol.area = { of = \"touch\", to = 0.9 }\n";
    let found = summary(&case, &set(&[]));
    assert_eq!((&found["converged"], &found["reason"]), (&false.into(), &"path_lost".into()));
    let warnings = found["warnings"].to_string();
    assert!(warnings.contains("no state with a contact area of 0.9") && warnings.contains("loads.press"), "{warnings}");
}

/// From a state in which it is hardly open any more it is not found open beyond that load.
#[test]
fn a_hole_does_not_outlive_its_load() {
    let steps = "[[steps]]\nto = 0.385\n[[steps]]\nto = 0.3925\n[[steps]]\nto = 0.3944\n[[steps]]\nto = 0.3953";
    let case = example("cosine_disc").replace("[[steps]]\nto = 0.4\nincrements = 4", steps);
    let found = summary(&case, &set(&[(CELLS, "[24, 24]".into())]));
    assert_eq!(found["converged"], true, "{}", found["verdict"]);
    let holes: Vec<u64> = found["steps"]
        .as_array()
        .expect("steps")
        .iter()
        .filter_map(|s| s["contacts"]["touch"]["holes"].as_u64())
        .collect();
    assert_eq!(holes, [1, 1, 1, 0]);
}

/// Two zones grow tips towards each other, merge, and part again at the same load. With 80 × 48 cells and a tolerance of
/// 4e-3 the merger is at t = 2.3488.
#[test]
fn mergers_are_located_from_both_sides() {
    let case = r#"
space = "plane"

[bodies.film.membrane]
domain.rectangle = { min = [-1, -0.6], max = [1, 0.6] }
mesh.grid = { cells = [30, 18] }
degree = 2
tension = 1.0

[bodies.floor.rigid]
shape.height = "-(15 + 5*cos(2*pi*x))/1000"

[supports.rim]
on = "film:boundary"
displacement = 0.0

[loads.press]
on = "film"
normal = "-0.1*min(t, 8 - t)"

[contacts.touch]
between = ["film", "floor"]
method.inequality_level_set = {}

[[steps]]
to = 2
[[steps]]
to = 2.8
events = 0.01
[[steps]]
to = 6
events = 0.01

[output]
pictures = false
"#;
    let found = summary(case, &set(&[]));
    let area = |k: usize| number(&found["steps"][k]["contacts"]["touch"]["area"]);
    assert!((area(2) / area(0) - 1.0).abs() < 1e-6, "{} {}", area(0), area(2));
    let events = found["events"].as_array().expect("events");
    assert_eq!(events.len(), 2, "{events:?}");
    for (event, kind, time) in [(&events[0], "merge", 2.3488), (&events[1], "split", 8.0 - 2.3488)] {
        assert!(event["kind"] == kind && event["by"] == "extrapolation" && number(&event["within"]) <= 0.01);
        assert!((number(&event["time"]) - time).abs() <= 0.005, "{kind} at {}", event["time"]);
        assert!(number(&event["at"][0]).abs() < 2e-3 && number(&event["at"][1]).abs() < 2e-3);
    }
    assert_eq!(found["warnings"].as_array().map(Vec::len), Some(0), "{}", found["warnings"]);
}

/// Two arms of one zone close to a ring round a dip of the floor, and part again. With 36 × 36 cells of degree 3 and a
/// tolerance of 2e-3 they close at a load of 0.6512.
#[test]
#[ignore = "takes 59 processor seconds"]
fn a_zone_that_merges_with_itself() {
    let case = r#"
space = "plane"

[bodies.film.membrane]
domain.disc = { radius = 1.0 }
mesh.grid = { cells = [30, 30] }
degree = 2
tension = 1.0

[bodies.floor.rigid]
shape.height = "-0.1 - 0.6*(x^2 + y^2 - 0.25)^2 - 0.01*exp(-((x + 0.5)^2 + y^2)/0.06)"

[supports.rim]
on = "film:boundary"
displacement = 0.0

[loads.press]
on = "film"
normal = "abs(t - 0.8) - 0.8"

[contacts.touch]
between = ["film", "floor"]
method.inequality_level_set = {}

[[steps]]
to = 0.62
increments = 1
[[steps]]
to = 0.7
increments = 1
events = 4e-3
[[steps]]
to = 0.9
increments = 1
[[steps]]
to = 0.98
increments = 1
events = 4e-3

[output]
pictures = false
"#;
    let found = summary(case, &set(&[]));
    let area = |k: usize| number(&found["steps"][k]["contacts"]["touch"]["area"]);
    assert!((area(3) / area(0) - 1.0).abs() < 1e-6 && (area(2) / area(1) - 1.0).abs() < 1e-5, "{}", found["steps"]);
    let events = found["events"].as_array().expect("events");
    assert_eq!(events.len(), 2, "{events:?}");
    for (event, kind, time) in [(&events[0], "hole_opened", 0.6512), (&events[1], "hole_closed", 1.6 - 0.6512)] {
        assert!(event["kind"] == kind && number(&event["within"]) <= 4e-3);
        assert!((number(&event["time"]) - time).abs() <= 2e-3, "{kind} at {}", event["time"]);
    }
}

#[test]
fn tolerances_are_positive() {
    let case = example("string").to_string() + "\n[[steps]]\nto = 1\nevents = 0\n";
    let found = error(&case);
    assert!(found.one_line().contains("not a valid time tolerance"));
}
