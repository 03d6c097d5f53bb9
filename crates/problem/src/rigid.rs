//! Rigid bodies: their shape, on which side they are touched, and how they move.

use super::shape::Shape;
use super::{List, Nothing, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A body that does not deform.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rigid {
    /// The shape of its surface.
    pub shape: Shape,
    /// On which side of the surface the body is free to be touched; `outside` if left out.
    pub side: Option<Side>,
    /// Of a triangle mesh: a smooth surface through its vertices in place of flat triangles, for what slides or rolls on it;
    /// flat if left out. Paths always run on the smooth one.
    pub smooth: Option<bool>,
    /// Where it lies beside a membrane; if left out a plane, a cone and a paraboloid tell it by their direction, a round
    /// body by its centre, and every other one lies below.
    pub lies: Option<Lies>,
    /// How it moves; it is at rest if left out.
    pub motion: Option<Motion>,
}

impl Rigid {
    /// A body at rest that is touched from outside.
    pub fn new(shape: Shape) -> Self {
        Self { shape, side: None, smooth: None, lies: None, motion: None }
    }
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Lies {
    /// Under the membrane: it is seen from above.
    Below,
    /// Over the membrane: it is seen from below.
    Above,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The body fills the shape.
    Outside,
    /// The shape is a hole in the body.
    Inside,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// At rest.
    Fixed(Nothing),
    /// Moved as stated.
    Prescribed(Prescribed),
    /// Moved by what acts on it.
    Free(FreeMotion),
}

/// A rigid body that moves freely: in space by six unknowns, in the plane by three.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FreeMotion {
    /// The point that forces act on and about which the body turns, lengths; the centre of the shape if left out.
    pub center: Option<List<Value>>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Prescribed {
    /// Displacement along each axis, lengths, as expressions of t.
    pub displacement: Option<List<Value>>,
    /// Rotation vector in radians, as expressions of t.
    pub rotation: Option<List<Value>>,
}
