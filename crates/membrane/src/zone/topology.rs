//! Zones to which something is added, or from which it is taken away.

use crate::obstacle::Side;
use signorini_fem::Grid;
use signorini_geometry::Point;

/// How a zone grows and loses parts.
pub trait ZoneTopology<const D: usize>: Sized {
    /// Adds the set where `f < 0`, which lies outside the zone and touches one side.
    fn united(&self, grid: &Grid<D>, side: Side, f: &mut dyn FnMut(&Point<D>) -> f64) -> Self;
    /// Removes the set where `f < 0`.
    fn reduced(&self, grid: &Grid<D>, f: &mut dyn FnMut(&Point<D>) -> f64) -> Self;
    /// The zone without one of its parts.
    fn without(&self, grid: &Grid<D>, part: usize) -> Self;
    /// The zone without those holes of which this says so, from the side that is touched round them, their outlines and
    /// areas; none where it does of no hole.
    fn filled(&self, _grid: &Grid<D>, _closes: &dyn Fn(Side, &[Point<D>], f64) -> bool) -> Option<Self> {
        None
    }
    /// A small zone about a point that touches one side, added.
    fn seeded(&self, grid: &Grid<D>, side: Side, x: &Point<D>, radius: f64) -> Self;
}
