//! What measurements tell of a contact: the energy of adhesion, and if wanted the tension, from loads and contact radii.
//!
//! A membrane is linear while its zone stays the same. So the slope with which it leaves the floor at the radius `c` is
//! `ρ(c) = ρ₀(c) + ρ₁(c)/τ`, of the floor and of the load, for `τ` times the tension stated; both parts are computed once
//! for every measurement and many radii. The radius that the model predicts is the stable root of
//! `ρ(c) = √(2γ/(τT))`, and least squares in the logarithms of the unknowns do the rest.

mod data;
mod estimate;
mod model;
mod picture;
pub(crate) mod student;

pub use data::Measurements;
pub use estimate::{Estimate, Parameter};
pub use model::{Model, Quantity};

use crate::output::{Folder, OutputError};
use crate::plan::{Plan, plan};
use crate::problem::{CaseError, Problem};
use crate::problem::{FitUnknown, Noise, Space};
use crate::run::RunError;
use serde_json::{Value, json};
use std::path::Path;

/// What was found.
pub struct Fitted {
    pub summary: Value,
    /// Whether the search for the least squares ended.
    pub converged: bool,
}

/// Fits the unknowns of a case to its measurements, and writes the results into a folder.
pub fn fit(problem: &Problem, folder: &Path) -> Result<Fitted, RunError> {
    fit_into(problem, || Folder::create(folder))
}

/// The same into a folder that is made once all is checked, or that is in memory.
///
/// # Errors
/// Those of [`fit`].
pub fn fit_into(problem: &Problem, folder: impl FnOnce() -> Result<Folder, OutputError>) -> Result<Fitted, RunError> {
    let Some(key) = &problem.fit else {
        return Err(CaseError::new(format!("{} has no table [fit]", problem.name()))
            .help("add  [fit]  data = \"measured.csv\"  time = \"pressure\"  radius = \"radius\"")
            .into());
    };
    let Plan::Line(planned) = plan(problem)? else {
        let space = &problem.space;
        return Err(problem
            .error(space, "a fit requires a contact zone described by one number")
            .help("space = \"axisymmetric\" for a round membrane, \"line\" for a strip")
            .into());
    };
    if planned.contacts.len() != 1 {
        let found = planned.contacts.len();
        return Err(problem.error(key, format!("exactly one contact is measured, but the case has {found}")).into());
    }
    if planned.space == Space::Axisymmetric && planned.grid.bounds().min[0] != 0.0 {
        return Err(problem.error(&problem.space, "a fit requires a disc: its radius must begin at 0").into());
    }
    let confidence = key.confidence.unwrap_or(0.95);
    if let Some(c) = &key.confidence
        && !(confidence > 0.0 && confidence < 1.0)
    {
        return Err(problem.error(c, format!("a confidence of {confidence} is not between 0 and 1")).into());
    }
    let unknown: Vec<FitUnknown> = match &key.unknown {
        None => vec![FitUnknown::Adhesion],
        Some(list) => list.iter().copied().collect(),
    };
    let with_tension = unknown.contains(&FitUnknown::Tension);
    if !unknown.contains(&FitUnknown::Adhesion) {
        let at = key.unknown.as_ref().map_or_else(|| problem.key(key), |u| problem.key(u));
        return Err(problem
            .error(&at, "the adhesion energy must be one of the unknowns")
            .help("unknown = [\"adhesion\"], or [\"adhesion\", \"tension\"]")
            .into());
    }
    let (quantity, column) = match (&key.radius, &key.area) {
        (Some(column), None) => (Quantity::Radius, column),
        (None, Some(column)) => (Quantity::Area, column),
        _ => {
            return Err(problem
                .error(key, "the fit requires either `radius` or `area`")
                .help("radius = \"NAME OF THE COLUMN\"")
                .into());
        }
    };
    let measured = data::read(problem, key, column)?;
    let parameters = 1 + usize::from(with_tension);
    if measured.time.len() <= parameters {
        return Err(problem
            .error(&key.data, format!("{} measurements are too few for {parameters} unknowns", measured.time.len()))
            .help("give at least one more than there are unknowns")
            .into());
    }
    for &time in &measured.time {
        planned.check_fields(&planned.at(time), time)?;
    }
    let model = Model::new(&planned, quantity, &measured.time)
        .map_err(|e| problem.error(key, format!("the membrane could not be solved: {e}")))?;
    model.check(problem, key, &measured)?;
    let relative = key.noise.unwrap_or_default() == Noise::Relative;
    let estimate = Estimate::new(&model, &measured.value, with_tension, relative, confidence);
    let folder = folder()?;
    write(problem, &folder, &measured, &estimate, confidence).map_err(RunError::from)
}

fn write(
    problem: &Problem,
    folder: &Folder,
    measured: &Measurements,
    estimate: &Estimate,
    confidence: f64,
) -> Result<Fitted, OutputError> {
    let entry = |p: &Parameter| json!({"value": p.value, "interval": p.interval, "relative_error": p.relative_error});
    let summary = json!({
        "schema": crate::report::SCHEMA,
        "case": problem.name(),
        "converged": estimate.converged,
        "measurements": measured.time.len(),
        "confidence": confidence,
        "adhesion_energy": entry(&estimate.adhesion),
        "tension_factor": estimate.tension.as_ref().map(entry),
        "correlation": estimate.correlation,
        "scatter": estimate.scatter,
        "warnings": problem.source.renamed_keys().into_iter().chain(estimate.warnings.clone()).collect::<Vec<_>>(),
        "verdict": estimate.verdict(confidence),
    });
    let mut rows = String::from("time,measured,fitted,residual\n");
    for (i, t) in measured.time.iter().enumerate() {
        rows += &format!("{t},{},{},{}\n", measured.value[i], estimate.fitted[i], estimate.residuals[i]);
    }
    folder.write("case.toml", crate::case::text(problem).as_bytes())?;
    folder.write("fit.csv", rows.as_bytes())?;
    crate::output::chart::save(folder, "fit", &picture::draw(measured, estimate)?)?;
    let text = serde_json::to_string_pretty(&summary).unwrap_or_default() + "\n";
    folder.write("summary.json", text.as_bytes())?;
    Ok(Fitted { summary, converged: estimate.converged })
}
