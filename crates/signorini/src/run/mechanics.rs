//! Bodies of any kind in one system as a model: ropes, beams, free rigid bodies.

mod accuracy;
mod events;
mod frame;
mod oscillation;
mod other_friction;
mod parts;
mod path;
pub(crate) mod recovered;
mod report;
mod warnings;

use super::audit::system::SystemAudit;
use super::checkpoint;
use super::driver::{Advanced, Model};
use super::record::{Record, START};
use crate::fields::ShownState;
use crate::output::film::Film;
use crate::output::system::SystemShown;
use crate::output::{Folder, OutputError, system_files, system_pictures, tables};
use crate::plan::Head;
use crate::plan::mechanics::{Kind, MechanicsPlan};
use crate::problem::{CaseError, Space};
use crate::report::{ForceBounds, Reason, StepReport};
use frame::{Frame, take};
use parts::{Control, Told};
use path::OnPath;
use serde_json::{Value, json};
use signorini_audit::Finding;
use signorini_mechanics::{HeatError, IncrementError, IncrementResult, Saved, SystemState};
use signorini_solve::{Iteration, Progress};
use std::collections::BTreeMap;
use std::path::Path;

/// A system on its way through its history.
pub struct MechanicsModel {
    plan: MechanicsPlan,
    state: SystemState,
    last: Option<SystemShown>,
    film: Film<Frame>,
    /// Where it stands in a step by arc length.
    path: OnPath,
    /// What decides how increments are cut into parts.
    control: Control,
    /// What is still to be told of the parts of an increment.
    told: Told,
    /// Whether the state at t = 0 is that of rest.
    rests: bool,
    /// Why there is no state after it.
    failure: Option<String>,
    /// What the last increment came to, and what checks it.
    result: IncrementResult,
    audit: SystemAudit,
}

/// An increment without a state: the reason, what happened in words, and the residuals until then.
struct Failure {
    reason: Reason,
    text: String,
    residuals: Vec<f64>,
}

impl MechanicsModel {
    pub fn new(plan: MechanicsPlan) -> Self {
        let state = plan.system.start();
        let rests = plan.times.first().is_some_and(|t| *t > 0.0) && rests(&plan, &state);
        let mut film = Film::default();
        film.add(&Frame { time: 0.0, bodies: state.bodies.clone(), zones: Vec::new() });
        Self {
            plan,
            state,
            last: None,
            film,
            path: OnPath::default(),
            control: Control::default(),
            told: Told::default(),
            rests,
            failure: None,
            result: IncrementResult::default(),
            audit: SystemAudit::default(),
        }
    }

    /// Lets bodies move as the step of an increment asks for: where they begin to move they have the velocities of the case.
    fn set_in_motion(&mut self, index: usize) {
        let dynamics = self.plan.motion.dynamics.get(index).copied().flatten();
        self.plan.system.dynamics = dynamics;
        if dynamics.is_none() {
            self.state.come_to_rest();
            self.control.come_to_rest();
        } else if self.state.velocities.is_empty() {
            self.state.velocities.clone_from(&self.plan.motion.velocities);
        }
    }

    /// Writes the bodies at rest, at t = 0.
    fn write_start(&self, record: &mut Record) -> Result<(), OutputError> {
        let shown = SystemShown::of_bodies(&self.plan, &self.plan.system.start().bodies);
        let fields = system_files::vtu(&shown.bodies, record.units.as_ref())?;
        record.folder.write(&format!("fields/fields_{START}.vtu"), &fields)?;
        self.write_rigid(&record.folder, &shown, START)?;
        let names: Vec<&str> = self.plan.system.contacts.iter().map(|c| c.name()).collect();
        record.add_frame(0.0, START.into(), &names)
    }

    /// Writes the rigid bodies of a state, and returns their names.
    fn write_rigid(&self, folder: &Folder, shown: &SystemShown, number: &str) -> Result<Vec<String>, OutputError> {
        let mut names = Vec::new();
        for (name, file) in system_files::rigid_files(&self.plan, shown)? {
            folder.write(&format!("rigid/{name}_{number}.vtp"), &file)?;
            names.push(name);
        }
        Ok(names)
    }

    /// What an error of the solver means, and what to try.
    fn failed(&self, error: &IncrementError, residuals: Vec<f64>) -> Failure {
        let has = |which: fn(&Kind) -> bool| self.plan.kinds.iter().any(which);
        let has_ropes = has(|kind| matches!(kind, Kind::Curve { .. }));
        let history = |h: &[f64]| h.iter().map(|r| format!("{r:.1e}")).collect::<Vec<_>>().join(", ");
        let (reason, text) = match error {
            IncrementError::Interrupted => (Reason::Interrupted, "interrupted".to_string()),
            IncrementError::Free { .. } => {
                (Reason::FreeBody, format!("{error}; add a support, a spring, or a contact that restrains it"))
            }
            IncrementError::Solve(_) => (
                Reason::LinearSolver,
                match has_ropes {
                    true => format!(
                        "{error}; check that every body is supported and every rope has tension; add a pretension or \
                         a support"
                    ),
                    false => {
                        format!("{error}; check that every body is supported; add a support, a spring, or a contact")
                    }
                },
            ),
            IncrementError::NotConverged { history: list, .. } => (
                Reason::Newton,
                format!(
                    "{error}; residuals of the last iterations, relative to the tolerance: {}; use more \
                     increments{}{}{}",
                    history(list),
                    if has(|kind| !matches!(kind, Kind::Rigid { .. })) { ", or more cells" } else { "" },
                    if has_ropes { ", or a pretension where a rope is slack" } else { "" },
                    match self.plan.system.bodies.iter().any(|b| !b.is_rigid() && !b.is_linear()) {
                        true => ", or `control.arc_length` where the state may snap through",
                        false => "",
                    },
                ),
            ),
            IncrementError::PassesThrough { .. } | IncrementError::Inside { .. } => {
                (Reason::Increment, format!("{error}; use more increments"))
            }
            IncrementError::Augmentation { history: list, .. } => (
                Reason::Contact,
                format!(
                    "{error}: {}; use  enforcement.multiplier = {{}}  or  enforcement.penalty = {{}}",
                    history(list)
                ),
            ),
            IncrementError::Unstable { .. } => (
                Reason::UnstableState,
                format!(
                    "{error}; add a support or a contact that restrains it; `stability = \"tell\"` retains such \
                     states"
                ),
            ),
            IncrementError::Heat(HeatError::NotConverged { history: list, .. }) => (
                Reason::Heat,
                format!(
                    "{error}; changes of the temperature, relative to the tolerance: {}; use more increments: a conductance \
                     that grows with the pressure may leave no stable state",
                    history(list)
                ),
            ),
            IncrementError::Heat(HeatError::Floating { .. }) => (
                Reason::Heat,
                format!(
                    "{error}; add a support with `temperature`, a load with `convection`, or heat.equation = \"transient\""
                ),
            ),
            IncrementError::Heat(_) => (Reason::Heat, error.to_string()),
            IncrementError::Assembly(_) => (Reason::Input, error.to_string()),
        };
        Failure { reason, text, residuals }
    }
}

/// Tells of an iteration of Newton's method.
fn tell_iteration(progress: &mut dyn Progress, step: usize, time: f64, (iteration, residual): (usize, f64)) {
    let figures = &[("residual", residual)];
    progress.iteration(&Iteration { step, time, iteration, residual, action: "newton", figures });
}

/// Whether solids are at rest at t = 0, with nothing but rigid bodies about them.
fn rests(plan: &MechanicsPlan, start: &SystemState) -> bool {
    let is_of_solids = plan.kinds.iter().all(|kind| matches!(kind, Kind::Solid | Kind::Rigid { is_free: false, .. }));
    let found = is_of_solids && plan.system.rests(start, 0.0).unwrap_or(false);
    // What has no value at t = 0 does not matter yet.
    plan.wrong.take(&plan.head.problem).is_none() && found
}

impl Model for MechanicsModel {
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
        let before = if index == 0 { 0.0 } else { self.state.time };
        self.set_in_motion(index);
        let found = match self.plan.arc_lengths[index] {
            Some(planned) => match self.follow(index, planned, progress)? {
                Some(found) => found,
                None => return Ok(Advanced::Nothing),
            },
            None => self.reach(index, [before, self.plan.times[index]], progress)?,
        };
        let time = self.state.time;
        let Told { events, warning } = std::mem::take(&mut self.told);
        record.contact_events.extend(events);
        warning.into_iter().for_each(|warning| record.warn_once(warning));
        let result = match found {
            Ok(result) => result,
            Err(Failure { reason, text, residuals }) => {
                let time = if self.plan.arc_lengths[index].is_some() { time } else { self.plan.times[index] };
                record.steps.push(StepReport {
                    index,
                    time,
                    converged: false,
                    reason,
                    iterations: residuals.len(),
                    solver: report::SOLVER.into(),
                    residual_history: residuals,
                    ..StepReport::default()
                });
                self.failure = Some(text);
                return Ok(Advanced::Failed(reason));
            }
        };
        record.unknowns = record.unknowns.max(result.unknowns);
        let shown = SystemShown::new(&self.plan, &self.state, &result, time);
        let mut step = report::step_report(&self.plan, &self.state, &result, &shown, index);
        if index + 1 == self.plan.times.len() {
            accuracy::estimate(self, (result.unknowns, result.solved), &record.steps, &mut step, progress);
        }
        record.steps.push(step);
        warnings::warn(&self.plan, [&self.result, &result], &shown, record);
        if self.plan.head.pictures && self.plan.times.len() > 1 {
            self.film.add(&Frame { time, bodies: self.state.bodies.clone(), zones: shown.zones.clone() });
        }
        self.last = Some(shown);
        self.result = result;
        // What slips count from next.
        if let Err(error) = self.plan.system.accept(&self.state) {
            let Failure { reason, text, .. } = self.failed(&error, Vec::new());
            self.failure = Some(text);
            return Ok(Advanced::Failed(reason));
        }
        Ok(Advanced::State)
    }

    fn audit_start(&mut self) -> Vec<Finding> {
        self.audit.start(&self.plan)
    }

    fn audit(&mut self, step: &StepReport) -> Vec<Finding> {
        let placed = self.last.as_ref().map_or(&[][..], |shown| &shown.placed);
        self.audit.increment(&self.plan, (&self.state, &self.result), (step, placed))
    }

    fn force_bounds(&self) -> Vec<(String, ForceBounds)> {
        let name = |contact: usize| self.plan.system.contacts[contact].name().to_string();
        let told = |b: &signorini_audit::ForceBounds| ForceBounds { least: b.least, largest: b.largest };
        self.audit.bounds().iter().map(|b| (name(b.contact), told(b))).collect()
    }

    fn write_fields(&mut self, index: usize, record: &mut Record) -> Result<(), OutputError> {
        let Some(shown) = &self.last else { return Ok(()) };
        if self.rests && record.frames.is_empty() {
            self.write_start(record)?;
        }
        let units = record.units.clone();
        let number = format!("{index:05}");
        let folder = &record.folder;
        folder.write(&format!("fields/fields_{number}.vtu"), &system_files::vtu(&shown.bodies, units.as_ref())?)?;
        let names: Vec<&str> = self.plan.system.contacts.iter().map(|c| c.name()).collect();
        for (contact, name) in shown.contacts.iter().zip(&names) {
            folder
                .write(&format!("contact/{name}_{number}.vtp"), &system_files::vtp(&contact.fields, units.as_ref())?)?;
            folder.write(&format!("contact/{name}_{number}.csv"), system_files::csv(&contact.fields).as_bytes())?;
            if let Some(surface) = &contact.surface {
                let outline = tables::zone_outline(&surface.boundary, self.plan.space == Space::ThreeD);
                folder.write(&format!("contact/{name}_{number}_outline.csv"), outline.as_bytes())?;
            }
        }
        let rigid = self.write_rigid(folder, shown, &number)?;
        let mut volumes = Vec::new();
        for (body, state) in self.plan.system.bodies.iter().zip(&self.state.bodies) {
            if let Some(samples) = body.samples(state) {
                let file = format!("volume/{}_{number}.vti", body.name());
                folder.write(&file, &system_files::vti(&samples, units.as_ref())?)?;
                volumes.push(body.name().to_string());
            }
        }
        record.add_frame(shown.time, number, &names)?;
        record.add_bodies("rigid", &rigid, "vtp")?;
        record.add_bodies("volume", &volumes, "vti")
    }

    fn shown(&self) -> Option<ShownState> {
        let shown = self.last.as_ref()?;
        let contacts = shown.contacts.iter().map(|c| c.fields.clone()).collect();
        Some(ShownState { time: shown.time, bodies: shown.bodies.clone(), contacts })
    }

    fn draw(&self, record: &Record) -> Result<(), OutputError> {
        let Some(shown) = &self.last else { return Ok(()) };
        let frames: Vec<SystemShown> = self.film.frames().iter().map(|frame| frame.shown(&self.plan)).collect();
        system_pictures::draw(&record.folder, &self.plan, shown, frames, &record.history(self.rests))
    }

    fn first_picture(&self) -> Option<String> {
        self.last.as_ref().map(|_| "pictures/deformed.png".into())
    }

    fn verdict(&self, record: &Record, reason: Reason) -> String {
        let (done, count) = (record.done(), self.plan.times.len());
        match reason {
            Reason::Interrupted => format!("Interrupted: {done} of {count} increments are done and on disk."),
            reason if !reason.is_converged() => {
                let why = self.failure.as_deref().unwrap_or("a value became invalid during the run");
                let time = self.plan.times.get(done).map_or(String::new(), |t| format!(", to t = {t},"));
                format!("Increment {} of {count}{time} has no solution: {why}.", done + 1)
            }
            _ => report::verdict(&self.plan, record),
        }
    }

    fn materials(&self) -> BTreeMap<String, String> {
        let bodies = self.plan.system.bodies.iter();
        bodies.filter_map(|body| Some((body.name().to_string(), body.law_name()?))).collect()
    }

    fn method(&self) -> String {
        let mut list = self.plan.contacts.iter().map(|c| c.method).collect::<Vec<_>>();
        list.dedup();
        if list.is_empty() { "none".into() } else { list.join(", ") }
    }

    fn save(&self, folder: &Folder, next: usize) -> Result<Option<Value>, OutputError> {
        if let Some(shown) = self.last.as_ref().filter(|_| self.plan.head.pictures) {
            let frame = Frame { time: shown.time, bodies: self.state.bodies.clone(), zones: shown.zones.clone() };
            frame.write(folder, next - 1)?;
        }
        let Saved { bodies, multipliers, reactions, time, contacts, motion, owed } = self.plan.system.save(&self.state);
        Ok(Some(json!({
            "bodies": bodies, "multipliers": multipliers, "reactions": reactions, "time": time, "contacts": contacts,
            "motion": motion, "owed": owed, "path": self.path, "control": self.control, "audit": self.audit.save(),
        })))
    }

    fn restore(&mut self, mut state: Value, folder: &Path, next: usize) -> Result<(), String> {
        for frame in Frame::read_all(folder, next).ok_or_else(|| checkpoint::damaged(folder))? {
            self.film.add(&frame);
        }
        let saved = || {
            Some(Saved {
                bodies: take(&mut state["bodies"])?,
                multipliers: take(&mut state["multipliers"])?,
                reactions: take(&mut state["reactions"])?,
                time: state["time"].as_f64()?,
                contacts: take(&mut state["contacts"])?,
                motion: take(&mut state["motion"])?,
                owed: take(&mut state["owed"])?,
            })
        };
        let restored = { saved }().and_then(|saved| self.plan.system.restore(saved));
        self.state = restored.ok_or_else(|| checkpoint::damaged(folder))?;
        self.path = take(&mut state["path"]).ok_or_else(|| checkpoint::damaged(folder))?;
        self.control = take(&mut state["control"]).ok_or_else(|| checkpoint::damaged(folder))?;
        self.audit.restore(&state["audit"], &self.plan, &self.state, self.state.time);
        Ok(())
    }
}
