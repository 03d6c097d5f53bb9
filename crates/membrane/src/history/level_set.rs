//! One increment by either method, and what looks wrong in it.

use super::engine::Engine;
use super::increment::{Increment, Sample, Sampler, Stability};
use super::nodal;
use super::remark::{Remark, RemarkKind};
use super::statement::{MethodChoice, Statement};
use crate::adhesion::Branch;
use crate::equilibrium::elements::Elements;
use crate::error_estimate::ErrorEstimate;
use crate::ils;
use crate::method::Transport;
use crate::multigrid::large::ByMultigrid;
use crate::problem::Membrane;
use crate::report::Report;
use crate::solution::{Reason, Solution, Start};
use crate::zone::contact_of;
use signorini_geometry::Point;
use signorini_solve::Progress;

/// Curvature times cell size beyond which a front is not resolved.
const RESOLVED: f64 = 0.5;

/// Unknowns up to which errors are estimated, by a factorisation for functions of one degree more.
const MOST_ESTIMATED: usize = 100_000;

/// Slope up to which a membrane is linear.
pub const LINEAR: f64 = 0.1;

impl<const D: usize, Z: ByMultigrid<D> + 'static> Engine<D, Z> {
    /// Solves the increment that ends at a time; its number is for the progress.
    pub fn solve(
        &mut self,
        statement: &dyn Statement<D>,
        membrane: &Membrane<D>,
        at: (usize, f64),
        progress: &mut dyn Progress,
    ) -> Increment<D> {
        match statement.method() {
            MethodChoice::InequalityLevelSet { .. } => self.level_set(statement, membrane, at, progress),
            MethodChoice::ActiveSet(start) => nodal::increment::<D, Z>(membrane, start, at, progress),
        }
    }

    fn level_set(
        &mut self,
        statement: &dyn Statement<D>,
        membrane: &Membrane<D>,
        at: (usize, f64),
        progress: &mut dyn Progress,
    ) -> Increment<D> {
        let nearby = match (&self.asked, &self.previous) {
            (Some(_), _) => true,
            (None, previous) => matches!(previous, Some((_, _, Branch::Nearest))),
        };
        let large = statement.by_multigrid(membrane) && !nearby;
        let (mut solves, mut other) = (0, None);
        let start = match (self.asked.take(), self.previous.take()) {
            (Some(zone), _) => Start::Asked(zone, Branch::Nearest),
            (None, Some((zone, scales, branch))) => {
                let mut ahead = None;
                if let Some(predicted) = self.ahead(statement, membrane, at.1) {
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
            None => match if large && !progress.interrupted() { statement.lacks_memory() } else { None } {
                Some(message) => {
                    Solution { reason: Reason::LinearSolver(message), ..Solution::begin(Z::empty(&membrane.grid)) }
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
                self.remember(statement, at.1, &solution.zone);
            }
        }
        let mut remarks = Vec::new();
        let mut warn = |kind, message: String| remarks.push(Remark::new(kind, message).at_time(at.1));
        let steepest = report.as_ref().map_or(0.0, |r| r.max_slope);
        if self.has_units && steepest > LINEAR {
            warn(
                RemarkKind::SteepSlopes,
                format!(
                    "slopes reach {steepest:.1}: the linear theory of the membrane is valid below about {LINEAR}, \
                     beyond it the tension increases"
                ),
            );
        }
        let sharp = solution.zone.bend();
        if D == 2 && !solution.zone.is_empty() && sharp > RESOLVED {
            warn(
                RemarkKind::SharpFront,
                format!(
                    "a front has a radius of curvature of {:.2} cells at t = {}: below two cells its shape is \
                     approximate; use more cells",
                    1.0 / sharp,
                    at.1
                ),
            );
        }
        if solution.unrefined {
            warn(
                RemarkKind::NotRefined,
                format!("no state was found on smaller cells at t = {}: the state on larger cells is reported", at.1),
            );
        }
        if let Some(fewest) = solution.zone.fewer_modes(membrane.modes) {
            warn(
                RemarkKind::FewerModes,
                format!(
                    "a front has {fewest} modes at t = {}, fewer than `mode_count`: its cells do not resolve more",
                    at.1
                ),
            );
        }
        let on_nodes = membrane.formulation.transport() != Transport::Exact;
        if let Some(step) = solution.settled_within {
            let why = if on_nodes {
                "since a level set on nodes shifts them in every step; use `transport = \"exact\"`"
            } else if step < 1e-3 {
                "on a jump of the discrete slope"
            } else {
                "where they are sharper than the grid; zones, areas and forces have this accuracy"
            };
            warn(
                RemarkKind::FrontsAtRest,
                format!("the fronts converged to {step:.0e} of a cell at t = {}, {why}", at.1),
            );
        }
        if let Some(depth) = solution.unresolved {
            warn(
                RemarkKind::NotResolved,
                format!(
                    "the grid does not resolve whether zones merge at t = {}: the membrane penetrates the body \
                     between them by {depth:.0e}",
                    at.1
                ),
            );
        }
        if let Reason::LinearSolver(message) = &solution.reason {
            warn(RemarkKind::LinearSolver, message.clone());
        }
        let reason = solution.reason.clone();
        if let Some(kink) = solution.conditions.as_ref().and_then(|c| c.kink).filter(|_| estimated) {
            let place: Vec<String> = kink.place.iter().map(|v| format!("{v:.4}")).collect();
            let message = format!(
                "the surface has a kink within the contact zone, near ({}): the pressure along it is a line force, \
                 which is included neither in the results nor in the error estimate; round the kink over a few cells",
                place.join(", ")
            );
            remarks.insert(0, Remark::new(RemarkKind::Kink, message).at_time(at.1).at(kink.place.as_slice()));
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
        let membrane = membrane.clone();
        let sample: Option<Sampler<D>> = solution.equilibrium.map(|equilibrium| {
            let zone = solution.zone;
            Box::new(move |x: &Point<D>| {
                let displacement = equilibrium.displacement(&zone, x)?;
                let touched = contact_of(zone.region_at(x));
                let pressure = touched.map_or(0.0, |(side, _)| membrane.pressure(side, x));
                Some(Sample { displacement, in_contact: touched.is_some(), pressure })
            }) as Sampler<D>
        });
        Increment {
            converged,
            reason,
            iterations,
            before,
            residuals,
            unknowns,
            solver: if solution.multigrid { "multigrid" } else { "direct" },
            remarks,
            report,
            outlines,
            sample,
            stability,
            resolved,
            errors,
        }
    }
}
