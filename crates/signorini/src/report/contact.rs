//! What is told of a contact at the end of an increment.

use super::UnitNames;
use crate::problem::Space;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A contact at the end of an increment.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ContactReport {
    /// The body whose points are tested, by choice of the case or of the program; null with membranes.
    #[serde(default)]
    pub slave: Option<String>,
    /// Contact force on the first body of the contact. For axisymmetric membranes it is that of the whole disc.
    pub force: [f64; 3],
    /// Contact moment on the first body about `moments_about`.
    #[serde(default)]
    pub moment: Option<[f64; 3]>,
    /// Smallest and largest normal force of the contact, summed over its contact points, over all sets of contact
    /// forces that balance the loads, are compressive and lie within the friction cones. Null if the forces are
    /// statically determinate, if bodies deform, if supports hold a free body in part, and for very large groups of
    /// contact points.
    #[serde(default)]
    pub force_bounds: Option<ForceBounds>,
    /// Kind of contact forces. It determines the meaning of `area` and the unit of pressures.
    #[serde(default)]
    pub carries: TractionKind,
    /// Contact area. A length for a string, in the plane, and for `carries = "line_load"`.
    pub area: f64,
    /// Number of connected contact zones.
    pub zones: usize,
    /// Number of holes in the contact zones.
    pub holes: Option<usize>,
    /// The connected contact zones one by one.
    pub components: Vec<Component>,
    /// Radius of a circular zone; half the length of an interval.
    pub radius: Option<f64>,
    /// Total length of the fronts; on a line their number.
    pub boundary_length: Option<f64>,
    /// Largest penetration.
    pub max_penetration: f64,
    /// Smallest gap outside the contact zones. For membranes, at a distance of more than half a cell from the fronts.
    pub min_gap_outside: Option<f64>,
    /// Largest contact pressure.
    pub max_pressure: f64,
    /// Smallest contact pressure within the zones; negative only by round-off.
    pub min_pressure: Option<f64>,
    /// Part of the contact force that acts along the fronts, as a line force. Without adhesion it vanishes with the
    /// slope jump.
    pub line_force: Option<f64>,
    /// Integral of the adhesion energy over the contact zones.
    pub adhesion_energy: Option<f64>,
    /// Whether the second variation of the energy is positive.
    pub stable: Option<bool>,
    /// Smallest eigenvalue of the second variation of the energy. The state is stable if it is positive.
    pub lowest_eigenvalue: Option<f64>,
    /// Estimated discretisation error in the last increment of a step. It is computed with functions of one degree
    /// more and with cells of half the size; the larger change counts.
    pub error_estimate: Option<ErrorEstimate>,
    /// Other equilibria at the same load: area, energy and stability.
    pub other_states: Vec<OtherState>,
    /// Contact area in stick. Null without friction, as are the next five.
    pub stick_area: Option<f64>,
    /// Contact area in slip.
    pub slip_area: Option<f64>,
    /// Largest slip since first contact.
    pub max_slip: Option<f64>,
    /// Largest ratio of the friction traction to the friction limit; 1 in slip.
    pub max_friction_utilisation: Option<f64>,
    /// Friction part of the contact force.
    pub friction_force: Option<[f64; 3]>,
    /// Energy dissipated by friction in the increment, summed over all parts of an increment with cut-backs.
    pub dissipation: Option<f64>,
    /// Largest traction against opening. Null without adhesion or cohesion. The contact area then includes what is apart and
    /// still attracted.
    #[serde(default)]
    pub max_tension: Option<f64>,
    /// Largest depth worn off at the end of the increment before this one. Null without wear, as is the next one.
    #[serde(default)]
    pub max_wear: Option<f64>,
    /// Volume worn off, an area in the plane.
    #[serde(default)]
    pub worn_volume: Option<f64>,
    /// Friction limits of a rope in its current position. Null for other bodies.
    #[serde(default)]
    pub rope: Option<RopeLimits>,
}

impl ContactReport {
    /// Half the length of one interval, or the radius of the disc of one area; none of several zones.
    pub fn radius_of(space: Space, area: f64, zones: usize) -> Option<f64> {
        match (zones, space) {
            (1, Space::PlaneStrain | Space::PlaneStress) => Some(0.5 * area),
            (1, _) => Some((area / std::f64::consts::PI).sqrt()),
            _ => None,
        }
    }
}

/// Bounds of a statically indeterminate normal force.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ForceBounds {
    /// The smallest normal force that balances the loads.
    pub least: f64,
    /// The largest normal force. Null if there is no bound, as for bodies that clamp each other.
    pub largest: Option<f64>,
}

/// Kind of contact forces: the meaning of `area` and the unit of pressures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TractionKind {
    /// Contact pressure, a force per area of a surface; per length of a line in the plane.
    #[default]
    Pressure,
    /// Line load, a force per length of a curve, for ropes, beams and edges; `area` is a length.
    LineLoad,
    /// Point forces: crossing rods, balls, corners of rigid bodies; `area` is their number or their weight.
    Force,
}

impl TractionKind {
    /// The units of extent and largest pressure.
    pub fn units(self, names: &UnitNames) -> [&str; 2] {
        match self {
            Self::Pressure => [&names.area, &names.pressure],
            Self::LineLoad => [&names.length, &names.line_load],
            Self::Force => ["", &names.force],
        }
    }
}

/// Friction limits of a rope on a surface, by the theorem of Euler and Eytelwein for curves on surfaces.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RopeLimits {
    /// Smallest and largest admissible logarithm of the ratio of the tensions at the ends of the contact.
    pub log_ratio: [f64; 2],
    /// Largest ratio of geodesic to normal curvature: the tangent of the angle between the contact force and the
    /// normal.
    pub max_tan_alpha: f64,
    /// Arc length at which this ratio occurs.
    pub at: f64,
    /// Limit of this ratio: the coefficient of friction across the rope.
    pub lateral_limit: f64,
    /// The result in a sentence.
    pub verdict: String,
}

/// One connected contact zone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Component {
    /// Contact area; a length for a string and in the plane.
    pub area: f64,
    /// Contact force of the zone on the first body of the contact.
    pub force: [f64; 3],
    /// Centroid of the zone.
    pub centroid: [f64; 3],
    /// Number of holes in the contact zones.
    pub holes: Option<usize>,
}

/// Estimated discretisation errors, as ±.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ErrorEstimate {
    /// In `error_estimate`: root mean square error of the front position. Null for solids.
    pub front: Option<f64>,
    /// Error of the contact area.
    pub area: f64,
    /// Error of the magnitude of the contact force.
    pub force: f64,
    /// Error of the largest pressure.
    pub max_pressure: Option<f64>,
}

impl ErrorEstimate {
    /// What is of first order in the cells differs from halved cells by half of its error, and a change may by chance be
    /// smaller than it usually is: the factor of safety of Roache (1994) for two grids.
    const SAFETY: f64 = 3.0;

    /// From the changes with finer functions.
    pub fn of_changes(force: f64, area: f64, max_pressure: f64) -> Self {
        let [force, area, max_pressure] = [force, area, max_pressure].map(|change| Self::SAFETY * change.abs());
        Self { front: None, area, force, max_pressure: Some(max_pressure) }
    }

    /// The larger of two, one by one.
    pub fn larger(&self, other: &Self) -> Self {
        let of = |a: Option<f64>, b: Option<f64>| a.into_iter().chain(b).reduce(f64::max);
        Self {
            front: of(self.front, other.front),
            area: self.area.max(other.area),
            force: self.force.max(other.force),
            max_pressure: of(self.max_pressure, other.max_pressure),
        }
    }
}

/// Another equilibrium of an adhesive membrane at the same load.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OtherState {
    /// Contact area.
    pub area: f64,
    /// Elastic energy minus the work of the load and the adhesion energy of the contact zones.
    pub energy_total: f64,
    /// Whether the second variation of the energy is positive.
    pub stable: bool,
}
