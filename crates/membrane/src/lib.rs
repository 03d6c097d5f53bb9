//! Membranes beside rigid bodies by the inequality level-set method.
pub mod active_set;
pub mod adhesion;
pub mod coexisting;
pub mod conditions;
pub mod continuation;
mod deferred;
pub mod domain;
pub mod equilibrium;
pub mod error_estimate;
pub mod field;
pub mod front;
pub mod history;
pub mod ils;
pub mod kernel;
pub mod kinks;
pub mod line_zone;
pub mod method;
mod mode_matrix;
pub mod multigrid;
pub mod obstacle;
pub mod plane_zone;
pub mod prediction;
pub mod problem;
pub mod published;
pub mod quadrature;
mod raster;
pub mod refinement;
pub mod report;
pub mod scales;
pub mod shape_rate;
pub mod sizing;
pub mod solution;
pub mod staircase;
mod stopping;
pub mod zone;

/// Inner parts for the tests in `tests`; no part of the interface.
#[doc(hidden)]
pub mod testing {
    pub use crate::deferred::Known;
    pub use crate::history::bridge::nearest;
    pub use crate::history::mergers::at_zero;
    pub use crate::history::seek::AreaController;
    pub use crate::history::statement::{Control, PlannedIncrement};
    pub use crate::mode_matrix::{MANY_MODES, ModeMatrix};
    pub use crate::multigrid::interior::Interior;
    pub use crate::multigrid::mesh::Near;
    pub use crate::multigrid::runs::{Run, common, dilated, find, parts, runs};
    use crate::plane_zone::PlaneZone;
    pub use crate::plane_zone::extrapolation::without_waves;
    pub use crate::plane_zone::motion::swept;
    pub use crate::published::level_set::NodalLevelSet;
    pub use crate::raster::Raster;
    pub use crate::stopping::{Decision, IterationHistory, Observation, StoppingRule};
    use signorini_fem::Grid;

    /// Cells near the fronts of a zone.
    pub fn cells_near_fronts(zone: &PlaneZone) -> impl Iterator<Item = usize> + '_ {
        zone.cells_near_fronts()
    }

    /// The number of knots that the first front of a zone would get.
    pub fn wanted_knots(grid: &Grid<2>, zone: &PlaneZone) -> usize {
        zone.wanted_knots(grid)
    }
}
