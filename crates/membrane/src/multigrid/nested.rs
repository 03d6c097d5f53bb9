//! The whole contact problem by nested iteration: the fronts are found on a coarse grid by the direct solver, and every
//! finer grid gives them a few steps, each after a single cycle.
//!
//! What a cycle leaves of the algebraic error is of the size of the discretisation error, so is what the front is off; the
//! whole costs as much as a few cycles on the finest grid.

use super::{Ground, Level, OnGrid, OnMesh, Regular, cycle, levels, that_show};
use crate::conditions::Conditions;
use crate::equilibrium::elements::Elements;
use crate::front::{Fronts, StepKind};
use crate::ils;
use crate::plane_zone::PlaneZone;
use crate::problem::Membrane;
use crate::scales::Scales;
use crate::solution::{Reason, Solution, Start};
use crate::stopping::{SETTLED, SETTLED_COARSE, StoppingRule};
use crate::zone::{Zone, ZoneFronts, ZoneMotion, ZoneSizes};
use signorini_solve::{Acceleration, Iteration, Progress, SolveError};

/// Nodes along the longer side of the grid on which the fronts are found at first, and, where zones were missed there, on
/// which they are looked for again.
const FIRST: [usize; 3] = [32, 128, 512];
/// Steps of the fronts on each finer grid, those at degree 1 on grids between the first and the last, where what they leave
/// is less than what the grid does, and how many more where they have far to go.
const STEPS: usize = 2;
/// Cycles for each further step.
const CYCLES: usize = 2;
const STEPS_BETWEEN: usize = 1;
const MORE: usize = 6;
/// Fronts that move by more than this fraction of a cell get another step.
const FAR: f64 = 0.3;
/// Fronts that moved by less than this fraction of a cell at last leave the displacement as it is.
const NEAR: f64 = 0.01;

/// A membrane in contact on the finest of nested grids.
pub struct NestedSolution<R: Regular> {
    pub zone: PlaneZone,
    /// The finest level, with the displacement.
    pub level: Level<R>,
    /// Steps of the fronts on each grid, the coarsest first.
    pub steps: Vec<usize>,
    pub scales: Scales,
    /// Residuals on the finest grid, relative to their tolerance.
    pub residuals: Vec<f64>,
    /// Whether the last residual is small enough, or the fronts rest on a jump of the discrete slope; the last step then.
    pub settled: bool,
    pub settled_within: Option<f64>,
}

/// Cycles at the end at most, and the residual relative to the load at which there are no more.
const CLOSING: usize = 60;
const CLOSED: f64 = 1e-12;
/// Steps without progress after which fronts may rest on a jump of the discrete slope.
const PATIENCE: usize = 9;
/// Steps on the finest grid before fronts are given up that have to meet a tolerance.
const MOST: usize = 30;
/// Steps without progress after which they are given up at once.
const HOPELESS: usize = 12;

/// Whether a membrane can be solved for so: on a grid with coarser ones or on a mesh whose cells were divided, without
/// adhesion.
pub fn is_able<const D: usize>(membrane: &Membrane<D>) -> bool {
    D == 2 && !membrane.obstacles.are_sticky() && (OnGrid::is_able(membrane) || OnMesh::is_able(membrane))
}

/// A state that meets the tolerances of every other solver; none where the way to it is not this one: the fronts were not
/// found on the coarsest grid, did not come to rest, or are not all there are.
///
/// # Errors
/// Equations that cannot be solved.
pub fn solution(
    membrane: &Membrane<2>,
    at: (usize, f64),
    progress: &mut dyn Progress,
) -> Result<Option<Solution<2, PlaneZone>>, SolveError> {
    if !is_able(membrane) {
        return Ok(None);
    }
    let from = |first: usize, progress: &mut dyn Progress| match OnGrid::is_able(membrane) {
        true => solution_from::<OnGrid>(membrane, first, at, progress),
        false => solution_from::<OnMesh>(membrane, first, at, progress),
    };
    for first in FIRST {
        if let Some(solution) = from(first, progress)? {
            return Ok(Some(solution));
        }
        if progress.interrupted() || membrane.grid.node_counts().into_iter().all(|n| n / 4 <= first) {
            break;
        }
    }
    Ok(None)
}

/// The same from a first grid of so many nodes.
fn solution_from<R: Regular>(
    membrane: &Membrane<2>,
    first: usize,
    at: (usize, f64),
    progress: &mut dyn Progress,
) -> Result<Option<Solution<2, PlaneZone>>, SolveError> {
    let Ok(found) = solve::<R>(membrane, 1.0, first, at, progress)? else { return Ok(None) };
    if !found.settled {
        return Ok(None);
    }
    let zone = found.zone;
    let equilibrium = found.level.whole_state(membrane, &zone);
    let conditions = Conditions::check(&equilibrium, &zone, &found.scales, false);
    if !conditions.hold(&found.scales) {
        return Ok(None);
    }
    Ok(Some(Solution {
        unknowns: found.level.unknowns(),
        equilibrium: Some(equilibrium),
        conditions: Some(conditions),
        scales: Some(found.scales),
        reason: if zone.is_empty() { Reason::NoContact } else { Reason::Converged },
        iterations: found.steps.last().copied().unwrap_or(0),
        residuals: found.residuals,
        multigrid: true,
        settled_within: found.settled_within,
        ..Solution::begin(zone)
    }))
}

/// Solves a membrane for which [`is_able`] holds, from the first grid of more than so many nodes along a side. On the finest
/// grid the fronts step until their residual is below `tolerance` of what other solvers reach, at least twice: with an
/// infinite one their error is that of the discretisation.
///
/// # Errors
/// Equations that cannot be solved. The reason, where the fronts were not found on the coarsest grid.
pub fn solve<R: Regular>(
    membrane: &Membrane<2>,
    tolerance: f64,
    first: usize,
    at: (usize, f64),
    progress: &mut dyn Progress,
) -> Result<Result<NestedSolution<R>, Reason>, SolveError> {
    let grounds = R::grounds(membrane);
    let many = |ground: &Ground<R::Cells>| ground.grid.node_counts().into_iter().max().unwrap_or(0) > first;
    let first = grounds.iter().position(many).unwrap_or(0);
    let Some(coarse) = grounds.get(first) else { return Ok(Err(Reason::IterationLimit)) };
    let coarse = coarse.membrane(membrane);
    let rest = if first + 1 < grounds.len() { StoppingRule::BeforeRefinement } else { StoppingRule::Final };
    let found = ils::solve::<2, PlaneZone>(&coarse, &mut Elements::new(&coarse), Start::Free, rest, at, progress);
    let (true, Some(scales), Some(state)) = (found.reason.converged(), found.scales, &found.equilibrium) else {
        return Ok(Err(found.reason));
    };
    let finest_modes = membrane.modes.finest();
    let mut zone = found.zone.clone();
    let mut levels = levels(membrane, &zone, that_show(&grounds[..=first], &zone))?;
    if let Some(level) = levels.last_mut() {
        level.take(state);
    }
    let mut steps = vec![found.iterations];
    let mut residuals = Vec::new();
    let mut settled = true;
    let mut settled_within = None;
    for ground in &grounds[first + 1..] {
        let (grid, here) = (&ground.grid, ground.membrane(membrane));
        let h = grid.h();
        let scales = scales.on(&here);
        zone = zone.on_grid(grid);
        let mut level = Level::new(&here, ground, &zone, false)?;
        if let Some(coarse) = levels.last() {
            level.interpolate(coarse);
        }
        levels.push(level);
        if zone.is_empty() {
            steps.push(0);
            continue;
        }
        let finest = ground.is_of(membrane);
        let mut count = 0;
        let mut wanted = if finest || grid.degree() > 1 { STEPS } else { STEPS_BETWEEN };
        let (mut best, mut waited) = (f64::INFINITY, 0);
        let mut acceleration = Acceleration::default();
        residuals.clear();
        while count < wanted {
            // Fronts that are brought to rest need a displacement that is not behind them.
            for _ in 0..if count < STEPS { 1 } else { CYCLES } {
                cycle(&mut levels)?;
            }
            count += 1;
            let Some(level) = levels.last_mut() else { break };
            let state = level.state();
            let fronts = Fronts::new(state, false);
            let residual = fronts.residual(&zone, finest_modes) / scales.slope_tolerance();
            residuals.push(residual);
            waited = if residual < 0.7 * best { 0 } else { waited + 1 };
            best = best.min(residual);
            let (zones, holes) = zone.counts();
            progress.iteration(&Iteration {
                step: at.0,
                time: at.1,
                iteration: count,
                residual,
                action: "multigrid step",
                figures: &[("cells", grid.cells()[0] as f64), ("zones", zones as f64), ("holes", holes as f64)],
            });
            if progress.interrupted() {
                return Ok(Err(Reason::Interrupted));
            }
            let mut step = fronts.newton_step(&zone, &scales)?;
            let last_step = step.length;
            // As everywhere: on a jump of the discrete slope no position makes it vanish.
            let enough = || {
                let seen = fronts.project(&zone, finest_modes);
                if seen.norm < seen.remainder { SETTLED_COARSE } else { SETTLED }
            };
            let on_jump = waited >= PATIENCE && last_step < enough();
            settled = residual <= tolerance || on_jump;
            if finest && settled && count >= STEPS && tolerance.is_finite() {
                settled_within = (residual > tolerance).then_some(last_step);
                break;
            }
            if finest && !settled && count >= wanted && wanted < MOST && waited < HOPELESS {
                wanted += 1;
            }
            if last_step > FAR && wanted < STEPS + MORE {
                wanted += 1;
            }
            // As everywhere: cells of degree 1 have a slope jump of their own, which the derivative does not know.
            if tolerance.is_finite() && step.kind == StepKind::Local && step.space == finest_modes {
                step.coefficients = acceleration.next(step.coefficients);
            }
            let advance = zone.advanced(grid, step.space, &step.coefficients, h);
            if advance.topology_changed || advance.zone.mode_offsets(step.space) != zone.mode_offsets(step.space) {
                acceleration = Acceleration::default();
            }
            zone = advance.zone;
            if count == wanted && (!finest || last_step < NEAR) {
                // The displacement changes with the square of the step, for fronts rest where it is in contact without a
                // slope; and what a finer grid is interpolated from may have the fronts of a moment ago.
                break;
            }
            level.moved(&here, &zone)?;
        }
        steps.push(count);
    }
    // The displacement itself to round-off: forces then balance as after a factorisation.
    for _ in 0..if tolerance.is_finite() { CLOSING } else { 1 } {
        cycle(&mut levels)?;
        if let Some(level) = levels.last_mut()
            && level.relative_residual() < CLOSED
        {
            break;
        }
    }
    let Some(level) = levels.pop() else { return Ok(Err(Reason::IterationLimit)) };
    Ok(Ok(NestedSolution { zone, level, steps, scales: scales.on(membrane), residuals, settled, settled_within }))
}
