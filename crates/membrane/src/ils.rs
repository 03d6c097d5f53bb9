//! The inequality level-set method: a Newton iteration on the shape of the contact zone inside a sweep over the contact
//! conditions.

use crate::active_set::{self, NodalStart};
use crate::conditions::{Conditions, corrected};
use crate::equilibrium::{Elements, Equilibrium};
use crate::field::SharedField;
use crate::front::{Fronts, StepKind};
use crate::problem::Membrane;
use crate::scales::Scales;
use crate::zone::{ModeSpace, Zone};
use signorini_solve::{Acceleration, Iteration, Progress, SolveError};

/// Steps after which fronts that do not come to rest are given up.
const MOST_STEPS: usize = 40;
/// Corrections of the zone after which it is given up.
const MOST_SWEEPS: usize = 12;
/// Fronts whose residual has not fallen for so many steps ...
const PATIENCE: usize = 9;
/// ... after a third of which steps are damped ...
const DAMPED_AFTER: usize = 3;
/// ... and that move by less than this fraction of a cell have settled: as a front crosses a grid line the discrete
/// slope jump makes a jump of its own, of the size of the discretisation error, and no position makes it vanish.
const SETTLED: f64 = 1e-3;
/// A step of this fraction of a cell that does not improve on the last is round-off.
const ROUND_OFF: f64 = 1e-8;
/// A front moves at most this fraction of the membrane's extent in one step.
const REACH: f64 = 0.15;

/// How a solve ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The slope jump vanishes on all fronts and the contact conditions hold everywhere.
    Converged,
    /// The membrane does not reach the floor.
    NoContact,
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
pub struct Solution<'a, const D: usize, Z> {
    pub zone: Z,
    /// None only where even the first linear system could not be solved.
    pub equilibrium: Option<Equilibrium<'a, D>>,
    pub conditions: Option<Conditions<D>>,
    pub scales: Option<Scales>,
    pub reason: Reason,
    /// Equilibrium solves.
    pub iterations: usize,
    /// Residual of each iteration relative to its tolerance.
    pub residuals: Vec<f64>,
    /// Size of the largest linear system.
    pub unknowns: usize,
    /// Length of the last step relative to a cell, where the fronts settled on a jump of the discrete slope.
    pub settled_within: Option<f64>,
}

/// Where an increment starts from.
pub enum Start<Z> {
    /// The membrane without contact.
    Free,
    /// A zone from an earlier increment, with its scales.
    Zone(Z, Scales),
}

/// Solves one increment.
pub fn solve<'a, const D: usize, Z: Zone<D>>(
    membrane: &'a Membrane<D>,
    elements: &mut Elements<D>,
    start: Start<Z>,
    at: (usize, f64),
    progress: &mut dyn Progress,
) -> Solution<'a, D, Z> {
    let mut run = Run {
        solution: Solution {
            zone: Z::empty(&membrane.grid),
            equilibrium: None,
            conditions: None,
            scales: None,
            reason: Reason::IterationLimit,
            iterations: 0,
            residuals: Vec::new(),
            unknowns: 0,
            settled_within: None,
        },
        membrane,
        elements,
        at,
        progress,
    };
    if let Start::Zone(zone, scales) = start
        && !zone.is_empty()
    {
        run.solution.zone = zone;
        run.solution.scales = Some(scales);
    }
    let reason = run.sweep().unwrap_or_else(|error| Reason::LinearSolver(error.to_string()));
    run.solution.reason = reason;
    run.solution
}

struct Run<'a, 'b, const D: usize, Z> {
    membrane: &'a Membrane<D>,
    elements: &'b mut Elements<D>,
    at: (usize, f64),
    progress: &'b mut dyn Progress,
    solution: Solution<'a, D, Z>,
}

/// How the iteration on the fronts ended.
enum Fixed {
    AtRest,
    Moving,
    Interrupted,
}

impl<const D: usize, Z: Zone<D>> Run<'_, '_, D, Z> {
    /// Corrects the zone until the contact conditions hold everywhere.
    fn sweep(&mut self) -> Result<Reason, SolveError> {
        let Some(floor) = &self.membrane.floor else {
            self.settle_fronts()?;
            return Ok(Reason::NoContact);
        };
        let mut predicted = false;
        let mut sweeps = 0;
        loop {
            let settled = self.settle_fronts();
            if let Ok(Fixed::Interrupted) = settled {
                return Ok(Reason::Interrupted);
            }
            let astray = !matches!(settled, Ok(Fixed::AtRest)) || sweeps > MOST_SWEEPS;
            if astray && predicted {
                return settled.map(|_| Reason::IterationLimit);
            }
            if astray {
                (predicted, sweeps) = (true, 0);
                self.predict(floor)?;
                continue;
            }
            sweeps += 1;
            let solution = &mut self.solution;
            let (Some(equilibrium), Some(scales)) = (&solution.equilibrium, &solution.scales) else {
                return Ok(Reason::IterationLimit);
            };
            let conditions = Conditions::check(equilibrium, &solution.zone, floor, scales);
            if conditions.hold(scales) {
                solution.conditions = Some(conditions);
                return Ok(if solution.zone.is_empty() { Reason::NoContact } else { Reason::Converged });
            }
            let first = solution.zone.is_empty();
            let zone = corrected(equilibrium, &solution.zone, floor, &conditions, scales);
            let simple = zone.counts() == (1, 0) && conditions.least_pressure_below > 0.0;
            solution.conditions = Some(conditions);
            solution.zone = zone;
            if first && !simple && !predicted {
                predicted = true;
                self.predict(floor)?;
            }
        }
    }

    /// Replaces the zone by the prediction of the nodal method on linear elements, which is cheap, and cannot go astray
    /// however the zone is connected. Its front is true to a fraction of a cell.
    fn predict(&mut self, floor: &SharedField<D>) -> Result<(), SolveError> {
        let finer = if self.membrane.grid.degree() >= 3 { 2 } else { 1 };
        let nodal = self.membrane.on_grid(self.membrane.grid.cells().map(|n| n * finer), 1);
        let progress = &*self.progress;
        let solution = active_set::solve::<D, Z>(&nodal, floor, NodalStart::Nested, &|| progress.interrupted())?;
        let predictor = solution.predictor(&nodal, floor);
        self.solution.zone = Z::empty(&self.membrane.grid).united(&self.membrane.grid, &mut |x| predictor(x));
        self.report(0.0, "predicted");
        self.solution.residuals.pop();
        Ok(())
    }

    /// Newton's iteration on the shape of the zone.
    fn settle_fronts(&mut self) -> Result<Fixed, SolveError> {
        let mut acceleration = Acceleration::default();
        let (mut best, mut waited) = (f64::INFINITY, 0);
        self.solution.settled_within = None;
        for count in 1..=MOST_STEPS {
            let last = count == MOST_STEPS;
            if self.progress.interrupted() {
                return Ok(Fixed::Interrupted);
            }
            let zone = &self.solution.zone;
            let equilibrium = Equilibrium::solve(self.membrane, zone, self.elements)?;
            self.solution.iterations += 1;
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
            let fronts = Fronts::new(&equilibrium);
            let projection = fronts.project(zone, ModeSpace::Fine);
            let residual = projection.norm / scales.slope_tolerance();
            if residual <= 1.0 {
                self.report(residual, "at rest");
                self.solution.equilibrium = Some(equilibrium);
                return Ok(Fixed::AtRest);
            }
            let mut step = fronts.newton_step(zone, &scales)?;
            waited = if residual < 0.7 * best { 0 } else { waited + 1 };
            best = best.min(residual);
            let relative_step = step.length / self.membrane.grid.h();
            if waited >= 1 && relative_step < ROUND_OFF {
                self.report(residual, "at rest");
                self.solution.equilibrium = Some(equilibrium);
                return Ok(Fixed::AtRest);
            }
            if (waited >= PATIENCE || last) && relative_step < SETTLED {
                self.report(residual, "settled");
                self.solution.settled_within = Some(relative_step);
                self.solution.equilibrium = Some(equilibrium);
                return Ok(Fixed::AtRest);
            }
            // Far from the solution the steps are no linear iteration that could be extrapolated.
            if waited >= DAMPED_AFTER {
                // The derivative does not fit the discrete slope jump here: shorter steps find where it vanishes.
                acceleration = Acceleration::default();
                let factor = 0.5f64.powi((waited / DAMPED_AFTER) as i32).max(0.1);
                step.coefficients.iter_mut().for_each(|c| *c *= factor);
            } else if step.space == ModeSpace::Fine && step.kind == StepKind::Local {
                step.coefficients = acceleration.next(step.coefficients);
            } else {
                acceleration = Acceleration::default();
            }
            let reach = REACH * scales.length;
            let advance = zone.advanced(&self.membrane.grid, step.space, &step.coefficients, reach);
            if advance.topology_changed
                || advance.zone.mode_offsets(ModeSpace::Fine) != zone.mode_offsets(ModeSpace::Fine)
            {
                acceleration = Acceleration::default();
            }
            let action = if advance.topology_changed { "topology changed" } else { step.kind.name() };
            self.report(residual, action);
            self.solution.equilibrium = Some(equilibrium);
            self.solution.zone = advance.zone;
        }
        Ok(Fixed::Moving)
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
