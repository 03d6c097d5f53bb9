//! Of `paths`.

use serde_json::{Value, json};
use signorini::paths::{PathCase, run, sentences};
use signorini::plan::paths::Task;
use signorini::run::Silent;

const WRAPPING: &str = "analysis = \"wrapping\"\nframes = 2\nconstants.height = 0.3\n\
    [bodies.egg.rigid]\nshape.ellipsoid = { center = [0, 0, 0], semi_axes = [2, 1.5, 1] }\n\
    [paths.tendon]\nfrom = [-3, \"0.5 + 4*t\", \"height\"]\nto = [2.2, 1.6, -0.9]\naround = [\"egg\"]\n\
    friction.coulomb = { mu = 0.3 }\ntension = 2.0\nend_tension = \"2 + t\"\n";

const WINDING: &str = "analysis = \"winding\"\nunits = \"mm-N-MPa\"\n\
    [bodies.dome.rigid]\nshape.ellipsoid = { center = [0, 0, 0], semi_axes = [50, 50, 30] }\n\
    [winding.yarn]\non = \"dome\"\nstart = { z = 0.0, angle = \"25 deg\" }\nfriction = 0.2\n\
    polar_opening = { radius = \"2.57059722868 cm\" }\n";

const ROPE: &str = "analysis = \"euler_eytelwein\"\n\
    [bodies.drum.rigid]\nshape.cylinder = { point = [0, 0, 0], axis = [0, 0, 1], radius = 2 }\n\
    [ropes.line]\non = \"drum\"\npath.helix = { radius = 2, pitch = 3, turns = 1.5 }\n\
    friction.coulomb = { mu = 0.2 }\ntension = 10\nend_tension = 40\n";

fn summary(text: &str) -> (tempfile::TempDir, Value) {
    let folder = tempfile::tempdir().unwrap();
    let case = PathCase::parse("case.toml", text, &[]).unwrap();
    let summary = run(&case, &folder.path().join("out"), &mut Silent).unwrap();
    assert!(!sentences(&summary).is_empty() && summary.steps.iter().all(|s| s.converged));
    let written = std::fs::read_to_string(folder.path().join("out/summary.json")).unwrap();
    let written: Value = serde_json::from_str(&written).unwrap();
    assert_eq!(written["case"], summary.case);
    (folder, json!(summary))
}

#[test]
fn a_shortest_path_from_a_case_file() {
    let (folder, summary) = summary(WRAPPING);
    let frames = &summary["paths"][0]["frames"];
    assert!((frames[0]["length"].as_f64().unwrap() - 5.488_014_095_081).abs() < 1e-10, "{frames}");
    assert_eq!(frames[1]["contacts"].as_array().unwrap().len(), 0);
    assert_eq!(summary["paths"][0]["events"][0]["kind"], "lift_off");
    let limit = frames[0]["tension_limits"][1].as_f64().unwrap();
    assert!((limit - 2.0 * frames[0]["log_ratio"][1].as_f64().unwrap().exp()).abs() < 1e-12);
    let out = folder.path().join("out");
    for file in [
        "paths/tendon.csv",
        "paths/tendon.pvd",
        "paths/frames/tendon_0001.vtp",
        "bodies.pvd",
        "history.csv",
        "pictures/paths.png",
    ] {
        assert!(out.join(file).exists(), "{file}");
    }
    // The folder may be written again, without pictures.
    let case = PathCase::parse("case.toml", &format!("{WRAPPING}\n[output]\npictures = false"), &[]).unwrap();
    assert!(run(&case, &out, &mut Silent).is_ok_and(|summary| summary.first_picture.is_none()));
    assert!(!out.join("pictures").exists());
    for (key, text) in [("limits.max_time", "[limits]\nmax_time = 1"), ("output.every", "[output]\nevery = 2")] {
        let refused = PathCase::parse("case.toml", &format!("{WRAPPING}\n{text}"), &[]);
        assert!(refused.is_err_and(|error| error.message.contains(key)));
    }
}

#[test]
fn a_yarn_from_a_case_file() {
    let (folder, summary) = summary(WINDING);
    let yarn = &summary["winding"][0];
    assert!((yarn["slippage_sought"].as_f64().unwrap() - 0.1).abs() < 1e-8, "{yarn}");
    assert!((yarn["length"].as_f64().unwrap() - 58.410_219_3).abs() < 1e-6 && yarn["stable"] == true, "{yarn}");
    assert!(folder.path().join("out/paths/yarn.csv").exists());
    let varied = WINDING
        .replace("polar_opening = { radius = \"2.57059722868 cm\" }", "slippage = \"0.001*s + 0*r\"\nlength = 10");
    let case = PathCase::parse("case.toml", &varied, &[]).unwrap();
    let Task::Winding(list) = &case.plan.task else { panic!() };
    let Some(signorini_paths::winding::Slippage::Variable(f)) = &list[0].slippage else { panic!() };
    let at = signorini_paths::winding::At { s: 20.0, angle: 0.3, radius: 1.0, height: 2.0 };
    assert!((f(&at) - 0.02).abs() < 1e-15);
}

/// On a cylinder a helix of inclination `β` turns by `φ cos β` on a circle of curvature: `ln T₁/T₀ <= μ φ cos β`.
#[test]
fn a_rope_on_a_given_curve_from_a_case_file() {
    let (folder, found) = summary(ROPE);
    let turn = 3.0 * std::f64::consts::PI;
    let inclination = (3.0 / (4.0 * std::f64::consts::PI)).atan();
    let limit = 10.0 * (0.2 * turn * inclination.cos()).exp();
    let rope = &found["ropes"][0];
    assert!((rope["tension_limits"][1].as_f64().unwrap() - limit).abs() < 1e-9 * limit, "{rope}");
    assert_eq!(rope["holds"], true, "{rope}");
    let out = folder.path().join("out");
    let table = std::fs::read_to_string(out.join("paths/line.csv")).unwrap();
    assert!(table.starts_with("s,x,y,z") && table.contains("tension") && out.join("paths/line.vtp").exists());
    let formula =
        "path.formula = { position = [\"2*cos(u)\", \"2*sin(u)\", \"0.3*sin(2*u)\"], from = 0, to = \"2*pi\" }";
    let bent = ROPE.replace("path.helix = { radius = 2, pitch = 3, turns = 1.5 }", formula);
    let (_, found) = summary(&bent.replace("mu = 0.2", "mu = [0.2, 0.05]"));
    let told = found["ropes"][0]["verdict"].as_str().unwrap();
    assert!(told.contains("slides sideways at s = "), "{told}");
}

#[test]
fn refused_cases_say_where() {
    let wrong = |text: &str, part: &str, line: usize| {
        let Err(error) = PathCase::parse("case.toml", text, &[]) else { panic!("{part} is not refused") };
        let place = error.place.as_ref().map(|place| place.line_and_column().0);
        assert!(error.to_string().contains(part) && place == Some(line), "{error:?}");
    };
    wrong(&WRAPPING.replace("[\"egg\"]", "[\"eg\"]"), "there is no body `eg`", 9);
    wrong(&WRAPPING.replace("[\"egg\"]", "[[\"egg\"], []]"), "there are 1 parts between fixed points", 9);
    wrong(&WRAPPING.replace("frames = 2", "frames = 0"), "`frames` is 0", 2);
    wrong(&WRAPPING.replace("mu = 0.3", "mu = -0.3"), "coefficient of friction", 10);
    wrong(&WRAPPING.replace("\"height\"", "\"hight\""), "unknown name `hight`", 7);
    wrong(&WINDING.replace("25 deg", "wide deg"), "is not an angle in degrees", 7);
    wrong(&WINDING.replace("2.57059722868 cm", "2 N"), "the unit is that of a force", 9);
    wrong(&ROPE.replace("euler_eytelwein", "winding"), "`ropes` belongs to another analysis", 4);
    wrong(&ROPE.replace("pitch = 3, ", ""), "pitch", 6);
    wrong(&ROPE.replace("end_tension = 40", "end_tension = 0"), "must be positive", 9);
}
