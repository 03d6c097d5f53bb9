//! The inequality level-set method: a Newton iteration on the shape of the contact zone inside a sweep over the contact
//! conditions.

mod newton;

use crate::adhesion::Branch;
use crate::conditions::{Conditions, corrected, least_free_gap};
use crate::deferred::Known;
use crate::equilibrium::Equilibrium;
use crate::equilibrium::elements::Elements;
use crate::method::Transport;
use crate::prediction::{FREE, prediction};
use crate::problem::Membrane;
pub use crate::solution::{Reason, Solution, Start};
pub use crate::stopping::StoppingRule;
use crate::stopping::{SETTLED, SHARP};
use crate::zone::Zone;
use signorini_solve::{Iteration, Progress, SolveError};

/// The solution next to a start that is one but for round-off, on the cells of the membrane as they are; no state where it
/// penetrates a body.
pub fn solve_here<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    start: Start<Z>,
    at: (usize, f64),
    progress: &mut dyn Progress,
) -> Solution<D, Z> {
    solve(membrane, &mut Elements::new(membrane), start.on(membrane), StoppingRule::Uncorrected, at, progress)
}

/// Solves one increment.
pub fn solve<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    elements: &mut Elements<D>,
    start: Start<Z>,
    rest: StoppingRule,
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
    rest: StoppingRule,
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
    rest: StoppingRule,
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

struct Run<'a, 'b, const D: usize, Z> {
    membrane: &'a Membrane<D>,
    elements: &'b mut Elements<D>,
    rest: StoppingRule,
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
            self.solve_front_equation()?;
            return Ok(Reason::NoContact);
        }
        match start {
            Start::Zone(zone, scales, branch) if !zone.is_empty() => {
                self.solution.zone =
                    if self.rest == StoppingRule::Uncorrected { zone } else { zone.on_cells(self.membrane) };
                self.solution.scales = Some(scales);
                self.branch = branch;
            }
            Start::Free | Start::Zone(..) => {}
            Start::Asked(zone, branch) => {
                // Without contact, for the scales.
                self.solve_front_equation()?;
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
        if let Fixed::Interrupted = self.solve_front_equation()? {
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
            let settled = self.solve_front_equation();
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
            if (self.rest == StoppingRule::BeforeMoreDivision && self.solution.unfinished)
                || (self.rest == StoppingRule::BeforeDivision && tips)
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
            if self.rest == StoppingRule::Uncorrected {
                let nearly = conditions.nearly_hold_about(&solution.zone, scales, self.membrane);
                solution.unresolved = nearly.then_some(-conditions.least_gap_outside);
                solution.conditions = Some(conditions);
                return Ok(if nearly { Reason::Converged } else { Reason::NoSuchState });
            }
            // Corrected and settled again it would come back to itself: the grid cannot tell whether zones touch.
            let state = (solution.zone.counts(), conditions.least_gap_outside);
            let left = self.rest == StoppingRule::BeforeDivision && !self.adhering;
            let again = |(counts, gap): &((usize, usize), f64)| {
                *counts == state.0 && ((left && !first) || (gap / state.1 - 1.0).abs() < 0.1)
            };
            if seen.iter().any(again) {
                if (left && !first) || conditions.nearly_hold(scales, self.membrane) {
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
