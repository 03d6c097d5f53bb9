//! What a run tells of paths on rigid bodies: shortest ones, those of yarns, ropes on given curves.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The results of paths; of other models there are none.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathReports {
    /// Shortest paths, of `analysis = "wrapping"` alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub paths: Vec<PathReport>,
    /// Yarns, of `analysis = "winding"` alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub winding: Vec<WindingReport>,
    /// Ropes on given curves, of `analysis = "euler_eytelwein"` alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ropes: Vec<RopeReport>,
}

/// A shortest path over bodies.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathReport {
    /// Its name.
    pub name: String,
    /// Steps of Newton's method over all times.
    pub iterations: usize,
    /// Bodies that the path came to touch, or left.
    pub events: Vec<PathEvent>,
    /// One entry for each time.
    pub frames: Vec<PathFrame>,
}

/// A body that a path came to touch, or left.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathEvent {
    /// What happens.
    pub kind: PathEventKind,
    /// The first time at which it has happened.
    pub time: f64,
    /// Number of that time, from 0.
    pub frame: usize,
    /// Name of the body.
    pub body: String,
}

/// Kinds of events of paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PathEventKind {
    /// A path comes to touch a body.
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
    /// Steps of Newton's method.
    pub iterations: usize,
    /// The largest sine of an angle by which lines and geodesics do not join along their tangents.
    pub residual: f64,
    /// Pieces on bodies, in the order of the path.
    pub contacts: Vec<PathContact>,
    /// How a unit tension acts on each body of the case, by its name.
    pub moment_arms: BTreeMap<String, MomentArm>,
    /// Least and largest logarithm of end tension over start tension that friction holds; null without friction.
    pub log_ratio: Option<[f64; 2]>,
    /// How far friction lets each contact lie aside of the shortest path; null where the axes of friction go with the surface.
    pub sideways: Option<Vec<Option<SidewaysReport>>>,
    /// Least and largest tension at the end that friction holds; null without friction or without a tension.
    pub tension_limits: Option<[f64; 2]>,
    /// Share of friction that the end tensions use; above 1 the path slips.
    pub utilisation: Option<f64>,
    /// Whether the path slips along itself.
    pub slips: Option<bool>,
}

/// A piece of a path on a body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathContact {
    /// Name of the body.
    pub body: String,
    /// Arc length of the path where it meets the body.
    pub from: f64,
    /// Arc length of the path where it leaves it.
    pub to: f64,
    /// Length on the body.
    pub length: f64,
    /// Where it meets the body.
    pub start: [f64; 3],
    /// Where it leaves it.
    pub end: [f64; 3],
    /// Whether the piece is a shortest one between its ends; else only its ends hold it.
    pub minimal: bool,
}

/// How a path of unit tension acts on a body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MomentArm {
    /// The centre of the body.
    pub about: [f64; 3],
    /// Force on the body.
    pub shift: [f64; 3],
    /// Moment on the body about its centre: a length along each axis.
    pub turn: [f64; 3],
}

/// How far friction lets a rope lie aside of the shortest path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SidewaysReport {
    /// Largest drift across the path where it leaves the body.
    pub drift: f64,
    /// Largest turn of the path there, in radians.
    pub rotation: f64,
}

/// A yarn on a mandrel.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WindingReport {
    /// Its name.
    pub name: String,
    /// Distance from the axis at the start.
    pub start_radius: f64,
    /// Angle from the meridian at the start, in radians.
    pub start_angle: f64,
    /// The slippage that reaches the polar opening; null where it is stated.
    pub slippage_sought: Option<f64>,
    /// Where the yarn turns, of a path to a polar opening.
    pub turn: Option<TurnReport>,
    /// There and back, of a pattern.
    pub circuit: Option<CircuitReport>,
    /// How circuits follow each other.
    pub pattern: Option<PatternReport>,
    /// What the bands of all circuits cover.
    pub coverage: Option<CoverageReport>,
    /// Length of the yarn.
    pub length: f64,
    /// Angle around the axis from the start to the end, in radians.
    pub theta: f64,
    /// Largest ratio of geodesic to normal curvature.
    pub largest_slippage: f64,
    /// The same as a share of the friction; null without friction.
    pub utilisation: Option<f64>,
    /// Whether the yarn neither slips nor bridges.
    pub stable: bool,
    /// Arc lengths from where to where it does not lie on the mandrel.
    pub bridges: Vec<[f64; 2]>,
    /// Arc lengths from where to where it slips.
    pub slips: Vec<[f64; 2]>,
}

/// Where a yarn turns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TurnReport {
    /// Whether it turns at all.
    pub reached: bool,
    /// Distance of the middle of the band from the axis.
    pub radius: f64,
    /// Radius of the opening that the band leaves.
    pub opening_radius: f64,
    /// Angle around the axis from the start, in radians.
    pub theta: f64,
}

/// A yarn there and back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CircuitReport {
    /// Angle around the axis, in radians.
    pub angle: f64,
    /// Its length.
    pub length: f64,
    /// Angle from the meridian by which its end misses its start, in radians.
    pub mismatch: f64,
    /// Distances from the axis at both turns.
    pub turn_radii: [f64; 2],
    /// Radii of the openings there.
    pub opening_radii: [f64; 2],
}

/// How the circuits of a pattern follow each other.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PatternReport {
    /// Number of circuits.
    pub n: u32,
    /// Places of a band by which a circuit goes on, beside the full turns.
    pub k: u32,
    /// Full turns of a circuit.
    pub m: u32,
    /// Angle that each circuit is to turn more, in radians.
    pub dwell: f64,
    /// Circuits after which the first neighbour is laid.
    pub neighbour_after: u32,
    /// Whether the neighbour lies ahead: `leading` or `lagging`.
    pub lead: String,
}

/// What the bands of a pattern cover.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CoverageReport {
    /// Least number of circuits that covers the mandrel.
    pub circuits_for_full: u32,
    /// Share of the mandrel that is covered.
    pub covered: f64,
    /// Width that is left open between neighbours at the start.
    pub gap: f64,
    /// Width by which neighbours overlap there.
    pub overlap: f64,
    /// Length of all circuits.
    pub length_of_all: f64,
}

/// A rope on a given curve, by the theorem of Euler and Eytelwein for curves on surfaces.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RopeReport {
    /// Its name.
    pub name: String,
    /// Length of the curve.
    pub length: f64,
    /// Least and largest logarithm of end tension over start tension that friction holds.
    pub log_ratio: [f64; 2],
    /// Tension at the start.
    pub tension: f64,
    /// Tension at the end; null where it is not stated.
    pub end_tension: Option<f64>,
    /// Least and largest tension at the end that friction holds; null where the curve cannot be held at all.
    pub tension_limits: Option<[f64; 2]>,
    /// Whether the rope is in equilibrium where it lies.
    pub holds: bool,
    /// Share of friction that the end tensions use; null where the rope does not hold.
    pub utilisation: Option<f64>,
    /// In words.
    pub verdict: String,
    /// Parts of the curve on which a condition fails.
    pub violations: Vec<ViolationReport>,
    /// The largest angle between the force that holds the rope and the normal, as a tangent.
    pub largest_tan_alpha: ExtremeReport,
    /// The largest normal curvature: below zero the rope is pressed on.
    pub largest_normal_curvature: ExtremeReport,
    /// The largest distance of the curve from the surface.
    pub off_surface: f64,
}

/// A part of a curve on which a condition fails.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ViolationReport {
    /// Which condition.
    pub condition: RopeCondition,
    /// Arc length at which it begins to fail.
    pub from: f64,
    /// Arc length up to which it fails.
    pub to: f64,
    /// Arc length of the worst place.
    pub at: f64,
    /// Normal curvature there, or the tangent of the angle; null where that is infinite.
    pub value: Option<f64>,
    /// What it must stay below.
    pub limit: Option<f64>,
}

/// How a rope fails to lie on its curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RopeCondition {
    /// The surface is hollow along the rope, which leaves it.
    LiftsOff,
    /// Friction across the rope does not hold it.
    SlidesSideways,
}

/// A value and where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ExtremeReport {
    /// Arc length of the place.
    pub s: f64,
    /// The value there; null where it is infinite.
    pub value: Option<f64>,
}
