//! Measurements of a contact, and what they are to tell.

use super::List;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Measurements of a contact, and what they are to tell.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fit {
    /// A CSV file with a line of names above its columns.
    pub data: String,
    /// Column of the time, of which loads and motions of the case are functions.
    pub time: String,
    /// Column of the radius of contact, or of its half length.
    pub radius: Option<String>,
    /// Column of the area of contact, in place of the radius.
    pub area: Option<String>,
    /// `adhesion`, and if wanted `tension`.
    pub unknown: Option<List<FitUnknown>>,
    /// Whether the scatter of the measurements is relative to their size.
    pub noise: Option<Noise>,
    /// Confidence of the intervals, 0.95 if left out.
    pub confidence: Option<f64>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum FitUnknown {
    /// The energy of adhesion of the contact.
    Adhesion,
    /// The tension of the membrane.
    Tension,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Noise {
    /// In proportion to the measured value.
    #[default]
    Relative,
    /// The same for all values.
    Absolute,
}
