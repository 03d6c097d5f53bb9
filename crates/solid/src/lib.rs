//! Elastic solids as bodies of a system: cells and their stiffness, boundaries that may touch, laws at small and finite strain.
//!
//! - [`material`]: linear elasticity in the plane, around an axis and in space.
//! - [`body`]: bodies and the parts of their boundary.
//! - [`stiffness`]: cells, and how they avoid locking.
//! - [`law`]: how stress follows from strain.
//! - [`solid_body`]: a solid as one of many bodies of any kind.

pub mod body;
pub mod law;
pub use signorini_fem::elastic as material;
pub mod solid_body;
pub mod solid_material;
pub mod stiffness;

pub use body::{Bodies, Body, BodySurface};
pub use law::{StrainError, StressLaw, Volumetric};
pub use material::{Elastic, Space, von_mises};
pub use solid_body::{EdgeError, EdgeOf, SolidBody, SolidError};
pub use solid_material::SolidMaterial;
