//! Supports of bodies.

use super::{Components, List, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A support: degrees of freedom that are fixed, prescribed or elastically supported.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Support {
    /// Body or group of a body: `BODY` or `BODY:GROUP`.
    pub on: String,
    /// Prescribed displacement: a value for a membrane, otherwise a vector with `"free"` for free components.
    pub displacement: Option<Components>,
    /// The axes of the components of `displacement`, at the reference position; those of space if left out.
    pub axes: Option<SupportAxes>,
    /// Prescribed rotation vector in radians of a beam section or a free rigid body, with `"free"` for free components.
    pub rotation: Option<List<Value>>,
    /// Prescribed displacement along the outward normal; the tangential components are free.
    pub normal: Option<Value>,
    /// All points share one unknown displacement: in the components that are not prescribed, or in those that are true of a list
    /// such as `[false, false, true]`.
    pub tied: Option<Tied>,
    /// Stiffness per area of an elastic foundation; for ropes, beams and rigid bodies force per displacement.
    pub spring: Option<List<Value>>,
    /// Prescribed temperature of a solid that conducts heat.
    pub temperature: Option<Value>,
    /// Time from which the support holds: at later times only. From the start if left out.
    pub from: Option<Value>,
    /// Time up to which the support holds, that time included. At later times the place is free. For ever if left out.
    pub until: Option<Value>,
}

/// Axes of the components of a prescribed displacement. Only for solids.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SupportAxes {
    /// The direction of the first axis, and in space one in the plane of the first two. Lengths have no influence.
    Rectangular(List<List<Value>>),
    /// Components away from a line, around it by the right hand, and along it. At degree 1 and 2.
    Cylindrical(CylindricalAxes),
}

/// The line about which axes turn.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CylindricalAxes {
    /// A point of the line, lengths.
    pub point: List<Value>,
    /// Its direction, which is that of the third component. Left out in the plane, where the line is normal to the plane.
    pub axis: Option<List<Value>>,
}

/// The components in which all points of a support share one unknown displacement.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Tied {
    /// All that are not prescribed, or none.
    All(bool),
    /// Those that are true.
    Components(List<bool>),
}
