//! What is told of temperatures and heat at the end of an increment.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Temperatures and flows of heat at the end of an increment. Flows are heat per time; in the plane per thickness, around an axis
/// of the whole circumference.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HeatReport {
    /// Number of solutions of the mechanical equations until the temperatures changed no more.
    pub passes: usize,
    /// Largest change of a temperature after each pass, relative to the tolerance.
    pub history: Vec<f64>,
    /// Sum of all flows into each body, relative to the largest flow: the largest of all bodies. Round-off.
    pub balance: f64,
    /// Bodies with a temperature, by their names.
    pub bodies: BTreeMap<String, BodyHeat>,
    /// Heat per time into the bodies by supports that prescribe a temperature.
    pub supports: BTreeMap<String, f64>,
    /// Heat per time into the bodies by loads: fluxes, sources, convection.
    pub loads: BTreeMap<String, f64>,
    /// Contacts through which heat passes, by their names.
    pub contacts: BTreeMap<String, ContactHeatReport>,
}

/// The temperature of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BodyHeat {
    /// Lowest temperature.
    pub min: f64,
    /// Highest temperature.
    pub max: f64,
    /// Heat per time that the body stores: 0 in the steady state.
    pub stored: f64,
    /// Heat per time into a body whose temperature is given, by what keeps it; null of others.
    pub given: Option<f64>,
}

/// Heat through a contact.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ContactHeatReport {
    /// Heat per time that the conductance passes from the first body to the second, in the order of `bodies`.
    pub conducted: f64,
    /// Power of friction.
    pub friction: f64,
    /// The two bodies.
    pub bodies: [String; 2],
    /// Heat per time into each of them.
    pub into: [f64; 2],
}
