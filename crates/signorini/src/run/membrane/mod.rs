//! A membrane as a model: what its history finds goes into summary, files and pictures.

mod report;
mod saved;
mod verdict;

use super::audit;
use super::checkpoint;
use super::driver::{Advanced, Model};
use super::record::{Record, START};
use crate::fields::ShownState;
use crate::output::film::Film;
use crate::output::{Folder, OutputError, pictures, tables, vtk};
use crate::plan::{Control, Head, MembranePlan};
use crate::problem::CaseError;
use crate::report::{OtherState, Reason, StepReport};
use crate::snapshot::{DisplayMesh, Snapshot};
use serde_json::Value;
use signorini_audit::Finding;
use signorini_geometry::Point;
use signorini_membrane::coexisting;
use signorini_membrane::history::{self, History, RemarkKind, Sample};
use signorini_solve::Progress;
use std::path::Path;
use std::rc::Rc;

/// A membrane on its way through its history.
pub struct MembraneModel<const D: usize> {
    plan: Rc<MembranePlan<D>>,
    mesh: DisplayMesh<D>,
    history: Box<dyn History<D>>,
    film: Film<Snapshot<D>>,
    /// The state at t = 0, where that is one of rest.
    rest: Option<Snapshot<D>>,
    last: Option<Snapshot<D>>,
}

impl<const D: usize> MembraneModel<D> {
    /// A membrane at its beginning.
    ///
    /// # Errors
    /// Fields that cannot be used at the first time.
    pub fn new(plan: MembranePlan<D>) -> Result<Self, CaseError> {
        if let Some(&time) = plan.known_times().first() {
            plan.check_fields(&plan.at(time), time)?;
        }
        let plan = Rc::new(plan);
        let mesh = DisplayMesh::new(&plan, &plan.at(plan.increments[0].range[0]));
        let history = (plan.kernel.history)(plan.clone());
        let rest = at_rest(&plan, &mesh);
        let mut film = Film::default();
        if plan.head.pictures && plan.increments.len() > 1 {
            rest.iter().for_each(|rest| film.add(rest));
        }
        Ok(Self { plan, mesh, history, film, rest, last: None })
    }
}

/// The state at t = 0 where the membrane is flat then and clear of what it may touch: without loads and displacements of
/// supports. None where a history does not begin at t = 0, or not with that state.
fn at_rest<const D: usize>(plan: &MembranePlan<D>, mesh: &DisplayMesh<D>) -> Option<Snapshot<D>> {
    let first = plan.increments.first()?;
    let [from, to] = first.range;
    // A path of equilibria begins somewhere else.
    if from != 0.0 || to <= 0.0 || plan.initial_zone.is_some() || first.control != Control::Time {
        return None;
    }
    let membrane = plan.at(0.0);
    let still = |x: &Point<D>| {
        membrane.load.value(x) == 0.0
            && membrane.supports.iter().flatten().all(|s| s.displacement.value(x) == 0.0)
            && membrane.obstacles.least_gap(x, 0.0).0 > 0.0
    };
    let flat = |_: &Point<D>| Some(Sample { displacement: 0.0, in_contact: false, pressure: 0.0 });
    mesh.points.iter().all(still).then(|| Snapshot::new(mesh, &membrane, 0.0, Vec::new(), flat))
}

impl<const D: usize> Model for MembraneModel<D> {
    fn head(&self) -> &Head {
        &self.plan.head
    }

    fn increments(&self) -> usize {
        self.plan.increments.len()
    }

    fn time(&self, index: usize) -> f64 {
        self.plan.increments[index].time
    }

    fn begins_at_rest(&self) -> bool {
        self.rest.is_some()
    }

    fn advance(
        &mut self,
        index: usize,
        record: &mut Record,
        progress: &mut dyn Progress,
    ) -> Result<Advanced, CaseError> {
        let (advanced, told) = self.history.advance(index, progress);
        for remark in told.remarks {
            // One of each kind, but every one of those that tell what became of the history.
            let every = matches!(remark.kind, RemarkKind::Path | RemarkKind::Jump | RemarkKind::EventInterval);
            match every {
                true => record.warnings.push(report::warning(remark)),
                false => record.warn_once(report::warning(remark)),
            }
        }
        record.events.extend(told.events.iter().map(|event| report::event(&self.plan, event)));
        let found = match advanced {
            history::Advanced::State(found) => found,
            history::Advanced::Nothing => return Ok(Advanced::Nothing),
            history::Advanced::Lost => return Ok(Advanced::Failed(Reason::PathLost)),
            history::Advanced::Interrupted => return Ok(Advanced::Failed(Reason::Interrupted)),
            history::Advanced::Invalid { time } => {
                self.plan.check_fields(&self.plan.at(time), time)?;
                return Ok(Advanced::Failed(Reason::Input));
            }
        };
        let increment = &found.increment;
        let membrane = self.plan.at(found.time);
        record.unknowns = record.unknowns.max(increment.unknowns);
        let loads = self.plan.load_resultants(&membrane, found.time);
        let mut step = report::step_report(increment, &self.plan, (record.steps.len(), found.time), &loads);
        let state =
            |o: &coexisting::OtherState| OtherState { area: o.area, energy_total: o.energy_total, stable: o.stable };
        for contact in step.contacts.values_mut() {
            contact.other_states = found.others.iter().map(state).collect();
        }
        record.steps.push(step);
        let sample = increment.sample.as_ref();
        let snapshot = sample.map(|s| Snapshot::new(&self.mesh, &membrane, found.time, increment.outlines.clone(), s));
        if let (Some(snapshot), false) = (&snapshot, found.interrupted)
            && self.plan.head.pictures
            && self.plan.increments.len() > 1
        {
            self.film.add(snapshot);
        }
        self.last = snapshot.or(self.last.take());
        Ok(if found.interrupted { Advanced::Failed(Reason::Interrupted) } else { Advanced::State })
    }

    fn audit(&mut self, step: &StepReport) -> Vec<Finding> {
        audit::of_membrane(step)
    }

    fn write_fields(&mut self, index: usize, record: &mut Record) -> Result<(), OutputError> {
        let Some(s) = &self.last else { return Ok(()) };
        let name = format!("{index:05}");
        let units = record.units.clone();
        if let Some(rest) = self.rest.as_ref().filter(|_| record.frames.is_empty()) {
            let file = format!("fields/fields_{START}.vtu");
            record.folder.write(&file, &vtk::fields(&self.mesh, rest, units.as_ref())?)?;
            record.add_frame(0.0, START.into(), &["contact"])?;
        }
        record.folder.write(&format!("fields/fields_{name}.vtu"), &vtk::fields(&self.mesh, s, units.as_ref())?)?;
        record.folder.write(&format!("contact/contact_{name}.vtp"), &vtk::outlines(s)?)?;
        record.folder.write(&format!("contact/outlines_{name}.csv"), tables::outlines(s).as_bytes())?;
        record.add_frame(s.time, name, &["contact"])
    }

    fn shown(&self) -> Option<ShownState> {
        let last = self.last.as_ref()?;
        let bodies = vec![last.to_fields(&self.plan.body, &self.mesh)];
        Some(ShownState { time: last.time, bodies, contacts: vec![last.edges()] })
    }

    fn draw(&self, record: &Record) -> Result<(), OutputError> {
        let Some(last) = &self.last else { return Ok(()) };
        let states = record.history(self.rest.is_some());
        let history = (&*states, record.events.as_slice());
        pictures::draw(&record.folder, &self.plan, &self.mesh, last, self.film.frames(), history)
    }

    fn first_picture(&self) -> Option<String> {
        self.last.as_ref().map(|_| "pictures/deflection.png".into())
    }

    fn verdict(&self, record: &Record, reason: Reason) -> String {
        verdict::verdict(&self.plan, record, reason)
    }

    fn method(&self) -> String {
        self.plan.method.name().into()
    }

    fn save(&self, folder: &Folder, next: usize) -> Result<Option<Value>, OutputError> {
        // Along a path the way back leads to the beginning of its step.
        if self.plan.increments[next - 1].control != Control::Time {
            return Ok(None);
        }
        if let Some(frame) = self.last.as_ref().filter(|_| self.plan.head.pictures) {
            saved::write_frame(folder, next - 1, frame)?;
        }
        Ok(Some(self.history.save()))
    }

    fn restore(&mut self, state: Value, folder: &Path, next: usize) -> Result<(), String> {
        let damaged = || checkpoint::damaged(folder);
        self.history.restore(&state).ok_or_else(damaged)?;
        for frame in saved::frames(folder, next).ok_or_else(damaged)? {
            self.film.add(&frame);
        }
        Ok(())
    }
}
