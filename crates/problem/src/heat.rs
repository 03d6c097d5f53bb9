//! Heat: how solids conduct and expand, and what passes through contacts.

use super::Value;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the temperature of solids is found.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Heat {
    /// The equation of heat; `steady` if left out.
    pub equation: Option<HeatEquation>,
    /// Largest change of a temperature by a further pass between heat and mechanics that ends them, relative to the range of
    /// temperatures; 1e-9 if left out.
    pub tolerance: Option<f64>,
    /// Most passes of an increment; 50 if left out.
    pub passes: Option<i64>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum HeatEquation {
    /// Heat flows balance at each time: nothing is stored.
    Steady,
    /// Bodies store heat: by the implicit Euler method, one step for each increment. Conducting bodies require `density` and
    /// `specific_heat`.
    Transient,
}

/// Temperature of a solid.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Thermal {
    /// Thermal expansion: strain per temperature, the same in all directions. A value or an expression of position; 0 if left
    /// out.
    pub expansion: Option<Value>,
    /// Temperature without thermal strain; `initial_temperature` if left out.
    pub stress_free_temperature: Option<Value>,
    /// Temperature at the start, a value or an expression of position; `stress_free_temperature` if left out.
    pub initial_temperature: Option<Value>,
    /// The temperature of the body where it is known, as an expression of position and time. Left out if the equation of heat is
    /// solved for it.
    pub temperature: Option<Value>,
    /// Conductivity: heat per time, length and temperature, the same in all directions. A value or an expression of position.
    /// Left out for a body whose `temperature` is given.
    pub conductivity: Option<Value>,
    /// Heat per mass and temperature, for `equation = "transient"`.
    pub specific_heat: Option<Value>,
}

/// Exchange of heat with a fluid, `coefficient * (ambient - temperature)` per area into the body.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Convection {
    /// Film coefficient: heat per time, area and difference of temperature.
    pub coefficient: Value,
    /// Temperature of the fluid.
    pub ambient: Value,
}

/// Heat through a contact.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactHeat {
    /// Conductance where the surfaces touch: heat per time, area and jump of temperature; with `pressure` that at this
    /// pressure. No heat passes if left out.
    pub conductance: Option<Value>,
    /// Pressure at which the conductance is the one stated: at a pressure `p` it is `conductance * (p/pressure)^exponent`. If
    /// left out, the conductance does not depend on the pressure.
    pub pressure: Option<Value>,
    /// Exponent of the pressure, above 0; 0.95 if left out (Cooper, Mikic and Yovanovich).
    pub exponent: Option<f64>,
    /// Part of the heat of friction that the first body of `between` takes, from 0 to 1; 0.5 if left out.
    pub friction_share: Option<f64>,
}
