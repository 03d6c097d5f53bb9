//! Materials of bodies in three dimensions.

use super::Value;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Material {
    /// Isotropic, linear elastic.
    LinearElastic(LinearElastic),
    /// Isotropic, hyperelastic: neo-Hookean; requires `strain = "finite"`.
    NeoHooke(LinearElastic),
    /// Isotropic, Saint-Venant-Kirchhoff: linear in the Green-Lagrange strain. For large rotations with small strains;
    /// requires `strain = "finite"`.
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
