//! Paths on rigid bodies, without equations of bodies: shortest paths over bodies that move, paths of yarns on mandrels,
//! and ropes on curves that are given.

use super::{Components, List, Named, Path, Value};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{
    Deserializer, MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer, value::SeqAccessDeserializer,
};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;

/// What is computed.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Analysis {
    /// Equilibrium of bodies in contact.
    Equilibrium,
    /// Shortest paths over rigid bodies: their length, its derivatives, the tensions that friction holds.
    Wrapping,
    /// Paths of yarns on a mandrel.
    Winding,
    /// Whether ropes hold on curves that are given, by the theorem of Euler and Eytelwein for curves on surfaces.
    EulerEytelwein,
}

/// From where pictures in space are drawn.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct View {
    /// The direction to the eye.
    pub from: List<f64>,
    /// The direction that is up on the page; z if left out.
    pub up: Option<List<f64>>,
}

/// A shortest path.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShortestPath {
    /// Where it starts: a point of space, its coordinates lengths by t, or a point of a body.
    pub from: PathEnd,
    /// Where it ends.
    pub to: PathEnd,
    /// Bodies in the order of the path, each touched where it is in the way; between points of `via` a list for each part.
    #[serde(default)]
    pub around: List<Around>,
    /// Further turns about bodies, by their names.
    #[serde(default)]
    pub turns: Named<i64>,
    /// Points through which it runs, in order.
    #[serde(default)]
    pub via: List<PathEnd>,
    /// Coefficients of friction: the same in all directions, or along the path and across it.
    pub friction: Option<PathFriction>,
    /// Tension at the start, a force by t.
    pub tension: Option<Value>,
    /// Tension at the end, a force by t: whether friction holds it is told.
    pub end_tension: Option<Value>,
}

/// A point of space, its coordinates values by t; or a point of a body, with which it moves.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum PathEnd {
    Space(List<Value>),
    OnBody(OnBody),
}

/// A point of a body.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OnBody {
    /// Name of the body.
    pub body: String,
    /// Where it is before the body moves, lengths.
    pub point: List<Value>,
}

impl JsonSchema for PathEnd {
    fn schema_name() -> Cow<'static, str> {
        "PathEnd".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (point, on_body) = (generator.subschema_for::<List<Value>>(), generator.subschema_for::<OnBody>());
        json_schema!({ "anyOf": [point, on_body] })
    }
}

impl<'de> Deserialize<'de> for PathEnd {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = PathEnd;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a point such as [1, 0, \"2*t\"], or { body = \"NAME\", point = [1, 0, 0] }")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<PathEnd, A::Error> {
                List::deserialize(SeqAccessDeserializer::new(list)).map(PathEnd::Space)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<PathEnd, A::Error> {
                OnBody::deserialize(MapAccessDeserializer::new(map)).map(PathEnd::OnBody)
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

/// The name of a body, or those of one part between fixed points.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum Around {
    Body(String),
    Part(List<String>),
}

impl JsonSchema for Around {
    fn schema_name() -> Cow<'static, str> {
        "Around".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "string" }, { "type": "array", "items": { "type": "string" } }] })
    }
}

impl<'de> Deserialize<'de> for Around {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Around;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("the name of a body, or a list of names")
            }
            fn visit_str<E>(self, v: &str) -> Result<Around, E> {
                Ok(Around::Body(v.to_string()))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Around, A::Error> {
                List::deserialize(SeqAccessDeserializer::new(list)).map(Around::Part)
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

/// Laws of friction of ropes.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PathFriction {
    /// In proportion to the pressure.
    Coulomb(PathCoulomb),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PathCoulomb {
    /// The coefficient; two where it depends on the direction: along the rope and across it, or along `axis` and across it.
    pub mu: Components,
    /// A direction, values by x, y and z, that the surface carries, projected on it; along the rope if left out.
    pub axis: Option<List<Value>>,
}

/// A path of a yarn on a mandrel.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Winding {
    /// Name of the mandrel.
    pub on: String,
    /// Where it starts, and how it runs there.
    pub start: WindingStart,
    /// Slippage, geodesic over normal curvature: by s, angle, r and z; sought where it is left out and an opening is given.
    pub slippage: Option<Value>,
    /// The coefficient of friction beyond which the yarn slips.
    pub friction: Option<Value>,
    /// The opening at the pole that is to be reached.
    pub polar_opening: Option<PolarOpening>,
    /// Width of the band, a length.
    pub band: Option<Value>,
    /// Circuits that cover the mandrel.
    pub pattern: Option<WindingPattern>,
    /// About which the mandrel turns, through the centre of its shape; z if left out.
    pub axis: Option<List<Value>>,
    /// Of a path without an opening or a pattern, or the greatest one to a turn.
    pub length: Option<Value>,
    /// Distance of the points that are written, a length.
    pub spacing: Option<Value>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WindingStart {
    /// Along the axis, a length.
    pub z: Value,
    /// Around the axis, in radians or as "25 deg"; 0 if left out.
    pub theta: Option<Value>,
    /// From the meridian, in radians or as "25 deg".
    pub angle: Value,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PolarOpening {
    /// Radius of the edge of the band, which is half its width inside of its middle.
    pub radius: Value,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WindingPattern {
    /// Their number, or "auto": as few as cover the mandrel.
    pub circuits: Value,
}

/// A rope on a curve that is given.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RopeOnSurface {
    /// Name of the body.
    pub on: String,
    /// The curve, on its surface.
    pub path: Path,
    /// Coefficients of friction along the rope and across it, or along and across an axis of the surface.
    pub friction: PathFriction,
    /// Tension at the start, a force; 1 if left out.
    pub tension: Option<Value>,
    /// Tension at the end, a force: whether friction holds it is told.
    pub end_tension: Option<Value>,
}
