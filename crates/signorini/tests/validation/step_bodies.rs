//! Solids of STEP files as rigid bodies: the same answers as shapes of the case that they are, and what is told of files.

use super::{last_step, number, set, summary};
use signorini::queries::{Query, answer_points};
use std::path::{Path, PathBuf};

fn file(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../import/tests/import/step_files")).join(name)
}

/// An elastic block under a rigid body.
fn pressed(shape: &str) -> String {
    format!(
        r#"
units = "mm-N-MPa"
[bodies.block.solid]
mesh.box = {{ min = [-1, -1, 0], max = [1, 1, 1], cells = [5, 5, 3] }}
material.linear_elastic = {{ youngs_modulus = 1000, poissons_ratio = 0.3 }}
[bodies.punch.rigid]
shape.{shape}
motion.prescribed.displacement = [0, 0, "-0.05*t"]
[supports.base]
on = "block:bottom"
displacement = [0, 0, 0]
[contacts.touch]
between = ["block:top", "punch"]
[[steps]]
to = 1
"#
    )
}

#[test]
fn a_solid_of_a_file_presses_as_the_shape_that_it_is() {
    let step = |name: &str, keys: &str| format!("step = {{ file = {:?}, {keys} }}", file(name).display().to_string());
    let pairs = [
        (step("hemisphere.step", "translate = [0.1, 0.05, 2]"), "sphere = { center = [0.1, 0.05, 2], radius = 1 }"),
        (
            step("cylinder.step", "scale = 1.5, rotate = [0, 1.5707963267948966, 0], translate = [-1.5, 0, 2.5]"),
            "cylinder = { point = [0, 0, 2.5], axis = [1, 0, 0], radius = 1.5 }",
        ),
    ];
    for (ours, own) in pairs {
        let force = |shape: &str| {
            let found = summary(&pressed(shape), &set(&[]));
            let force = &last_step(&found)["contacts"]["touch"]["force"];
            [0, 1, 2].map(|k| number(&force[k]))
        };
        let (a, b) = (force(&ours), force(own));
        let size = b[2].abs();
        assert!(size > 1.0, "{own}: {b:?}");
        assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-8 * size), "{own}: {a:?}, {b:?}");
    }
}

#[test]
fn points_are_projected_to_the_solid_of_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let (points, answers) = (folder.path().join("points.csv"), folder.path().join("answers.json"));
    std::fs::write(&points, "0.5;1;4\n-1;-1;-1\n0.5;1;1.4\n0.5;3;4\n").unwrap();
    let report = answer_points(&points, &file("box.step"), &answers, &Query::default(), &mut |_| true).unwrap();
    assert_eq!((report.answered, report.wrong_count), (4, 0));
    let found: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(&answers).unwrap()).unwrap();
    let kinds = ["0", "1", "2", "3"].map(|k| found[k]["feature_b"].as_str().unwrap().to_string());
    assert_eq!(kinds, ["interior", "vertex", "interior", "edge"]);
    let gaps = ["0", "1", "2", "3"].map(|k| number(&found[k]["gap"]));
    let wanted = [1.0, 3f64.sqrt(), -0.5, 2f64.sqrt()];
    assert!(gaps.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12), "{gaps:?}");
    // Two faces are as near as each other from within.
    assert_eq!(found["2"]["uniqueness"], "multiple");
}
