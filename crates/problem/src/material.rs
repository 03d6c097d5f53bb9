//! Materials of bodies in three dimensions.

use super::{List, Value};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::borrow::Cow;
use std::fmt;

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
    /// Linear elastic with three perpendicular planes of symmetry; with `strain = "finite"` linear in the Green-Lagrange
    /// strain.
    Orthotropic(Orthotropic),
    /// Isotropic, elastic-plastic: von Mises with isotropic and kinematic hardening; with `strain = "finite"` in logarithmic
    /// strains.
    ElasticPlastic(ElasticPlastic),
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
pub struct Orthotropic {
    /// `E1`, `E2`, `E3` along the axes of the material, forces per area.
    pub youngs_moduli: List<Value>,
    /// `v12`, `v13`, `v23`: `vij` is the contraction along axis j per stretch along axis i by a stress along axis i.
    pub poissons_ratios: List<Value>,
    /// `G12`, `G13`, `G23`, forces per area.
    pub shear_moduli: List<Value>,
    /// The first two axes of the material, perpendicular and of any length, such as `[[1, 0, 0], [0, 1, 0]]`; the third is
    /// perpendicular to both. The axes of the case if left out. In the plane one axis is along z.
    pub axes: Option<List<List<Value>>>,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElasticPlastic {
    /// Young's modulus, a force per area.
    pub youngs_modulus: Value,
    /// Poisson's ratio, above -1 and below 0.5.
    pub poissons_ratio: Value,
    /// Yield stress, a force per area, or a table `[[stress, plastic strain], …]` from a plastic strain of 0 on. With
    /// `strain = "finite"` true stress and logarithmic plastic strain.
    pub yield_stress: YieldStress,
    /// Modulus of linear isotropic hardening: yield stress per plastic strain, a force per area, beyond the last row of a
    /// table; 0 if left out.
    pub hardening: Option<Value>,
    /// Modulus of linear kinematic hardening (Prager): uniaxial stress per plastic strain, a force per area; 0 if left out.
    /// With `strain = "finite"` of the logarithms of the plastic stretches.
    pub kinematic_hardening: Option<Value>,
}

/// A yield stress, or a table of it.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum YieldStress {
    Constant(Value),
    Table(List<List<Value>>),
}

impl JsonSchema for YieldStress {
    fn schema_name() -> Cow<'static, str> {
        "YieldStress".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (value, table) = (generator.subschema_for::<Value>(), generator.subschema_for::<List<List<Value>>>());
        json_schema!({ "anyOf": [value, table] })
    }
}

impl<'de> Deserialize<'de> for YieldStress {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = YieldStress;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a stress, or a table such as [[250, 0], [300, 0.05]] of stress and plastic strain")
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<YieldStress, E> {
                Ok(YieldStress::Constant(Value::Number(value)))
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<YieldStress, E> {
                self.visit_f64(value as f64)
            }
            fn visit_u64<E: Error>(self, value: u64) -> Result<YieldStress, E> {
                self.visit_f64(value as f64)
            }
            fn visit_str<E: Error>(self, text: &str) -> Result<YieldStress, E> {
                Ok(YieldStress::Constant(Value::Text(text.into())))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<YieldStress, A::Error> {
                List::deserialize(SeqAccessDeserializer::new(list)).map(YieldStress::Table)
            }
        }
        deserializer.deserialize_any(Reader)
    }
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
