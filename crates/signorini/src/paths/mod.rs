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
use crate::problem::{Analysis, Problem};
use crate::report::{
    PathEventKind, PathReport, PathReports, Reason, RopeReport, SCHEMA, StepReport, Summary, UnitNames, Warning,
    WindingReport,
};
use crate::run::{Progress, environment};
use crate::scene::SceneError;
pub use case::PathCase;
use output::Line;
use std::path::Path;
use std::time::Instant;

/// Whether a problem is about paths rather than equilibrium.
pub fn is_of_paths(problem: &Problem) -> bool {
    problem.analysis.is_some_and(|a| a != Analysis::Equilibrium)
}

/// What an analysis of paths found.
#[derive(Default)]
struct Found {
    reports: PathReports,
    /// One for each time.
    steps: Vec<StepReport>,
    /// Unknowns that were solved for, at most.
    unknowns: usize,
    warnings: Vec<Warning>,
}

impl Found {
    /// Results of one time.
    fn at_once(reports: PathReports) -> Self {
        Found { reports, steps: vec![StepReport { converged: true, ..StepReport::default() }], ..Found::default() }
    }
}

/// Runs a case into a folder and returns its summary.
///
/// # Errors
/// A path that is not found, a motion that is not finite, files that cannot be written.
pub fn run(case: &PathCase, folder: &Path, progress: &mut dyn Progress) -> Result<Summary, SceneError> {
    let start = Instant::now();
    let folder = Folder::create(folder)?;
    let text = crate::case::text(case.problem());
    folder.write("case.toml", text.as_bytes())?;
    let (method, found) = match &case.plan.task {
        Task::Wrapping { frames, paths } => ("wrapping", wrapping::run(case, (*frames, paths), &folder, progress)?),
        Task::Winding(list) => ("winding", winding::run(case, list, &folder, progress)?),
        Task::EulerEytelwein(list) => ("euler_eytelwein", rope::run(case, list, &folder, progress)?),
    };
    let head = &case.plan.head;
    let mut summary = Summary {
        schema: SCHEMA,
        case: case.name().to_string(),
        converged: true,
        reason: Reason::Converged,
        answer: None,
        verdict: String::new(),
        method: method.into(),
        unknowns: found.unknowns,
        units: head.unit_names(),
        first_picture: picture::are_wanted(case).then(|| "pictures/paths.png".into()),
        warnings: head.warnings.iter().cloned().chain(found.warnings).collect(),
        interpreted: head.interpreted.clone(),
        steps: found.steps,
        events: Vec::new(),
        of_paths: found.reports,
        environment: environment::describe(start, rayon::current_num_threads(), (&text, 0.0)),
    };
    summary.verdict = sentences(&summary).join("; ");
    folder.write("summary.json", summary.to_json().as_bytes())?;
    Ok(summary)
}

/// A picture of the bodies with the paths at their first time, as SVG.
///
/// # Errors
/// A path that is not found, a picture that cannot be drawn.
pub fn preview(case: &PathCase) -> Result<String, SceneError> {
    let lines = match &case.plan.task {
        Task::Wrapping { paths, .. } => wrapping::at_start(case, paths)?,
        Task::Winding(list) => winding::all(case, list, &mut |_| {})?.0,
        Task::EulerEytelwein(list) => rope::all(case, list, &mut |_| {})?.0,
    };
    let around = surface::box_around(points(&lines), 0.15);
    let bodies = surface::surfaces(case, &[0.0], &around)?;
    Ok(picture::of_paths(case, &bodies[0], &lines)?)
}

/// The points of all lines.
fn points(lines: &[Line]) -> impl Iterator<Item = signorini_geometry::Point<3>> {
    lines.iter().flat_map(|l| l.points.iter().map(|p| p.x))
}

/// Numbers with the units of length and force of a case.
struct Units<'a>(Option<&'a UnitNames>);

impl Units<'_> {
    fn length(&self, v: f64) -> String {
        exact(v, self.0.map_or("", |u| &u.length))
    }

    fn forces(&self, v: [f64; 2]) -> [String; 2] {
        v.map(|v| exact(v, self.0.map_or("", |u| &u.force)))
    }
}

/// What a summary says, in sentences.
pub fn sentences(summary: &Summary) -> Vec<String> {
    let units = Units(summary.units.as_ref());
    let PathReports { paths, winding, ropes } = &summary.of_paths;
    let found = paths.iter().flat_map(|p| of_path(p, &units));
    let found = found.chain(winding.iter().flat_map(|w| of_yarn(w, &units)));
    let found = found.chain(ropes.iter().flat_map(|r| of_rope(r, &units)));
    found.chain(summary.warnings.iter().map(|w| format!("warning: {w}"))).collect()
}

fn of_path(path: &PathReport, units: &Units) -> Vec<String> {
    let name = &path.name;
    let mut out = Vec::new();
    if let (Some(first), Some(last)) = (path.frames.first(), path.frames.last()) {
        let touched = last.contacts.len();
        let times = if touched == 1 { "1 contact".to_string() } else { format!("{touched} contacts") };
        out.push(format!(
            "`{name}`: length {} at t = {}, {} at t = {}, with {times}",
            units.length(first.length),
            exact(first.time, ""),
            units.length(last.length),
            exact(last.time, ""),
        ));
        if let Some(limits) = last.tension_limits {
            let [low, high] = units.forces(limits);
            out.push(format!("friction admits end tensions from {low} to {high} for `{name}`"));
        }
        if let (Some(true), Some(used)) = (last.slips, last.utilisation) {
            out.push(format!("`{name}` slips: {:.0} % of the friction limit is required", 100.0 * used));
        }
    }
    out.extend(path.events.iter().map(|event| {
        let kind = if event.kind == PathEventKind::Touchdown { "touchdown" } else { "lift off" };
        format!("{kind} of `{name}` and `{}` at t = {}", event.body, exact(event.time, ""))
    }));
    out
}

fn of_yarn(yarn: &WindingReport, units: &Units) -> Vec<String> {
    let name = &yarn.name;
    let (length, slippage) = (units.length(yarn.length), exact(yarn.largest_slippage, ""));
    let mut out = vec![format!("`{name}`: length {length}, largest slippage {slippage}")];
    if let (Some(pattern), Some(coverage)) = (&yarn.pattern, &yarn.coverage) {
        out.push(format!(
            "pattern of {} circuits, shifted by {} band positions each, dwell {} rad; {} of the mandrel covered",
            pattern.n,
            pattern.k,
            exact(pattern.dwell, ""),
            exact(coverage.covered, "")
        ));
    }
    let parts = |list: &[[f64; 2]], what: &str, remedy: &str| -> Vec<String> {
        let part = |[from, to]: &[f64; 2]| {
            format!("`{name}` {what} from s = {} to {}: {remedy}", units.length(*from), units.length(*to))
        };
        list.iter().map(part).collect()
    };
    let hollow = "the mandrel is concave along the yarn: use another angle, or a slippage that avoids this region";
    out.extend(parts(&yarn.bridges, "bridges", hollow));
    out.extend(parts(
        &yarn.slips,
        "slips",
        "the slippage exceeds the coefficient of friction: use less slippage, or a larger coefficient",
    ));
    out
}

fn of_rope(rope: &RopeReport, units: &Units) -> Vec<String> {
    let mut out = vec![format!("`{}`: {}", rope.name, rope.verdict)];
    if let Some(limits) = rope.tension_limits {
        let [low, high] = units.forces(limits);
        let [tension, _] = units.forces([rope.tension; 2]);
        out.push(format!("with start tension {tension} friction admits end tensions from {low} to {high}"));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Silent;
    use serde_json::{Value, json};

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
}
