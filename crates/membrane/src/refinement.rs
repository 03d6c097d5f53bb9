//! Cells divided where the fronts need it: where they curve within a cell or come near each other.

use crate::adhesion::Branch;
use crate::conditions::Conditions;
use crate::deferred::Known;
use crate::domain::DomainOnCells;
use crate::equilibrium::Equilibrium;
use crate::equilibrium::elements::Elements;
use crate::front::Fronts;
use crate::ils;
use crate::method::Formulation;
use crate::prediction::prediction;
use crate::problem::Membrane;
use crate::scales::Scales;
use crate::sizing::Sizing;
use crate::solution::{Reason, Solution, Start};
use crate::stopping::{SETTLED_COARSE, StoppingRule};
use crate::zone::Zone;
use signorini_fem::Grid;
use signorini_geometry::{Aabb, Point};
use signorini_solve::Progress;
use std::sync::Arc;

/// Cells may be so much larger than fronts that have moved within them want.
const HARDLY: f64 = 1.5;
/// Fronts that have to move by less than this part of a divided cell are near.
const NEAR: f64 = 0.5;
/// Fronts that were predicted by two polynomials which differ by less than this are as near.
const SURE: f64 = 1.0;
/// Divisions more than fronts want of their cells, where no state is found on those.
const MOST_FINER: usize = 2;
/// Divisions from one solve to the next ...
const AT_ONCE: usize = 2;
/// ... of cells of degree 1, on which fronts wander off that were not brought to rest.
const AT_ONCE_LINEAR: usize = 3;
/// Predictions on cells divided so often.
const MOST_LOOKS: usize = 6;
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
    /// The sizes that the fronts of a zone want of the cells, which are divided `finer` times more often than would do; none
    /// where they need not be divided.
    fn sizing<Z: Zone<D>>(&self, membrane: &Membrane<D>, zone: &Z, finer: usize) -> Option<Sizing<D>> {
        if D != 2 || self.most == 0 || zone.is_empty() {
            return None;
        }
        zone.sizing(&membrane.grid, [(self.fronts + finer).min(self.most), self.most], finer)
    }

    /// The membrane on cells of such sizes near the fronts of a zone.
    fn divided<Z: Zone<D>>(&self, membrane: &Membrane<D>, zone: &Z, sizing: Sizing<D>) -> Option<Membrane<D>> {
        let coarse = &membrane.grid;
        let cells = zone.divided(&membrane.cells, &sizing, self.most, &*self.always)?;
        let finer = 1 << (0..cells.count()).map(|cell| cells.divisions(cell)).max().unwrap_or(0);
        let grid = Grid::new(*coarse.bounds(), coarse.cells().map(|n| n * finer), coarse.degree());
        let domain = DomainOnCells::new(membrane.domain.domain.clone(), &*cells);
        Some(Membrane { cells, grid, domain, sizing: Some(Arc::new(sizing)), ..membrane.clone() })
    }

    /// The membrane on cells that are divided as the fronts of a zone want it.
    pub fn about<Z: Zone<D>>(&self, membrane: &Membrane<D>, zone: &Z) -> Membrane<D> {
        let divided = self.sizing(membrane, zone, 0).and_then(|sizing| self.divided(membrane, zone, sizing));
        divided.unwrap_or_else(|| membrane.clone())
    }

    /// Whether cells of the membrane are hardly larger than the fronts of a zone want them.
    pub fn resolves<Z: Zone<D>>(&self, membrane: &Membrane<D>, cells: &Membrane<D>, zone: &Z) -> bool {
        self.sizing(membrane, zone, 0).is_none_or(|sizing| resolves(cells, zone, &sizing))
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
        let found =
            ils::solve(&coarse, &mut Elements::new(&coarse), start, StoppingRule::BeforeRefinement, at, progress);
        found.reason.converged().then_some((found.zone, found.iterations))
    }

    /// The zone by the nodal method, on cells that are divided about it as the fronts need it.
    fn predicted<Z: Zone<D>>(
        &self,
        membrane: &Membrane<D>,
        zone: &Z,
        known: Option<&Known<'_, D, Z>>,
        interrupted: &dyn Fn() -> bool,
    ) -> Option<Z> {
        let mut zone = zone.clone();
        let mut cells: Option<Membrane<D>> = None;
        for most in 1..=self.most {
            let step = Self { most, ..self.clone() };
            for _ in 0..MOST_LOOKS {
                let Some(sizing) = step.sizing(membrane, &zone, 0) else { return Some(zone) };
                if cells.as_ref().is_some_and(|cells| resolves(cells, &zone, &sizing)) {
                    break;
                }
                let divided = step.divided(membrane, &zone, sizing)?;
                zone = prediction(&divided, known, interrupted).ok()?;
                cells = Some(divided);
            }
        }
        Some(zone)
    }

    /// Solves an increment: on cells divided for the zone that it starts from if the fronts have not far to go from there,
    /// else on cells that are not, and then on cells divided as the fronts need it. They have not far to go where another
    /// prediction is near the one that they start from, or where a state on undivided cells says so. With adhesion divided
    /// cells are tried wherever the fronts are, as all of the derivative, by which they go then, is not worth its name on cells
    /// that are too large; but a jump is believed only if the others see it too.
    pub fn solve<Z: Zone<D>>(
        &self,
        membrane: &Membrane<D>,
        elements: &mut Elements<D>,
        start: Start<Z>,
        other: Option<&Z>,
        at: (usize, f64),
        progress: &mut dyn Progress,
    ) -> Solution<D, Z> {
        let (mut cells, mut looked, mut before) = (None, None, 0);
        if let Start::Zone(zone, scales, _) = &start
            && let Some(sizing) = self.sizing(membrane, zone, 0)
        {
            let apart = other.and_then(|other| zone.farthest_from(other, &|x| sizing.at(x)));
            if (membrane.obstacles.are_sticky() || apart.is_some_and(|apart| apart < SURE))
                && let Some(divided) = self.divided(membrane, zone, sizing.clone())
            {
                let of_divided = &mut Elements::new(&divided);
                let found = self.solve_on((divided, of_divided), membrane, start.clone(), None, at, progress);
                if found.reason == Reason::Interrupted || (found.reason.converged() && !found.jumped) {
                    return found;
                }
                before = found.before + found.iterations;
            } else {
                let coarse = zone.on_grid(&membrane.grid);
                let state = Equilibrium::solve(membrane, &coarse, elements).ok();
                let way = |state| Fronts::new(state, true).farthest(&coarse, scales, |x| sizing.at(x));
                if state.as_ref().is_some_and(|state| way(state) < NEAR) {
                    before += 1;
                    cells = self.divided(membrane, zone, sizing);
                } else {
                    // It is the first one on undivided cells.
                    looked = state;
                }
            }
        }
        let mut found = match cells {
            Some(cells) => {
                let of_divided = &mut Elements::new(&cells);
                self.solve_on((cells, of_divided), membrane, start, None, at, progress)
            }
            None => self.solve_on((membrane.clone(), elements), membrane, start, looked, at, progress),
        };
        found.before += before;
        found
    }

    /// Solves an increment on some cells first, on which the state around its start may be known.
    fn solve_on<Z: Zone<D>>(
        &self,
        (cells, elements): (Membrane<D>, &mut Elements<D>),
        membrane: &Membrane<D>,
        start: Start<Z>,
        known: Option<Equilibrium<D>>,
        at: (usize, f64),
        progress: &mut dyn Progress,
    ) -> Solution<D, Z> {
        let start = start.on(&cells);
        let branch = match &start {
            Start::Zone(_, _, branch) | Start::Asked(_, branch) => *branch,
            Start::Free => Branch::Stable,
        };
        let last = cells.sizing.is_some() || D != 2 || self.most == 0;
        let rest = if last { StoppingRule::Final } else { StoppingRule::BeforeDivision };
        let found = ils::solve_from(&cells, elements, start, known, rest, at, progress);
        let mut search =
            Search { refinement: self, membrane, branch, at, progress, cells, found, finer: 0, predicted: false };
        (0..MOST_ROUNDS).take_while(|_| search.goes_on().is_some()).count();
        search.finished()
    }
}

/// The search for cells that resolve the fronts of an increment.
struct Search<'a, const D: usize, Z> {
    refinement: &'a Refinement<D>,
    /// On cells that are not divided.
    membrane: &'a Membrane<D>,
    branch: Branch,
    at: (usize, f64),
    progress: &'a mut dyn Progress,
    /// What was found last, and the membrane on the cells that it was found on.
    found: Solution<D, Z>,
    cells: Membrane<D>,
    /// Divisions more than the fronts want.
    finer: usize,
    /// Whether the nodal method has told where the fronts are.
    predicted: bool,
}

impl<const D: usize, Z: Zone<D>> Search<'_, D, Z> {
    /// Goes on to smaller cells; none where they are small enough, or there are no smaller ones.
    fn goes_on(&mut self) -> Option<()> {
        let scales = self.found.scales.filter(|_| !self.found.zone.is_empty())?;
        let too_large = match self.found.reason {
            Reason::Interrupted | Reason::NoSuchState => return None,
            // Fronts that fold within a cell leave no equations to solve; without a prediction nothing ever did.
            Reason::LinearSolver(_) if self.found.predicted.is_none() => return None,
            Reason::IterationLimit | Reason::LinearSolver(_) => true,
            Reason::Converged | Reason::NoContact => self.found.unresolved.is_some(),
        };
        if too_large && self.cells.sizing.is_some() {
            self.finer += 1;
        }
        if self.finer > MOST_FINER || (!too_large && self.resolves()) {
            return None;
        }
        let (counts, predicted) = (self.found.zone.counts(), self.predicted);
        let (zone, most) = self.best_known();
        let step = Refinement { most, ..self.refinement.clone() };
        let more = || step.sizing(self.membrane, &zone, 1).filter(|_| too_large);
        let sizing = step.sizing(self.membrane, &zone, self.finer).or_else(more)?;
        let first = self.cells.sizing.is_none() || most < self.refinement.most;
        let rest = if first { StoppingRule::BeforeMoreDivision } else { StoppingRule::Final };
        let (mut cells, mut next) = self.about(&step, zone, sizing, scales, rest)?;
        next.before = self.found.before + self.found.iterations;
        if self.is_lost(&next)
            && let Some(other) = next.predicted.take().filter(|other| other.counts() != counts)
            && let Some(sizing) = step.sizing(self.membrane, &other, self.finer)
            && let Some((others, again)) = self.about(&step, other, sizing, scales, rest)
        {
            // Cells were divided about fronts that are not there any more.
            next = Solution { before: next.before + next.iterations, ..again };
            cells = others;
        }
        next.jumped |= self.found.jumped;
        if self.is_lost(&next) && self.predicted && !predicted {
            // What was predicted is no start; what was found is, for cells that are not so much smaller.
            self.found.before = next.before + next.iterations - self.found.iterations;
            return Some(());
        }
        if self.is_lost(&next) {
            // What was found on larger cells is an answer all the same.
            self.found.before = next.before + next.iterations - self.found.iterations;
            self.found.unrefined = true;
            return None;
        }
        self.found.residuals.append(&mut next.residuals);
        next.residuals = std::mem::take(&mut self.found.residuals);
        (self.found, self.cells) = (next, cells);
        Some(())
    }

    /// Whether the cells are hardly larger than the fronts that were found want them.
    fn resolves(&self) -> bool {
        let sizing = self.refinement.sizing(self.membrane, &self.found.zone, self.finer);
        sizing.is_none_or(|sizing| resolves(&self.cells, &self.found.zone, &sizing))
    }

    /// Where to go on from, and how often cells are divided then at most.
    fn best_known(&mut self) -> (Z, usize) {
        let astray = !self.found.reason.converged();
        let zone = self.found.predicted.take().filter(|_| astray).unwrap_or_else(|| self.found.zone.clone());
        // Fronts that lie some cells off come to rest soon; those that lie many off do not.
        let reached = (self.membrane.grid.h() / self.cells.grid.h()).log2().round() as usize;
        let at_once = if self.membrane.cells.degree() == 1 { AT_ONCE_LINEAR } else { AT_ONCE };
        let most = self.refinement.most.min(reached + at_once);
        // Those that went astray, or whose tips no cell shows, are a worse start than those that are predicted; so are some
        // that come too near to each other to tell whether they touch.
        let lost =
            astray || (!self.predicted && (zone.has_lost_tips() || (self.found.unfinished && zone.fronts_are_long())));
        if !(lost || self.found.unresolved.is_some()) || self.membrane.obstacles.are_sticky() {
            return (zone, most);
        }
        self.predicted = true;
        let known = self.found.equilibrium.as_ref().filter(|_| !astray);
        let known = known.map(|state| Known { state, zone: &self.found.zone });
        let predicted =
            self.refinement.predicted(self.membrane, &zone, known.as_ref(), &|| self.progress.interrupted());
        match predicted.filter(|predicted| lost || predicted.counts() != zone.counts()) {
            Some(predicted) => (predicted, self.refinement.most),
            None => (zone, most),
        }
    }

    /// What is found on cells divided about a zone.
    fn about(
        &mut self,
        refinement: &Refinement<D>,
        zone: Z,
        sizing: Sizing<D>,
        scales: Scales,
        rest: StoppingRule,
    ) -> Option<(Membrane<D>, Solution<D, Z>)> {
        let cells = refinement.divided(self.membrane, &zone, sizing)?;
        let start = Start::Zone(zone, scales.on(&cells), self.branch);
        let found = ils::solve(&cells, &mut Elements::new(&cells), start, rest, self.at, self.progress);
        Some((cells, found))
    }

    /// Whether less is known than before.
    fn is_lost(&self, next: &Solution<D, Z>) -> bool {
        self.found.reason.converged() && !next.reason.converged() && next.reason != Reason::Interrupted
    }

    /// What was found, brought to rest.
    fn finished(self) -> Solution<D, Z> {
        let Self { cells, mut found, at, progress, .. } = self;
        if !found.unfinished || !found.reason.converged() {
            return found;
        }
        if let (true, Some(state), Some(scales)) = (found.near_enough, &found.equilibrium, &found.scales) {
            let conditions = Conditions::check(state, &found.zone, scales, false);
            let hold = conditions.hold(scales);
            if hold || (found.zone.has_lost_tips() && conditions.nearly_hold_about(&found.zone, scales, &cells)) {
                found.unresolved = (!hold).then_some(-conditions.least_gap_outside);
                found.conditions = Some(conditions);
                return found;
            }
        }
        // Smaller cells turned out not to be wanted, or not to be had.
        let left = (found.zone.clone(), found.conditions.take(), found.settled_within, found.unresolved.take());
        let true_enough = left.2.is_none_or(|step| step < SETTLED_COARSE);
        let mut next = ils::resume(&cells, found, StoppingRule::Final, at, progress);
        if matches!(next.reason, Reason::IterationLimit | Reason::LinearSolver(_))
            && true_enough
            && let Ok(state) = Equilibrium::solve(&cells, &left.0, &mut Elements::new(&cells))
        {
            // Where they were left they were as near to rest as these cells can tell.
            (next.reason, next.unfinished) = (Reason::Converged, true);
            (next.iterations, next.equilibrium) = (next.iterations + 1, Some(state));
            (next.zone, next.conditions, next.settled_within, next.unresolved) = left;
        }
        next
    }
}

/// Whether the cells at the fronts of a zone are hardly larger than these want them.
fn resolves<const D: usize, Z: Zone<D>>(membrane: &Membrane<D>, zone: &Z, sizing: &Sizing<D>) -> bool {
    let small = |x: &Point<D>| {
        let cell = membrane.cells.containing(x);
        cell.is_none_or(|cell| membrane.cells.size(cell) <= HARDLY * sizing.at(x))
    };
    zone.outlines().iter().flatten().all(small)
}

impl Scales {
    /// The same scales for other cells.
    pub fn on<const D: usize>(self, membrane: &Membrane<D>) -> Self {
        Self { h: membrane.front_size(), degree: membrane.grid.degree(), ..self }
    }
}
