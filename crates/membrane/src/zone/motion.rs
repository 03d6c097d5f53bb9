//! Zones whose fronts move.

use crate::method::{ModeSpace, Transport};
use signorini_fem::Grid;
use signorini_geometry::Point;

/// What became of a zone whose fronts were moved.
pub struct Advance<Z> {
    pub zone: Z,
    /// Whether zones or holes appeared, merged, split or vanished.
    pub topology_changed: bool,
}

/// How the fronts of a zone move.
pub trait ZoneMotion<const D: usize>: Sized {
    /// Moves the fronts by `step` (coefficients of the modes) along their normals, nowhere further than `reach` and
    /// nowhere so far that they would fold.
    fn advanced(&self, grid: &Grid<D>, modes: ModeSpace, step: &[f64], reach: f64) -> Advance<Self>;
    /// Moves the fronts as [`ZoneMotion::advanced`] does, or as the level set of a function on the nodes of the grid; in one
    /// dimension that makes no difference.
    fn transported(
        &self,
        grid: &Grid<D>,
        modes: ModeSpace,
        step: &[f64],
        reach: f64,
        _transport: Transport,
    ) -> Advance<Self> {
        self.advanced(grid, modes, step, reach)
    }
    /// The zone with its fronts moved by a sum of multiples of the ways that they have come since earlier zones; none where
    /// these differ in more than the place of the fronts.
    fn extrapolated(&self, grid: &Grid<D>, before: &[(&Self, f64)]) -> Option<Self>;
    /// How far the fronts are from those of a zone that was extrapolated from the same one, at the place where that is
    /// farthest relative to a size; none where that is not told.
    fn farthest_from(&self, _other: &Self, _size: &dyn Fn(&Point<D>) -> f64) -> Option<f64> {
        None
    }
}
