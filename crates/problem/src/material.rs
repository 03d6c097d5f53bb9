//! Materials of bodies in three dimensions.

use super::Value;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Material {
    /// Isotropic and linear.
    LinearElastic(LinearElastic),
    /// Isotropic at any strain, from the strain energy of Neo and Hooke; with `strain = "finite"`.
    NeoHooke(LinearElastic),
    /// Isotropic and linear in the strain of Green and Lagrange: for large rotations; with `strain = "finite"`.
    SaintVenantKirchhoff(LinearElastic),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinearElastic {
    /// Young's modulus, a force per area.
    pub youngs_modulus: Value,
    /// Poisson's ratio, above -1 and below 0.5.
    pub poissons_ratio: Value,
}
