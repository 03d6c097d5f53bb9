//! What one time came to: displacement, pressures, forces.

use crate::contact::ContactResult;
use crate::friction::statement::Found as FoundFriction;
use signorini_contact::Route;
use signorini_geometry::Point;

/// The solution at one time.
#[derive(Clone, Debug)]
pub struct State<const D: usize> {
    /// Unknowns of all bodies.
    pub u: Vec<f64>,
    pub contacts: Vec<ContactResult<D>>,
    pub iterations: usize,
    /// How the compliance of the contacts was known in the end.
    pub route: Route,
    /// After each iteration: how many nodes changed.
    pub residuals: Vec<f64>,
    /// Force of each support on the bodies.
    pub support_forces: Vec<Point<D>>,
    /// Largest unbalanced force relative to the largest of all.
    pub imbalance: f64,
    /// Strain energy.
    pub energy: f64,
    pub unknowns: usize,
    /// With friction: whether the equilibrium is one that a disturbance leaves.
    pub unstable: bool,
}

/// Displacement of all unknowns, and pressure, weighted gap and status of all rows.
pub(crate) struct Found {
    pub u: Vec<f64>,
    pub pressure: Vec<f64>,
    pub gap: Vec<f64>,
    pub active: Vec<bool>,
    pub iterations: usize,
    pub route: Route,
    pub residuals: Vec<f64>,
    /// Friction of all rows.
    pub rubbing: Option<FoundFriction>,
}
