//! What a run tells of paths on rigid bodies: shortest ones, those of yarns, ropes on given curves.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Results of paths. Empty for other analyses.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathReports {
    /// Shortest paths, for `analysis = "wrapping"`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub paths: Vec<PathReport>,
    /// Yarns, for `analysis = "winding"`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub winding: Vec<WindingReport>,
    /// Ropes on given curves, for `analysis = "euler_eytelwein"`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ropes: Vec<RopeReport>,
}

/// A shortest path over bodies.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathReport {
    /// Name of the path.
    pub name: String,
    /// Number of Newton iterations over all times.
    pub iterations: usize,
    /// Events: bodies that the path comes into contact with, or leaves.
    pub events: Vec<PathEvent>,
    /// One entry for each time.
    pub frames: Vec<PathFrame>,
}

/// A body that a path comes into contact with, or leaves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathEvent {
    /// Kind of the event.
    pub kind: PathEventKind,
    /// First time after the event.
    pub time: f64,
    /// Number of this time, from 0.
    pub frame: usize,
    /// Name of the body.
    pub body: String,
}

/// Kinds of events of paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PathEventKind {
    /// A path comes into contact with a body.
    Touchdown,
    /// A path leaves a body.
    LiftOff,
}

/// A shortest path at a time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathFrame {
    /// The time, from 0 to 1.
    pub time: f64,
    /// Length of the path.
    pub length: f64,
    /// Number of Newton iterations.
    pub iterations: usize,
    /// Largest sine of the angles between straight segments and geodesics at their ends.
    pub residual: f64,
    /// Segments on bodies, in the order of the path.
    pub contacts: Vec<PathContact>,
    /// Generalised forces of a unit tension on each body of the case, by its name.
    pub moment_arms: BTreeMap<String, MomentArm>,
    /// Smallest and largest logarithm of the ratio of end tension to start tension that friction admits. Null without
    /// friction.
    pub log_ratio: Option<[f64; 2]>,
    /// Largest lateral deviation from the shortest path that friction admits, for each contact. Null if the axes of
    /// friction are attached to the surface.
    pub sideways: Option<Vec<Option<SidewaysReport>>>,
    /// Smallest and largest end tension that friction admits. Null without friction or without a tension.
    pub tension_limits: Option<[f64; 2]>,
    /// Ratio of the end tension to the friction limit. Above 1 the path slips.
    pub utilisation: Option<f64>,
    /// Whether the path slips along its tangent.
    pub slips: Option<bool>,
}

/// A segment of a path on a body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathContact {
    /// Name of the body.
    pub body: String,
    /// Arc length at which the segment begins.
    pub from: f64,
    /// Arc length at which the segment ends.
    pub to: f64,
    /// Length of the segment.
    pub length: f64,
    /// Start point of the segment.
    pub start: [f64; 3],
    /// End point of the segment.
    pub end: [f64; 3],
    /// Whether the segment is a shortest path between its ends. If not, it is held by its ends only.
    pub minimal: bool,
}

/// Generalised forces of a path of unit tension on a body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MomentArm {
    /// Centre of the body.
    pub about: [f64; 3],
    /// Force on the body.
    pub shift: [f64; 3],
    /// Moment on the body about its centre, divided by the tension: a length along each axis.
    pub turn: [f64; 3],
}

/// Largest lateral deviation from the shortest path that friction admits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SidewaysReport {
    /// Largest lateral distance at the end of the segment.
    pub drift: f64,
    /// Largest rotation of the path there, in radians.
    pub rotation: f64,
}

/// A yarn on a mandrel.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WindingReport {
    /// Name of the yarn.
    pub name: String,
    /// Distance from the axis at the start.
    pub start_radius: f64,
    /// Angle to the meridian at the start, in radians.
    pub start_angle: f64,
    /// Computed slippage that reaches the polar opening. Null if the slippage is given.
    pub slippage_sought: Option<f64>,
    /// Turning point of a path to a polar opening.
    pub turn: Option<TurnReport>,
    /// One circuit of a pattern: forth and back.
    pub circuit: Option<CircuitReport>,
    /// Pattern of the circuits.
    pub pattern: Option<PatternReport>,
    /// Coverage of the mandrel by the bands of all circuits.
    pub coverage: Option<CoverageReport>,
    /// Length of the yarn.
    pub length: f64,
    /// Angle around the axis from the start to the end, in radians.
    pub theta: f64,
    /// Largest ratio of geodesic to normal curvature.
    pub largest_slippage: f64,
    /// Largest slippage divided by the coefficient of friction. Null without friction.
    pub utilisation: Option<f64>,
    /// Whether the yarn neither slips nor bridges.
    pub stable: bool,
    /// Arc-length intervals in which the yarn lifts off the mandrel.
    pub bridges: Vec<[f64; 2]>,
    /// Arc-length intervals in which the yarn slips.
    pub slips: Vec<[f64; 2]>,
}

/// Turning point of a yarn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TurnReport {
    /// Whether the yarn turns.
    pub reached: bool,
    /// Distance of the centreline of the band from the axis.
    pub radius: f64,
    /// Radius of the opening that the band leaves free.
    pub opening_radius: f64,
    /// Angle around the axis from the start, in radians.
    pub theta: f64,
}

/// One circuit of a yarn: forth and back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CircuitReport {
    /// Angle around the axis, in radians.
    pub angle: f64,
    /// Length of the circuit.
    pub length: f64,
    /// Angle to the meridian between end and start of the circuit, in radians.
    pub mismatch: f64,
    /// Distances from the axis at both turning points.
    pub turn_radii: [f64; 2],
    /// Radii of the openings at both turning points.
    pub opening_radii: [f64; 2],
}

/// Pattern of the circuits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PatternReport {
    /// Number of circuits.
    pub n: u32,
    /// Shift of a circuit in band positions, in addition to the full turns.
    pub k: u32,
    /// Number of full turns of a circuit.
    pub m: u32,
    /// Additional rotation of each circuit, in radians.
    pub dwell: f64,
    /// Number of circuits after which the first neighbour is laid.
    pub neighbour_after: u32,
    /// Whether the neighbour is ahead (`leading`) or behind (`lagging`).
    pub lead: String,
}

/// Coverage of the mandrel by the bands of a pattern.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CoverageReport {
    /// Smallest number of circuits that covers the mandrel.
    pub circuits_for_full: u32,
    /// Fraction of the mandrel that is covered.
    pub covered: f64,
    /// Width of the gap between neighbouring bands at the start.
    pub gap: f64,
    /// Width of the overlap of neighbouring bands at the start.
    pub overlap: f64,
    /// Total length of all circuits.
    pub length_of_all: f64,
}

/// A rope on a given curve, by the theorem of Euler and Eytelwein for curves on surfaces.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RopeReport {
    /// Name of the rope.
    pub name: String,
    /// Length of the curve.
    pub length: f64,
    /// Smallest and largest logarithm of the ratio of end tension to start tension that friction admits.
    pub log_ratio: [f64; 2],
    /// Tension at the start.
    pub tension: f64,
    /// Tension at the end. Null if it is not given.
    pub end_tension: Option<f64>,
    /// Smallest and largest end tension that friction admits. Null if there is no equilibrium on the curve for any
    /// tension.
    pub tension_limits: Option<[f64; 2]>,
    /// Whether the rope is in equilibrium on its curve.
    pub holds: bool,
    /// Ratio of the end tension to the friction limit. Null if the rope is not in equilibrium.
    pub utilisation: Option<f64>,
    /// The result in a sentence.
    pub verdict: String,
    /// Parts of the curve in which an equilibrium condition is violated.
    pub violations: Vec<ViolationReport>,
    /// Largest tangent of the angle between the contact force and the normal.
    pub largest_tan_alpha: ExtremeReport,
    /// Largest normal curvature. The rope is pressed on where it is negative.
    pub largest_normal_curvature: ExtremeReport,
    /// Largest distance of the curve from the surface.
    pub off_surface: f64,
}

/// A part of a curve in which an equilibrium condition is violated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ViolationReport {
    /// The violated condition.
    pub condition: RopeCondition,
    /// Arc length at which the part begins.
    pub from: f64,
    /// Arc length at which the part ends.
    pub to: f64,
    /// Arc length of the largest violation.
    pub at: f64,
    /// Normal curvature there, or the tangent of the angle. Null if it is infinite.
    pub value: Option<f64>,
    /// Limit of the value.
    pub limit: Option<f64>,
}

/// Violated equilibrium condition of a rope on its curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RopeCondition {
    /// The surface is concave along the rope, so the rope lifts off.
    LiftsOff,
    /// Friction across the rope is too small, so the rope slides sideways.
    SlidesSideways,
}

/// A value and its position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ExtremeReport {
    /// Arc length.
    pub s: f64,
    /// The value. Null if it is infinite.
    pub value: Option<f64>,
}
