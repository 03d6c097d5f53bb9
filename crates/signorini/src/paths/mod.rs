//! Runs of problems of paths on rigid bodies: shortest paths over bodies that move, paths of yarns on mandrels, ropes on
//! given curves. No equations of bodies are solved.

mod case;
pub(crate) mod output;
pub(crate) mod picture;
mod rope;
pub(crate) mod surface;
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
use std::collections::BTreeMap;
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
    run_into(case, &Folder::create(folder)?, progress)
}

/// The same into a folder that exists, or that is in memory.
///
/// # Errors
/// Those of [`run`].
pub fn run_into(case: &PathCase, folder: &Folder, progress: &mut dyn Progress) -> Result<Summary, SceneError> {
    let start = Instant::now();
    let text = crate::case::text(case.problem());
    folder.write("case.toml", text.as_bytes())?;
    let (method, found) = match &case.plan.task {
        Task::Wrapping { frames, paths } => ("wrapping", wrapping::run(case, (*frames, paths), folder, progress)?),
        Task::Winding(list) => ("winding", winding::run(case, list, folder, progress)?),
        Task::EulerEytelwein(list) => ("euler_eytelwein", rope::run(case, list, folder, progress)?),
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
        materials: BTreeMap::new(),
        interpreted: head.interpreted.clone(),
        steps: found.steps,
        events: Vec::new(),
        contact_events: Vec::new(),
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
