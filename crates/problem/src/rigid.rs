//! Rigid bodies: their shape, on which side they are touched, and how they move.

use super::shape::Shape;
use super::{Components, List, Nothing, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rigid body.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rigid {
    /// The shape of its surface.
    pub shape: Shape,
    /// The side of the surface on which contact is possible; `outside` if left out. In contact with a membrane, the side of the
    /// membrane on which the body is. If left out there, it follows from the direction of a plane, cone or paraboloid and from the
    /// centre of a round body; all other bodies are below.
    pub side: Option<Side>,
    /// For triangle meshes: a smooth surface through the vertices replaces the flat triangles, for bodies that slide or
    /// roll on it; false if left out. Paths always use the smooth surface.
    pub smooth: Option<bool>,
    /// Motion of the body; at rest if left out.
    pub motion: Option<Motion>,
    /// Temperature of the body, an expression of t, for contacts that conduct heat.
    pub temperature: Option<Value>,
}

impl Rigid {
    /// A body at rest with contact on its outside.
    pub fn new(shape: Shape) -> Self {
        Self { shape, side: None, smooth: None, motion: None, temperature: None }
    }
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The body is inside the surface; contact is on the outside.
    Outside,
    /// The surface bounds a hole in the body; contact is on the inside.
    Inside,
    /// The body is below a membrane.
    Below,
    /// The body is above a membrane.
    Above,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// At rest.
    Fixed(Nothing),
    /// Prescribed translation and rotation.
    Prescribed(Prescribed),
    /// A free body: its motion is unknown.
    Free(FreeMotion),
}

/// A free rigid body: six unknowns in space, three in the plane.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FreeMotion {
    /// Reference point for forces and rotations, lengths; if left out the centre of the volume, or of the shape where its volume is not known. With a mass it is the centre of mass.
    pub center: Option<List<Value>>,
    /// Mass per volume, from which mass, centre of mass and inertia of a closed shape follow; no mass if left out.
    pub density: Option<Value>,
    /// Mass, in place of the density.
    pub mass: Option<Value>,
    /// Moments of inertia about the centre: one value of a ball or in the plane, or `[Jxx, Jyy, Jzz]` about the axes. That of the shape
    /// with this mass if left out.
    pub inertia: Option<Components>,
    /// Velocity of the centre along each axis at the start; at rest if left out.
    pub velocity: Option<List<Value>>,
    /// Angular velocity in radians per time at the start, along each axis or one value in the plane; none if left out.
    pub angular_velocity: Option<Components>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Prescribed {
    /// Displacement along each axis, lengths, as expressions of t.
    pub displacement: Option<List<Value>>,
    /// Rotation vector in radians about the centre of the shape, which is the origin of surfaces from files and of level sets, as
    /// expressions of t.
    pub rotation: Option<List<Value>>,
}
