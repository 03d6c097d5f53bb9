//! Geometrically exact (Simo-Reissner) beams: a C1 centreline and cross-sections that turn.
//!
//! - [`strain`]: strains of a point with their derivatives.
//! - [`element`]: energy, forces and tangent of an element.
//! - [`body`]: a whole beam; [`start`]: how it starts.

pub mod body;
pub mod element;
mod inertia;
pub mod start;
pub mod strain;

pub use body::Beam;
pub use start::BeamError;
