//! Cells divided where the fronts need it: where they curve within a cell or come near each other.

use crate::adhesion::Branch;
use crate::domain::DomainOnCells;
use crate::equilibrium::{Elements, Equilibrium};
use crate::front::Fronts;
use crate::ils::{self, Reason, Rest, Solution, Start};
use crate::problem::Membrane;
use crate::published::Formulation;
use crate::scales::Scales;
use crate::zone::Zone;
use signorini_fem::Grid;
use signorini_geometry::Aabb;
use signorini_solve::Progress;
use std::sync::Arc;

/// A length of the fronts is resolved by so many cells.
const RESOLVED: f64 = 2.0;
/// Fronts that have to move less than this part of an undivided cell are near.
const NEAR: f64 = 0.2;
/// Solves on new cells within one increment.
const MOST_ROUNDS: usize = 6;

/// Where cells are divided.
#[derive(Clone)]
pub struct Refinement<const D: usize> {
    /// How often cells at fronts are divided, whatever these look like.
    pub fronts: usize,
    /// How often they are divided at most.
    pub most: usize,
    /// Whether a cell is divided wherever the fronts are, from its box and how often it was divided.
    pub always: Arc<dyn Fn(&Aabb<D>, usize) -> bool + Send + Sync>,
}

impl<const D: usize> Default for Refinement<D> {
    fn default() -> Self {
        Self { fronts: 0, most: 0, always: Arc::new(|_, _| false) }
    }
}

impl<const D: usize> Refinement<D> {
    /// How often the cells at the fronts of a zone are to be divided.
    fn levels<Z: Zone<D>>(&self, membrane: &Membrane<D>, zone: &Z) -> usize {
        let Some(coarse) = membrane.cells.divisible().filter(|_| D == 2 && self.most > 0 && !zone.is_empty()) else {
            return 0;
        };
        let cells = RESOLVED * coarse.h() / zone.least_feature();
        let wanted = cells.log2().ceil().clamp(0.0, self.most as f64) as usize;
        wanted.max(self.fronts).min(self.most)
    }

    /// The membrane on cells divided near the fronts of a zone.
    fn divided<Z: Zone<D>>(&self, membrane: &Membrane<D>, zone: &Z, levels: usize) -> Option<Membrane<D>> {
        let coarse = membrane.cells.divisible()?;
        let cells = zone.divided(coarse, levels, &*self.always)?;
        let grid = Grid::new(*coarse.bounds(), coarse.cells().map(|n| n << levels), coarse.degree());
        let domain = DomainOnCells::new(membrane.domain.domain.clone(), &*cells);
        Some(Membrane { cells, grid, domain, ..membrane.clone() })
    }

    /// The zone on cells of twice the size, if these resolve it, and the solves that it took: fronts that have far to go
    /// need few steps from there, however small the cells are. Not with adhesion, which may jump elsewhere on other cells.
    pub fn approached<Z: Zone<D>>(
        &self,
        membrane: &Membrane<D>,
        zone: &Z,
        scales: &Scales,
        at: (usize, f64),
        progress: &mut dyn Progress,
    ) -> Option<(Z, usize)> {
        if D != 2 || membrane.obstacles.are_sticky() || membrane.formulation != Formulation::OneSided {
            return None;
        }
        let degree = membrane.cells.degree();
        let mut cells = membrane.cells.coarser()?;
        while cells.degree() < degree {
            cells = cells.raised()?;
        }
        let grid = Grid::new(*membrane.grid.bounds(), membrane.grid.cells().map(|n| n.div_ceil(2)), degree);
        let coarse = Membrane { grid, ..membrane.on(cells) };
        if zone.is_empty() || coarse.grid.h() > zone.least_feature() {
            return None;
        }
        let start = Start::Zone(zone.clone(), scales.on(&coarse), Branch::Stable);
        let found = ils::solve(&coarse, &mut Elements::new(&coarse), start, Rest::BeforeRefinement, at, progress);
        found.reason.converged().then_some((found.zone, found.iterations))
    }

    /// Solves an increment, on cells divided as often as `levels` says at first, and more often where the fronts need
    /// it; `levels` is then what they need.
    pub fn solve<Z: Zone<D>>(
        &self,
        membrane: &Membrane<D>,
        levels: &mut usize,
        start: Start<Z>,
        at: (usize, f64),
        progress: &mut dyn Progress,
    ) -> Solution<D, Z> {
        let (mut used, mut looks) = (0, 0);
        let divided = match &start {
            Start::Zone(zone, scales, _) if *levels > 0 && !zone.is_empty() => {
                looks = 1;
                if is_near(membrane, zone, scales) {
                    used = *levels;
                    self.divided(membrane, zone, used)
                } else {
                    None
                }
            }
            _ => None,
        };
        let whole = divided.as_ref().unwrap_or(membrane);
        let start = match start {
            Start::Zone(zone, scales, branch) => Start::Zone(zone, scales.on(whole), branch),
            other => other,
        };
        let branch = match &start {
            Start::Zone(_, _, branch) | Start::Asked(_, branch) => *branch,
            Start::Free => Branch::Stable,
        };
        let last = whole.cells.divisible().is_none() || D != 2 || used >= self.most;
        let rest = if last { Rest::Final } else { Rest::BeforeDivision };
        let mut best = ils::solve(whole, &mut Elements::new(whole), start, rest, at, progress);
        best.before = looks;
        // Fronts that were left to smaller cells, which may turn out not to be wanted.
        let mut unfinished = rest == Rest::BeforeDivision;
        for _ in 0..MOST_ROUNDS {
            let (Some(scales), false) = (best.scales, best.zone.is_empty()) else { break };
            let astray = best.reason == Reason::IterationLimit;
            // Fronts that went astray are a worse start than those that were predicted.
            let zone = best.predicted.take().filter(|_| astray).unwrap_or_else(|| best.zone.clone());
            let wanted = match (best.reason.clone(), best.unresolved) {
                (Reason::Interrupted | Reason::NoSuchState | Reason::LinearSolver(_), _) => break,
                (Reason::IterationLimit, _) => (used + 1).max(self.levels(membrane, &zone)),
                (_, Some(_)) => self.most,
                _ => self.levels(membrane, &zone),
            };
            let wanted = wanted.min(self.most);
            if wanted < used || (wanted == used && !strayed(&best)) {
                *levels = wanted;
                if unfinished && best.out_of_steps {
                    let start = Start::Zone(zone, scales, branch);
                    let next = ils::solve(whole, &mut Elements::new(whole), start, Rest::Final, at, progress);
                    return continued(best, next);
                }
                return best;
            }
            if astray && wanted == used {
                break;
            }
            let mut about = |zone: Z| {
                let finer = self.divided(membrane, &zone, wanted)?;
                let start = Start::Zone(zone, scales.on(&finer), branch);
                Some(ils::solve(&finer, &mut Elements::new(&finer), start, Rest::Final, at, progress))
            };
            let counts = zone.counts();
            let Some(mut next) = about(zone) else { break };
            (used, unfinished) = (wanted, false);
            next.before = best.before + best.iterations;
            let lost = |next: &Solution<D, Z>| {
                best.reason.converged() && !next.reason.converged() && next.reason != Reason::Interrupted
            };
            if lost(&next)
                && let Some(other) = next.predicted.take().filter(|other| other.counts() != counts)
                && let Some(again) = about(other)
            {
                // Cells were divided about fronts that are not there any more.
                next = Solution { before: next.before + next.iterations, ..again };
            }
            next.jumped |= best.jumped;
            if lost(&next) {
                // What was found on coarser cells is an answer all the same.
                best.before = next.before + next.iterations - best.iterations;
                best.unrefined = true;
                break;
            }
            best.residuals.append(&mut next.residuals);
            next.residuals = std::mem::take(&mut best.residuals);
            best = next;
        }
        *levels = used;
        best
    }
}

/// A solution and what came of going on from it on the same cells.
fn continued<const D: usize, Z: Zone<D>>(mut first: Solution<D, Z>, mut next: Solution<D, Z>) -> Solution<D, Z> {
    if next.reason != Reason::Interrupted && !next.reason.converged() {
        first.before += next.iterations;
        return first;
    }
    next.before = first.before;
    next.iterations += first.iterations;
    next.jumped |= first.jumped;
    first.residuals.append(&mut next.residuals);
    next.residuals = first.residuals;
    next
}

/// Whether the fronts have not so far to go that the way is cheaper on undivided cells.
fn is_near<const D: usize, Z: Zone<D>>(membrane: &Membrane<D>, zone: &Z, scales: &Scales) -> bool {
    let zone = zone.on_grid(&membrane.grid);
    let state = Equilibrium::solve(membrane, &zone, &mut Elements::new(membrane));
    state.is_ok_and(|state| Fronts::new(&state, true).farthest(scales) < NEAR * membrane.grid.h())
}

/// Whether fronts have left the cells that were divided for them.
fn strayed<const D: usize, Z: Zone<D>>(solution: &Solution<D, Z>) -> bool {
    let Some(equilibrium) = &solution.equilibrium else { return false };
    let membrane = &equilibrium.membrane;
    let fine = 1.5 * membrane.grid.h();
    membrane.cells.divisible().is_some()
        && equilibrium.quadrature.front.iter().any(|p| membrane.cells.size(p.cell) > fine)
}

impl Scales {
    /// The same scales for other cells.
    pub fn on<const D: usize>(self, membrane: &Membrane<D>) -> Self {
        Self { h: membrane.grid.h(), degree: membrane.grid.degree(), ..self }
    }
}
