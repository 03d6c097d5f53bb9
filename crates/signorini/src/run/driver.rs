//! One driver for all models: increments, files, what a later run goes on from, and the end.

use super::audit;
use super::checkpoint::{self, Checkpoint};
use super::environment;
use super::outcome::{Ending, Outcome, RunError, not_resumed};
use super::record::Record;
use crate::fields::ShownState;
use crate::output::{Folder, OutputError};
use crate::plan::Head;
use crate::problem::{CaseError, Limits};
use crate::processes;
use crate::report::{Environment, ForceBounds, PathReports, Reason, SCHEMA, StepReport, Summary, history};
use serde_json::{Value, json};
use signorini_audit::{Check, Finding, Verdict, worst};
use signorini_solve::{Iteration, Progress};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

/// What came of an increment.
pub enum Advanced {
    /// A state, entered as the last step of the record.
    State,
    /// Nothing: its step of the history has ended before.
    Nothing,
    /// No state. What is known of the failure stands in the record.
    Failed(Reason),
}

/// A problem that is solved increment by increment.
pub trait Model {
    /// What the record of a run needs to know.
    fn head(&self) -> &Head;

    /// Number of increments.
    fn increments(&self) -> usize;

    /// The end of an increment as far as it is known before.
    fn time(&self, index: usize) -> f64;

    /// Whether it is known without solving that the state at t = 0 has neither displacements nor contact forces. Files and
    /// pictures of the history begin with it then.
    fn begins_at_rest(&self) -> bool {
        false
    }

    /// Solves an increment, starting from the state of the one before, and enters what was found.
    ///
    /// # Errors
    /// A value of the case that is none at that time.
    fn advance(
        &mut self,
        index: usize,
        record: &mut Record,
        progress: &mut dyn Progress,
    ) -> Result<Advanced, CaseError>;

    /// Checks the bodies as they start, from plain data and without what solves for them.
    fn audit_start(&mut self) -> Vec<Finding> {
        Vec::new()
    }

    /// Checks the last state in the same way; `step` is what is told of it.
    fn audit(&mut self, step: &StepReport) -> Vec<Finding>;

    /// Bounds of the forces of contacts by name that the last state does not determine, as the check of it found them.
    fn force_bounds(&self) -> Vec<(String, ForceBounds)> {
        Vec::new()
    }

    /// Writes the fields of the last state.
    ///
    /// # Errors
    /// Files that cannot be written.
    fn write_fields(&mut self, index: usize, record: &mut Record) -> Result<(), OutputError>;

    /// What the last state shows; none before the first.
    fn shown(&self) -> Option<ShownState>;

    /// Draws the last state and the history.
    ///
    /// # Errors
    /// Pictures that cannot be drawn or written.
    fn draw(&self, record: &Record) -> Result<(), OutputError>;

    /// The picture to open first; none where there is none.
    fn first_picture(&self) -> Option<String>;

    /// The result in a sentence, with what to try where there is none.
    fn verdict(&self, record: &Record, reason: Reason) -> String;

    /// How the contact is found.
    fn method(&self) -> String;

    /// The stress law of each solid, by its name.
    fn materials(&self) -> BTreeMap<String, String> {
        BTreeMap::new()
    }

    /// The last state, enough to go on from to the same digits; none where one cannot go on from there.
    ///
    /// # Errors
    /// Files beside the checkpoint that cannot be written.
    fn save(&self, folder: &Folder, next: usize) -> Result<Option<Value>, OutputError>;

    /// Goes on from what [`Model::save`] told.
    ///
    /// # Errors
    /// In words, where that is not the state of such a model.
    fn restore(&mut self, state: Value, folder: &Path, next: usize) -> Result<(), String>;
}

/// Writes every iteration to the log on its way to the user's progress.
struct Logged<'a> {
    folder: &'a Folder,
    inner: &'a mut dyn Progress,
    budget: &'a Budget,
}

/// What a run may take, and what it has taken.
struct Budget {
    /// When its time is over.
    until: Option<Instant>,
    /// The most iterations.
    iterations: Option<usize>,
    used: Cell<usize>,
}

impl Budget {
    fn new(limits: &Limits, start: Instant) -> Self {
        // A time too long to be told is none.
        let after = |seconds: f64| start.checked_add(Duration::try_from_secs_f64(seconds).ok()?);
        Budget {
            until: limits.max_time.and_then(after),
            iterations: limits.max_iterations.map(|n| usize::try_from(n).unwrap_or(0)),
            used: Cell::new(0),
        }
    }

    fn is_spent(&self) -> bool {
        self.until.is_some_and(|until| Instant::now() >= until)
            || self.iterations.is_some_and(|most| self.used.get() >= most)
    }
}

impl Progress for Logged<'_> {
    fn step(&mut self, index: usize, count: usize, time: f64) {
        self.inner.step(index, count, time);
    }
    fn iteration(&mut self, i: &Iteration) {
        let mut line = json!({
            "event": "iteration", "step": i.step, "time": i.time, "iteration": i.iteration,
            "residual": i.residual, "action": i.action,
        });
        for (name, value) in i.figures {
            line[*name] = json!(value);
        }
        // A log that cannot be written will be told by the files that follow.
        let _ = self.folder.log(&line);
        self.budget.used.set(self.budget.used.get() + 1);
        self.inner.iteration(i);
    }
    fn interrupted(&self) -> bool {
        processes::agreed(self.inner.interrupted() || self.budget.is_spent())
    }
}

/// Runs a model from an increment on to its end.
///
/// # Errors
/// A value of the case that is none at some time, after what was found so far is written; files that cannot be written.
pub fn drive(
    model: &mut dyn Model,
    mut record: Record,
    first: usize,
    start: Instant,
    progress: &mut dyn Progress,
) -> Result<Outcome, RunError> {
    let count = model.increments();
    let mut reason = Reason::Converged;
    let budget = Budget::new(&model.head().problem.limits, start);
    // What ends a run that nobody interrupted is its limit.
    let named = |reason: Reason, by_user: bool| match reason {
        Reason::Interrupted if processes::agreed(!by_user && budget.is_spent()) => Reason::LimitReached,
        other => other,
    };
    if first == 0 && count > 0 && !checked_start(model, &mut record) {
        reason = Reason::Refused;
    }
    let end = if reason == Reason::Refused { first } else { count };
    for index in first..end {
        progress.step(index, count, model.time(index));
        let folder = record.folder.clone();
        let mut logged = Logged { folder: &folder, inner: progress, budget: &budget };
        match model.advance(index, &mut record, &mut logged) {
            Ok(Advanced::State) => check(model, &mut record, index + 1 == count),
            Ok(Advanced::Nothing) => continue,
            Ok(Advanced::Failed(why)) => {
                reason = named(why, progress.interrupted());
                if let Some(step) = record.steps.last_mut().filter(|step| step.reason == why) {
                    step.reason = reason;
                }
                break;
            }
            Err(error) => {
                // What was found so far stays; the summary says how far it goes.
                finish(&record, model, Reason::Input, start)?;
                return Err(error.into());
            }
        }
        if let Some(step) = record.steps.last_mut() {
            step.reason = named(step.reason, progress.interrupted());
        }
        let found = record.steps.last().map_or(reason, |step| step.reason);
        let last = index + 1 == count;
        if last || index % record.every == record.every - 1 || !found.is_converged() {
            if record.folder.path().is_some() {
                model.write_fields(index, &mut record)?;
            }
            if record.keeps_states {
                record.states.extend(model.shown());
            }
        }
        if !found.is_converged() || count == 1 {
            reason = found;
        }
        if !found.is_converged() {
            break;
        }
        // After the last there is nothing to go on to.
        if !last
            && record.folder.path().is_some()
            && let Some(state) = model.save(&record.folder, index + 1)?
        {
            checkpoint::write(&record, index + 1, state)?;
        }
    }
    record.warnings.extend(processes::remark().map(|told| told.as_str().into()));
    let summary = finish(&record, model, reason, start)?;
    let states = std::mem::take(&mut record.states);
    let ending = Ending::of(reason);
    if ending == Ending::Converged {
        checkpoint::remove(&record.folder);
    }
    Ok(Outcome { summary, ending, states })
}

/// Checks the bodies as they start; whether there may be a state that follows.
fn checked_start(model: &mut dyn Model, record: &mut Record) -> bool {
    let start = Instant::now();
    let findings = model.audit_start();
    record.audit_seconds += start.elapsed().as_secs_f64();
    let refused = Verdict::of(&findings) == Verdict::NotAnAnswer;
    if refused {
        let reason = Reason::Refused;
        record.steps.push(StepReport { reason, audit: findings, ..StepReport::default() });
    }
    !refused
}

/// Checks the last state of a record, and enters what was found.
fn check(model: &mut dyn Model, record: &mut Record, last: bool) {
    let Some(step) = record.steps.last().filter(|s| s.reason.is_converged()) else { return };
    let start = Instant::now();
    let mut findings = model.audit(step);
    findings.extend(audit::of_warnings(&record.warnings, step.time));
    if last {
        findings.retain(|f| f.check != Check::Resolution || !audit::is_resolved(step, f.on.as_ref()));
        findings.extend(audit::of_errors(step));
    }
    record.audit_seconds += start.elapsed().as_secs_f64();
    let findings = worst(findings);
    if let Some(step) = record.steps.last_mut() {
        if Verdict::of(&findings) == Verdict::NotAnAnswer {
            step.reason = Reason::Refused;
        }
        step.audit = findings;
        for (name, bounds) in model.force_bounds() {
            step.contacts.entry(name).and_modify(|c| c.force_bounds = Some(bounds));
        }
    }
}

/// Goes on with an earlier run in its folder.
///
/// # Errors
/// Those of [`drive`], and in words, where there is nothing to go on with.
pub fn go_on(
    model: &mut dyn Model,
    record: Record,
    path: &Path,
    start: Instant,
    progress: &mut dyn Progress,
) -> Result<Outcome, RunError> {
    let Checkpoint { next, state, record } = processes::all(checkpoint::read(path, record).map_err(not_resumed))?;
    if next >= model.increments() {
        return Err(not_resumed(checkpoint::damaged(path)).into());
    }
    model.restore(state, path, next).map_err(not_resumed)?;
    drive(model, record, next, start, progress)
}

/// What is said of a run that reached its limit.
fn stopped(record: &Record, model: &dyn Model) -> String {
    let (done, count) = (record.done(), model.increments());
    let Limits { max_time, max_iterations } = model.head().problem.limits;
    let limits: Vec<String> = (max_time.map(|t| format!("{t} s")).into_iter())
        .chain(max_iterations.map(|n| format!("{n} iterations")))
        .collect();
    let next = if done < count { format!(", the next one to t = {}", model.time(done)) } else { String::new() };
    format!("Stopped at the limit of {}: {done} of {count} increments are done and on disk{next}.", limits.join(" or "))
}

/// Writes history, pictures and summary.
///
/// # Errors
/// Files that cannot be written.
fn finish(record: &Record, model: &dyn Model, reason: Reason, start: Instant) -> Result<Summary, OutputError> {
    let states = record.history(model.begins_at_rest());
    record.folder.write("history.csv", history(&states, record.units.as_ref()).as_bytes())?;
    if record.pictures && record.folder.keeps() {
        model.draw(record)?;
    }
    let answer = match reason {
        Reason::Refused => audit::answer(&record.steps, &model.head().problem),
        reason if reason.is_converged() => audit::answer(&record.steps, &model.head().problem),
        _ => None,
    };
    let verdict = match &answer {
        Some(answer) if reason == Reason::Refused => answer.text.clone(),
        _ if reason == Reason::LimitReached => stopped(record, model),
        _ => model.verdict(record, reason),
    };
    let summary = Summary {
        schema: SCHEMA,
        case: record.case.clone(),
        converged: reason.is_converged(),
        reason,
        answer,
        verdict,
        method: model.method(),
        unknowns: record.unknowns,
        units: record.units.clone(),
        first_picture: model.first_picture().filter(|_| record.pictures && record.folder.keeps()),
        warnings: record.warnings.clone(),
        materials: model.materials(),
        interpreted: record.interpreted.clone(),
        steps: record.steps.clone(),
        events: record.events.clone(),
        contact_events: record.contact_events.clone(),
        of_paths: PathReports::default(),
        environment: Environment {
            estimated_memory: model.head().size.as_ref().map(|size| size.memory as u64),
            ..environment::describe(start, rayon::current_num_threads(), (&record.text, record.audit_seconds))
        },
    };
    record.folder.write("summary.json", summary.to_json().as_bytes())?;
    Ok(summary)
}
