//! The inequality level-set method: a Newton iteration on the shape of the contact zone inside a sweep over the contact
//! conditions.

use crate::active_set::{self, NodalStart};
use crate::adhesion::Branch;
use crate::conditions::{Conditions, corrected, least_free_gap, pushes};
use crate::deferred::Known;
use crate::equilibrium::{Elements, Equilibrium};
use crate::front::{Fronts, Step, StepKind};
use crate::problem::Membrane;
use crate::published::{ModeSchedule, Transport};
pub use crate::rest::Rest;
use crate::rest::{Course, SETTLED, SHARP, Sight, Verdict};
use crate::scales::Scales;
use crate::zone::{Advance, Zone, contact_index};
use signorini_fem::Grid;
use signorini_geometry::Point;
use signorini_solve::{Acceleration, Iteration, Progress, SolveError};

/// Fronts that have torn or met so often have gone astray.
const MOST_CHANGES: usize = 10;
/// Steps down the energy before a jump is given up.
const MOST_DESCENTS: usize = 200;
/// An eigenvalue of the second variation below this fraction of the pressure's share is negative.
const UNSTABLE: f64 = -1e-6;
/// A gap of this fraction of the scale counts as none: without contact nothing but round-off disturbs it.
const FREE: f64 = -1e-10;
/// A zone of less than this part of a cell has no shape.
const SMALL: f64 = 0.7;
/// Holes of fewer cells are nowhere far from their outlines.
const FEW: f64 = 16.0;
/// Steps shorter than so many cells are made with the derivative of the discrete equations ...
const CLOSE: f64 = 0.3;
/// ... or, with adhesion, than so many: near the loss of a state the derivative in the continuum lacks much of it ...
const CLOSE_STICKY: f64 = 1.0;
/// ... on fronts that curve by less than this within a cell ...
const BLUNT: f64 = 1.0;
/// ... unless they get longer by this factor.
const LONGER: f64 = 2.0;
/// Adhesive steps shorter than this fraction of a cell are extrapolated.
const NEAR: f64 = 0.1;
/// A front moves at most this fraction of the membrane's extent in one step.
const REACH: f64 = 0.15;
/// A step may make a front so much sharper than a cell, or sharper by so much than it was: where the pressure that steers it
/// is weak, what cells make of the slope jump would bend it.
const WILD: f64 = 3.0;
const SHARPENED: f64 = 2.0;
/// So often its short waves are left out, each time those of twice the length.
const MOST_SMOOTHINGS: u32 = 4;

/// How a solve ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The slope jump vanishes on all fronts and the contact conditions hold everywhere.
    Converged,
    /// The membrane does not reach any body.
    NoContact,
    /// No equilibrium with contact was found near the zone that was asked for.
    NoSuchState,
    /// The fronts did not come to rest.
    IterationLimit,
    /// The linear solver failed; its message.
    LinearSolver(String),
    /// The user asked to stop.
    Interrupted,
}

impl Reason {
    pub fn converged(&self) -> bool {
        matches!(self, Reason::Converged | Reason::NoContact)
    }
}

/// The state at the end of a solve, whether it converged or not.
pub struct Solution<const D: usize, Z> {
    pub zone: Z,
    /// None only where even the first linear system could not be solved.
    pub equilibrium: Option<Equilibrium<D>>,
    pub conditions: Option<Conditions<D>>,
    pub scales: Option<Scales>,
    pub reason: Reason,
    /// Equilibrium solves on the cells of this state, and on larger ones before that.
    pub iterations: usize,
    pub before: usize,
    /// Residual of each iteration relative to its tolerance.
    pub residuals: Vec<f64>,
    /// Size of the largest linear system.
    pub unknowns: usize,
    /// With adhesion, the lowest eigenvalue of the second variation of the energy: stable where it is positive.
    pub lowest_eigenvalue: Option<f64>,
    /// Whether the way led through unstable states: adhesion let the contact jump.
    pub jumped: bool,
    /// With adhesion, how far the state is from its loss: the square of the lowest eigenvalue, or the least gap of a free
    /// membrane. Near that loss it vanishes linearly in the load.
    pub margin: Option<f64>,
    /// Penetration that was put up with where zones come so near to each other that the grid cannot tell whether they touch.
    pub unresolved: Option<f64>,
    /// Whether smaller cells were wanted at the fronts, but no state was found on them.
    pub unrefined: bool,
    /// Length of the last step relative to a cell, where the fronts settled on a jump of the discrete slope.
    pub settled_within: Option<f64>,
    /// Whether they were left to smaller cells before they came to rest ...
    pub unfinished: bool,
    /// ... and whether they may stay so where there are none.
    pub near_enough: bool,
    /// Whether multigrid found it, and not a factorisation.
    pub multigrid: bool,
    /// What the nodal method predicted on the way, if it was asked.
    pub predicted: Option<Z>,
}

impl<const D: usize, Z> Solution<D, Z> {
    /// Nothing but a zone.
    pub fn begin(zone: Z) -> Self {
        Self {
            zone,
            equilibrium: None,
            conditions: None,
            scales: None,
            reason: Reason::IterationLimit,
            iterations: 0,
            before: 0,
            residuals: Vec::new(),
            unknowns: 0,
            lowest_eigenvalue: None,
            jumped: false,
            margin: None,
            unresolved: None,
            unrefined: false,
            settled_within: None,
            unfinished: false,
            near_enough: false,
            multigrid: false,
            predicted: None,
        }
    }

    /// Whether the fronts came to rest no sharper than the grid can show.
    pub fn is_resolved(&self) -> bool {
        self.settled_within.is_none_or(|step| step < SETTLED)
    }
}

/// Where an increment starts from.
#[derive(Clone)]
pub enum Start<Z> {
    /// The membrane without contact.
    Free,
    /// A zone from an earlier increment, with its scales, and which of the equilibria near it is wanted.
    Zone(Z, Scales, Branch),
    /// A zone that someone asked for, and which of the equilibria near it is wanted.
    Asked(Z, Branch),
}

impl<Z> Start<Z> {
    /// The same start on the cells of a membrane.
    pub(crate) fn on<const D: usize>(self, membrane: &Membrane<D>) -> Self {
        match self {
            Start::Zone(zone, scales, branch) => Start::Zone(zone, scales.on(membrane), branch),
            other => other,
        }
    }
}

/// The solution next to a start that is one but for round-off, on the cells of the membrane as they are; no state where it
/// penetrates a body.
pub fn solve_here<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    start: Start<Z>,
    at: (usize, f64),
    progress: &mut dyn Progress,
) -> Solution<D, Z> {
    solve(membrane, &mut Elements::new(membrane), start.on(membrane), Rest::Uncorrected, at, progress)
}

/// Solves one increment.
pub fn solve<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    elements: &mut Elements<D>,
    start: Start<Z>,
    rest: Rest,
    at: (usize, f64),
    progress: &mut dyn Progress,
) -> Solution<D, Z> {
    solve_from(membrane, elements, start, None, rest, at, progress)
}

/// Solves one increment from a zone whose state on these cells may be known.
pub(crate) fn solve_from<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    elements: &mut Elements<D>,
    start: Start<Z>,
    known: Option<Equilibrium<D>>,
    rest: Rest,
    at: (usize, f64),
    progress: &mut dyn Progress,
) -> Solution<D, Z> {
    let mut run = Run {
        solution: Solution { iterations: usize::from(known.is_some()), ..Solution::begin(Z::empty(&membrane.grid)) },
        known,
        branch: Branch::Stable,
        adhering: false,
        membrane,
        elements,
        rest,
        at,
        progress,
    };
    let reason = run.from(start).unwrap_or_else(|error| Reason::LinearSolver(error.to_string()));
    run.solution.reason = reason;
    run.solution
}

/// Goes on from where a solve left its fronts, on the same cells and without adhesion.
pub(crate) fn resume<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    mut found: Solution<D, Z>,
    rest: Rest,
    at: (usize, f64),
    progress: &mut dyn Progress,
) -> Solution<D, Z> {
    // It is told again what the fronts lack.
    found.residuals.pop();
    let mut run = Run {
        known: found.equilibrium.take(),
        solution: found,
        branch: Branch::Stable,
        adhering: false,
        membrane,
        elements: &mut Elements::new(membrane),
        rest,
        at,
        progress,
    };
    let reason = run.sweep().unwrap_or_else(|error| Reason::LinearSolver(error.to_string()));
    run.solution.reason = reason;
    run.solution
}

/// The zone by the nodal method on linear elements, which is cheap, and cannot go astray however the zone is connected. Its
/// front is true to a fraction of a cell, or of smaller ones where the question is what has merged.
pub(crate) fn prediction<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    known: Option<&Known<'_, D, Z>>,
    interrupted: &dyn Fn() -> bool,
) -> Result<Z, SolveError> {
    let finer = if membrane.cells.degree() >= 3 { 2 } else { 1 };
    let nodal = membrane.on(membrane.cells.linear(finer));
    let solution = active_set::solve_beside::<D, Z>(&nodal, NodalStart::Nested, known, interrupted)?;
    if let Some(sizing) = &membrane.sizing {
        let outlines = |side| {
            let found = nodal.cells.outlines(&solution.predictor(&nodal, side, true));
            found.map(|found| found.into_iter().map(move |outline| (side, outline)).collect::<Vec<_>>())
        };
        if let Some(outlines) = nodal.obstacles.sides().map(outlines).collect::<Option<Vec<_>>>() {
            let linear = Grid::new(*membrane.grid.bounds(), membrane.grid.cells(), 1);
            return Ok(Z::within(&linear, sizing, &outlines.concat()));
        }
    }
    let grid = membrane.samples();
    Ok(nodal.obstacles.sides().fold(Z::empty(&grid), |zone, side| {
        let predictor = solution.predictor(&nodal, side, false);
        zone.united(&grid, side, &mut |x| predictor(x))
    }))
}

/// Whether a membrane without contact would penetrate a body.
pub fn reaches_obstacle<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    elements: &mut Elements<D>,
) -> Result<bool, SolveError> {
    if membrane.obstacles.is_empty() {
        return Ok(false);
    }
    let none = Z::empty(&membrane.grid);
    let free = Equilibrium::solve(membrane, &none, elements)?;
    Ok(!is_clear(&free, &none))
}

/// Whether a membrane without contact stays clear of all bodies.
pub(crate) fn is_clear<const D: usize, Z: Zone<D>>(free: &Equilibrium<D>, none: &Z) -> bool {
    least_free_gap(free, none).0 >= FREE * Scales::of_free(free).gap
}

/// The area of each zone as it is drawn, whatever it weighs.
fn areas<const D: usize>(equilibrium: &Equilibrium<D>, zones: usize) -> Vec<f64> {
    let mut area = vec![0.0; zones];
    equilibrium.for_each_point(|_, region, x, w| {
        if let Some(a) = contact_index(region).and_then(|k| area.get_mut(k)) {
            *a += w / equilibrium.membrane.measure.weight(x);
        }
    });
    area
}

/// A zone smaller than a cell that shrinks: there is nothing that would stop it.
fn lost<const D: usize>(equilibrium: &Equilibrium<D>, fronts: &Fronts<'_, D>, area: &[f64]) -> Option<usize> {
    let cell = equilibrium.membrane.grid.h().powi(D as i32);
    let drive = fronts.drive_of_zones(area.len());
    (0..area.len()).find(|&k| area[k] < SMALL * cell && drive[k] > 0.0)
}

struct Run<'a, 'b, const D: usize, Z> {
    membrane: &'a Membrane<D>,
    elements: &'b mut Elements<D>,
    rest: Rest,
    at: (usize, f64),
    progress: &'b mut dyn Progress,
    branch: Branch,
    /// Whether adhesion holds the fronts, or is left out.
    adhering: bool,
    solution: Solution<D, Z>,
    /// The state of the zone of this solution, where it is known before the first solve.
    known: Option<Equilibrium<D>>,
}

/// How the iteration on the fronts ended.
enum Fixed {
    AtRest,
    Moving,
    Interrupted,
}

impl<const D: usize, Z: Zone<D>> Run<'_, '_, D, Z> {
    fn from(&mut self, start: Start<Z>) -> Result<Reason, SolveError> {
        if self.membrane.obstacles.is_empty() {
            self.settle_fronts()?;
            return Ok(Reason::NoContact);
        }
        match start {
            Start::Zone(zone, scales, branch) if !zone.is_empty() => {
                self.solution.zone = if self.rest == Rest::Uncorrected { zone } else { zone.on_cells(self.membrane) };
                self.solution.scales = Some(scales);
                self.branch = branch;
            }
            Start::Free | Start::Zone(..) => {}
            Start::Asked(zone, branch) => {
                // Without contact, for the scales.
                self.settle_fronts()?;
                self.solution.zone = zone.on_cells(self.membrane);
                self.branch = branch;
            }
        }
        if !self.membrane.obstacles.are_sticky() {
            return self.sweep();
        }
        if self.solution.zone.is_empty()
            && let Some(ended) = self.nucleate()?
        {
            return Ok(ended);
        }
        self.adhering = true;
        let before = self.solution.zone.counts();
        let reason = self.sweep()?;
        self.solution.jumped |= self.solution.zone.counts() != before;
        self.solution.margin = self.solution.lowest_eigenvalue.map(|v| v.max(0.0).powi(2));
        if let (Reason::NoContact, Some(equilibrium)) = (&reason, &self.solution.equilibrium) {
            self.solution.margin = Some(least_free_gap(equilibrium, &self.solution.zone).0);
        }
        Ok(match reason {
            Reason::NoContact | Reason::IterationLimit if self.branch == Branch::Nearest => Reason::NoSuchState,
            other => other,
        })
    }

    /// Where the free membrane reaches a body: the zone without adhesion, from which adhesion then spreads; or a seed
    /// where that is smaller than the grid can tell. Adhesion acts at no distance: a membrane that stays clear of all
    /// bodies is free.
    fn nucleate(&mut self) -> Result<Option<Reason>, SolveError> {
        if let Fixed::Interrupted = self.settle_fronts()? {
            return Ok(Some(Reason::Interrupted));
        }
        let solution = &mut self.solution;
        let (Some(equilibrium), Some(scales)) = (&solution.equilibrium, solution.scales) else {
            return Ok(Some(Reason::IterationLimit));
        };
        let (gap, side, deepest) = least_free_gap(equilibrium, &solution.zone);
        if gap >= FREE * scales.gap {
            solution.margin = Some(gap);
            solution.conditions = Some(Conditions::check(equilibrium, &solution.zone, &scales, false));
            return Ok(Some(Reason::NoContact));
        }
        match self.sweep()? {
            Reason::Converged => {}
            Reason::Interrupted => return Ok(Some(Reason::Interrupted)),
            _ => {
                let grid = &self.membrane.grid;
                self.solution.zone = Z::empty(grid).seeded(grid, side, &deepest, 0.5 * grid.h());
            }
        }
        self.solution.jumped = true;
        Ok(None)
    }

    /// Corrects the zone until the contact conditions hold everywhere.
    fn sweep(&mut self) -> Result<Reason, SolveError> {
        let mut predicted = false;
        let mut sweeps = 0;
        let mut seen: Vec<((usize, usize), f64)> = Vec::new();
        loop {
            let settled = self.settle_fronts();
            if let Ok(Fixed::Interrupted) = settled {
                return Ok(Reason::Interrupted);
            }
            let astray = !matches!(settled, Ok(Fixed::AtRest))
                || sweeps > self.rest.most_sweeps()
                || (!predicted && self.have_missed_a_merger()?);
            if astray && (predicted || self.adhering) {
                return settled.map(|_| Reason::IterationLimit);
            }
            if astray {
                (predicted, sweeps) = (true, 0);
                self.predict()?;
                continue;
            }
            let [tips, sharp] = [1.0, SHARP].map(|bend| self.has_tips(&self.solution.zone, bend));
            if (self.rest == Rest::BeforeMoreDivision && self.solution.unfinished)
                || (self.rest == Rest::BeforeDivision && tips)
            {
                return Ok(Reason::Converged);
            }
            sweeps += 1;
            let solution = &mut self.solution;
            let (Some(equilibrium), Some(scales)) = (&solution.equilibrium, &solution.scales) else {
                return Ok(Reason::IterationLimit);
            };
            let conditions = Conditions::check(equilibrium, &solution.zone, scales, self.adhering);
            let first = solution.zone.is_empty();
            if conditions.hold(scales) {
                solution.conditions = Some(conditions);
                return Ok(if solution.zone.is_empty() { Reason::NoContact } else { Reason::Converged });
            }
            // What fronts about as sharp as a cell leave between them is for smaller cells, or for none.
            let divided = self.membrane.sizing.is_some();
            let at_tips = tips || (sharp && divided && solution.settled_within.is_some());
            let nearly = || conditions.nearly_hold_about(&solution.zone, scales, self.membrane);
            if (tips && solution.unfinished) || (at_tips && nearly()) {
                solution.unresolved = Some(-conditions.least_gap_outside);
                solution.conditions = Some(conditions);
                return Ok(Reason::Converged);
            }
            if self.rest == Rest::Uncorrected {
                let nearly = conditions.nearly_hold_about(&solution.zone, scales, self.membrane);
                solution.unresolved = nearly.then_some(-conditions.least_gap_outside);
                solution.conditions = Some(conditions);
                return Ok(if nearly { Reason::Converged } else { Reason::NoSuchState });
            }
            // Corrected and settled again it would come back to itself: the grid cannot tell whether zones touch.
            let state = (solution.zone.counts(), conditions.least_gap_outside);
            let left = self.rest == Rest::BeforeDivision && !self.adhering;
            let again = |(counts, gap): &((usize, usize), f64)| {
                *counts == state.0 && (left || (gap / state.1 - 1.0).abs() < 0.1)
            };
            if !first && seen.iter().any(again) {
                if left || conditions.nearly_hold(scales, self.membrane) {
                    solution.unresolved = Some(-conditions.least_gap_outside);
                    solution.conditions = Some(conditions);
                    return Ok(Reason::Converged);
                }
                solution.conditions = Some(conditions);
                if predicted || self.adhering {
                    return Ok(Reason::IterationLimit);
                }
                (predicted, sweeps) = (true, 0);
                self.predict()?;
                continue;
            }
            seen.push(state);
            if self.branch == Branch::Nearest && first {
                return Ok(Reason::NoContact);
            }
            let zone = corrected(equilibrium, &solution.zone, &conditions, scales, self.adhering);
            let simple = zone.counts() == (1, 0) && conditions.least_pressure_below > 0.0;
            solution.conditions = Some(conditions);
            self.solution.zone = self.resized(zone);
            if first && !simple && !predicted && !self.adhering {
                predicted = true;
                self.predict()?;
            }
        }
    }

    /// Whether a level set on nodes moves the fronts, which shifts them with every step.
    fn is_shifted(&self) -> bool {
        self.membrane.formulation.transport() != Transport::Exact
    }

    /// Whether long fronts curve by so much within a cell. On tips sharper than one Newton's method does not converge, as their
    /// radius is the length on which it may move them.
    fn has_tips(&self, zone: &Z, bend: f64) -> bool {
        !self.is_shifted() && !self.adhering && zone.has_tips(bend)
    }

    /// Whether fronts that moved to the last, sharper than the grid, are those of zones that have merged or split.
    fn have_missed_a_merger(&self) -> Result<bool, SolveError> {
        let left = self.solution.unfinished;
        let moving = self.solution.settled_within.is_some_and(|step| step > SETTLED);
        if !moving || left || self.is_shifted() || self.adhering {
            return Ok(false);
        }
        let zone = &self.solution.zone;
        let known = self.solution.equilibrium.as_ref().map(|state| Known { state, zone });
        Ok(self.prediction(known.as_ref())?.counts() != zone.counts())
    }

    /// Replaces the zone by what the nodal method predicts.
    fn predict(&mut self) -> Result<(), SolveError> {
        self.solution.zone = self.prediction(None)?;
        self.solution.predicted = Some(self.solution.zone.clone());
        self.report(0.0, "predicted");
        self.solution.residuals.pop();
        Ok(())
    }

    /// The zone by the nodal method, on as many nodes as the cells make worth while.
    fn prediction(&self, known: Option<&Known<'_, D, Z>>) -> Result<Z, SolveError> {
        Ok(self.resized(prediction(self.membrane, known, &|| self.progress.interrupted())?))
    }

    /// A zone whose fronts were drawn anew on the grid, with modes as long as the cells are large.
    fn resized(&self, zone: Z) -> Z {
        match &self.membrane.sizing {
            None => zone,
            Some(sizing) => zone.on_sizes(&self.membrane.grid, sizing),
        }
    }

    /// Newton's iteration on the shape of the zone.
    fn settle_fronts(&mut self) -> Result<Fixed, SolveError> {
        let finest = self.membrane.modes.finest();
        let mut acceleration = Acceleration::default();
        let mut schedule = ModeSchedule::default();
        let mut course = Course::default();
        self.solution.settled_within = None;
        self.solution.unfinished = false;
        self.solution.lowest_eigenvalue = None;
        let (mut count, mut descents, mut changes) = (0, 0, 0);
        let transport = self.membrane.formulation.transport();
        let shifted = self.is_shifted();
        let most_steps = self.rest.most_steps();
        while count < most_steps && changes < MOST_CHANGES && descents < MOST_DESCENTS {
            count += 1;
            if self.progress.interrupted() {
                return Ok(Fixed::Interrupted);
            }
            let zone = &self.solution.zone;
            let equilibrium = match self.known.take() {
                Some(known) => known,
                None => {
                    self.solution.iterations += 1;
                    Equilibrium::solve(self.membrane, zone, self.elements)?
                }
            };
            self.solution.unknowns = self.solution.unknowns.max(equilibrium.size());
            if self.solution.scales.is_none() {
                self.solution.scales = Some(Scales::of_free(&equilibrium));
            }
            let Some(scales) = self.solution.scales else { return Ok(Fixed::Moving) };
            if zone.is_empty() {
                self.report(0.0, "free membrane");
                self.solution.equilibrium = Some(equilibrium);
                return Ok(Fixed::AtRest);
            }
            let area = areas(&equilibrium, zone.counts().0);
            // Fronts that have left the membrane, or closed.
            let beyond = area.iter().position(|a| *a == 0.0);
            let fewer = beyond.map(|part| (zone.without(&self.membrane.grid, part), "zone left the membrane"));
            let fewer = fewer.or_else(|| Some((self.without_pressed_holes(zone)?, "hole closed")));
            if let Some((zone, what)) = fewer {
                self.report(0.0, what);
                course = Course::default();
                acceleration = Acceleration::default();
                self.solution.equilibrium = Some(equilibrium);
                self.solution.zone = zone;
                continue;
            }
            let h = self.membrane.grid.h();
            let fronts = Fronts::new(&equilibrium, self.adhering);
            if let (true, Branch::Stable) = (self.adhering, self.branch)
                && let Some(part) = lost(&equilibrium, &fronts, &area)
            {
                let zone = zone.without(&self.membrane.grid, part);
                self.report(0.0, "zone lost");
                (count, descents, course) = (0, descents + 1, Course::default());
                self.solution.jumped = true;
                self.solution.equilibrium = Some(equilibrium);
                self.solution.zone = zone;
                continue;
            }
            let residual = fronts.residual(zone, finest) / scales.slope_tolerance();
            let linearised = if self.adhering { Some(fronts.linearise(zone, finest, &scales)?) } else { None };
            let mut step = match &linearised {
                Some(linearised) => linearised.step(self.branch, &scales),
                None => match equilibrium.saddle() {
                    Some(saddle) => schedule.step(&fronts, saddle, zone, &scales)?,
                    None => fronts.newton_step(zone, &scales)?,
                },
            };
            course.take(residual, area.iter().sum::<f64>() / scales.length.powi(D as i32), step.kind, shifted);
            let bend = if D > 1 { zone.bend() } else { 0.0 };
            let sight = Sight {
                residual,
                step: step.length,
                kind: step.kind,
                bend,
                tips: bend >= SHARP && self.has_tips(zone, SHARP),
                divided: self.membrane.sizing.is_some(),
                shifted,
                adhering: self.adhering,
                kinks: scales.degree == 1,
                last: count == most_steps,
                unseen: &|share| {
                    let projection = fronts.project(zone, finest);
                    projection.norm < share * projection.remainder
                },
                farthest: &|| fronts.farthest(zone, &scales, |_| h),
            };
            let verdict = self.rest.judge(&course, &sight);
            if verdict != Verdict::Moving {
                if let Some(linearised) = &linearised {
                    let spectrum = linearised.spectrum();
                    let lowest = spectrum.as_ref().and_then(|s| s.values.first().copied());
                    if let (Some(spectrum), Some(lowest), Branch::Stable) = (&spectrum, lowest, self.branch)
                        && lowest < UNSTABLE * linearised.scale
                        && descents < MOST_DESCENTS
                    {
                        let kick = linearised.kick(spectrum, h);
                        let advance = zone.advanced(&self.membrane.grid, finest, &kick, h);
                        self.report(residual, "at rest, but unstable");
                        (count, descents, course) = (0, descents + 10, Course::default());
                        self.solution.jumped = true;
                        self.solution.equilibrium = Some(equilibrium);
                        self.solution.zone = advance.zone;
                        continue;
                    }
                    self.solution.lowest_eigenvalue = lowest;
                }
                let settled = verdict != Verdict::AtRest;
                self.report(residual, if settled { "settled" } else { "at rest" });
                self.solution.settled_within = settled.then_some(step.length);
                self.solution.unfinished = matches!(verdict, Verdict::Left { .. });
                self.solution.near_enough = verdict == Verdict::Left { settled: true };
                self.solution.equilibrium = Some(equilibrium);
                return Ok(Fixed::AtRest);
            }
            if step.kind == StepKind::Descent {
                (count, descents, course) = (0, descents + 1, Course::default());
                self.solution.jumped = true;
            }
            // Short of adhesion fronts rest without a slope: the pressure of the floor is nearly all of the derivative in the
            // continuum. Near the solution the rest of it, which cells add, makes the convergence quadratic.
            let close = if self.adhering { CLOSE_STICKY } else { CLOSE };
            let near = step.length < close && course.is_smooth() && bend < BLUNT && step.kind != StepKind::Descent;
            let exact = match D > 1 && near && !shifted && equilibrium.responds() {
                true => fronts.discrete_step(zone, self.elements, &scales, linearised.as_ref())?,
                false => None,
            };
            step = exact.filter(|exact| exact.length < LONGER * step.length).unwrap_or(step);
            course.make(step.kind);
            // Far from the solution the steps are no linear iteration that could be extrapolated.
            if let Some(factor) = course.damping().filter(|_| !shifted) {
                acceleration = Acceleration::default();
                step.coefficients.iter_mut().for_each(|c| *c *= factor);
            } else if step.space == finest
                && (step.kind == StepKind::Local || (step.kind == StepKind::Adhesive && step.length < NEAR))
            {
                step.coefficients = acceleration.next(step.coefficients);
            } else {
                acceleration = Acceleration::default();
            }
            let reach = step.reach.min(REACH * scales.length);
            let advanced =
                |step: &Step| zone.transported(&self.membrane.grid, step.space, &step.coefficients, reach, transport);
            let mut advance = advanced(&step);
            if D > 1 && !self.adhering && !shifted {
                let sharpest = f64::max(WILD, SHARPENED * bend);
                // A short step that leaves as many zones and holes folds a tip.
                let folds = |zone: &Z| step.length < CLOSE && zone.counts() == self.solution.zone.counts();
                let shapeless = |advance: &Advance<Z>| match advance.topology_changed {
                    true => folds(&advance.zone),
                    false => advance.zone.bend() > sharpest,
                };
                for doublings in 0..MOST_SMOOTHINGS {
                    if !shapeless(&advance) {
                        break;
                    }
                    step.coefficients = fronts.smoothed(zone, &step, scales.h * f64::from(1u32 << doublings));
                    acceleration = Acceleration::default();
                    advance = advanced(&step);
                }
            }
            if advance.topology_changed || advance.zone.mode_offsets(finest) != zone.mode_offsets(finest) {
                acceleration = Acceleration::default();
            }
            if advance.topology_changed {
                // Another problem: what the residuals were before says nothing of it.
                changes += 1;
                course = Course::default();
            }
            let action = if advance.topology_changed { "topology changed" } else { step.kind.name() };
            let zone = if advance.topology_changed { self.resized(advance.zone) } else { advance.zone };
            self.report(residual, action);
            self.solution.equilibrium = Some(equilibrium);
            self.solution.zone = zone;
        }
        Ok(Fixed::Moving)
    }

    /// The zone without holes of a few cells in which a body pushes everywhere: there the membrane would lie below it, and
    /// Newton's method only halves such a hole in every step. None where there are no such holes.
    fn without_pressed_holes(&self, zone: &Z) -> Option<Z> {
        let membrane = self.membrane;
        if self.adhering || self.is_shifted() {
            return None;
        }
        zone.filled(&membrane.grid, &|side, outline, area| {
            let centre = outline.iter().sum::<Point<D>>() / outline.len() as f64;
            let size = membrane.cells.containing(&centre).map_or(0.0, |cell| membrane.cells.size(cell));
            let few = area < FEW * size.powi(D as i32);
            few && std::iter::once(&centre).chain(outline).all(|x| pushes(membrane, zone, side, x, size))
        })
    }

    fn report(&mut self, residual: f64, action: &str) {
        self.solution.residuals.push(residual);
        let (zones, holes) = self.solution.zone.counts();
        self.progress.iteration(&Iteration {
            step: self.at.0,
            time: self.at.1,
            iteration: self.solution.iterations,
            residual,
            action,
            figures: &[("zones", zones as f64), ("holes", holes as f64)],
        });
    }
}
