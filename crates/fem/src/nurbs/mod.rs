//! Patches of rational B-splines (NURBS), of which the spans between knots are the cells of a mesh.
//!
//! - [`mod@line`]: knots of one direction, and the functions on their spans.
//! - [`join`]: which control points and vertices of different patches are the same.
//! - [`macro_cells`]: cells on which dilatations are projected together.
//! - [`build`]: the mesh.

pub mod build;
pub mod join;
pub mod line;
pub mod macro_cells;
mod patch;
#[cfg(test)]
mod tests;

pub use build::mesh_of_patches;
pub use patch::{NurbsError, NurbsPatch};
