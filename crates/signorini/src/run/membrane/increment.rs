//! One increment, by either method, and what of it goes into the summary.

use super::events::Known;
use crate::plan::{MembranePlan, MethodChoice};
use crate::problem::Space;
use crate::report::{self, Reason, StepReport, Warning, WarningKind, vector};
use crate::snapshot::{DisplayMesh, Sample, Snapshot};
use serde_json::{Value, json};
use signorini_geometry::Point;
use signorini_membrane::active_set::{self, NodalSolution, NodalStart};
use signorini_membrane::adhesion::Branch;
use signorini_membrane::conditions::Extremes;
use signorini_membrane::equilibrium::{Elements, Equilibrium};
use signorini_membrane::error_estimate::ErrorEstimate;
use signorini_membrane::ils::{self, Solution, Start};
use signorini_membrane::problem::Membrane;
use signorini_membrane::published::Transport;
use signorini_membrane::refinement::Refinement;
use signorini_membrane::report::{Component, ContactReport, Report};
use signorini_membrane::scales::Scales;
use signorini_membrane::staircase::Staircase;
use signorini_membrane::zone::{Zone, contact_of};
use signorini_solve::{Iteration, Progress};
use std::collections::BTreeMap;

/// Curvature times cell size beyond which a front is not resolved.
const RESOLVED: f64 = 0.5;

/// Unknowns up to which errors are estimated, by a factorisation for functions of one degree more.
const MOST_ESTIMATED: usize = 100_000;

/// Slope up to which a membrane is linear.
pub const LINEAR: f64 = 0.1;

/// States that are kept to tell where a path goes on, how many of them do, and how far ahead at most, relative to the distance
/// between the nearest two.
const TRAIL: usize = 64;
const NEAREST: usize = 3;
const FARTHEST: f64 = 1.5;
/// States nearer than this part of an increment are at the same place.
const SAME: f64 = 1e-6;

/// Solves increments, each from the one before.
pub struct Engine<const D: usize, Z> {
    previous: Option<(Z, Scales, Branch)>,
    /// The zone that the case asks to start from, until the first increment.
    asked: Option<Z>,
    /// The scales of the problem, once they are known.
    scales: Option<Scales>,
    /// The last states of the path and their times.
    trail: Vec<(f64, Z)>,
    /// The cells of a state that was found on a path of equilibria, for the next increment.
    cells: Option<Membrane<D>>,
    refinement: Refinement<D>,
    /// Whether lengths are lengths; without units the problem may be scaled at will.
    has_units: bool,
    /// Whether errors are estimated, which takes a solve more.
    pub estimates: bool,
}

/// What an engine carries from one increment to the next.
#[derive(Clone)]
pub struct Saved<Z> {
    previous: Option<(Z, Scales, Branch)>,
    scales: Option<Scales>,
    trail: Vec<(f64, Z)>,
}

impl<Z> Saved<Z> {
    pub fn to_json(&self, zone: impl Fn(&Z) -> Value) -> Value {
        let scales =
            |s: &Scales| json!([s.gap, s.pressure, s.tension, s.length, s.h, s.degree as f64, s.dimension as f64]);
        json!({
            "previous": self.previous.as_ref().map(|(z, s, branch)| {
                json!({"zone": zone(z), "scales": scales(s), "nearest": *branch == Branch::Nearest})
            }),
            "scales": self.scales.as_ref().map(scales),
            "trail": self.trail.iter().map(|(t, z)| json!([t, zone(z)])).collect::<Vec<_>>(),
        })
    }

    pub fn from_json(v: &Value, zone: impl Fn(&Value) -> Option<Z>) -> Option<Self> {
        let scales = |v: &Value| {
            let [gap, pressure, tension, length, h, degree, dimension] =
                serde_json::from_value::<[f64; 7]>(v.clone()).ok()?;
            Some(Scales { gap, pressure, tension, length, h, degree: degree as usize, dimension: dimension as usize })
        };
        let previous = match &v["previous"] {
            Value::Null => None,
            p => {
                let branch = if p["nearest"].as_bool()? { Branch::Nearest } else { Branch::Stable };
                Some((zone(&p["zone"])?, scales(&p["scales"])?, branch))
            }
        };
        Some(Self {
            previous,
            scales: if v["scales"].is_null() { None } else { Some(scales(&v["scales"])?) },
            trail: v["trail"]
                .as_array()?
                .iter()
                .map(|e| Some((e[0].as_f64()?, zone(&e[1])?)))
                .collect::<Option<_>>()?,
        })
    }
}

type Sampler<'a, const D: usize> = Box<dyn Fn(&Point<D>) -> Option<Sample> + 'a>;

/// The result of an increment.
pub struct Increment<'a, const D: usize> {
    pub converged: bool,
    pub reason: Reason,
    /// Equilibrium solves on the cells of the state, and on larger ones before that.
    pub iterations: usize,
    pub before: usize,
    pub residuals: Vec<f64>,
    pub unknowns: usize,
    /// What solved the equations.
    pub solver: &'static str,
    pub warnings: Vec<Warning>,
    report: Option<Report<D>>,
    outlines: Vec<Vec<Point<D>>>,
    sample: Option<Sampler<'a, D>>,
    pub stability: Stability,
    /// Whether the fronts are no sharper than the grid can show.
    pub resolved: bool,
    /// What the discretisation leaves uncertain, where that was asked for.
    pub errors: Option<ErrorEstimate>,
}

/// What adhesion makes of a state.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stability {
    /// Lowest eigenvalue of the second variation of the energy; none without adhesion.
    pub lowest_eigenvalue: Option<f64>,
    /// Whether the contact jumped to get there.
    pub jumped: bool,
    /// How far the state is from its loss; see [`Solution::margin`].
    pub margin: Option<f64>,
}

impl<const D: usize, Z: Zone<D>> Engine<D, Z> {
    pub fn new(plan: &MembranePlan<D>) -> Self {
        let asked = plan.initial_zone.as_ref().map(|(side, shape)| {
            let grid = &plan.grid;
            Z::empty(grid).united(grid, *side, &mut |x| shape.level(x))
        });
        Self {
            previous: None,
            asked,
            scales: None,
            trail: Vec::new(),
            cells: None,
            refinement: plan.refinement.clone(),
            estimates: false,
            has_units: plan.head.problem.units.is_some(),
        }
    }

    /// What the next increment goes on from.
    pub fn save(&self) -> Saved<Z> {
        let Self { previous, scales, trail, .. } = self;
        Saved { previous: previous.clone(), scales: *scales, trail: trail.clone() }
    }

    /// Goes on from what was saved.
    pub fn restore(&mut self, saved: Saved<Z>) {
        self.asked = None;
        Saved { previous: self.previous, scales: self.scales, trail: self.trail } = saved;
    }

    /// The state that the last increment converged to.
    pub fn known(&self, time: f64, increment: &Increment<'_, D>) -> Option<Known<Z>> {
        let (zone, ..) = self.previous.as_ref().filter(|_| increment.converged)?;
        Some(Known {
            time,
            zone: zone.clone(),
            area: increment.area(),
            force: increment.report.as_ref().map_or(0.0, |r| r.force()),
            energy_total: increment.energy_total(),
            margin: increment.stability.margin,
        })
    }

    /// Takes the scales from another time, where those of the beginning say nothing: before any load there are none.
    pub fn measure(&mut self, membrane: &Membrane<D>) -> Option<Scales> {
        let free = Equilibrium::solve(membrane, &Z::empty(&membrane.grid), &mut Elements::new(membrane)).ok()?;
        self.scales = Some(Scales::of_free(&free));
        self.scales
    }

    /// The zone that the last increment converged to.
    pub fn zone(&self) -> Option<Z> {
        self.previous.as_ref().map(|(zone, ..)| zone.clone())
    }

    /// Starts the next increment from another zone, in search of the stable state that follows.
    pub fn start_from(&mut self, zone: Z) {
        self.start_near(zone, Branch::Stable);
    }

    /// Where the fronts will be by the polynomial through the states nearest on the path of what drives them, and, to tell how
    /// true that is, by another one through one state less, or one more. Along a branch of equilibria the state depends on
    /// nothing else, and a path that turns comes by where it was.
    fn ahead(&self, plan: &MembranePlan<D>, membrane: &Membrane<D>, time: f64) -> Option<(Z, Option<Z>)> {
        let times: Vec<f64> = self.trail.iter().map(|(t, _)| *t).chain([time]).collect();
        let places = plan.places(&times);
        let (next, states) = places.split_last()?;
        let counts = self.trail.last()?.1.counts();
        let alike = |k: &usize| self.trail[*k].1.counts() == counts;
        let mut near: Vec<usize> = (0..states.len()).rev().filter(alike).collect();
        near.sort_by(|&a, &b| (next - states[a]).abs().total_cmp(&(next - states[b]).abs()));
        near.truncate(NEAREST);
        let [from, second, ..] = near[..] else { return None };
        let step = (states[second] - states[from]).abs();
        let apart = |k: usize| near.iter().all(|&o| o == k || (states[o] - states[k]).abs() > SAME * step);
        if (next - states[from]).abs() > FARTHEST * step || !near.iter().all(|&k| apart(k)) {
            return None;
        }
        let through = |near: &[usize]| {
            let weight = |k: usize| {
                let others = near.iter().filter(|&&o| o != k);
                others.map(|&o| (next - states[o]) / (states[k] - states[o])).product::<f64>()
            };
            let multiples: Vec<(&Z, f64)> = near[1..].iter().map(|&k| (&self.trail[k].1, -weight(k))).collect();
            self.trail[from].1.extrapolated(&membrane.grid, &multiples)
        };
        let ahead = through(&near)?;
        // Nobody asks on a line.
        let rough = if D == 2 { through(&near[..near.len() - 1]) } else { None };
        // Short waves on fronts of degree 1, which come and go with the cells, grow with the degree of the polynomial.
        Some(match rough {
            Some(rough) if near.len() == NEAREST && membrane.cells.degree() == 1 => (rough, Some(ahead)),
            rough => (ahead, rough),
        })
    }

    /// Keeps a state as one of those that tell where the path goes on. A place that was there before is told again.
    fn remember(&mut self, plan: &MembranePlan<D>, time: f64, zone: &Z) {
        if zone.is_empty() {
            return;
        }
        let times: Vec<f64> = self.trail.iter().map(|(t, _)| *t).chain([time]).collect();
        if let [states @ .., last] = plan.places(&times).as_slice() {
            let step = states.last().map_or(0.0, |s| (last - s).abs());
            let mut places = states.iter();
            self.trail.retain(|(_, known)| {
                let near = places.next().is_some_and(|p| (p - last).abs() <= SAME * step);
                !near || known.counts() != zone.counts()
            });
        }
        if self.trail.len() == TRAIL {
            self.trail.remove(0);
        }
        self.trail.push((time, zone.clone()));
    }

    /// Starts the next increment from another zone.
    pub fn start_near(&mut self, zone: Z, branch: Branch) {
        self.trail.clear();
        self.previous = self.scales.map(|scales| (zone, scales, branch));
    }

    /// Starts the next increment from a state that is known to be one, on the cells that it was found on.
    pub fn start_on(&mut self, zone: Z, cells: Membrane<D>) {
        self.start_near(zone, Branch::Nearest);
        self.cells = Some(cells);
    }

    /// The scales of the problem, once a state is known.
    pub fn scales(&self) -> Option<Scales> {
        self.scales
    }

    /// Whether a membrane without contact would penetrate a body; none where that cannot be computed.
    pub fn reaches_obstacle(&self, membrane: &Membrane<D>) -> Option<bool> {
        ils::reaches_obstacle::<D, Z>(membrane, &mut Elements::new(membrane)).ok()
    }

    /// Whether the case asks for a zone that no increment has started from yet.
    pub fn is_asked(&self) -> bool {
        self.asked.is_some()
    }

    pub fn solve<'a>(
        &mut self,
        plan: &MembranePlan<D>,
        membrane: &'a Membrane<D>,
        at: (usize, f64),
        progress: &mut dyn Progress,
    ) -> Increment<'a, D>
    where
        Z: 'a,
    {
        match plan.method {
            MethodChoice::InequalityLevelSet { .. } => self.level_set(plan, membrane, at, progress),
            MethodChoice::ActiveSet(start) => active_set::<D, Z>(membrane, start, at, progress),
        }
    }

    fn level_set<'a>(
        &mut self,
        plan: &MembranePlan<D>,
        membrane: &'a Membrane<D>,
        at: (usize, f64),
        progress: &mut dyn Progress,
    ) -> Increment<'a, D>
    where
        Z: 'a,
    {
        let nearby = match (&self.asked, &self.previous) {
            (Some(_), _) => true,
            (None, previous) => matches!(previous, Some((_, _, Branch::Nearest))),
        };
        let large = plan.by_multigrid(membrane) && !nearby;
        let (mut solves, mut other) = (0, None);
        let start = match (self.asked.take(), self.previous.take()) {
            (Some(zone), _) => Start::Asked(zone, Branch::Nearest),
            (None, Some((zone, scales, branch))) => {
                let mut ahead = None;
                if let Some(predicted) = self.ahead(plan, membrane, at.1) {
                    (ahead, other) = (Some(predicted.0), predicted.1);
                }
                if ahead.is_none() && !large && !nearby {
                    let approached = self.refinement.approached(membrane, &zone, &scales, at, progress);
                    (ahead, solves) = approached.map_or((None, 0), |(zone, solves)| (Some(zone), solves));
                }
                Start::Zone(ahead.unwrap_or(zone), scales, branch)
            }
            (None, None) => Start::Free,
        };
        let found = if large { Z::by_multigrid(membrane, at, progress).ok().flatten() } else { None };
        // Where multigrid does not lead to a state a factorisation does, if it has the memory.
        let mut solution: Solution<D, Z> = match found {
            Some(solution) => solution,
            None => match if large && !progress.interrupted() { plan.lacks_memory() } else { None } {
                Some(message) => {
                    Solution { reason: ils::Reason::LinearSolver(message), ..Solution::begin(Z::empty(&membrane.grid)) }
                }
                None => match self.cells.take().map(|cells| membrane.clone().on_cells_of(&cells)) {
                    Some(cells) => ils::solve_here(&cells, start, at, progress),
                    None => {
                        let elements = &mut Elements::new(membrane);
                        self.refinement.solve(membrane, elements, start, other.as_ref(), at, progress)
                    }
                },
            },
        };
        solution.before += solves;
        self.scales = solution.scales.or(self.scales);
        let report = Report::new(&solution);
        let estimated = self.estimates && solution.reason.converged() && solution.unknowns < MOST_ESTIMATED;
        let errors = if estimated { ErrorEstimate::of(&solution).ok().flatten() } else { None };
        let converged = solution.reason.converged();
        if let (true, Some(scales)) = (converged, solution.scales) {
            self.previous = Some((solution.zone.clone(), scales, Branch::Stable));
            if membrane.obstacles.are_sticky() && (solution.jumped || solution.zone.is_empty()) {
                // Another branch of equilibria, which the states so far tell nothing of.
                self.trail.clear();
            }
            // Multigrid finds its own way from the coarsest grid.
            if !solution.multigrid {
                self.remember(plan, at.1, &solution.zone);
            }
        }
        let mut warnings = Vec::new();
        let mut warn = |kind, message: String| warnings.push(Warning::new(kind, message).at_time(at.1));
        let steepest = report.as_ref().map_or(0.0, |r| r.max_slope);
        if self.has_units && steepest > LINEAR {
            warn(
                WarningKind::SteepSlopes,
                format!(
                    "slopes reach {steepest:.1}: the linear theory of the membrane holds below about {LINEAR}, beyond it the tension grows"
                ),
            );
        }
        let sharp = solution.zone.bend();
        if D == 2 && !solution.zone.is_empty() && sharp > RESOLVED {
            warn(
                WarningKind::SharpFront,
                format!(
                    "a front has a radius of curvature of {:.2} cells at t = {}: below two cells its shape is approximate, use more cells",
                    1.0 / sharp,
                    at.1
                ),
            );
        }
        if solution.unrefined {
            warn(
                WarningKind::NotRefined,
                format!("no state was found on smaller cells at t = {}: the one on larger cells stands", at.1),
            );
        }
        if let Some(fewest) = membrane.modes.reduced(&solution.zone) {
            warn(
                WarningKind::FewerModes,
                format!(
                    "a front has {fewest} modes at t = {}, fewer than `mode_count`: its cells tell no more apart",
                    at.1
                ),
            );
        }
        let on_nodes = membrane.formulation.transport() != Transport::Exact;
        if let Some(step) = solution.settled_within {
            let why = if on_nodes {
                "as far as a level set on nodes shifts them with every step: `transport = \"exact\"` does not"
            } else if step < 1e-3 {
                "on a jump of the discrete slope"
            } else {
                "where they are sharper than the grid: zones, areas and forces are known to that only"
            };
            warn(
                WarningKind::FrontsAtRest,
                format!("the fronts settled to {step:.0e} of a cell at t = {}, {why}", at.1),
            );
        }
        if let Some(depth) = solution.unresolved {
            warn(
                WarningKind::NotResolved,
                format!(
                    "the grid cannot tell whether zones touch at t = {}: the membrane penetrates what lies between them by {depth:.0e}",
                    at.1
                ),
            );
        }
        let reason = match &solution.reason {
            ils::Reason::Converged => Reason::Converged,
            ils::Reason::NoContact => Reason::NoContact,
            ils::Reason::NoSuchState => Reason::NoSuchState,
            ils::Reason::IterationLimit => Reason::IterationLimit,
            ils::Reason::Interrupted => Reason::Interrupted,
            ils::Reason::LinearSolver(message) => {
                warn(WarningKind::LinearSolver, message.clone());
                Reason::LinearSolver
            }
        };
        if let Some(kink) = solution.conditions.as_ref().and_then(|c| c.kink).filter(|_| estimated) {
            let place: Vec<String> = kink.place.iter().map(|v| format!("{v:.4}")).collect();
            let message = format!(
                "what the membrane touches has a kink within the contact, near ({}): along it the pressure is a line force that the method \
                 leaves out, and the error estimate does not see it; round the kink off by a few cells",
                place.join(", ")
            );
            warnings.insert(0, Warning::new(WarningKind::Kink, message).at_time(at.1).at(vector(&kink.place)));
        }
        let outlines = solution.zone.outlines();
        let resolved = solution.is_resolved();
        let residuals = std::mem::take(&mut solution.residuals);
        let (iterations, before, unknowns) = (solution.iterations, solution.before, solution.unknowns);
        let stability = Stability {
            lowest_eigenvalue: solution.lowest_eigenvalue,
            jumped: solution.jumped && converged,
            margin: solution.margin,
        };
        let sample: Option<Sampler<'a, D>> = solution.equilibrium.map(|equilibrium| {
            let zone = solution.zone;
            Box::new(move |x: &Point<D>| {
                let displacement = equilibrium.displacement(&zone, x)?;
                let touched = contact_of(zone.region_at(x));
                let pressure = touched.map_or(0.0, |(side, _)| membrane.pressure(side, x));
                Some(Sample { displacement, in_contact: touched.is_some(), pressure })
            }) as Sampler<'a, D>
        });
        Increment {
            converged,
            reason,
            iterations,
            before,
            residuals,
            unknowns,
            solver: if solution.multigrid { "multigrid" } else { "direct" },
            warnings,
            report,
            outlines,
            sample,
            stability,
            resolved,
            errors,
        }
    }
}

fn active_set<'a, const D: usize, Z: Zone<D>>(
    membrane: &'a Membrane<D>,
    start: NodalStart,
    at: (usize, f64),
    progress: &mut dyn Progress,
) -> Increment<'a, D> {
    let failed = |message: String| Increment {
        converged: false,
        reason: Reason::LinearSolver,
        iterations: 0,
        before: 0,
        residuals: Vec::new(),
        unknowns: 0,
        solver: "direct",
        warnings: vec![Warning::new(WarningKind::LinearSolver, message).at_time(at.1)],
        report: None,
        outlines: Vec::new(),
        sample: None,
        stability: Stability::default(),
        resolved: true,
        errors: None,
    };
    if membrane.obstacles.is_empty() {
        return failed("method.active_set needs something to touch".into());
    }
    let solved = {
        let shared = &*progress;
        active_set::solve::<D, Z>(membrane, start, &|| shared.interrupted())
    };
    let solution = match solved {
        Ok(solution) => solution,
        Err(error) => return failed(error.to_string()),
    };
    let zones = Staircase::new(membrane, &solution);
    for (i, changed) in solution.changes.iter().enumerate() {
        progress.iteration(&Iteration {
            step: at.0,
            time: at.1,
            iteration: i + 1,
            residual: *changed as f64,
            action: "active set",
            figures: &[("zones", zones.components.len() as f64)],
        });
    }
    let reason = match (solution.converged, progress.interrupted(), zones.components.is_empty()) {
        (true, _, true) => Reason::NoContact,
        (true, ..) => Reason::Converged,
        (false, true, _) => Reason::Interrupted,
        (false, false, _) => Reason::IterationLimit,
    };
    Increment {
        converged: solution.converged,
        reason,
        iterations: solution.iterations,
        before: 0,
        residuals: solution.changes.iter().map(|c| *c as f64).collect(),
        unknowns: solution.unknowns,
        solver: "direct",
        warnings: Vec::new(),
        report: Some(nodal_report(membrane, &solution, &zones)),
        outlines: zones.outlines,
        stability: Stability::default(),
        resolved: true,
        errors: None,
        sample: Some(Box::new(move |x| {
            Some(Sample {
                displacement: solution.displacement(membrane, x),
                in_contact: solution.contact(membrane, x).is_some(),
                pressure: solution.pressure(membrane, x),
            })
        })),
    }
}

fn nodal_report<const D: usize>(
    membrane: &Membrane<D>,
    solution: &NodalSolution<D>,
    zones: &Staircase<D>,
) -> Report<D> {
    let obstacles = &membrane.obstacles;
    let supports: f64 = solution.support_forces.iter().sum();
    let forces = zones.components.iter().map(|c| c.force);
    let largest = forces.clone().chain([supports, solution.load_force]).fold(f64::MIN_POSITIVE, |m, f| m.max(f.abs()));
    let length = |o: &Vec<Point<D>>| -> f64 {
        if D == 1 { 2.0 } else { o.iter().zip(o.iter().cycle().skip(1)).map(|(a, b)| (b - a).norm()).sum() }
    };
    let contact = |k: usize| {
        let side = obstacles.0[k].side;
        let mut extremes = Extremes::default();
        for (i, node) in solution.nodes.iter().enumerate() {
            let Some(node) = node.filter(|n| n.inside) else { continue };
            let x = membrane.grid.node(i);
            if obstacles.index_at(side, &x) != Some(k) {
                continue;
            }
            if node.contact == Some(side) {
                extremes.add_pressure(node.pressure());
            } else {
                extremes.add_gap(obstacles.gap(side, &x, node.displacement), true);
            }
        }
        let own = zones.components.iter().filter(|c| c.obstacle == k).cloned().collect();
        // Outlines are not told apart by bodies: with several of them the length is that of all.
        ContactReport::of(own, zones.outlines.iter().map(length).sum(), Some(&extremes))
    };
    Report {
        support_forces: solution.support_forces.clone(),
        load_force: solution.load_force,
        energy: solution.energy,
        max_slope: 0.0,
        volume: solution.nodes.iter().flatten().map(|n| n.share * n.displacement).sum(),
        equilibrium_residual: (forces.sum::<f64>() + supports + solution.load_force).abs() / largest,
        contacts: (0..obstacles.0.len()).map(contact).collect(),
    }
}

impl<const D: usize> Increment<'_, D> {
    /// Area of contact.
    pub fn area(&self) -> f64 {
        self.report.as_ref().map_or(0.0, |r| r.area())
    }

    /// Energy with that of adhesion.
    pub fn energy_total(&self) -> f64 {
        self.report.as_ref().map_or(f64::NAN, |r| r.energy_total())
    }

    /// The state on the display mesh; none where nothing was solved.
    pub fn snapshot(&self, mesh: &DisplayMesh<D>, membrane: &Membrane<D>, time: f64) -> Option<Snapshot<D>> {
        let sample = self.sample.as_ref()?;
        Some(Snapshot::new(mesh, membrane, time, self.outlines.clone(), sample))
    }

    /// The entry of the summary, with the resultants of the loads.
    pub fn step_report(
        &self,
        plan: &MembranePlan<D>,
        (index, time): (usize, f64),
        loads: &BTreeMap<String, f64>,
    ) -> StepReport {
        let upward = |f: f64| [0.0, 0.0, f];
        let step = StepReport {
            index,
            time,
            converged: self.converged,
            reason: self.reason,
            iterations: self.iterations,
            iterations_before: self.before,
            solver: self.solver.into(),
            residual_history: self.residuals.clone(),
            ..StepReport::default()
        };
        let Some(report) = &self.report else { return step };
        let probe = |x: &Point<D>| {
            let found = self.sample.as_ref().and_then(|sample| sample(x))?;
            Some(report::Probe {
                at: vector(x),
                displacement: upward(found.displacement),
                in_contact: Some(found.in_contact),
                pressure: Some(found.pressure),
                von_mises: None,
            })
        };
        let supports = plan.supports.iter().zip(&report.support_forces);
        let contacts = plan.contacts.iter().zip(&report.contacts);
        StepReport {
            energy: Some(report.energy),
            energy_total: Some(report.energy_total()),
            volume: Some(report.volume),
            max_slope: Some(report.max_slope),
            equilibrium_residual: Some(report.equilibrium_residual),
            support_forces: supports.map(|(support, force)| (support.name.clone(), upward(*force))).collect(),
            load_forces: loads.iter().map(|(name, force)| (name.clone(), upward(*force))).collect(),
            contacts: contacts.map(|(c, found)| (c.name.clone(), self.contact_report(found, plan.space))).collect(),
            probes: plan.probes.iter().map(|(name, x)| (name.clone(), probe(x))).collect(),
            ..step
        }
    }

    fn contact_report(&self, c: &ContactReport<D>, space: Space) -> report::ContactReport {
        let component = |k: &Component<D>| report::Component {
            area: k.area,
            force: [0.0, 0.0, k.force],
            centroid: vector(&k.centroid),
            holes: Some(k.holes),
        };
        report::ContactReport {
            force: [0.0, 0.0, c.force],
            area: c.area,
            zones: c.components.len(),
            holes: Some(c.holes),
            components: c.components.iter().map(component).collect(),
            radius: self.radius(c, space),
            boundary_length: Some(c.boundary_length),
            max_penetration: c.max_penetration,
            min_gap_outside: c.min_gap_outside,
            max_pressure: c.max_pressure,
            min_pressure: Some(c.min_pressure),
            line_force: Some(c.line_force),
            adhesion_energy: Some(c.adhesion_energy),
            stable: Some(self.stability.lowest_eigenvalue.is_none_or(|v| v > 0.0)),
            lowest_eigenvalue: self.stability.lowest_eigenvalue,
            error_estimate: self.errors.map(|e| report::ErrorEstimate {
                front: Some(e.front),
                area: e.area,
                force: e.force,
                max_pressure: Some(e.max_pressure),
            }),
            ..report::ContactReport::default()
        }
    }

    /// The radius of a zone that is a disc to two hundredths, or half the length of one that is an interval.
    fn radius(&self, c: &ContactReport<D>, space: Space) -> Option<f64> {
        let [component] = c.components.as_slice() else { return None };
        let disc = (c.area / std::f64::consts::PI).sqrt();
        match (space, D) {
            (Space::Line, _) => Some(0.5 * c.area),
            (Space::Axisymmetric, _) => {
                let outer = self.outlines.first()?.last()?[0];
                ((outer - disc).abs() < 0.02 * outer).then_some(disc)
            }
            _ => {
                let [outline] = self.outlines.as_slice() else { return None };
                let radii = outline.iter().map(|p| (p - component.centroid).norm());
                let (lo, hi) = radii.fold((f64::INFINITY, 0.0f64), |(l, h), r| (l.min(r), h.max(r)));
                (hi - lo < 0.02 * hi).then_some(disc)
            }
        }
    }
}
