//! Solids in contact as a model: their increments, and the ± of the last.

mod failure;
mod report;
pub(crate) mod saved;
mod setup;

use super::audit::solid::{Looked, SolidAudit};
use super::checkpoint;
use super::driver::{Advanced, Model};
use super::record::{Record, START};
use crate::fields::ShownState;
use crate::output::film::Film;
use crate::output::solid_fields::{ContactDisplay, SolidDisplay};
use crate::output::solid_state::SolidFrame;
use crate::output::{Folder, OutputError, rigid, solid_pictures, tables};
use crate::plan::solid::{PlannedBody, SolidContact, SolidPlan, SolidSupport};
use crate::plan::{Head, check_memory};
use crate::problem::CaseError;
use crate::report::{ErrorEstimate, Reason, StepReport};
use failure::{Failure, explained};
use report::{SOLVER, Shown};
use serde_json::Value;
pub(super) use setup::{OPERATIONS_PER_SECOND, cost, judge, load, memory, model};
use setup::{at_time, blamed};
use signorini_audit::Finding;
use signorini_geometry::Point;
use signorini_solid::{Circumstances, ContactResult, Model as Solids, RigidGap, State};
use signorini_solve::cholesky::Cost;
use signorini_solve::{Iteration, Progress};
use std::path::Path;

/// The most unknowns of one degree more, and the seconds of their factorisation, for which errors are estimated.
const AFFORDABLE: f64 = 50_000.0;
const AFFORDABLE_SECONDS: f64 = 3.0;

/// Solids on their way through their history.
pub struct SolidModel<const D: usize> {
    plan: SolidPlan<D>,
    solids: Solids<D>,
    display: SolidDisplay<D>,
    /// The last state.
    last: Option<Shown<D>>,
    /// Why there is no state after it.
    failure: Option<Failure>,
    film: Film<SolidFrame<D>>,
    /// Whether the state at t = 0 is that of rest.
    rests: bool,
    /// What the last increment came to, and what checks it.
    state: Option<State<D>>,
    audit: SolidAudit,
}

impl<const D: usize> SolidModel<D> {
    /// Solids at their beginning.
    ///
    /// # Errors
    /// Supports and contacts that make no sense, at whatever time, and what does not fit into memory.
    pub fn new(plan: SolidPlan<D>) -> Result<Self, CaseError> {
        let mut solids = model(&plan)?;
        judge(&plan, &mut solids)?;
        let cost = cost(&plan, &solids)?;
        check_memory(&plan.head.problem, &format!("{} unknowns", solids.unknowns()), memory(&cost))?;
        let display = SolidDisplay::new(&solids);
        let rests = plan.times[0] > 0.0 && at_rest(&plan, &mut solids);
        let mut film = Film::default();
        if rests && plan.head.pictures && plan.times.len() > 1 {
            film.add(&SolidFrame::new(0.0, &display.at_rest(), &[]));
        }
        let audit = SolidAudit::default();
        Ok(Self { plan, solids, display, last: None, failure: None, film, rests, state: None, audit })
    }

    /// Writes the rigid bodies around solids with these displacements, and returns their names.
    fn write_rigid(
        &self,
        record: &Record,
        time: f64,
        u: &[Point<D>],
        number: &str,
    ) -> Result<Vec<String>, OutputError> {
        let now = self.display.points.iter().zip(u).map(|(x, u)| x + u);
        let mut names = Vec::new();
        for (name, file) in rigid::files(&self.plan, time, now)? {
            record.folder.write(&format!("rigid/{name}_{number}.vtp"), &file)?;
            names.push(name);
        }
        Ok(names)
    }

    /// Solves for the end of an increment.
    fn solve(
        &mut self,
        index: usize,
        time: f64,
        progress: &mut dyn Progress,
    ) -> Result<Result<State<D>, Failure>, CaseError> {
        let mut stopped = false;
        let mut residuals = Vec::new();
        let mut report = |iteration: usize, residual: f64| {
            progress.iteration(&Iteration {
                step: index,
                time,
                iteration,
                residual,
                action: "active set",
                figures: &[("nodes_changed", residual)],
            });
            residuals.push(residual);
            stopped = progress.interrupted();
            !stopped
        };
        let solved = at_time(&self.plan, &mut self.solids, time, |model, now| model.solve(now, &mut report))?;
        match solved {
            Ok(state) => Ok(Ok(state)),
            Err(error) => match blamed(&self.plan, &mut self.solids, time, &error) {
                Some(error) => Err(error),
                None => Ok(Err(Failure { residuals, ..explained(&self.plan, &error) })),
            },
        }
    }

    /// What the cells leave uncertain, in the last step: the change with functions of one degree more, or with cells of half
    /// the size where there are none. Not where they are too many.
    fn estimate(&self, time: f64, state: &State<D>, step: &mut StepReport) {
        let unknowns = self.plan.growth() * self.solids.unknowns() as f64;
        if self.plan.contacts.is_empty() || unknowns > AFFORDABLE {
            return;
        }
        let plan = self.plan.finer();
        let Ok(mut fine) = model(&plan) else { return };
        let affordable = |cost: &Cost| cost.operations <= AFFORDABLE_SECONDS * OPERATIONS_PER_SECOND;
        if !cost(&plan, &fine).is_ok_and(|cost| affordable(&cost)) {
            return;
        }
        let solved = at_time(&plan, &mut fine, time, |model, now| model.solve(now, &mut |_, _| true));
        let Ok(Ok(fine)) = solved else { return };
        for ((contact, coarse), fine) in self.plan.contacts.iter().zip(&state.contacts).zip(&fine.contacts) {
            let peak = |c: &ContactResult<D>| c.nodes.iter().map(|n| n.pressure).fold(0.0, f64::max);
            let Some(found) = step.contacts.get_mut(&contact.name) else { continue };
            let force = (fine.force - coarse.force).norm();
            found.error_estimate =
                Some(ErrorEstimate::of_changes(force, fine.area - coarse.area, peak(fine) - peak(coarse)));
        }
    }
}

/// Whether the bodies are at rest at t = 0: without loads, displacements of supports, and rigid bodies that reach into them.
fn at_rest<const D: usize>(plan: &SolidPlan<D>, solids: &mut Solids<D>) -> bool {
    let look = |model: &mut Solids<D>, now: &Circumstances<'_, D>| {
        let nodes = |body: usize| model.bodies.list[body].mesh.nodes();
        let still =
            |(k, s): (usize, &SolidSupport)| nodes(s.body).iter().all(|x| (now.displacement)(k, x).amax() == 0.0);
        let clear = |(gap, c): (&Option<RigidGap<D>>, &SolidContact<D>)| {
            let reach = |gap: &RigidGap<D>| nodes(c.body).iter().map(|x| gap(x).gap).fold(f64::INFINITY, f64::min);
            let size = nodes(c.body).iter().map(|x| x.amax()).fold(0.0, f64::max);
            gap.as_ref().is_none_or(|gap| reach(gap) >= -1e-12 * size)
        };
        now.load.iter().all(|f| *f == 0.0)
            && plan.supports.iter().enumerate().all(still)
            && now.rigid.iter().zip(&plan.contacts).all(clear)
    };
    at_time(plan, solids, 0.0, look).unwrap_or(false)
}

impl<const D: usize> Model for SolidModel<D> {
    fn head(&self) -> &Head {
        &self.plan.head
    }

    fn increments(&self) -> usize {
        self.plan.times.len()
    }

    fn time(&self, index: usize) -> f64 {
        self.plan.times[index]
    }

    fn begins_at_rest(&self) -> bool {
        self.rests
    }

    fn advance(
        &mut self,
        index: usize,
        record: &mut Record,
        progress: &mut dyn Progress,
    ) -> Result<Advanced, CaseError> {
        record.unknowns = self.solids.unknowns();
        let time = self.plan.times[index];
        let state = match self.solve(index, time, progress)? {
            Ok(state) => state,
            Err(failed) => {
                let reason = failed.reason;
                record.steps.push(StepReport {
                    index,
                    time,
                    converged: false,
                    reason,
                    iterations: failed.residuals.len(),
                    solver: SOLVER.into(),
                    residual_history: failed.residuals.clone(),
                    ..StepReport::default()
                });
                self.failure = Some(failed);
                return Ok(Advanced::Failed(reason));
            }
        };
        let contacts =
            (self.solids.contacts.iter().enumerate()).map(|(k, c)| ContactDisplay::new(c, k, &state)).collect();
        let shown = Shown { index, time, fields: self.display.fields(&self.solids, &state.u), contacts };
        let mut step = report::step_report(&self.plan, &self.solids, &self.display, &state, &shown);
        if index + 1 == self.plan.times.len() {
            self.estimate(time, &state, &mut step);
        }
        report::warn(&self.plan, &self.solids, &self.display, &state, &shown, record);
        record.steps.push(step);
        if self.plan.head.pictures && self.plan.times.len() > 1 {
            self.film.add(&SolidFrame::new(time, &shown.fields, &shown.contacts));
        }
        self.last = Some(shown);
        self.state = Some(state);
        Ok(Advanced::State)
    }

    fn audit_start(&mut self) -> Vec<Finding> {
        self.audit.start(&Looked { plan: &self.plan, model: &self.solids, display: &self.display })
    }

    fn audit(&mut self, step: &StepReport) -> Vec<Finding> {
        let (Some(state), Some(shown)) = (&self.state, &self.last) else { return Vec::new() };
        let looked = Looked { plan: &self.plan, model: &self.solids, display: &self.display };
        self.audit.increment(&looked, state, (&shown.fields, &shown.contacts), step)
    }

    fn write_fields(&mut self, index: usize, record: &mut Record) -> Result<(), OutputError> {
        let Some(Shown { time, fields, contacts, .. }) = &self.last else { return Ok(()) };
        let units = record.units.clone();
        let units = units.as_ref();
        let names: Vec<&str> = self.plan.contacts.iter().map(|c| c.name.as_str()).collect();
        if self.rests && record.frames.is_empty() {
            let rest = self.display.at_rest();
            record.folder.write(&format!("fields/fields_{START}.vtu"), &self.display.vtu(&rest, units)?)?;
            self.write_rigid(record, 0.0, &rest.displacement, START)?;
            record.add_frame(0.0, START.into(), &names)?;
        }
        let (folder, name) = (&record.folder, format!("{index:05}"));
        folder.write(&format!("fields/fields_{name}.vtu"), &self.display.vtu(fields, units)?)?;
        for (contact, shown) in self.plan.contacts.iter().zip(contacts) {
            let file = |end: &str| format!("contact/{}_{name}{end}", contact.name);
            folder.write(&file(".vtp"), &shown.vtp(units)?)?;
            folder.write(&file(".csv"), tables::pressure(shown).as_bytes())?;
            folder.write(&file("_outline.csv"), tables::solid_outline(&shown.boundary).as_bytes())?;
        }
        let bodies = self.write_rigid(record, *time, &fields.displacement, &name)?;
        record.add_frame(*time, name, &names)?;
        record.add_bodies("rigid", &bodies, "vtp")
    }

    fn shown(&self) -> Option<ShownState> {
        let Shown { time, fields, contacts, .. } = self.last.as_ref()?;
        let body = |(k, b): (usize, &PlannedBody<D>)| self.display.of_body(&b.name, k as u32, fields);
        let bodies = self.plan.bodies.iter().enumerate().map(body).collect();
        let contact = |(c, shown): (&SolidContact<D>, &ContactDisplay<D>)| shown.to_fields(&c.name);
        let contacts = self.plan.contacts.iter().zip(contacts).map(contact).collect();
        Some(ShownState { time: *time, bodies, contacts })
    }

    fn draw(&self, record: &Record) -> Result<(), OutputError> {
        let Some(Shown { time, fields, contacts, .. }) = &self.last else { return Ok(()) };
        let last = (&SolidFrame::new(*time, fields, contacts), contacts.as_slice());
        let states = record.history(self.rests);
        solid_pictures::draw(&record.folder, &self.plan, &self.display, last, self.film.frames(), &states)
    }

    fn first_picture(&self) -> Option<String> {
        self.last.as_ref().map(|_| "pictures/deformed.png".into())
    }

    fn verdict(&self, record: &Record, reason: Reason) -> String {
        let (done, count) = (record.done(), self.plan.times.len());
        match reason {
            Reason::Interrupted => format!("Interrupted: {done} of {count} increments are done and on disk."),
            reason if !reason.is_converged() => {
                let why = self.failure.as_ref().map_or("a value became invalid during the run", |f| &f.text);
                let time = self.plan.times.get(done).map_or(String::new(), |t| format!(", to t = {t},"));
                format!("Increment {} of {count}{time} has no solution: {why}.", done + 1)
            }
            _ => {
                let Some(step) = record.steps.last() else { return "No increment was requested.".into() };
                if self.plan.contacts.is_empty() {
                    return "The bodies are in equilibrium; the case has no contact.".into();
                }
                let of_contact = |(name, c): (&String, _)| report::verdict(&self.plan, name, c);
                let list: Vec<String> = step.contacts.iter().map(of_contact).collect();
                let balance = step.equilibrium_residual.unwrap_or(f64::NAN);
                format!("{}; forces balance to {balance:.0e}.", list.join("; "))
            }
        }
    }

    fn method(&self) -> String {
        report::method(&self.plan)
    }

    fn save(&self, folder: &Folder, next: usize) -> Result<Option<Value>, OutputError> {
        if let Some(Shown { time, fields, contacts, .. }) = self.last.as_ref().filter(|_| self.plan.head.pictures) {
            saved::write_frame(folder, next - 1, &SolidFrame::new(*time, fields, contacts))?;
        }
        let mut value = saved::to_json(self.solids.save());
        value["audit"] = self.audit.save();
        Ok(Some(value))
    }

    fn restore(&mut self, mut state: Value, folder: &Path, next: usize) -> Result<(), String> {
        for frame in saved::frames(folder, next).ok_or_else(|| checkpoint::damaged(folder))? {
            self.film.add(&frame);
        }
        let damaged = || checkpoint::damaged(folder);
        let kept = state["audit"].take();
        let memory = saved::from_json(state).filter(|memory| self.solids.fits(memory)).ok_or_else(damaged)?;
        let first = self.plan.times[0];
        at_time(&self.plan, &mut self.solids, first, |solids, now| solids.restore(memory, now))
            .map_err(|e| e.one_line())?
            .map_err(|e| e.to_string())?;
        let time = next.checked_sub(1).map_or(0.0, |last| self.plan.times[last]);
        let looked = Looked { plan: &self.plan, model: &self.solids, display: &self.display };
        self.audit.restore(&kept, &looked, time);
        Ok(())
    }
}
