//! The history: what is ramped to which time, and what is prescribed along it.

use super::{Nothing, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A part of the history.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// Time at its end.
    pub to: Value,
    /// Number of increments, 1 if left out.
    pub increments: Option<i64>,
    /// What is prescribed along the step; the time if left out.
    pub control: Option<Control>,
    /// Changes of topology and jumps are located to so much of the time; they are not sought if left out.
    pub events: Option<f64>,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Control {
    /// The time.
    Time(Nothing),
    /// Along the path of equilibria, through its folds.
    ArcLength(ArcLength),
    /// The area of contact.
    Area(AreaControl),
}

/// A step along a path of equilibria.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArcLength {
    /// Length of an increment, where the area of the membrane and the time that the step takes have length one.
    pub size: f64,
}

/// A step in which the area of contact is given, and the time at which it is reached is sought.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AreaControl {
    /// Name of the contact.
    pub of: String,
    /// The area at the end of the step.
    pub to: Value,
}
