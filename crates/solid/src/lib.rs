//! Elastic solids as bodies of a system: cells and their stiffness, boundaries that may touch, laws at small and finite strain.
//!
//! - [`body`]: bodies and the parts of their boundary.
//! - [`stiffness`]: cells, and how they avoid locking.
//! - [`solid_body`]: a solid as one of many bodies of any kind.

pub mod body;
pub mod solid_body;
pub mod stiffness;

pub use body::{Bodies, Body, BodySurface};
pub use signorini_material::{Elastic, SolidMaterial, Space, StrainError, StressLaw, Volumetric, von_mises};
pub use solid_body::{Constant, EdgeError, EdgeOf, SolidBody, SolidError, ThermalMaterial};
