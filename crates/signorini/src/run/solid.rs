//! Solids in contact: from the plan to results.

use super::solid_checkpoint::SolidCheckpoint;
use super::{Begun, Ending, Logged, Outcome, RunError, checkpoint, environment, not_resumed};
use crate::case::CaseError;
use crate::case::statement::{Body, Space as Stated};
use crate::output::figure::{figures, told};
use crate::output::solid_fields::{ContactDisplay, SolidDisplay, SolidFields};
use crate::output::{Folder, OutputError, solid_pictures, tables, vtk};
use crate::plan::pieces::{Apart, UNITE};
use crate::plan::solid::{Opposite, SolidLoad, SolidPlan, evaluate};
use crate::plan::{Placed, memory_at_hand};
use crate::report::{
    Component, ContactReport, ErrorEstimate, Probe, Reason, SCHEMA, StepReport, Summary, UnitNames, Warning,
    WarningKind, history, vector,
};
use signorini_contact::GapJet;
use signorini_geometry::Point;
use signorini_solid::loads::{forces, resultant};
use signorini_solid::{
    Bodies, Circumstances, Contact, ContactResult, Load, LoadKind, Master, Memory, Method, Model, PressureNode,
    RigidGap, Sliding, Space, State, StepError, Support, SupportError, SupportKind, facing,
};
use signorini_solve::cholesky::Cost;
use signorini_solve::{Iteration, Progress};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// Strain from which the theory of small strains is off by more than a few per cent of the result: the terms left out are
/// half the square of the displacement gradient, and rotations come with strains.
const LARGE_STRAIN: f64 = 0.05;
/// The most unknowns of one degree more for which errors are estimated, in the plane; they take a fraction of a second.
const AFFORDABLE: usize = 30_000;
/// The estimate is as likely too small as too large: this makes it seldom too small.
const SAFETY: f64 = 1.5;

/// What solves the equations.
const SOLVER: &str = "direct";

/// Share of an increment below which it is not cut any more.
const SMALLEST_INCREMENT: f64 = 1e-3;

struct Runner<const D: usize> {
    plan: SolidPlan<D>,
    folder: Folder,
    model: Model<D>,
    /// The increment to begin with.
    next: usize,
    steps: Vec<StepReport>,
    warnings: Vec<Warning>,
    frames: Vec<(f64, String)>,
}

/// A failure in words: the reason for the summary, what happened and what to try.
struct Failure {
    reason: Reason,
    text: String,
    /// What was left after each iteration until then.
    residuals: Vec<f64>,
}

impl Failure {
    fn new(reason: Reason, text: String) -> Self {
        Failure { reason, text, residuals: Vec::new() }
    }
}

/// Runs a plan, or goes on with an earlier run of it, and writes its results.
pub fn run<const D: usize>(
    plan: SolidPlan<D>,
    folder: &Path,
    begun: Begun,
    start: std::time::Instant,
    progress: &mut dyn Progress,
) -> Result<Outcome, RunError> {
    // Everything that can be checked is checked before the folder is touched.
    let mut model = model(&plan)?;
    judge(&plan, &mut model)?;
    let cost = cost(&plan, &model)?;
    if memory(&cost) > memory_at_hand() {
        return Err(too_large(&plan, model.unknowns(), &cost).into());
    }
    if begun == Begun::Resumed {
        let found = SolidCheckpoint::read(folder, &plan.document.text).map_err(not_resumed)?;
        if !model.fits(&found.memory) || found.next >= plan.times.len() {
            return Err(not_resumed(checkpoint::damaged(folder)).into());
        }
        let SolidCheckpoint { next, memory, steps, warnings, frames } = found;
        let mut runner = Runner { warnings, plan, model, folder: Folder::of_earlier_run(folder), next, steps, frames };
        runner.restore(memory)?;
        return runner.run(start, progress);
    }
    let runner = Runner {
        warnings: plan.warnings.clone(),
        plan,
        model,
        folder: Folder::create(folder)?,
        next: 0,
        steps: vec![],
        frames: vec![],
    };
    runner.folder.write("case.toml", runner.plan.document.text.as_bytes())?;
    runner.run(start, progress)
}

/// Bodies, supports and contacts of a plan.
pub fn model<const D: usize>(plan: &SolidPlan<D>) -> Result<Model<D>, CaseError> {
    raised(plan, 0)
}

/// The same with functions of a higher degree, on cells whose curves are.
fn raised<const D: usize>(plan: &SolidPlan<D>, by: usize) -> Result<Model<D>, CaseError> {
    let space = match plan.space {
        Stated::PlaneStrain => Space::PlaneStrain,
        Stated::PlaneStress => Space::PlaneStress,
        Stated::Axisymmetric => Space::Axisymmetric,
        _ => Space::Solid,
    };
    let mut bodies = Bodies::<D>::new(space);
    for b in &plan.bodies {
        let mesh = b.raised.as_ref().filter(|_| by > 0).unwrap_or(&b.mesh);
        bodies.add(&b.name, mesh.clone(), b.degree + by, b.material);
    }
    let supports = (plan.supports.iter())
        .map(|s| Support { name: s.name.clone(), body: s.body, group: s.group.clone(), kind: s.kind.clone() })
        .collect();
    let contacts = (plan.contacts.iter())
        .map(|c| {
            let mut slave = bodies.surface(c.body, c.sides.clone());
            let master = match &c.opposite {
                Opposite::Body { body, sides, whole } => {
                    let mut master = bodies.surface(*body, sides.clone());
                    // Where bodies may slide, any part may come to meet any other.
                    if c.sliding == Sliding::Small {
                        let looking = |a: &_, b: &_| facing(a, b).ok().filter(|list| !list.is_empty());
                        let of_slave = c.whole.then(|| looking(&slave, &master)).flatten();
                        let of_master = whole.then(|| looking(&master, &slave)).flatten();
                        slave = of_slave.map_or(slave, |list| bodies.surface(c.body, list));
                        master = of_master.map_or(master, |list| bodies.surface(*body, list));
                    }
                    Master::Surface(master)
                }
                Opposite::Rigid(_) => Master::Rigid,
            };
            let mut contact = Contact::new(&c.name, slave, master);
            (contact.method, contact.enforcement, contact.sliding) = (c.method, c.enforcement, c.sliding);
            contact
        })
        .collect();
    Model::new(bodies, supports, contacts).map_err(|error| {
        let place = plan.document.case.space.span();
        let place = match &error {
            StepError::Support(signorini_solid::SupportError::NotFlat { support, .. }) => {
                plan.document.case.supports.get(support).map_or(place, |s| s.span())
            }
            _ => place,
        };
        plan.document.error(place, error.to_string())
    })
}

/// Multiplications with additions that a factorisation does in a second on one core, about: `check` tells a time by it.
pub(super) const OPERATIONS_PER_SECOND: f64 = 2e10;

/// What the factorisation of a model takes.
pub(super) fn cost<const D: usize>(plan: &SolidPlan<D>, model: &Model<D>) -> Result<Cost, CaseError> {
    model.cost().map_err(|error| plan.document.error(plan.document.case.space.span(), error.to_string()))
}

/// The memory of a run, about: the factor and, of about half its size at most, matrices and results.
pub(super) fn memory(cost: &Cost) -> f64 {
    1.5 * cost.bytes
}

fn too_large<const D: usize>(plan: &SolidPlan<D>, unknowns: usize, cost: &Cost) -> CaseError {
    let gib = |bytes: f64| bytes / f64::from(1u32 << 30);
    let message = format!(
        "{unknowns} unknowns need about {:.1} GiB, and {:.1} GiB are free for them",
        gib(memory(cost)),
        gib(memory_at_hand())
    );
    plan.document
        .error(plan.document.case.space.span(), message)
        .help("fewer cells, a lower degree, symmetry, or cells graded towards the contact")
}

impl<const D: usize> Runner<D> {
    fn run(mut self, start: std::time::Instant, progress: &mut dyn Progress) -> Result<Outcome, RunError> {
        let times = self.plan.times.clone();
        let display = SolidDisplay::new(&self.model);
        let mut ending = Ending::Converged;
        let mut failure = None;
        let mut last = None;
        for (index, &time) in times.iter().enumerate().skip(self.next) {
            progress.step(index, times.len(), time);
            let folder = self.folder.clone();
            let mut logged = Logged { folder: &folder, inner: progress };
            let before = if index == 0 { 0.0 } else { times[index - 1] };
            let state = match self.advance(index, [before, time], &mut logged) {
                Ok(Ok(state)) => state,
                Ok(Err(failed)) => {
                    ending =
                        if failed.reason == Reason::Interrupted { Ending::Interrupted } else { Ending::NotConverged };
                    self.steps.push(StepReport {
                        index,
                        time,
                        converged: false,
                        reason: failed.reason,
                        iterations: failed.residuals.len(),
                        solver: SOLVER.into(),
                        residual_history: failed.residuals.clone(),
                        ..StepReport::default()
                    });
                    failure = Some(failed);
                    break;
                }
                Err(error) => {
                    let failed = Failure::new(Reason::Input, "a value became invalid along the way".into());
                    self.finish(Ending::NotConverged, Some(&failed), start, &display, last.as_ref())?;
                    return Err(error.into());
                }
            };
            let fields = display.fields(&self.model, &state.u);
            let contacts: Vec<ContactDisplay<D>> =
                self.model.contacts.iter().enumerate().map(|(k, c)| ContactDisplay::new(c, k, &state)).collect();
            self.record(index, time, &state, &contacts, &display, &fields);
            if index + 1 == times.len() {
                self.estimate(time, &state);
            }
            if index % self.plan.every == self.plan.every - 1 || index + 1 == times.len() {
                self.write_fields(index, time, &display, &fields, &contacts)?;
            }
            last = Some((time, fields, contacts));
            // After the last there is nothing to go on to.
            if index + 1 < times.len() {
                self.checkpoint(index + 1)?;
            }
        }
        let summary = self.finish(ending, failure.as_ref(), start, &display, last.as_ref())?;
        if ending == Ending::Converged {
            self.folder.remove(checkpoint::FILE);
        }
        Ok(Outcome { summary, ending })
    }

    /// Writes what a later run needs to go on.
    fn checkpoint(&self, next: usize) -> Result<(), OutputError> {
        let checkpoint = SolidCheckpoint {
            next,
            memory: self.model.save(),
            steps: self.steps.clone(),
            warnings: self.warnings.clone(),
            frames: self.frames.clone(),
        };
        checkpoint.write(&self.folder, &self.plan.document.text)
    }

    /// Brings the model to where an earlier run ended.
    fn restore(&mut self, memory: Memory) -> Result<(), CaseError> {
        let first = self.plan.times[0];
        let document = &self.plan.document;
        let rejected = |error: StepError| document.error(document.case.space.span(), error.to_string());
        at_time(&self.plan, &mut self.model, first, |model, now| model.restore(memory, now))?.map_err(rejected)
    }

    /// Solves for the end of an increment. With finite sliding an increment that has no solution at once is cut: after an
    /// error the model still has the state before, from which the next try starts.
    fn advance(
        &mut self,
        index: usize,
        [before, time]: [f64; 2],
        progress: &mut dyn Progress,
    ) -> Result<Result<State<D>, Failure>, CaseError> {
        let (mut reached, mut size) = (before, time - before);
        let mut iterations = 0;
        let mut residuals = Vec::new();
        loop {
            let last = reached + size >= time - 1e-9 * (time - before);
            let target = if last { time } else { reached + size };
            match self.solve(index, target, progress)? {
                Ok(mut state) => {
                    iterations += state.iterations;
                    residuals.append(&mut state.residuals);
                    if last {
                        return Ok(Ok(State { iterations, residuals, ..state }));
                    }
                    reached = target;
                    size *= 1.5;
                }
                Err(mut failed) => {
                    residuals.append(&mut failed.residuals);
                    let curable = !matches!(failed.reason, Reason::Interrupted | Reason::Input);
                    if !self.model.slides() || !curable || size <= SMALLEST_INCREMENT * (time - before) {
                        return Ok(Err(Failure { residuals, ..failed }));
                    }
                    size *= 0.25;
                }
            }
        }
    }

    fn solve(
        &mut self,
        index: usize,
        time: f64,
        progress: &mut dyn Progress,
    ) -> Result<Result<State<D>, Failure>, CaseError> {
        let mut stopped = false;
        let mut residuals = Vec::new();
        let (action, figure) =
            if self.model.slides() { ("newton", "residual") } else { ("active set", "nodes_changed") };
        let mut report = |iteration: usize, residual: f64| {
            progress.iteration(&Iteration {
                step: index,
                time,
                iteration,
                residual,
                action,
                figures: &[(figure, residual)],
            });
            residuals.push(residual);
            stopped = progress.interrupted();
            !stopped
        };
        let solved = at_time(&self.plan, &mut self.model, time, |model, now| model.solve(now, &mut report))?;
        match solved {
            Ok(state) => Ok(Ok(state)),
            Err(error) => match blamed(&self.plan, &mut self.model, time, &error) {
                Some(error) => Err(error),
                None => Ok(Err(Failure { residuals, ..explained(&self.plan, &error) })),
            },
        }
    }

    fn record(
        &mut self,
        index: usize,
        time: f64,
        state: &State<D>,
        contacts: &[ContactDisplay<D>],
        display: &SolidDisplay<D>,
        fields: &SolidFields<D>,
    ) {
        // A support of several kinds is one for its reader; the axis is none.
        let mut supports: BTreeMap<String, Point<D>> = BTreeMap::new();
        for (support, force) in self.plan.supports.iter().zip(&state.support_forces) {
            if support.name != "axis" {
                *supports.entry(support.name.clone()).or_insert_with(Point::<D>::zeros) += force;
            }
        }
        let value = |p: &Placed, x: &Point<D>| evaluate(&self.plan.document, p, x, time).unwrap_or(0.0);
        let bodies = &self.model.bodies;
        let loads =
            self.plan.loads.iter().map(|l| (l.name.clone(), vector(&resultant(bodies, &load(bodies, l, &value)))));
        let probe = |x: &Point<D>| {
            let distance = |k: &usize| (display.points[*k] - x).norm();
            let nearest = (0..display.points.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
            Some(Probe {
                at: vector(&display.points[nearest]),
                displacement: vector(&fields.displacement[nearest]),
                in_contact: None,
                pressure: None,
                von_mises: Some(fields.von_mises[nearest]),
            })
        };
        let most = (0..fields.strain.len()).max_by(|&a, &b| fields.strain[a].total_cmp(&fields.strain[b]));
        let step = StepReport {
            index,
            time,
            converged: true,
            reason: Reason::Converged,
            iterations: state.iterations,
            solver: SOLVER.into(),
            residual_history: state.residuals.clone(),
            energy: Some(state.energy),
            max_strain: most.map(|k| fields.strain[k]),
            equilibrium_residual: Some(state.imbalance),
            support_forces: supports.iter().map(|(name, force)| (name.clone(), vector(force))).collect(),
            load_forces: loads.collect(),
            contacts: (self.plan.contacts.iter().zip(&state.contacts).zip(contacts))
                .map(|((contact, result), shown)| {
                    (contact.name.clone(), contact_report(self.plan.space, result, shown))
                })
                .collect(),
            probes: self.plan.probes.iter().map(|(name, (_, x))| (name.clone(), probe(x))).collect(),
            ..StepReport::default()
        };
        let told = self.warnings.iter().any(|w| w.kind == WarningKind::LargeStrain);
        if let Some(k) = most.filter(|&k| !told && fields.strain[k] >= LARGE_STRAIN) {
            let x: Vec<String> = display.points[k].iter().map(|v| format!("{v:.4}")).collect();
            let message = format!(
                "the strain is not small: {:.0} % at ({}) of `{}` at t = {time}; the theory is that of small strains, and errs by as much from {:.0} % on",
                100.0 * fields.strain[k],
                x.join(", "),
                display.body_of(&self.model, k),
                100.0 * LARGE_STRAIN,
            );
            let warning = Warning::new(WarningKind::LargeStrain, message);
            self.warnings.push(warning.at_time(time).at(vector(&display.points[k])));
        }
        for (contact, result) in self.plan.contacts.iter().zip(&state.contacts) {
            // Of pairs that were not named most never meet.
            if !self.plan.document.case.contacts.contains_key(&contact.name) {
                continue;
            }
            let name = &contact.name;
            let warning = if result.nodes.is_empty() {
                let message = format!(
                    "contact `{name}`: no part of the slave faces the master: do the normals look at each other?"
                );
                Warning::new(WarningKind::NotFacing, message)
            } else if result.nodes.iter().all(|n| !n.active) {
                let gap = result.nodes.iter().map(|n| n.gap).fold(f64::INFINITY, f64::min);
                let message =
                    format!("contact `{name}`: the bodies do not touch at t = {time} (smallest gap {gap:.6e})");
                Warning::new(WarningKind::Apart, message)
            } else {
                continue;
            };
            self.warnings.push(warning.at_time(time));
        }
        self.steps.push(step);
    }

    /// What the cells leave uncertain, in the last step recorded: the change with functions of one degree more. With finite
    /// sliding the path is gone again with them. Not where these functions do not exist or are too many.
    fn estimate(&mut self, time: f64, state: &State<D>) {
        // In space unknowns cost several times as much.
        let most = if D == 3 { AFFORDABLE / 4 } else { AFFORDABLE };
        let raises = |b: &crate::plan::solid::PlannedBody<D>| {
            let simplices = (0..b.mesh.cell_count()).any(|c| !b.mesh.shape(c).is_tensor());
            b.degree < if simplices { 2 } else { 8 }
        };
        let growth: f64 =
            self.plan.bodies.iter().map(|b| (1.0 + 1.0 / b.degree as f64).powi(D as i32)).fold(1.0, f64::max);
        let way = if self.model.slides() { self.plan.times.as_slice() } else { std::slice::from_ref(&time) };
        let unknowns = growth * (way.len() * self.model.unknowns()) as f64;
        if self.plan.contacts.is_empty() || !self.plan.bodies.iter().all(raises) || unknowns > most as f64 {
            return;
        }
        let Ok(mut fine) = raised(&self.plan, 1) else { return };
        let mut solve = |&time: &f64| {
            at_time(&self.plan, &mut fine, time, |model, now| model.solve(now, &mut |_, _| true)).ok()?.ok()
        };
        let Some(fine) = way.iter().map(&mut solve).collect::<Option<Vec<_>>>().and_then(|mut states| states.pop())
        else {
            return;
        };
        let Some(step) = self.steps.last_mut() else { return };
        for ((contact, coarse), fine) in self.plan.contacts.iter().zip(&state.contacts).zip(&fine.contacts) {
            let peak = |c: &ContactResult<D>| c.nodes.iter().map(|n| n.pressure).fold(0.0, f64::max);
            let Some(found) = step.contacts.get_mut(&contact.name) else { continue };
            found.error_estimate = Some(ErrorEstimate {
                front: None,
                force: SAFETY * (fine.force - coarse.force).norm(),
                area: SAFETY * (fine.area - coarse.area).abs(),
                max_pressure: Some(SAFETY * (peak(fine) - peak(coarse)).abs()),
            });
        }
    }

    fn write_fields(
        &mut self,
        index: usize,
        time: f64,
        display: &SolidDisplay<D>,
        fields: &SolidFields<D>,
        contacts: &[ContactDisplay<D>],
    ) -> Result<(), OutputError> {
        let name = format!("{index:05}");
        self.folder.write(&format!("fields/fields_{name}.vtu"), &display.vtu(fields)?)?;
        for (contact, shown) in self.plan.contacts.iter().zip(contacts) {
            self.folder.write(&format!("contact/{}_{name}.vtp", contact.name), &shown.vtp()?)?;
            self.folder.write(&format!("contact/{}_{name}.csv", contact.name), tables::pressure(shown).as_bytes())?;
            let outline = tables::solid_outline(&shown.boundary);
            self.folder.write(&format!("contact/{}_{name}_outline.csv", contact.name), outline.as_bytes())?;
        }
        self.frames.push((time, name));
        let list: Vec<(f64, String)> =
            self.frames.iter().map(|(t, n)| (*t, format!("fields/fields_{n}.vtu"))).collect();
        self.folder.write("fields.pvd", vtk::collection(&list).as_bytes())?;
        let list: Vec<(f64, String)> = (self.frames.iter())
            .flat_map(|(t, n)| self.plan.contacts.iter().map(move |c| (*t, format!("contact/{}_{n}.vtp", c.name))))
            .collect();
        self.folder.write("contact.pvd", vtk::collection(&list).as_bytes())
    }

    fn finish(
        &self,
        ending: Ending,
        failure: Option<&Failure>,
        start: std::time::Instant,
        display: &SolidDisplay<D>,
        last: Option<&(f64, SolidFields<D>, Vec<ContactDisplay<D>>)>,
    ) -> Result<Summary, OutputError> {
        self.folder.write("history.csv", history(&self.steps, self.plan.unit_names().as_ref()).as_bytes())?;
        if let (true, Some((time, fields, contacts))) = (self.plan.pictures, last) {
            solid_pictures::draw(&self.folder, &self.plan, *time, display, fields, contacts, &self.steps)?;
        }
        let summary = Summary {
            schema: SCHEMA,
            case: self.plan.document.case.title.clone().unwrap_or_else(|| self.plan.document.name.clone()),
            converged: ending == Ending::Converged,
            reason: failure.map_or(Reason::Converged, |f| f.reason),
            verdict: self.verdict(ending, failure),
            method: method(&self.plan),
            unknowns: self.model.unknowns(),
            units: self.plan.unit_names(),
            first_picture: (self.plan.pictures && last.is_some()).then(|| "pictures/deformed.png".into()),
            warnings: self.warnings.clone(),
            interpreted: self.plan.interpreted.clone(),
            steps: self.steps.clone(),
            events: Vec::new(),
            environment: environment::describe(start, rayon::current_num_threads(), &self.plan.document.text),
        };
        self.folder.write("summary.json", summary.to_json().as_bytes())?;
        Ok(summary)
    }

    fn verdict(&self, ending: Ending, failure: Option<&Failure>) -> String {
        let done = self.steps.iter().filter(|s| s.converged).count();
        let count = self.plan.times.len();
        match (ending, failure) {
            (Ending::Interrupted, _) => format!("Interrupted: {done} of {count} increments are done and on disk."),
            (Ending::NotConverged, failure) => {
                format!("Increment {} of {count} has no solution: {}.", done + 1, failure.map_or("", |f| &f.text))
            }
            (Ending::Converged, _) => {
                let Some(step) = self.steps.last() else { return "Nothing was asked.".into() };
                if self.plan.contacts.is_empty() {
                    return "The bodies are in equilibrium; no contact was stated.".into();
                }
                let list: Vec<String> = (step.contacts.iter()).map(|(name, c)| self.contact_verdict(name, c)).collect();
                format!("{}; forces balance to {:.0e}.", list.join("; "), step.equilibrium_residual.unwrap_or(f64::NAN))
            }
        }
    }

    /// One contact in a clause.
    fn contact_verdict(&self, name: &str, c: &ContactReport) -> String {
        if c.zones == 0 {
            return format!("`{name}` is open");
        }
        let errors = c.error_estimate;
        let units = self.plan.unit_names();
        let unit = |of: fn(&UnitNames) -> &String| units.as_ref().map_or("", |u| of(u));
        let of_force = errors.map(|e| e.force);
        let within = of_force.filter(|e| *e > 0.0).map_or(String::new(), |e| format!(" ± {e:.0e}"));
        format!(
            "`{name}` carries {}{within}{} over {} {} in {} zone{}, at most {}",
            figures(&c.force[..D], of_force),
            units.as_ref().map_or(String::new(), |u| format!(" {}", u.force)),
            if D == 3 || self.plan.space == Stated::Axisymmetric { "area" } else { "length" },
            told(c.area, errors.map(|e| e.area), unit(|u| &u.area)),
            c.zones,
            if c.zones == 1 { "" } else { "s" },
            told(c.max_pressure, errors.and_then(|e| e.max_pressure), unit(|u| &u.pressure)),
        )
    }
}

/// A contact of a state as it is told.
fn contact_report<const D: usize>(
    space: Stated,
    result: &ContactResult<D>,
    shown: &ContactDisplay<D>,
) -> ContactReport {
    let node: HashMap<usize, &PressureNode<D>> = result.nodes.iter().map(|n| (n.number as usize, n)).collect();
    let component = |zone: &Vec<usize>| {
        let own = || zone.iter().filter_map(|k| node.get(k));
        let whole: f64 = own().map(|n| n.weight).sum();
        let centroid = zone.iter().filter_map(|k| Some(shown.points[*k] * node.get(k)?.weight)).sum::<Point<D>>();
        let force: Point<D> = own().map(|n| n.force).sum();
        Component { area: shown.area(zone), force: vector(&force), centroid: vector(&(centroid / whole)), holes: None }
    };
    let components: Vec<Component> = shown.zones().iter().map(component).collect();
    let closed = || result.nodes.iter().filter(|n| n.active);
    ContactReport {
        force: vector(&result.force),
        area: result.area,
        zones: components.len(),
        radius: radius(space, result.area, components.len()),
        components,
        max_penetration: result.nodes.iter().map(|n| -n.gap).fold(0.0, f64::max),
        min_gap_outside: result.nodes.iter().filter(|n| !n.active).map(|n| n.gap).reduce(f64::min),
        max_pressure: result.nodes.iter().map(|n| n.pressure).fold(0.0, f64::max),
        min_pressure: closed().map(|n| n.pressure).reduce(f64::min),
        ..ContactReport::default()
    }
}

/// Does something with a model and what the plan has for it at one time.
///
/// # Errors
/// An expression of the case whose value is no number there.
fn at_time<const D: usize, R>(
    plan: &SolidPlan<D>,
    model: &mut Model<D>,
    time: f64,
    act: impl FnOnce(&mut Model<D>, &Circumstances<'_, D>) -> R,
) -> Result<R, CaseError> {
    let document = &plan.document;
    let wrong: RefCell<Option<CaseError>> = RefCell::new(None);
    let value = |placed: &Placed, x: &Point<D>| match evaluate(document, placed, x, time) {
        Ok(v) => v,
        Err(error) => {
            wrong.borrow_mut().get_or_insert(error);
            0.0
        }
    };
    let mut forces = vec![0.0; model.bodies.unknowns()];
    for l in &plan.loads {
        forces.iter_mut().zip(load(&model.bodies, l, &value)).for_each(|(sum, f)| *sum += f);
    }
    let displacement = |number: usize, x: &Point<D>| {
        let support = &plan.supports[number];
        let along = |k: usize| support.values.get(k).and_then(|p| p.as_ref()).map_or(0.0, |p| value(p, x));
        match support.kind {
            SupportKind::Normal => Point::<D>::from_fn(|k, _| if k == 0 { along(0) } else { 0.0 }),
            _ => Point::<D>::from_fn(|k, _| along(k)),
        }
    };
    let rigid: Vec<Option<RigidGap<D>>> = (plan.contacts.iter())
        .map(|c| match &c.opposite {
            Opposite::Rigid(body) => Ok(Some(flat_gap::<D>(body.gap_at(document, time)?))),
            Opposite::Body { .. } => Ok(None),
        })
        .collect::<Result<_, CaseError>>()?;
    let result = act(model, &Circumstances { displacement: &displacement, load: forces, rigid });
    wrong.into_inner().map_or(Ok(result), Err)
}

/// What can be said of a plan without solving: supports and loads are looked at for all times, and where the bodies lie for
/// the first. What a run would find no solution for is told in words.
///
/// # Errors
/// What a run refuses.
pub(super) fn judge<const D: usize>(plan: &SolidPlan<D>, model: &mut Model<D>) -> Result<Option<String>, CaseError> {
    if let Some(error) = loose_piece(plan, model) {
        return Err(error);
    }
    for (index, &time) in plan.times.iter().enumerate() {
        let look = |model: &mut Model<D>, now: &Circumstances<'_, D>| match index {
            0 => model.examine(now),
            _ => model.examine_again(now),
        };
        let Err(error) = at_time(plan, model, time, look)? else { continue };
        match blamed(plan, model, time, &error) {
            Some(error) => return Err(error),
            // With finite sliding the increment will be cut.
            None if matches!(error, StepError::Deep { .. }) => {}
            // A run ends there.
            None => return Ok(Some(format!("at t = {time}: {}", explained(plan, &error).text))),
        }
    }
    Ok(None)
}

/// The error of a mesh that falls into pieces one of which nothing holds: neither supports nor a contact of its own, or it
/// lies on another one, to which it should hold by the nodes that they do not share.
fn loose_piece<const D: usize>(plan: &SolidPlan<D>, model: &Model<D>) -> Option<CaseError> {
    for (number, body) in plan.bodies.iter().enumerate() {
        let free: BTreeSet<u32> =
            (model.free_modes().iter()).filter(|m| m.body == body.name).map(|m| m.piece).collect();
        if free.is_empty() {
            continue;
        }
        let Some(apart) = Apart::new(&body.mesh) else { continue };
        let in_contact: BTreeSet<u32> = (plan.contacts.iter())
            .flat_map(|c| {
                let own = (c.body == number).then_some(&c.sides);
                let other = match &c.opposite {
                    Opposite::Body { body, sides, .. } if *body == number => Some(sides),
                    _ => None,
                };
                own.into_iter().chain(other).flatten()
            })
            .map(|side| apart.of_cell[side.cell as usize])
            .collect();
        if let Some(&loose) = free.iter().find(|piece| apart.touching.is_some() || !in_contact.contains(piece)) {
            let document = &plan.document;
            let place = match document.case.bodies.get(&body.name).map(|b| b.get_ref()) {
                Some(Body::Solid(solid)) => solid.mesh.span(),
                _ => document.case.space.span(),
            };
            return Some(document.error(place, apart.held_by_nothing(&body.name, loose)).help(UNITE));
        }
    }
    None
}

/// The error of the case behind that of a time, at its place; none where a run may find a way.
fn blamed<const D: usize>(
    plan: &SolidPlan<D>,
    model: &mut Model<D>,
    time: f64,
    error: &StepError,
) -> Option<CaseError> {
    let document = &plan.document;
    let space = document.case.space.span();
    match error {
        StepError::Support(error) => {
            let name = match error {
                SupportError::NotFlat { support, .. } => support,
                SupportError::Contradiction { second, .. } => second,
            };
            let place = document.case.supports.get(name).map_or(space, |s| s.span());
            Some(document.error(place, error.to_string()))
        }
        StepError::Deep { contact, depth } => {
            let place = document.case.contacts.get(contact).map_or(space, |c| c.span());
            let start = at_time(plan, model, 0.0, |model, now| model.examine(now));
            match start {
                Ok(Err(StepError::Deep { depth, .. })) => Some(document
                    .error(place, format!("the bodies of `{contact}` start {depth:.4e} deep in each other"))
                    .help("move them apart; or does the normal of a rigid plane point into it, or `side` name the wrong side?")),
                _ if model.slides() => None,
                _ => Some(document
                    .error(
                        place,
                        format!("the first increment, to t = {time}, is too large: it brings the bodies of `{contact}` {depth:.4e} deep into each other"),
                    )
                    .help("more `increments`, a smaller motion, or  sliding = \"finite\"  in the contact, which cuts increments that are too large")),
            }
        }
        _ => None,
    }
}

/// The forces of a load on the unknowns of the bodies.
fn load<const D: usize>(bodies: &Bodies<D>, l: &SolidLoad, value: &dyn Fn(&Placed, &Point<D>) -> f64) -> Vec<f64> {
    let load = Load { name: l.name.clone(), body: l.body, group: l.group.clone(), kind: l.kind };
    forces(bodies, &load, &|x| {
        Point::<D>::from_fn(|k, _| {
            let k = if l.kind == LoadKind::Pressure { 0 } else { k };
            l.values.get(k).map_or(0.0, |p| value(p, x))
        })
    })
}

/// The method of the contacts, all names where there are several.
fn method<const D: usize>(plan: &SolidPlan<D>) -> String {
    let name = |m: Method| match m {
        Method::Mortar => "mortar",
        Method::Node => "node",
        Method::GaussPoint => "gauss_point",
    };
    let mut list: Vec<&str> = plan.contacts.iter().map(|c| name(c.method)).collect();
    list.dedup();
    if list.is_empty() { "none".into() } else { list.join(", ") }
}

/// Half the length of one interval, or the radius of the disc of one area.
fn radius(space: Stated, area: f64, zones: usize) -> Option<f64> {
    match (zones, space) {
        (1, Stated::PlaneStrain | Stated::PlaneStress) => Some(0.5 * area),
        (1, _) => Some((area / std::f64::consts::PI).sqrt()),
        _ => None,
    }
}

fn flat_gap<const D: usize>(gap: impl Fn(&Point<3>) -> GapJet<3> + Sync + Send + 'static) -> RigidGap<D> {
    Box::new(move |x| {
        let found = gap(&Point::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 }));
        GapJet {
            gap: found.gap,
            normal: Point::<D>::from_fn(|k, _| found.normal[k]),
            hessian: signorini_geometry::Matrix::<D>::from_fn(|r, c| found.hessian[(r, c)]),
        }
    })
}

/// A failure, and what may be behind it: of a body that is free, that its mesh falls into pieces.
fn explained<const D: usize>(plan: &SolidPlan<D>, error: &StepError) -> Failure {
    let mut failed = failure(error);
    if let StepError::Free { body, .. } | StepError::PulledAway { body, .. } = error
        && let Some(apart) = plan.bodies.iter().find(|b| b.name == *body).and_then(|b| Apart::new(&b.mesh))
    {
        failed.text += &format!("; {}", apart.text(body));
    }
    failed
}

fn failure(error: &StepError) -> Failure {
    let (reason, text) = match error {
        StepError::Interrupted => (Reason::Interrupted, "interrupted".into()),
        StepError::Free { body, motion } => (
            Reason::FreeBody,
            format!(
                "body `{body}` is free {motion}: neither its supports nor the contact found hold it; add a support, or a spring"
            ),
        ),
        StepError::PulledAway { body, direction } => (
            Reason::FreeBody,
            format!(
                "body `{body}` is pulled away {direction}: only contact holds it there, and contact does not pull; turn the \
                 load round, or add a support, or a spring"
            ),
        ),
        StepError::Solve(error) => {
            (Reason::LinearSolver, format!("{error}; are all bodies held, and are their stiffnesses of one scale?"))
        }
        StepError::Deep { contact, depth } => (
            Reason::Increment,
            format!(
                "the increment is too large: it brings the bodies of `{contact}` {depth:.4e} deep into each other; try more increments"
            ),
        ),
        StepError::Support(_) | StepError::Shape { .. } | StepError::NitscheSlides { .. } => {
            (Reason::Input, error.to_string())
        }
        StepError::Newton { history, place, .. } => (
            Reason::Newton,
            format!(
                "{error}, worst at {place}; what was left after each: {}; try more increments, or a finer mesh there",
                history.iter().map(|r| format!("{r:.1e}")).collect::<Vec<_>>().join(", ")
            ),
        ),
        StepError::Contact { contact, error, places } => (
            Reason::Contact,
            format!(
                "contact `{contact}`: {error}{}; try more increments, or a finer mesh there",
                if places.is_empty() { String::new() } else { format!(" ({})", places.join(", ")) }
            ),
        ),
    };
    Failure::new(reason, text)
}
