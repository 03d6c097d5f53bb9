//! Runs of problems of paths on rigid bodies: shortest paths over bodies that move, paths of yarns on mandrels, ropes on
//! given curves. No equations of bodies are solved.

mod case;
mod output;
mod picture;
mod rope;
mod surface;
mod winding;
mod wrapping;

use crate::output::Folder;
use crate::output::figure::exact;
use crate::plan::paths::Task;
use crate::problem::units::{FORCE, LENGTH};
use crate::problem::{Analysis, Problem};
use crate::run::Progress;
use crate::scene::SceneError;
pub use case::PathCase;
use serde_json::{Value, json};
use std::path::Path;

/// Whether a problem is about paths rather than equilibrium.
pub fn is_of_paths(problem: &Problem) -> bool {
    problem.analysis.is_some_and(|a| a != Analysis::Equilibrium)
}

/// Runs a case into a folder and returns its summary.
///
/// # Errors
/// A path that is not found, a motion that is not finite, files that cannot be written.
pub fn run(case: &PathCase, folder: &Path, progress: &mut dyn Progress) -> Result<Value, SceneError> {
    let folder = Folder::create(folder)?;
    folder.write("case.toml", crate::case::text(case.problem()).as_bytes())?;
    let mut summary = match &case.plan.task {
        Task::Wrapping { frames, paths } => wrapping::run(case, (*frames, paths), &folder, progress)?,
        Task::Winding(list) => winding::run(case, list, &folder, progress)?,
        Task::EulerEytelwein(list) => rope::run(case, list, &folder, progress)?,
    };
    summary["units"] = match case.plan.head.units {
        Some(_) => json!({"length": case.unit(LENGTH), "force": case.unit(FORCE)}),
        None => Value::Null,
    };
    summary["verdict"] = sentences(&summary).join("; ").into();
    summary["warnings"] = json!(case.plan.head.warnings);
    folder.write("summary.json", format!("{summary:#}\n").as_bytes())?;
    Ok(summary)
}

/// What a summary says, in sentences.
pub fn sentences(summary: &Value) -> Vec<String> {
    let mut out = Vec::new();
    let unit = |of: &str| summary["units"][of].as_str().unwrap_or_default().to_string();
    let (length, force) = (unit("length"), unit("force"));
    let number = |v: &Value| v.as_f64().map_or("-".to_string(), |v| exact(v, ""));
    let long = |v: &Value| v.as_f64().map_or("-".to_string(), |v| exact(v, &length));
    let strong = |v: &Value| v.as_f64().map_or("-".to_string(), |v| exact(v, &force));
    for path in summary["paths"].as_array().into_iter().flatten() {
        let name = path["name"].as_str().unwrap_or_default();
        let frames = path["frames"].as_array().map_or(&[][..], Vec::as_slice);
        if let (Some(first), Some(last)) = (frames.first(), frames.last()) {
            let touched = last["contacts"].as_array().map_or(0, Vec::len);
            let times = if touched == 1 { "once".to_string() } else { format!("{touched} times") };
            out.push(format!(
                "`{name}`: length {} at t = {}, {} at t = {}, where it touches {times}",
                long(&first["length"]),
                number(&first["time"]),
                long(&last["length"]),
                number(&last["time"]),
            ));
            if let Some(limits) = last["tension_limits"].as_array() {
                let [low, high] = [0, 1].map(|k| limits.get(k).map_or("-".into(), strong));
                out.push(format!("friction holds tensions from {low} to {high} at the end of `{name}`"));
            }
            if last["slips"] == true {
                let used = last["utilisation"].as_f64().unwrap_or(f64::NAN);
                out.push(format!("`{name}` slips: {:.0} % of the friction is used", 100.0 * used));
            }
        }
        for event in path["events"].as_array().into_iter().flatten() {
            let text = |key: &str| event[key].as_str().unwrap_or_default().replace('_', " ");
            out.push(format!("{} of `{name}` and `{}` at t = {}", text("kind"), text("body"), number(&event["time"])));
        }
    }
    for path in summary["winding"].as_array().into_iter().flatten() {
        let name = path["name"].as_str().unwrap_or_default();
        out.push(format!(
            "`{name}`: length {}, largest slippage {}",
            long(&path["length"]),
            number(&path["largest_slippage"])
        ));
        if let Some(pattern) = path["pattern"].as_object() {
            out.push(format!(
                "pattern of {} circuits, {} places on after each, dwell {} rad; {} of the mandrel covered",
                pattern["n"],
                pattern["k"],
                number(&pattern["dwell"]),
                number(&path["coverage"]["covered"])
            ));
        }
        let parts = |key: &str| path[key].as_array().into_iter().flatten().map(|p| [long(&p[0]), long(&p[1])]);
        out.extend(parts("bridges").map(|[from, to]| {
            let remedy = "the mandrel is hollow along it: another angle, or a slippage that leads round";
            format!("`{name}` bridges from s = {from} to {to}: {remedy}")
        }));
        out.extend(parts("slips").map(|[from, to]| {
            let remedy = "its slippage is beyond the friction: less of it, or a rougher yarn";
            format!("`{name}` slips from s = {from} to {to}: {remedy}")
        }));
    }
    for rope in summary["ropes"].as_array().into_iter().flatten() {
        out.push(format!(
            "`{}`: {}",
            rope["name"].as_str().unwrap_or_default(),
            rope["verdict"].as_str().unwrap_or("-")
        ));
        if let Some(limits) = rope["tension_limits"].as_array() {
            let [low, high] = [0, 1].map(|k| limits.get(k).map_or("-".into(), strong));
            out.push(format!("with {} at its start it holds {low} to {high} at its end", strong(&rope["tension"])));
        }
    }
    let warnings = summary["warnings"].as_array().into_iter().flatten();
    out.extend(warnings.filter_map(|w| Some(format!("warning: {}", w["message"].as_str()?))));
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Silent;

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
        (folder, summary)
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
        assert!(sentences(&summary).len() > 2);
        // The folder may be written again.
        let case = PathCase::parse("case.toml", WRAPPING, &[]).unwrap();
        assert!(run(&case, &out, &mut Silent).is_ok());
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
        wrong(&WRAPPING.replace("[\"egg\"]", "[[\"egg\"], []]"), "for 1 parts between fixed points", 9);
        wrong(&WRAPPING.replace("frames = 2", "frames = 0"), "`frames` is 0", 2);
        wrong(&WRAPPING.replace("mu = 0.3", "mu = -0.3"), "coefficient of friction", 10);
        wrong(&WRAPPING.replace("\"height\"", "\"hight\""), "unknown name `hight`", 7);
        wrong(&WINDING.replace("25 deg", "wide deg"), "is not a number of degrees", 7);
        wrong(&WINDING.replace("2.57059722868 cm", "2 N"), "the unit is that of a force", 9);
        wrong(&ROPE.replace("euler_eytelwein", "winding"), "`ropes` belongs to another analysis", 4);
        wrong(&ROPE.replace("pitch = 3, ", ""), "pitch", 6);
        wrong(&ROPE.replace("end_tension = 40", "end_tension = 0"), "must be positive", 9);
    }
}
