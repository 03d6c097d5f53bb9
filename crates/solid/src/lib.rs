//! Elastic solids.
pub mod material;
pub mod stiffness;
