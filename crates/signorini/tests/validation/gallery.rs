//! Every case of the gallery runs, at a coarse size, and gives the numbers that its folder states. Each is a test of its own, so
//! that they run beside one another.

use super::{CELLS, last_step, number, set, summary};
use serde_json::Value;
use signorini::gallery::{Example, GALLERY, PATHS};

fn expected(name: &str) -> Value {
    let path = format!("{}/../../gallery/{name}/expected.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// A test for each named example, and one that none is left out.
macro_rules! tests_of {
    ($examples:ident, $check:ident: $($name:ident)*) => {
        $(#[test]
        fn $name() {
            super::$check(signorini::gallery::find(stringify!($name)).expect("an example"));
        })*

        #[test]
        fn none_is_left_out() {
            assert_eq!([$(stringify!($name)),*], super::$examples.map(|e| e.name));
        }
    };
}

mod cases {
    tests_of! { GALLERY, gives_its_expected_numbers:
        string axisymmetric snap_in fold ball blister flat_disc cosine_disc cosine_square tilted_floor drum two_floors
        active_set hertz hertz_sphere patch_test punch cylinder_on_block high_order_blocks torus ironing
        cattaneo_mindlin incline roller wedge press_fit peel jkr ring seal snap_fit brinell tubes groove capstan edge belt
        elastic_pulley sphere_parallel crossing twist clasp knot hertz_cells hertz_published plate_holes ball_cells rubber_tube two_balls foot pore pore_discs
        lattice foam die brake impact cradle dice duels arch cards
        tippe_top
    }
}

mod paths {
    tests_of! { PATHS, path_gives_its_expected_numbers:
        helix geodesic tendon scan dome
    }
}

fn gives_its_expected_numbers(example: &Example) {
    let expected = expected(example.name);
    let mut pairs = Vec::new();
    if let Some(cells) = expected.get("cells") {
        pairs.push((CELLS, cells.to_string()));
    }
    let summary = summary(example.case, &set(&pairs));
    // Solids state figures by their place in the last step.
    if let Some(figures) = expected.get("figures").and_then(Value::as_object) {
        for (place, figure) in figures {
            let found = number(last_step(&summary).pointer(place).unwrap_or(&Value::Null));
            let (value, tolerance) = (number(&figure["value"]), number(&figure["relative_tolerance"]));
            assert!((found / value - 1.0).abs() <= tolerance, "{}: {place} is {found}, not {value}", example.name);
        }
        return;
    }
    let contact = &last_step(&summary)["contacts"]["touch"];
    for key in ["area", "force"] {
        let found = if key == "force" { number(&contact["force"][2]) } else { number(&contact[key]) };
        let (value, tolerance) = (number(&expected[key]["value"]), number(&expected[key]["relative_tolerance"]));
        assert!((found / value - 1.0).abs() <= tolerance, "{}: {key} is {found}, not {value}", example.name);
    }
    for key in ["zones", "holes"] {
        assert_eq!(contact[key], expected[key], "{}: {key}", example.name);
    }
}

/// By their place in the summary, which is one as those of all models.
fn path_gives_its_expected_numbers(example: &Example) {
    let validator = jsonschema::validator_for(&signorini::report::words::schema()).expect("a schema");
    let expected = expected(example.name);
    let case = signorini::paths::PathCase::parse("case.toml", example.case, &[])
        .unwrap_or_else(|e| panic!("{}: {}", example.name, e.one_line()));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let summary = signorini::paths::run(&case, &folder.path().join("out"), &mut signorini::run::Silent)
        .unwrap_or_else(|e| panic!("{}: {e:?}", example.name));
    let summary = serde_json::json!(summary);
    let errors: Vec<String> = validator.iter_errors(&summary).map(|e| format!("{}: {e}", e.instance_path())).collect();
    assert!(errors.is_empty(), "{}: {errors:#?}", example.name);
    for (place, figure) in expected["figures"].as_object().expect("figures") {
        let found = number(summary.pointer(place).unwrap_or(&Value::Null));
        let (value, tolerance) = (number(&figure["value"]), number(&figure["relative_tolerance"]));
        assert!((found / value - 1.0).abs() <= tolerance, "{}: {place} is {found}, not {value}", example.name);
    }
}
