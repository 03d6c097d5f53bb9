//! Materials of bodies in three dimensions.

use super::{List, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Material {
    /// Isotropic, linear elastic.
    LinearElastic(LinearElastic),
    /// Isotropic, hyperelastic: neo-Hookean; requires `strain = "finite"`.
    NeoHooke(NeoHooke),
    /// Isotropic, Saint-Venant-Kirchhoff: linear in the Green-Lagrange strain. For large rotations with small strains;
    /// requires `strain = "finite"`.
    SaintVenantKirchhoff(LinearElastic),
    /// Hyperelastic: Mooney-Rivlin, `c10 (I1 - 3) + c01 (I2 - 3)` of the invariants without change of volume; requires
    /// `strain = "finite"`.
    MooneyRivlin(MooneyRivlin),
    /// Hyperelastic: Yeoh, `c10 (I1 - 3) + c20 (I1 - 3)^2 + c30 (I1 - 3)^3` of the invariant without change of volume;
    /// requires `strain = "finite"`.
    Yeoh(Yeoh),
    /// Hyperelastic: Ogden, the sum of `2 mu/alpha^2 (l1^alpha + l2^alpha + l3^alpha - 3)` of the principal stretches
    /// without change of volume; requires `strain = "finite"`.
    Ogden(Ogden),
    /// Hyperelastic: Arruda-Boyce, with the five terms of its series in the invariant I1 without change of volume;
    /// requires `strain = "finite"`.
    ArrudaBoyce(ArrudaBoyce),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinearElastic {
    /// Young's modulus, a force per area.
    pub youngs_modulus: Value,
    /// Poisson's ratio, above -1 and below 0.5.
    pub poissons_ratio: Value,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NeoHooke {
    /// Young's modulus at rest, a force per area.
    pub youngs_modulus: Value,
    /// Poisson's ratio at rest, above -1 and below 0.5.
    pub poissons_ratio: Value,
    /// Energy of the change of volume, with Lamé's constant `lambda`: `quadratic`, `lambda/4 (J^2 - 1 - 2 ln J)`, or
    /// `logarithmic`, `lambda/2 ln(J)^2`; `quadratic` if left out.
    pub volumetric: Option<String>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MooneyRivlin {
    /// Constant of the first invariant, a force per area. The shear modulus at rest is `2 (c10 + c01)`.
    pub c10: Value,
    /// Constant of the second invariant, a force per area; 0 if left out.
    pub c01: Option<Value>,
    /// Bulk modulus, a force per area: `2/D1` in Abaqus.
    pub bulk_modulus: Value,
    /// Energy of the change of volume with the bulk modulus `K`: `linear`, `K/2 (J - 1)^2` (Abaqus), `logarithmic`,
    /// `K/2 ln(J)^2` (FEBio), or `quadratic`, `K/4 (J^2 - 1 - 2 ln J)`; `linear` if left out.
    pub volumetric: Option<String>,
    /// Fibres along one direction.
    pub fibre: Option<Fibre>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Yeoh {
    /// `c10`, `c20` and `c30`, forces per area; those left out are 0. The shear modulus at rest is `2 c10`.
    pub c: List<Value>,
    /// Bulk modulus, a force per area: `2/D1` in Abaqus.
    pub bulk_modulus: Value,
    /// Energy of the change of volume: `linear`, `logarithmic` or `quadratic`, as of `mooney_rivlin`; `linear` if left out.
    pub volumetric: Option<String>,
    /// Fibres along one direction.
    pub fibre: Option<Fibre>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ogden {
    /// Moduli of up to six terms, forces per area, as in Abaqus; half the `c` of FEBio. Their sum is the shear modulus
    /// at rest.
    pub mu: List<Value>,
    /// Exponents of the terms, not 0.
    pub alpha: List<Value>,
    /// Bulk modulus, a force per area: `2/D1` in Abaqus.
    pub bulk_modulus: Value,
    /// Energy of the change of volume: `linear`, `logarithmic` or `quadratic`, as of `mooney_rivlin`; `linear` if left out.
    pub volumetric: Option<String>,
    /// Fibres along one direction.
    pub fibre: Option<Fibre>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArrudaBoyce {
    /// Modulus of the series, a force per area. The shear modulus at rest is
    /// `mu (1 + 3/(5 s^2) + 99/(175 s^4) + 513/(875 s^6) + 42039/(67375 s^8))` with the locking stretch `s`.
    pub mu: Value,
    /// Stretch at which the chains of molecules are straight, above 1.
    pub locking_stretch: Value,
    /// Bulk modulus, a force per area: `2/D` in Abaqus.
    pub bulk_modulus: Value,
    /// Energy of the change of volume: `linear`, `logarithmic` or `quadratic`, as of `mooney_rivlin`; `linear` if left out.
    pub volumetric: Option<String>,
    /// Fibres along one direction.
    pub fibre: Option<Fibre>,
}

/// Fibres along one direction, which carry in tension only (Weiss, Maker and Govindjee 1996; FEBio's transversely isotropic
/// Mooney-Rivlin): the stress times the stretch is `c3 (exp(c4 (l - 1)) - 1)` between the stretches 1 and `stretch`, and
/// linear beyond.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fibre {
    /// Direction before the body deforms, of any length: expressions of x, y and z.
    pub direction: List<Value>,
    /// Scale of the stress of curled fibres, a force per area.
    pub c3: Value,
    /// Exponent of the stress of curled fibres.
    pub c4: Value,
    /// Modulus of straight fibres, a force per area.
    pub c5: Value,
    /// Stretch at which fibres are straight, above 1.
    pub stretch: Value,
}
