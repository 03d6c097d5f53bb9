//! What is told of a contact at the end of an increment.

use super::UnitNames;
use crate::problem::Space;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A contact at the end of an increment.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ContactReport {
    /// Force of the contact on the first body that it names; for a round membrane, on the whole of it.
    pub force: [f64; 3],
    /// Moment of the contact on that body about `moments_about`.
    #[serde(default)]
    pub moment: Option<[f64; 3]>,
    /// Least and largest normal force, over all its places, of all contact forces that would hold the rigid bodies as well; null
    /// where balance determines it, where bodies deform or supports hold them, and of very many places together.
    #[serde(default)]
    pub force_bounds: Option<ForceBounds>,
    /// What `area` measures, and pressures are forces per.
    #[serde(default)]
    pub carries: Carried,
    /// Area of contact; a length for a string, in the plane, and where `carries` says `line_load`.
    pub area: f64,
    /// Number of connected zones of contact.
    pub zones: usize,
    /// Number of holes in the zones.
    pub holes: Option<usize>,
    /// The connected zones of a contact one by one.
    pub components: Vec<Component>,
    /// Radius of a zone that is a disc; half the length of one that is an interval.
    pub radius: Option<f64>,
    /// Length of the fronts together; their number on a line.
    pub boundary_length: Option<f64>,
    /// How deep the bodies lie in each other at worst.
    pub max_penetration: f64,
    /// Least gap outside the zones, for membranes further than half a cell from the fronts.
    pub min_gap_outside: Option<f64>,
    /// Largest contact pressure.
    pub max_pressure: f64,
    /// Least contact pressure within the zones; negative only by round-off.
    pub min_pressure: Option<f64>,
    /// Part of the contact force along the fronts; it vanishes with the slope jump, and is what adhesion holds.
    pub line_force: Option<f64>,
    /// What adhesion gives back: the integral of its energy over the zones.
    pub adhesion_energy: Option<f64>,
    /// Whether the second variation of the energy is positive.
    pub stable: Option<bool>,
    /// Of the second variation of the energy: the state is stable where it is positive.
    pub lowest_eigenvalue: Option<f64>,
    /// What the discretisation leaves uncertain, estimated with functions of one degree more, or cells of half the size, in
    /// the last increment of a step.
    pub error_estimate: Option<ErrorEstimate>,
    /// Other equilibria at the same load: area, energy, and whether they are stable.
    pub other_states: Vec<OtherState>,
    /// Area in contact that sticks; null without friction, as all that follows.
    pub stick_area: Option<f64>,
    /// Area in contact that slips.
    pub slip_area: Option<f64>,
    /// Largest slip since the bodies touched.
    pub max_slip: Option<f64>,
    /// Largest share of the friction limit: 1 where it slips.
    pub max_friction_utilisation: Option<f64>,
    /// Part of the force that is friction.
    pub friction_force: Option<[f64; 3]>,
    /// Energy that friction took in the increment, in all parts of one that was cut.
    pub dissipation: Option<f64>,
    /// What friction could hold of a rope where it lies; null for other bodies.
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

/// Between what a normal force lies that balance does not determine.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ForceBounds {
    /// The least normal force that holds the bodies.
    pub least: f64,
    /// The largest one; null where there is no bound, as of bodies that clamp each other.
    pub largest: Option<f64>,
}

/// What a contact carries: what its `area` measures, and what its pressures are forces per.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Carried {
    /// Forces per area of a surface (per length of a line in the plane).
    #[default]
    Pressure,
    /// Forces per length of a curve, of ropes, beams and edges: `area` is a length.
    LineLoad,
    /// Forces at points: rods that cross, balls, corners of rigid bodies; `area` is their number or what they stand for.
    Force,
}

impl Carried {
    /// The units of extent and largest pressure.
    pub fn units(self, names: &UnitNames) -> [&str; 2] {
        match self {
            Self::Pressure => [&names.area, &names.pressure],
            Self::LineLoad => [&names.length, &names.line_load],
            Self::Force => ["", &names.force],
        }
    }
}

/// What friction could hold of a rope that lies on a surface, by the theorem of Euler and Eytelwein for curves on surfaces.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RopeLimits {
    /// Least and largest logarithm of the ratio of the tensions at both ends of the contact.
    pub log_ratio: [f64; 2],
    /// Largest angle between the force that holds the rope and the normal, as a tangent: geodesic over normal curvature.
    pub max_tan_alpha: f64,
    /// Where along the rope that is.
    pub at: f64,
    /// What it must stay below, the coefficient across the rope.
    pub lateral_limit: f64,
    /// In words.
    pub verdict: String,
}

/// One connected zone of contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Component {
    /// Area of contact; a length for a string and in the plane.
    pub area: f64,
    /// Force of the zone on the first body of the contact.
    pub force: [f64; 3],
    /// Middle of a zone, weighted by area.
    pub centroid: [f64; 3],
    /// Number of holes in the zones.
    pub holes: Option<usize>,
}

/// How far figures may be off, as ±.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ErrorEstimate {
    /// In `error_estimate`: root mean square of the distance by which fronts are off; null for solids.
    pub front: Option<f64>,
    /// Of the area of contact.
    pub area: f64,
    /// Of the size of the contact force.
    pub force: f64,
    /// Of the largest pressure.
    pub max_pressure: Option<f64>,
}

impl ErrorEstimate {
    /// A change with the cells is as likely too small as too large an estimate: this makes it seldom too small.
    const SAFETY: f64 = 1.5;

    /// From the changes with finer functions.
    pub fn of_changes(force: f64, area: f64, max_pressure: f64) -> Self {
        let [force, area, max_pressure] = [force, area, max_pressure].map(|change| Self::SAFETY * change.abs());
        Self { front: None, area, force, max_pressure: Some(max_pressure) }
    }
}

/// Another equilibrium of an adhesive membrane at the same load.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OtherState {
    /// Area of contact.
    pub area: f64,
    /// Elastic energy less the work of the load and what adhesion gives back.
    pub energy_total: f64,
    /// Whether the second variation of the energy is positive.
    pub stable: bool,
}
