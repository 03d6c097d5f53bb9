//! The history: what is ramped to which time, and what is prescribed along it.

use super::{Nothing, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A load step.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// Time at the end of the step.
    pub to: Value,
    /// Number of increments; 1 if left out.
    pub increments: Option<i64>,
    /// The path parameter of the step; the time if left out.
    pub control: Option<Control>,
    /// Motion with inertia; equilibrium at each time if left out.
    pub dynamics: Option<Dynamics>,
    /// Time tolerance to which events are located: changes of topology and jumps of membranes; of other bodies when contacts touch,
    /// part, stick and slip. Not located if left out.
    pub events: Option<f64>,
}

/// Motion with inertia from the state at the end of the step before, or from the start.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dynamics {
    /// Spectral radius at high frequencies of the generalised-α method, from 0 to 1; 1 if left out: nothing is damped.
    pub spectral_radius: Option<f64>,
    /// Damping by mass and stiffness; none if left out.
    pub damping: Option<RayleighDamping>,
    /// Error of the displacements that an increment may add, per time, relative to the largest velocity so far, both in the norm of
    /// the mass. Increments are solved in parts that keep to it. Left out: each increment is one part.
    pub tolerance: Option<f64>,
}

/// Damping forces in proportion to the momentum of each point, and to the rate of the internal forces.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RayleighDamping {
    /// Damping force per momentum, one over a time; 0 if left out.
    pub mass: Option<Value>,
    /// Damping force per rate of the elastic force, a time; 0 if left out.
    pub stiffness: Option<Value>,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Control {
    /// Time.
    Time(Nothing),
    /// Arc-length control along the equilibrium path, through folds.
    ArcLength(ArcLength),
    /// Area control: the contact area is prescribed and the time is an unknown.
    Area(AreaControl),
}

/// Arc-length control.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArcLength {
    /// Arc length of an increment. The duration of the step has length one; so have the area of the membrane, and in a system the
    /// displacement that the step would come to if it went on as it begins.
    pub size: f64,
}

/// Area control: the contact area is prescribed and the time is an unknown.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AreaControl {
    /// Name of the contact.
    pub of: String,
    /// Contact area at the end of the step.
    pub to: Value,
}
