//! The published formulation of Graveleau, Chevaugeon & Moës (2015), run as a user runs it.

use super::{CELLS, DEGREE, error, example, last_step, number, reference, set, summary};
use serde_json::Value;
use signorini::reproduce::{FIGURES, reproduce};
use signorini_verify::order::fitted;

const METHOD: &str = "contacts.touch.method.inequality_level_set";

fn solve(name: &str, pairs: &[(&str, String)]) -> Value {
    let formulation = format!("{METHOD}.formulation");
    let mut all = vec![(formulation.as_str(), "\"published\"".to_string())];
    all.extend(pairs.iter().cloned());
    let summary = summary(example(name), &set(&all));
    let step = last_step(&summary);
    assert!(number(&step["equilibrium_residual"]) <= 1e-10, "{}", step["equilibrium_residual"]);
    step.clone()
}

fn plane(n: usize) -> Vec<(&'static str, String)> {
    vec![(CELLS, format!("[{n},{n}]")), (DEGREE, "1".into())]
}

fn contact<'a>(step: &'a Value, key: &str) -> &'a Value {
    &step["contacts"]["touch"][key]
}

/// Radius of the disc of contact: load 1, depth 0.1, tension and radius 1.
const RADIUS: f64 = 0.502_474_357_083_085;

#[test]
fn the_front_on_the_disc_is_of_second_order() {
    // From the zone that the free membrane penetrates, of radius 0.7746.
    let sizes = [20, 40, 80, 160];
    let steps = sizes.map(|n| solve("flat_disc", &plane(n)));
    let errors = steps.each_ref().map(|s| ((number(contact(s, "area")) / std::f64::consts::PI).sqrt() - RADIUS).abs());
    let order = fitted(&sizes.map(|n| 1.0 / n as f64), &errors);
    assert!(order >= 1.9, "{order}: {errors:?}");
    for (step, n) in steps.iter().zip(sizes) {
        let iterations = step["iterations"].as_u64().expect("a number");
        assert!(iterations <= 12, "{iterations} at {n}");
    }
}

#[test]
fn so_it_is_on_triangles_and_quadrilaterals() {
    for mesh in ["triangles_2_6.msh", "mixed_2_6.msh"] {
        let divisions = [1, 2, 3];
        let errors = divisions.map(|k| {
            let text = super::meshes::case(mesh)
                .replace("group = \"film\"", &format!("group = \"film\", divisions = {k}"))
                .replace("tension", "degree = 1\ntension")
                + "method.inequality_level_set = { formulation = \"published\" }\n";
            let found = summary(&text, &set(&[]));
            let step = last_step(&found);
            assert!(number(&step["equilibrium_residual"]) <= 1e-10, "{}", step["equilibrium_residual"]);
            let iterations = step["iterations"].as_u64().expect("a number");
            assert!(iterations <= 12, "{mesh}, divided {k} times: {iterations}");
            ((number(contact(step, "area")) / std::f64::consts::PI).sqrt() - RADIUS).abs()
        });
        let order = fitted(&divisions.map(|k| 0.5f64.powi(k)), &errors);
        assert!(order >= 1.9, "{mesh}: {order}: {errors:?}");
    }
}

#[test]
fn along_the_radius_it_has_every_degree() {
    for (degree, bound) in [(1, 1e-3), (2, 1e-6), (3, 1e-9), (4, 1e-10), (5, 1e-8), (6, 1e-8)] {
        let pairs = [(CELLS, "[20]".to_string()), (DEGREE, degree.to_string())];
        let step = solve("axisymmetric", &pairs);
        let off = number(contact(&step, "radius")) - RADIUS;
        assert!(off.abs() <= bound, "degree {degree}: {off}");
    }
}

#[test]
fn adhesion_too() {
    // Every state of the reference that a load alone leads to: the stable one, where the free membrane touches the floor.
    let mut checked = 0;
    for row in reference()["axisymmetric"].as_array().expect("rows") {
        let [f, d, t, r, gamma] = ["f", "d", "T", "R", "gamma"].map(|k| number(&row[k]));
        if gamma == 0.0 || f * r * r <= 4.0 * t * d {
            continue;
        }
        let pairs = [
            (CELLS, "[30]".to_string()),
            (DEGREE, "4".to_string()),
            ("loads.press.normal", format!("{}", -f)),
            ("bodies.floor.rigid.shape.height", format!("\"{}\"", -d)),
            ("bodies.film.membrane.tension", t.to_string()),
            ("bodies.film.membrane.domain.interval.to", r.to_string()),
            ("contacts.touch.adhesion.energy", gamma.to_string()),
        ];
        let step = solve("axisymmetric", &pairs);
        let states = row["states"].as_array().expect("states");
        let stable = states.iter().find(|s| s["stable"] == true).expect("a stable state");
        let off = number(contact(&step, "radius")) - number(&stable["rc"]);
        assert!(off.abs() <= 1e-8 * r, "{off} of {row}");
        assert!(number(contact(&step, "lowest_eigenvalue")) > 0.0);
        checked += 1;
    }
    assert!(checked >= 5, "{checked} rows");
}

#[test]
fn on_the_cosine_floor_it_finds_the_zones_of_the_other_formulation() {
    let reference = reference();
    let rows = reference["wavy_floor"]["cases"].as_array().expect("rows");
    for (load, zones, holes) in [(0.1, 4, 0), (0.2, 1, 1), (0.3, 1, 1), (0.4, 1, 0)] {
        let mut pairs = plane(40);
        pairs.push(("loads.press.normal", format!("{}", -load)));
        let step = solve("cosine_disc", &pairs);
        assert_eq!(contact(&step, "zones").as_u64(), Some(zones), "at {load}");
        assert_eq!(contact(&step, "holes").as_u64(), Some(holes), "at {load}");
        if let Some(row) = rows.iter().find(|r| r["name"] == "disc-wavy" && number(&r["f"]) == load) {
            let (area, exact) = (number(contact(&step, "area")), number(&row["contact_area"]));
            assert!((area / exact - 1.0).abs() <= 1e-2, "{area} instead of {exact} at {load}");
        }
    }
}

#[test]
fn a_level_set_on_nodes_shifts_the_front_and_says_so() {
    let solve = |transport: &str| {
        let key = format!("{METHOD}.transport");
        let mut pairs = plane(40);
        pairs.push((key.as_str(), format!("\"{transport}\"")));
        solve("flat_disc", &pairs)
    };
    let residual =
        |step: &Value| number(step["residual_history"].as_array().and_then(|r| r.last()).expect("residuals"));
    let exact = solve("exact");
    assert!(residual(&exact) <= 1.0);
    for transport in ["redistancing", "hamilton_jacobi"] {
        let step = solve(transport);
        // The residual stays where the shift of every step keeps it; the front is off by no more than that.
        assert!(residual(&step) > 5.0 * residual(&exact), "{transport}");
        let radius = (number(contact(&step, "area")) / std::f64::consts::PI).sqrt();
        assert!((radius - RADIUS).abs() < 2e-3 && (radius - RADIUS).abs() > 2e-4, "{transport}: {radius}");
    }
}

/// Few modes tell a circle; more than its cells tell apart are not to be had, which is said.
#[test]
fn as_many_modes_as_are_asked_for() {
    let found = |count: usize, formulation: &str| {
        let mut pairs = plane(40);
        let [fourier, most, kind] = ["modes", "mode_count", "formulation"].map(|key| format!("{METHOD}.{key}"));
        pairs.extend([
            (fourier.as_str(), "\"fourier\"".to_string()),
            (most.as_str(), count.to_string()),
            (kind.as_str(), format!("\"{formulation}\"")),
        ]);
        let summary = summary(example("flat_disc"), &set(&pairs));
        let radius = (number(contact(last_step(&summary), "area")) / std::f64::consts::PI).sqrt();
        assert!((radius - RADIUS).abs() < 2e-4, "{formulation}, {count}: {radius}");
        summary["warnings"].to_string()
    };
    for formulation in ["published", "one_sided"] {
        let few = found(3, formulation);
        assert!(!few.contains("mode_count"), "{formulation}: {few}");
        let many = found(500, formulation);
        assert!(many.contains("fewer than `mode_count`"), "{formulation}: {many}");
    }
}

#[test]
fn what_does_not_go_together_is_told() {
    let case = |method: &str, extra: &str| {
        let published = format!("method.inequality_level_set = {{ {method} }}");
        example("flat_disc").replace("method.inequality_level_set = {}", &published) + extra
    };
    let told = |case: &str| error(case).one_line();
    let degree = told(&case("formulation = \"published\"", ""));
    assert!(degree.contains("degree 1 in the plane"), "{degree}");
    let key = told(&case("multiplier = \"l2\"", ""));
    assert!(key.contains("belongs to the published formulation"), "{key}");
    let linear = case("formulation = \"published\"", "").replace("degree = 4", "degree = 1");
    let both = told(&linear.replace("\"published\"", "\"published\", multiplier = \"l2\", multiplier_length = 1.0"));
    assert!(both.contains("has no length"), "{both}");
    let length = told(&linear.replace("\"published\"", "\"published\", multiplier_length = -2"));
    assert!(length.contains("must be positive"), "{length}");
    let splines = told(&linear.replace("\"published\"", "\"one_sided\", mode_count = 5"));
    assert!(splines.contains("is determined by its cells"), "{splines}");
    let none = told(&linear.replace("\"published\"", "\"published\", mode_count = 0"));
    assert!(none.contains("must be at least one, not 0"), "{none}");
    let controlled = told(&(linear + "\n[[steps]]\nto = 1.0\ncontrol.arc_length = { size = 0.1 }\n"));
    assert!(controlled.contains("follows time only"), "{controlled}");
}

#[test]
fn the_figures_of_the_publication_are_computed() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = |name: &str| {
        let figure = FIGURES.iter().find(|f| f.name == name).expect("a figure");
        let text = reproduce(figure, folder.path()).unwrap_or_else(|e| panic!("{e}"));
        assert!(folder.path().join(format!("{name}.md")).is_file());
        assert!(folder.path().join(format!("{name}.svg")).is_file());
        text
    };
    // The rows of a table, each cell as a number where it is one.
    let rows = |text: &str| -> Vec<Vec<f64>> {
        let cells = |line: &str| line.split('|').map(|c| c.trim().parse().unwrap_or(f64::NAN)).collect();
        text.lines().filter(|l| l.starts_with("| ")).skip(1).map(cells).collect()
    };
    let way = rows(&page("front_evolution"));
    let radii: Vec<f64> = way.iter().map(|row| row[2]).collect();
    assert!((radii[0] - 0.6f64.sqrt()).abs() < 5e-3 && radii.windows(2).all(|r| r[1] <= r[0] + 1e-6), "{radii:?}");
    assert!((radii[radii.len() - 1] - RADIUS).abs() < 2e-4, "{radii:?}");
    let waves = rows(&page("modes"));
    // By symmetry the second wave has nothing to do on the one mesh, but on the other.
    assert!(waves[0][4] < 1e-3 * waves[1][4] && waves[0][6] > 10.0 * waves[0][4], "{waves:?}");
    let states = rows(&page("axisymmetric"));
    assert!(states.iter().all(|row| row[4] <= 1e-10) && states.len() == 5, "{states:?}");
}
