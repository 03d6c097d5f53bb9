//! Flat floors: the string and the round membrane of Graveleau, Chevaugeon & Moës (2015), by their closed solutions,
//! and an elliptic membrane by a spectral one.

use super::{CELLS, DEGREE, REFINE, example, last_step, number, reference, set, summary};
use signorini_verify::flat_floor::{FlatFloor, Kind};
use signorini_verify::order::fitted;

/// Radius and force of the contact, and the number of solves.
fn solve(name: &str, pairs: &[(&str, String)]) -> (f64, f64, u64) {
    let summary = summary(example(name), &set(pairs));
    let step = last_step(&summary);
    assert!(number(&step["equilibrium_residual"]) <= 1e-10, "{}", step["equilibrium_residual"]);
    let contact = &step["contacts"]["touch"];
    let radius = contact["radius"].as_f64().unwrap_or(0.0);
    (radius, number(&contact["force"][2]), step["iterations"].as_u64().unwrap_or(99))
}

fn line(n: usize, degree: usize) -> Vec<(&'static str, String)> {
    vec![(CELLS, format!("[{n}]")), (DEGREE, degree.to_string())]
}

fn plane(n: usize, degree: usize) -> Vec<(&'static str, String)> {
    vec![(CELLS, format!("[{n},{n}]")), (DEGREE, degree.to_string())]
}

#[test]
fn every_row_of_the_reference_without_adhesion() {
    let reference = reference();
    let rows = reference["axisymmetric"].as_array().expect("rows");
    let mut checked = 0;
    for row in rows.iter().filter(|r| number(&r["gamma"]) == 0.0) {
        let (f, d, t, r) = (number(&row["f"]), number(&row["d"]), number(&row["T"]), number(&row["R"]));
        let mut pairs = line(40, 4);
        pairs.extend([
            ("loads.press.normal", format!("{}", -f)),
            ("bodies.floor.rigid.shape.height", format!("\"{}\"", -d)),
            ("bodies.film.membrane.tension", t.to_string()),
            ("bodies.film.membrane.domain.interval.to", r.to_string()),
        ]);
        let (radius, force, _) = solve("axisymmetric", &pairs);
        match row["states"].as_array().and_then(|s| s.first()) {
            None => assert_eq!((radius, force), (0.0, 0.0), "no contact exists at {row}"),
            Some(state) => {
                assert!(
                    (radius - number(&state["rc"])).abs() <= 1e-10 * r,
                    "radius {radius}, off by {}, of {row}",
                    radius - number(&state["rc"])
                );
                let exact = number(&state["force"]);
                assert!((force - exact).abs() <= 1e-10 * exact.abs().max(1.0), "force {force} of {row}");
            }
        }
        checked += 1;
    }
    assert!(checked >= 20, "{checked} rows");
}

#[test]
fn the_string_is_exact_from_degree_two_on() {
    let exact = FlatFloor { tension: 1.0, load: 1.0, depth: 0.1, radius: 1.0, kind: Kind::String };
    for degree in [2, 4, 6] {
        let (radius, force, iterations) = solve("string", &line(40, degree));
        assert!((radius - exact.contact_radius().unwrap_or(0.0)).abs() <= 1e-10, "degree {degree}: {radius}");
        assert!((force - exact.contact_force()).abs() <= 1e-10);
        assert!(iterations <= 12, "{iterations} solves");
    }
}

#[test]
fn orders_of_the_radius_in_one_dimension() {
    let exact = 0.502474357083085;
    for (degree, cells, order) in [(1, [20, 40, 80], 1.9), (2, [10, 20, 40], 3.8), (3, [6, 9, 14], 5.5)] {
        let h: Vec<f64> = cells.iter().map(|n| 1.0 / *n as f64).collect();
        let errors: Vec<f64> = cells.iter().map(|&n| solve("axisymmetric", &line(n, degree)).0 - exact).collect();
        let observed = fitted(&h, &errors);
        assert!(observed >= order, "degree {degree}: order {observed}, errors {errors:?}");
    }
}

#[test]
fn the_disc_of_degree_one_converges_with_order_two() {
    let exact = 0.502474357083085;
    let cells = [20, 40, 80, 160];
    // Coarse cells would be divided, and err less than the order says.
    let undivided = (REFINE, "{ most = 0 }".to_string());
    let run = |n: usize| solve("flat_disc", &[plane(n, 1), vec![undivided.clone()]].concat());
    let runs: Vec<(f64, f64, u64)> = cells.iter().map(|&n| run(n)).collect();
    let h: Vec<f64> = cells.iter().map(|n| 1.0 / *n as f64).collect();
    let radius: Vec<f64> = runs.iter().map(|r| r.0 - exact).collect();
    let force: Vec<f64> = runs.iter().map(|r| r.1 - std::f64::consts::PI * exact * exact).collect();
    assert!(fitted(&h, &radius) >= 1.8, "{radius:?}");
    assert!(fitted(&h, &force) >= 1.8, "{force:?}");
    assert!(runs.iter().all(|r| r.2 <= 12));
}

#[test]
fn the_disc_of_higher_degree() {
    let exact = 0.502474357083085;
    let force = std::f64::consts::PI * exact * exact;
    let (coarse, fine) = (solve("flat_disc", &plane(20, 2)), solve("flat_disc", &plane(40, 2)));
    assert!((fine.0 - exact).abs() <= 2e-7, "{}", fine.0 - exact);
    assert!((fine.1 - force).abs() <= 1e-6);
    assert!(((coarse.0 - exact) / (fine.0 - exact)).abs().log2() >= 3.8);
    let four = solve("flat_disc", &plane(20, 4));
    assert!((four.0 - exact).abs() <= 1e-9, "{}", four.0 - exact);
    assert!((four.1 - force).abs() <= 4e-9);
    for run in [coarse, fine, four, solve("flat_disc", &plane(20, 6))] {
        assert!(run.2 <= 9, "{} solves", run.2);
    }
}

#[test]
fn the_ellipse() {
    let reference = reference();
    let row = reference["two_dimensional"]
        .as_array()
        .and_then(|rows| rows.iter().find(|r| r["name"] == "ellipse-1-0.7-flat"))
        .cloned()
        .expect("the ellipse");
    let case =
        example("flat_disc").replace("domain.disc = { radius = 1.0 }", "domain.ellipse = { semi_axes = [1.0, 0.7] }");
    let pairs = [(CELLS, "[30, 24]".to_string()), ("bodies.floor.rigid.shape.height", "\"-0.05\"".to_string())];
    let summary = summary(&case, &set(&pairs));
    let contact = &last_step(&summary)["contacts"]["touch"];
    assert!((number(&contact["area"]) - number(&row["contact_area"])).abs() <= 1e-7);
    assert!((number(&contact["force"][2]) - number(&row["contact_force"])).abs() <= 1e-7);
    assert!((number(&last_step(&summary)["energy"]) - number(&row["energy"])).abs() <= 1e-7);
}

/// On a floor that falls away with the fourth power the pressure is largest at the fronts: how far it may be off is told.
#[test]
fn the_error_of_the_largest_pressure_is_told() {
    // u'' = 1 from the front at a, where it is tangential, to the rim at 1, where u = 0.
    let rim = |a: f64| -0.1 - 0.02 * a.powi(4) - 0.08 * a.powi(3) * (1.0 - a) + 0.5 * (1.0 - a).powi(2);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if rim(middle) > 0.0 { low = middle } else { high = middle }
    }
    let exact = 1.0 + 0.24 * low * low;
    for (cells, degree) in [(10, 1), (40, 1), (10, 2), (40, 3)] {
        let mut pairs = line(cells, degree);
        pairs.push(("bodies.floor.rigid.shape.height", "\"-0.1 - 0.02*x^4\"".to_string()));
        let summary = summary(example("string"), &set(&pairs));
        let contact = &last_step(&summary)["contacts"]["touch"];
        let error = (number(&contact["max_pressure"]) - exact).abs();
        let told = number(&contact["error_estimate"]["max_pressure"]);
        assert!(told >= 0.5 * error && told <= 20.0 * error, "{cells}, {degree}: off by {error:e}, told {told:e}");
    }
}
