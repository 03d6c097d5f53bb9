//! Zones and the sizes of cells at their fronts.

use crate::obstacle::Side;
use crate::problem::Membrane;
use crate::sizing::Sizing;
use signorini_fem::{Cells, Grid};
use signorini_geometry::{Aabb, Point};
use std::sync::Arc;

/// How finely a zone is told on cells, and how small cells it wants.
pub trait ZoneSizes<const D: usize>: Sized {
    /// The zone within outlines on each side, with modes as long as cells of the given sizes can tell apart.
    fn within(grid: &Grid<D>, sizing: &Arc<Sizing<D>>, outlines: &[(Side, Vec<Point<D>>)]) -> Self;
    /// The zone with fronts of as many modes as another grid can tell apart.
    fn on_grid(&self, grid: &Grid<D>) -> Self;
    /// The zone with fronts whose modes are as long as cells of the given sizes can tell apart, the smallest of which are
    /// those of the grid.
    fn on_sizes(&self, grid: &Grid<D>, _sizing: &Arc<Sizing<D>>) -> Self {
        self.on_grid(grid)
    }
    /// The zone with fronts of as many modes as the cells of a membrane can tell apart.
    fn on_cells(&self, membrane: &Membrane<D>) -> Self {
        match &membrane.sizing {
            Some(sizing) => self.on_sizes(&membrane.grid, sizing),
            None => self.on_grid(&membrane.grid),
        }
    }
    /// The sizes that the fronts want of cells: those of `grid` divided at least and at most so often, and `finer` times more
    /// often than would do; none where cells are not divided or need not be.
    fn sizing(&self, _grid: &Grid<D>, _divisions: [usize; 2], _finer: usize) -> Option<Sizing<D>> {
        None
    }
    /// Cells divided near the fronts as the sizes say, at most so often, and elsewhere where `also` says so of a cell's box and
    /// how often it was divided; none where cells are not divided.
    fn divided(
        &self,
        _cells: &Arc<dyn Cells<D>>,
        _sizing: &Sizing<D>,
        _most: usize,
        _also: &dyn Fn(&Aabb<D>, usize) -> bool,
    ) -> Option<Arc<dyn Cells<D>>> {
        None
    }
}
