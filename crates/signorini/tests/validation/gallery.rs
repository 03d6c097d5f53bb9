//! Every case of the gallery runs, at a coarse size, and gives the numbers that its folder states.

use super::{CELLS, last_step, number, set, summary};
use serde_json::Value;

fn expected(name: &str) -> Value {
    let path = format!("{}/../../gallery/{name}/expected.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{path}: {e}"))
}

#[test]
fn every_case_gives_its_expected_numbers() {
    for example in signorini::gallery::GALLERY {
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
            continue;
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
}

/// Of paths by their place in the summary, which is one as those of all models.
#[test]
fn every_path_gives_its_expected_numbers() {
    let validator = jsonschema::validator_for(&signorini::report::words::schema()).expect("a schema");
    for example in signorini::gallery::PATHS {
        let expected = expected(example.name);
        let case = signorini::paths::PathCase::parse("case.toml", example.case, &[])
            .unwrap_or_else(|e| panic!("{}: {}", example.name, e.one_line()));
        let folder = tempfile::tempdir().expect("a temporary folder");
        let summary = signorini::paths::run(&case, &folder.path().join("out"), &mut signorini::run::Silent)
            .unwrap_or_else(|e| panic!("{}: {e:?}", example.name));
        let summary = serde_json::json!(summary);
        let errors: Vec<String> =
            validator.iter_errors(&summary).map(|e| format!("{}: {e}", e.instance_path())).collect();
        assert!(errors.is_empty(), "{}: {errors:#?}", example.name);
        for (place, figure) in expected["figures"].as_object().expect("figures") {
            let found = number(summary.pointer(place).unwrap_or(&Value::Null));
            let (value, tolerance) = (number(&figure["value"]), number(&figure["relative_tolerance"]));
            assert!((found / value - 1.0).abs() <= tolerance, "{}: {place} is {found}, not {value}", example.name);
        }
    }
}
