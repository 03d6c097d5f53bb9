//! Smooth curves without sections that turn: cables, and beams free of torsion.
//!
//! - [`element`]: energy, forces and tangent of an element.
//! - [`body`]: a whole cable or beam.

pub mod body;
pub mod element;

pub use body::{Cable, CableError};
