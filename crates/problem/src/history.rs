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
    /// Time tolerance to which changes of topology and jumps are located; not located if left out.
    pub events: Option<f64>,
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
