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

/// Kind of analysis.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Analysis {
    /// Equilibrium of bodies in contact.
    Equilibrium,
    /// Shortest paths over rigid bodies: length, derivatives, and the tensions that friction admits.
    Wrapping,
    /// Paths of yarns on a mandrel.
    Winding,
    /// Equilibrium of ropes on given curves: theorem of Euler and Eytelwein for curves on surfaces.
    EulerEytelwein,
}

/// View direction of pictures in space.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct View {
    /// Direction from the object to the viewer.
    pub from: List<f64>,
    /// Direction that points up in the picture; z if left out.
    pub up: Option<List<f64>>,
}

/// A shortest path.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShortestPath {
    /// Start: a point in space (lengths, expressions of t) or a point of a body.
    pub from: PathEnd,
    /// End: a point in space or a point of a body.
    pub to: PathEnd,
    /// Bodies in the order of the path. The path is in contact with a body only where it is obstructed by it. With
    /// `via`, one list for each part.
    #[serde(default)]
    pub around: List<Around>,
    /// Additional turns around bodies, by their names.
    #[serde(default)]
    pub turns: Named<i64>,
    /// Points that the path passes through, in order.
    #[serde(default)]
    pub via: List<PathEnd>,
    /// Coefficients of friction: one for all directions, or along the path and across it.
    pub friction: Option<PathFriction>,
    /// Tension at the start, a force, as an expression of t.
    pub tension: Option<Value>,
    /// Tension at the end, a force, as an expression of t. It is compared with the friction limits.
    pub end_tension: Option<Value>,
}

/// A point in space (expressions of t), or a point attached to a body.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum PathEnd {
    Space(List<Value>),
    OnBody(OnBody),
}

/// A point attached to a body.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OnBody {
    /// Name of the body.
    pub body: String,
    /// Position before the body moves, lengths.
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

/// Friction laws of ropes.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PathFriction {
    /// Coulomb friction.
    Coulomb(PathCoulomb),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PathCoulomb {
    /// Coefficient of friction. Two if it depends on the direction: along and across the rope, or along and across
    /// `axis`.
    pub mu: Components,
    /// A direction attached to the surface (expressions of x, y and z), projected on it; along the rope if left out.
    pub axis: Option<List<Value>>,
}

/// A path of a yarn on a mandrel.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Winding {
    /// Name of the mandrel.
    pub on: String,
    /// Start point and start direction.
    pub start: WindingStart,
    /// Slippage, the ratio of geodesic to normal curvature, as an expression of s, angle, r and z. If left out and
    /// `polar_opening` is given, it is computed.
    pub slippage: Option<Value>,
    /// Coefficient of friction. The yarn slips beyond it.
    pub friction: Option<Value>,
    /// Polar opening that the path has to reach.
    pub polar_opening: Option<PolarOpening>,
    /// Width of the band, a length.
    pub band: Option<Value>,
    /// Winding pattern of circuits that covers the mandrel.
    pub pattern: Option<WindingPattern>,
    /// Rotation axis of the mandrel, through the centre of its shape; z if left out.
    pub axis: Option<List<Value>>,
    /// Length of a path without opening or pattern; with these, the maximum length to a turn.
    pub length: Option<Value>,
    /// Distance between the points that are written, a length.
    pub spacing: Option<Value>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WindingStart {
    /// Position along the axis, a length.
    pub z: Value,
    /// Angle around the axis, in radians or as "25 deg"; 0 if left out.
    pub theta: Option<Value>,
    /// Angle to the meridian, in radians or as "25 deg".
    pub angle: Value,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PolarOpening {
    /// Radius of the edge of the band. The edge is half a band width from the centreline.
    pub radius: Value,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WindingPattern {
    /// Number of circuits, or "auto" for the smallest number that covers the mandrel.
    pub circuits: Value,
}

/// A rope on a given curve.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RopeOnSurface {
    /// Name of the body.
    pub on: String,
    /// The curve on the surface of the body.
    pub path: Path,
    /// Coefficients of friction along the rope and across it, or along and across an axis of the surface.
    pub friction: PathFriction,
    /// Tension at the start, a force; 1 if left out.
    pub tension: Option<Value>,
    /// Tension at the end, a force. It is compared with the friction limits.
    pub end_tension: Option<Value>,
}
