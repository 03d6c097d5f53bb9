//! Membranes on rigid floors by the inequality level-set method.
pub mod active_set;
pub mod adhesion;
pub mod conditions;
pub mod domain;
pub mod equilibrium;
pub mod field;
pub mod front;
pub mod ils;
pub mod line_zone;
pub mod plane_zone;
pub mod problem;
pub mod quadrature;
mod raster;
pub mod report;
pub mod scales;
pub mod staircase;
pub mod zone;
