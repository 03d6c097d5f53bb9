//! Flows of heat that a solution of the equation of heat comes to.

/// Heat per time through a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactFlow {
    /// From the first body to the second by conductance.
    pub conducted: f64,
    /// Of friction.
    pub friction: f64,
    /// Into each of the bodies: both together.
    pub into: [f64; 2],
}

/// Heat of an increment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeatResult {
    /// Changes of the temperature by each further pass, relative to the tolerance.
    pub history: Vec<f64>,
    /// Solutions of the mechanical equations.
    pub passes: usize,
    /// Least and largest temperature of each body; none of bodies without.
    pub ranges: Vec<Option<[f64; 2]>>,
    /// Heat per time into the bodies by each support and load of heat, and into each body whose temperature is known.
    pub supports: Vec<f64>,
    pub loads: Vec<f64>,
    pub known: Vec<f64>,
    pub contacts: Vec<ContactFlow>,
    /// Heat per time that each body stores.
    pub stored: Vec<f64>,
    /// What is left of all flows, relative to the largest.
    pub imbalance: f64,
}
