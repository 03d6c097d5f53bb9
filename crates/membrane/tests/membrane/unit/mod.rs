//! Parts by themselves.

mod deferred;
mod history_bridge;
mod history_mergers;
mod history_seek;
mod mode_matrix;
mod multigrid_interior;
mod multigrid_mesh;
mod multigrid_runs;
mod plane_zone;
mod published_level_set;
mod raster;
mod sizing;
mod stopping;
