//! Multigrid for the membrane cut by its edge and its fronts.
//!
//! Away from the cuts the equations repeat from cell to cell and are never stored; they are relaxed patch by patch, one
//! around each vertex of the grid, which at degree 1 is Gauss-Seidel in four colours. Along the cuts the equations are stored, and a band of nodes there, with one layer of regular nodes around it, is solved for
//! exactly in every sweep: it is a graph of one dimension, so its factor is small. Coarser levels are the same membrane on
//! grids of half the cells. One cycle costs a few tens of nanoseconds per unknown and leaves less than an eighth of the
//! error, however thin the slivers.

mod band;
mod interior;
mod level;
pub mod nested;
mod runs;
mod transfer;

pub use level::Level;

use crate::plane_zone::PlaneZone;
use crate::problem::Membrane;
use crate::zone::Zone;
use signorini_fem::Grid;
use signorini_solve::SolveError;
use std::sync::Arc;

/// Cells along the longer side of the coarsest grid, below which all is solved for at once.
const COARSEST: usize = 16;

/// Cells that the smallest zone has to be wide for a coarsest grid, and how many times cells of degree 1 that may be at most
/// along one side.
const SHOWN: f64 = 2.0;
const LARGEST_WHOLE: usize = 128;

/// Functions from which on multigrid takes less time than a factorisation.
pub const LARGE: usize = 60_000;

/// A membrane around a zone on grids of growing size, the finest last.
pub struct Hierarchy {
    pub levels: Vec<Level>,
}

/// Whether so many cells may be those of a grid with a coarser one.
fn can_be_halved(cells: usize) -> bool {
    cells.is_multiple_of(2) && cells / 2 >= COARSEST
}

/// The grids of a hierarchy, the coarsest first.
pub fn grids(finest: &Grid<2>) -> Vec<Grid<2>> {
    let mut list = vec![finest.clone()];
    while let Some(last) = list.last()
        && last.cells().iter().all(|n| can_be_halved(*n))
    {
        let coarser = Grid::new(*last.bounds(), last.cells().map(|n| n / 2), last.degree());
        list.push(coarser);
    }
    list.reverse();
    list
}

/// The grids of a hierarchy that a zone needs: coarser ones than show its smallest part leave a slow error round it that
/// only finer ones could take away; but what is cheap to solve for whole is not made larger for its sake.
fn that_show<'a>(grids: &'a [Grid<2>], zone: &PlaneZone) -> &'a [Grid<2>] {
    let smallest = zone.smallest();
    let shows = |g: &Grid<2>| SHOWN * g.h() <= smallest || g.cells().iter().any(|n| n * g.degree() >= LARGEST_WHOLE);
    let first = grids.iter().position(shows).unwrap_or(0);
    &grids[first.min(grids.len() - 1)..]
}

/// The same membrane on a grid of a hierarchy.
pub fn on_grid(membrane: &Membrane<2>, grid: &Grid<2>) -> Membrane<2> {
    if grid.cells() == membrane.grid.cells() {
        return membrane.clone();
    }
    Membrane { grid: grid.clone(), ..membrane.on(Arc::new(grid.clone())) }
}

/// A membrane around a zone on some grids, the coarsest first, which is solved whole.
fn levels(membrane: &Membrane<2>, zone: &PlaneZone, grids: &[Grid<2>]) -> Result<Vec<Level>, SolveError> {
    let level = |(k, grid)| Level::new(&on_grid(membrane, grid), &zone.on_grid(grid), k == 0);
    grids.iter().enumerate().map(level).collect()
}

impl Hierarchy {
    /// The membrane on all grids down from its own, around a zone.
    ///
    /// # Errors
    /// Equations along the cuts that cannot be factorised.
    pub fn new(membrane: &Membrane<2>, zone: &PlaneZone) -> Result<Self, SolveError> {
        Ok(Self { levels: levels(membrane, zone, that_show(&grids(&membrane.grid), zone))? })
    }

    /// One cycle on the finest level: relaxation, correction from the coarser levels, relaxation.
    ///
    /// # Errors
    /// A factorisation that does not solve.
    pub fn cycle(&mut self) -> Result<(), SolveError> {
        cycle(&mut self.levels)
    }

    /// The finest level.
    pub fn finest(&mut self) -> &mut Level {
        let last = self.levels.len() - 1;
        &mut self.levels[last]
    }
}

/// A V-cycle on the last of some levels, whose right-hand side and displacement are those in it.
pub(crate) fn cycle(levels: &mut [Level]) -> Result<(), SolveError> {
    let Some((fine, coarser)) = levels.split_last_mut() else { return Ok(()) };
    let Some(coarse) = coarser.last_mut() else { return fine.relax_bands() };
    fine.relax()?;
    fine.restrict_residual(coarse);
    coarse.u.iter_mut().for_each(|u| *u = 0.0);
    cycle(coarser)?;
    if let Some(coarse) = coarser.last() {
        fine.add_correction(coarse);
    }
    fine.relax()
}
