//! Multigrid for the membrane cut by its edge and its fronts.
//!
//! Away from the cuts the equations of a grid repeat from cell to cell and are never stored; they are relaxed patch by patch,
//! one around each vertex of the grid, which at degree 1 is Gauss-Seidel in four colours. On a mesh of which every cell was
//! divided into four, again and again, they are stored, and relaxed colour by colour. Along the cuts the equations are stored,
//! and a band of nodes there, with one layer of regular nodes around it, is solved for exactly in every sweep: it is a graph of
//! one dimension, so its factor is small. Coarser levels are the same membrane on grids of half the cells, or on the mesh before
//! its cells were divided. One cycle costs a few tens of nanoseconds per unknown and leaves less than an eighth of the error,
//! however thin the slivers.

mod band;
mod grid;
pub(crate) mod interior;
pub mod large;
mod level;
pub(crate) mod mesh;
pub mod nested;
mod patches;
mod regular;
mod rows;
pub(crate) mod runs;
mod transfer;
mod uneven;

pub use grid::OnGrid;
pub use level::Level;
pub use mesh::OnMesh;
pub use regular::{Ground, Regular};

use crate::plane_zone::PlaneZone;
use crate::problem::Membrane;
use crate::zone::ZoneSizes;
use signorini_solve::SolveError;

/// Cells that the smallest zone has to be wide for a coarsest level, and how many nodes that may have at most along one
/// side.
const SHOWN: f64 = 2.0;
const LARGEST_WHOLE: usize = 128;

/// Functions from which on multigrid takes less time than a factorisation.
pub const LARGE: usize = 60_000;

/// A membrane around a zone on levels of growing size, the finest last.
pub struct Hierarchy<R: Regular> {
    pub levels: Vec<Level<R>>,
}

/// The levels that a zone needs: coarser ones than show its smallest part leave a slow error round it that only finer ones
/// could take away; but what is cheap to solve for whole is not made larger for its sake.
fn that_show<'a, C>(grounds: &'a [Ground<C>], zone: &PlaneZone) -> &'a [Ground<C>] {
    let smallest = zone.smallest();
    let shows = |ground: &Ground<C>| {
        let grid = &ground.grid;
        SHOWN * grid.h() <= smallest || grid.cells().iter().any(|n| n * grid.degree() >= LARGEST_WHOLE)
    };
    &grounds[grounds.iter().position(shows).unwrap_or(0)..]
}

/// A membrane around a zone on some levels, the coarsest first, which is solved whole.
fn levels<R: Regular>(
    membrane: &Membrane<2>,
    zone: &PlaneZone,
    grounds: &[Ground<R::Cells>],
) -> Result<Vec<Level<R>>, SolveError> {
    let level = |(k, ground): (usize, &Ground<R::Cells>)| {
        Level::new(&ground.membrane(membrane), ground, &zone.on_grid(&ground.grid), k == 0)
    };
    grounds.iter().enumerate().map(level).collect()
}

impl<R: Regular> Hierarchy<R> {
    /// The membrane on all levels down from its own cells, around a zone; no levels where there are none for it.
    ///
    /// # Errors
    /// Equations along the cuts that cannot be factorised.
    pub fn new(membrane: &Membrane<2>, zone: &PlaneZone) -> Result<Self, SolveError> {
        let grounds = R::grounds(membrane);
        Ok(Self { levels: levels(membrane, zone, that_show(&grounds, zone))? })
    }

    /// One cycle on the finest level: relaxation, correction from the coarser levels, relaxation.
    ///
    /// # Errors
    /// A factorisation that does not solve.
    pub fn cycle(&mut self) -> Result<(), SolveError> {
        cycle(&mut self.levels)
    }

    /// The finest level.
    ///
    /// # Panics
    /// Where there are no levels.
    pub fn finest(&mut self) -> &mut Level<R> {
        let last = self.levels.len() - 1;
        &mut self.levels[last]
    }
}

/// A V-cycle on the last of some levels, whose right-hand side and displacement are those in it.
pub(crate) fn cycle<R: Regular>(levels: &mut [Level<R>]) -> Result<(), SolveError> {
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
