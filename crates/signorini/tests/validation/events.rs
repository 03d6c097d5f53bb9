//! Changes of topology along load paths, located.

use super::{error, example, number, set, summary};
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
    let found = summary(&case, &set(&[]));
    let events = events(&found);
    assert_eq!(events.len(), 1, "{events:?}");
    assert!(events[0].0 == "hole_closed" && (events[0].1 - exact).abs() <= 1e-3, "{events:?}");
    let at = &found["events"][0]["at"];
    assert!(number(&at[0]).abs() < 1e-3 && number(&at[1]).abs() < 1e-3);
}

#[test]
fn tolerances_are_positive() {
    let case = example("string").to_string() + "\n[[steps]]\nto = 1\nevents = 0\n";
    let found = error(&case);
    assert!(found.one_line().contains("no tolerance"));
}
