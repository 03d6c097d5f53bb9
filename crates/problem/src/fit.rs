//! Measurements of a contact, and what they are to tell.

use super::List;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Measurements of a contact, and the parameters to be computed from them.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fit {
    /// A CSV file whose first line contains the column names.
    pub data: String,
    /// Column of the time. Loads and motions of the case are functions of it.
    pub time: String,
    /// Column of the radius of contact, or of half its length.
    pub radius: Option<String>,
    /// Column of the contact area; replaces the radius.
    pub area: Option<String>,
    /// Unknown parameters: `adhesion`, and optionally `tension`.
    pub unknown: Option<List<FitUnknown>>,
    /// Whether the scatter of the measurements is relative to their size; `relative` if left out.
    pub noise: Option<Noise>,
    /// Confidence level of the intervals; 0.95 if left out.
    pub confidence: Option<f64>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum FitUnknown {
    /// Adhesion energy of the contact.
    Adhesion,
    /// Tension of the membrane.
    Tension,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Noise {
    /// Proportional to the measured value.
    #[default]
    Relative,
    /// The same for all values.
    Absolute,
}
