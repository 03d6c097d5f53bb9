//! From a plan to results: one driver for all models.

mod audit;
mod checkpoint;
mod contact_verdict;
pub(crate) mod driver;
pub(crate) mod environment;
pub(crate) mod mechanics;
mod membrane;
pub(crate) mod outcome;
mod planned;
pub(crate) mod record;
mod sizes;
pub(crate) mod strain;

use crate::output::{Files, Folder};
use crate::plan::{Plan, plan};
use crate::problem::{CaseError, Problem};
use crate::processes;
use driver::{Model, drive, go_on};
use outcome::not_resumed;
pub use outcome::{Begun, Ending, Outcome, RunError};
use planned::Planned;
use record::Record;
use serde_json::Value;
pub use signorini_solve::{Iteration, Progress, Silent};
use std::path::Path;
use std::time::Instant;

/// Runs a case and writes its results into a folder, with the threads of rayon's current pool.
pub fn run(problem: &Problem, folder: &Path, progress: &mut dyn Progress) -> Result<Outcome, RunError> {
    begin(problem, folder, Begun::Fresh, progress)
}

/// Where a run of a case would go on in the folder of an earlier one.
///
/// # Errors
/// A folder without a run, or with one of another case.
pub fn begun(problem: &Problem, folder: &Path) -> Result<Begun, CaseError> {
    processes::all(checkpoint::begun(folder, &crate::case::text(problem)).map_err(not_resumed))
}

/// Goes on with a run that was interrupted or killed, from its last increment; to the same digits. Of a run that is done
/// the summary is read, and nothing is written.
///
/// # Errors
/// Those of [`run`], and a folder without such a run, or with one of another case.
pub fn resume(problem: &Problem, folder: &Path, progress: &mut dyn Progress) -> Result<Outcome, RunError> {
    let begun = begun(problem, folder)?;
    if begun == Begun::Done {
        let summary = checkpoint::summary(folder).map_err(not_resumed)?;
        return Ok(Outcome { summary, ending: Ending::Converged, states: Vec::new() });
    }
    begin(problem, folder, begun, progress)
}

/// Solves a problem and keeps its results in memory: no file is read but those it names, and none is written.
///
/// # Errors
/// What is wrong with the problem, by its key. A history that does not converge is no error: [`Outcome::ending`] and the
/// reason of the summary tell of it, and the states before are there.
pub fn solve(problem: &Problem, progress: &mut dyn Progress) -> Result<Outcome, RunError> {
    let start = Instant::now();
    let mut model = model(problem, progress)?;
    let record = record::in_memory(model.head());
    drive(&mut *model, record, 0, start, progress)
}

/// Solves a problem for its summary alone: nothing is drawn, written or kept.
///
/// # Errors
/// Those of [`solve`].
pub fn summarise(problem: &Problem, progress: &mut dyn Progress) -> Result<Outcome, RunError> {
    let start = Instant::now();
    let mut model = model(problem, progress)?;
    let record = Record::new(model.head(), Folder::default());
    drive(&mut *model, record, 0, start, progress)
}

/// Solves a problem and keeps its states in memory, and what a run writes beside the fields: history, pictures. With a folder
/// all files of a run are written there, else these few are kept in memory and returned.
///
/// # Errors
/// Those of [`run`].
pub fn keep(
    problem: &Problem,
    folder: Option<&Path>,
    progress: &mut dyn Progress,
) -> Result<(Outcome, Files), RunError> {
    let start = Instant::now();
    let mut model = model(problem, progress)?;
    let record = match folder {
        Some(folder) => record::begin(model.head(), folder)?,
        None => Record::new(model.head(), Folder::in_memory()),
    };
    let folder = record.folder.clone();
    let outcome = drive(&mut *model, Record { keeps_states: true, ..record }, 0, start, progress)?;
    Ok((outcome, folder.take_files()))
}

fn begin(problem: &Problem, folder: &Path, begun: Begun, progress: &mut dyn Progress) -> Result<Outcome, RunError> {
    let start = Instant::now();
    // Everything that can be checked is checked before the folder is touched.
    let mut model = model(problem, progress)?;
    // The first of several processes writes for all.
    let writes = processes::rank() == 0;
    let silent = |model: &dyn Model| Record::new(model.head(), Folder::default());
    if begun == Begun::Resumed {
        let record = if writes { record::of_earlier_run(model.head(), folder) } else { silent(&*model) };
        return go_on(&mut *model, record, folder, start, progress);
    }
    let record = if writes { record::begin(model.head(), folder).map_err(RunError::from) } else { Ok(silent(&*model)) };
    let record = processes::all(record)?;
    drive(&mut *model, record, 0, start, progress)
}

/// The model of a problem at its beginning; its size is told.
fn model(problem: &Problem, progress: &mut dyn Progress) -> Result<Box<dyn Model>, CaseError> {
    let planned: Box<dyn Planned> = match processes::all(plan(problem))? {
        Plan::Line(p) => Box::new(p),
        Plan::Plane(p) => Box::new(p),
        Plan::Mechanics(p) => p,
    };
    let model = processes::all(planned.model())?;
    if let Some(size) = &model.head().size {
        progress.size(&size.told);
    }
    Ok(model)
}

fn planned(plan: &Plan) -> &dyn Planned {
    match plan {
        Plan::Line(p) => p,
        Plan::Plane(p) => p,
        Plan::Mechanics(p) => &**p,
    }
}

/// What a run of a plan would have to do: size, time, for a membrane the gap before any load, and warnings; after all that a
/// run checks at the times that are known before it.
///
/// # Errors
/// Fields that cannot be used, at their place.
pub fn sizes(plan: &Plan) -> Result<Value, CaseError> {
    planned(plan).sizes()
}

/// A picture of a case before anything happens in it, as SVG; none where there is nothing to draw.
///
/// # Errors
/// Fields that cannot be used, at their place, and a picture that cannot be drawn.
pub fn preview(plan: &Plan) -> Result<Option<String>, RunError> {
    planned(plan).preview()
}
