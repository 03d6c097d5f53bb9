//! Which membranes are solved for by multigrid: those in the plane with many functions.

use super::{LARGE, nested};
use crate::line_zone::LineZone;
use crate::plane_zone::PlaneZone;
use crate::problem::Membrane;
use crate::solution::Solution;
use crate::zone::Zone;
use signorini_solve::{Progress, SolveError};

/// A zone whose state on a large membrane multigrid may find.
pub trait ByMultigrid<const D: usize>: Zone<D> {
    /// The state by multigrid; none where that is not the way.
    ///
    /// # Errors
    /// Equations that cannot be solved.
    fn by_multigrid(
        _membrane: &Membrane<D>,
        _at: (usize, f64),
        _progress: &mut dyn Progress,
    ) -> Result<Option<Solution<D, Self>>, SolveError> {
        Ok(None)
    }
}

impl ByMultigrid<1> for LineZone {}

impl ByMultigrid<2> for PlaneZone {
    fn by_multigrid(
        membrane: &Membrane<2>,
        at: (usize, f64),
        progress: &mut dyn Progress,
    ) -> Result<Option<Solution<2, Self>>, SolveError> {
        if membrane.cells.function_count() < LARGE {
            return Ok(None);
        }
        nested::solution(membrane, at, progress)
    }
}
