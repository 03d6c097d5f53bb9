//! From a plan to results: one driver for all models.

mod checkpoint;
mod driver;
mod environment;
mod mechanics;
mod membrane;
mod record;
mod sizes;
mod solid;
mod strain;

use crate::fields::ShownState;
use crate::output::OutputError;
use crate::plan::{Plan, plan};
use crate::problem::{CaseError, Problem};
use crate::report::{Reason, Summary};
use driver::{Model, drive, go_on};
use mechanics::MechanicsModel;
use membrane::MembraneModel;
use signorini_membrane::line_zone::LineZone;
use signorini_membrane::plane_zone::PlaneZone;
pub use signorini_solve::{Iteration, Progress, Silent};
pub use sizes::{preview, sizes};
use solid::SolidModel;
use std::path::Path;
use std::time::Instant;

/// Why a run has no summary.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    #[error(transparent)]
    Case(#[from] Box<CaseError>),
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl From<CaseError> for RunError {
    fn from(error: CaseError) -> Self {
        RunError::Case(Box::new(error))
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    Converged,
    NotConverged,
    Interrupted,
}

impl Ending {
    /// The ending that a reason means.
    fn of(reason: Reason) -> Self {
        match reason {
            Reason::Interrupted => Self::Interrupted,
            reason if reason.is_converged() => Self::Converged,
            _ => Self::NotConverged,
        }
    }
}

/// What a run leaves behind.
pub struct Outcome {
    pub summary: Summary,
    pub ending: Ending,
    /// The states of [`solve`], as often as the output asks for; of a run with a folder they are there.
    pub states: Vec<ShownState>,
}

/// Runs a case and writes its results into a folder, with the threads of rayon's current pool.
pub fn run(problem: &Problem, folder: &Path, progress: &mut dyn Progress) -> Result<Outcome, RunError> {
    begin(problem, folder, Begun::Fresh, progress)
}

/// Where a run begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Begun {
    /// At its beginning, as was asked.
    Fresh,
    /// After the last increment that an earlier run kept.
    Resumed,
    /// At its beginning, as the earlier run kept no increment.
    Anew,
    /// Nowhere: the earlier run is done.
    Done,
}

/// Where a run of a case would go on in the folder of an earlier one.
///
/// # Errors
/// A folder without a run, or with one of another case.
pub fn begun(problem: &Problem, folder: &Path) -> Result<Begun, CaseError> {
    checkpoint::begun(folder, &crate::case::text(problem)).map_err(not_resumed)
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
    let mut model = model(problem)?;
    let record = record::in_memory(model.head());
    drive(&mut *model, record, 0, start, progress)
}

fn begin(problem: &Problem, folder: &Path, begun: Begun, progress: &mut dyn Progress) -> Result<Outcome, RunError> {
    let start = Instant::now();
    // Everything that can be checked is checked before the folder is touched.
    let mut model = model(problem)?;
    if begun == Begun::Resumed {
        let record = record::of_earlier_run(model.head(), folder);
        return go_on(&mut *model, record, folder, start, progress);
    }
    let record = record::begin(model.head(), folder)?;
    drive(&mut *model, record, 0, start, progress)
}

/// The model of a problem at its beginning.
fn model(problem: &Problem) -> Result<Box<dyn Model>, CaseError> {
    Ok(match plan(problem)? {
        Plan::Line(p) => Box::new(MembraneModel::<1, LineZone>::new(p)?),
        Plan::Plane(p) => Box::new(MembraneModel::<2, PlaneZone>::new(p)?),
        Plan::PlaneSolids(p) => Box::new(SolidModel::new(*p)?),
        Plan::Solids(p) => Box::new(SolidModel::new(*p)?),
        Plan::Mechanics(p) => Box::new(MechanicsModel::new(*p)),
    })
}

/// Why there is nothing to go on with, for a user.
fn not_resumed(why: String) -> CaseError {
    CaseError::new(why).help("run it from the beginning, without --resume")
}
