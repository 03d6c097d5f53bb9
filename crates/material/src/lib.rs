//! Stress laws, at small and finite strain, for bodies of any discretisation.
//!
//! - [`elastic`]: linear elasticity in the plane, around an axis and in space.
//! - [`law`]: energy, stress and tangent from the deformation gradient.
//! - [`solid_material`]: constants and law of a body, the same everywhere or by position.
//! - [`history`]: what laws with a history keep at points of quadrature.

pub mod elastic;
pub mod history;
pub mod law;
pub mod solid_material;

pub use elastic::{Elastic, Space, von_mises};
pub use history::History;
pub use law::{StrainError, StressLaw, Volumetric};
pub use solid_material::SolidMaterial;
