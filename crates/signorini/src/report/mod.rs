//! What a run tells: one summary for all models, with the same keys and the same types.
//!
//! Numbers stand in the base units of the case. Vectors have three entries in every space: on a line and for membranes seen
//! from above `[x, y, z]` with z upward, in the plane and around an axis `[x, y, 0]`, x the radius around an axis. A figure
//! that a model does not have is null. The comments on the fields are what `signorini explain` and the reference tell.

mod contact;
mod paths;
mod reason;
mod table;
pub mod words;

use crate::plan::reader::Interpreted;
use crate::problem::Space;
use crate::problem::units::{self, Units};
pub use contact::{Carried, Component, ContactReport, ErrorEstimate, ForceBounds, OtherState, RopeLimits};
pub use paths::*;
pub use reason::{Reason, Warning, WarningKind};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use signorini_audit::{Answer, Finding};
use std::collections::BTreeMap;
pub use table::{history, resultants, table};

/// Version of the keys of the summary.
pub const SCHEMA: u32 = 2;

/// The results of a run in numbers and words: the content of summary.json.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Summary {
    /// Version of the keys of the summary.
    pub schema: u32,
    /// The title of the case, or the name of its file.
    pub case: String,
    /// Whether all increments were solved, each to its tolerance.
    pub converged: bool,
    /// Why the run or the increment ended as it did: a word of its own, which `explain` knows.
    pub reason: Reason,
    /// What an independent check of the increments came to; null where the run has not come to its end.
    #[serde(default)]
    pub answer: Option<Answer>,
    /// The result in a sentence.
    pub verdict: String,
    /// How the contact was found; as in `contacts.NAME.method`.
    pub method: String,
    /// Number of unknowns that were solved for, at most.
    pub unknowns: usize,
    /// The base units of the case by name; null where it states none.
    pub units: Option<UnitNames>,
    /// The picture to open first, within the folder; null without pictures.
    pub first_picture: Option<String>,
    /// What looked wrong before or during the run.
    pub warnings: Vec<Warning>,
    /// What the values with units were taken for: line, text, value, unit and factor.
    pub interpreted: Vec<Interpreted>,
    /// One entry for each increment.
    pub steps: Vec<StepReport>,
    /// Changes of topology, in steps that ask for `events`.
    pub events: Vec<Event>,
    /// What was found of paths on rigid bodies.
    #[serde(flatten)]
    pub of_paths: PathReports,
    /// Where and when it ran: all that differs between two runs of one case.
    pub environment: Environment,
}

/// What the base units of a case are called, as people write them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct UnitNames {
    /// Of places, displacements and gaps.
    pub length: String,
    /// Of areas of contact: of length for a string and in the plane.
    pub area: String,
    /// Of forces; in the plane of a body of thickness one.
    pub force: String,
    /// Of pressures and stresses.
    pub pressure: String,
    /// Of forces per length, that ropes, beams and edges carry.
    #[serde(default)]
    pub line_load: String,
    /// Of moments.
    #[serde(default)]
    pub moment: String,
    /// Of energies.
    pub energy: String,
    /// Of times that stand for times.
    pub time: String,
}

impl UnitNames {
    /// Those of the results of a case.
    pub fn new(units: &Units, space: Space) -> Self {
        let is_length = matches!(space, Space::Line | Space::PlaneStrain | Space::PlaneStress);
        Self {
            length: units.written(units::LENGTH),
            area: units.written(if is_length { units::LENGTH } else { units::AREA }),
            force: units.written(units::FORCE),
            pressure: units.written(units::PRESSURE),
            line_load: units.written(units::FORCE_PER_LENGTH),
            moment: format!("{}·{}", units.written(units::FORCE), units.written(units::LENGTH)),
            energy: units.written(units::ENERGY),
            time: units.written(units::TIME),
        }
    }
}

/// The state at the end of an increment.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StepReport {
    /// Number of the increment, from 0.
    pub index: usize,
    /// The end of the increment, in the time of the case.
    pub time: f64,
    /// Whether the increment was solved to its tolerance.
    pub converged: bool,
    /// Why the run or the increment ended as it did: a word of its own, which `explain` knows.
    pub reason: Reason,
    /// What an independent check of the state found: all that is in doubt or refused, and of each other check what came nearest to
    /// its limit.
    #[serde(default)]
    pub audit: Vec<Finding>,
    /// Equilibrium solves on the cells of the state; for solids the steps of the active set or of Newton's method.
    pub iterations: usize,
    /// Equilibrium solves on larger cells, and on the way to the state.
    pub iterations_before: usize,
    /// `direct` by factorisation, `condensed` where linear bodies are factorised once and what contact changes is solved for in a
    /// dense system, `direct with krylov` where the tractions of a large zone of contact are found by steps of a
    /// Krylov method, each a solve with the factors, `multigrid`, or `schwarz` by iterations with a Schwarz preconditioner.
    pub solver: String,
    /// The most iterations that an iterative solver took for one linear system.
    pub linear_iterations: Option<usize>,
    /// Residual of each solve, relative to its tolerance; for solids with small sliding the nodes that changed their state.
    pub residual_history: Vec<f64>,
    /// Elastic energy that the bodies store; of a membrane its potential energy, which is that less the work of the load.
    pub energy: Option<f64>,
    /// `energy` less what adhesion gives back.
    pub energy_total: Option<f64>,
    /// Integral of the deflection of a membrane.
    pub volume: Option<f64>,
    /// Steepest slope of the membrane: the theory is linear, for slopes well below 1.
    pub max_slope: Option<f64>,
    /// Largest principal strain of solids: the theory is that of small strains.
    pub max_strain: Option<f64>,
    /// Whether the state is stable, of systems whose bodies deform by more than small strains, or are all rigid; null for others.
    #[serde(default)]
    pub stability: Option<StabilityReport>,
    /// Sum of all forces, relative to the largest: round-off where all is well.
    pub equilibrium_residual: Option<f64>,
    /// Force of each support on the body, by its name.
    pub support_forces: BTreeMap<String, [f64; 3]>,
    /// Resultant of each load, by its name.
    pub load_forces: BTreeMap<String, [f64; 3]>,
    /// The point about which moments are told: the origin, or `output.moments_about`; null where none are.
    #[serde(default)]
    pub moments_about: Option<[f64; 3]>,
    /// Moment of each support on the body, by its name, where bodies are now.
    #[serde(default)]
    pub support_moments: BTreeMap<String, [f64; 3]>,
    /// Resultant moment of each load, by its name.
    #[serde(default)]
    pub load_moments: BTreeMap<String, [f64; 3]>,
    /// Results by the name of the contact.
    pub contacts: BTreeMap<String, ContactReport>,
    /// Values at the probes of `output.probes`, by their names; null outside the body.
    pub probes: BTreeMap<String, Option<Probe>>,
    /// Ropes and beams by their names.
    #[serde(default)]
    pub curves: BTreeMap<String, CurveReport>,
    /// Bodies of cells by their names, as pieces of a material that fills their box.
    #[serde(default)]
    pub cells: BTreeMap<String, CellsReport>,
    /// Free rigid bodies by their names.
    #[serde(default)]
    pub free_bodies: BTreeMap<String, Pose>,
}

/// Whether an equilibrium is stable: by the second variation of the energy on what supports and contacts admit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StabilityReport {
    /// Whether no disturbance makes the energy fall.
    pub stable: bool,
    /// Negative eigenvalues of the tangent on what may move: none of a stable state.
    pub negative_eigenvalues: usize,
    /// Number of unstable states that were left on the way to this one.
    pub followed: usize,
    /// The body that moves most as the first unstable state is left; null where all were stable.
    pub body: Option<String>,
    /// When stability was lost, where that was in this increment.
    pub critical_time: Option<f64>,
}

/// A rope or beam at the end of an increment: its axial force, of a rope never negative.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CurveReport {
    /// In the first cell.
    pub start_tension: f64,
    /// In the last cell.
    pub end_tension: f64,
    /// Largest axial force.
    pub max_tension: f64,
    /// Least axial force.
    pub min_tension: f64,
    /// Number of cells without tension.
    pub slack_cells: usize,
    /// Bending moments, shear forces and torque, of what resists bending; null for others.
    #[serde(default)]
    pub section: Option<SectionReport>,
    /// Length without tension of the rope that is out, where it has straight elements: a winch changes it.
    pub unstrained_length: Option<f64>,
}

/// What the sections of a beam carry: sizes of vectors across it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SectionReport {
    /// Bending moment at the start.
    pub start_bending_moment: f64,
    /// Bending moment at the end.
    pub end_bending_moment: f64,
    /// Largest bending moment.
    pub max_bending_moment: f64,
    /// Where along the beam that is.
    pub max_bending_moment_at: f64,
    /// Largest shear force; null where the model has no shear.
    pub max_shear_force: Option<f64>,
    /// Largest torque, with its sign; null where the model has no torsion.
    pub max_torque: Option<f64>,
}

/// A body of cells as a piece of a material that fills its box: its stress-strain curve, step by step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CellsReport {
    /// Normal stresses along the axes, summed over the material and divided by the volume of the box.
    pub mean_stress: [f64; 3],
    /// How far the material on opposite sides of the box moved apart, over their distance; null where there is none on one.
    pub mean_strain: [Option<f64>; 3],
}

/// Where a free rigid body has come.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Pose {
    /// Displacement of its centre since the start.
    pub displacement: [f64; 3],
    /// Rotation vector in radians since the start, whole turns included.
    pub rotation: [f64; 3],
}

/// Values at a place that `output.probes` names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Probe {
    /// The place where the values stand, at rest; of solids the nearest point of the display.
    pub at: [f64; 3],
    /// How far the point has moved.
    pub displacement: [f64; 3],
    /// Whether the point is within a zone of contact; null for solids.
    pub in_contact: Option<bool>,
    /// Contact pressure at the point; null for solids.
    pub pressure: Option<f64>,
    /// Equivalent stress of von Mises; null for membranes.
    pub von_mises: Option<f64>,
}

/// One change of topology.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Event {
    /// The contact that it changes.
    pub contact: String,
    /// What happens.
    pub kind: EventKind,
    /// The middle of the interval of time that holds the event.
    pub time: f64,
    /// Length of the interval of time that holds the event.
    pub within: f64,
    /// How the event was located.
    pub by: LocatedBy,
    /// Where: coordinates of the place.
    pub at: [f64; 3],
    /// Whether what the zone touches lies above the membrane.
    pub above: bool,
    /// Zones before the event.
    pub zones_before: usize,
    /// Zones after the event.
    pub zones_after: usize,
    /// Holes before the event.
    pub holes_before: usize,
    /// Holes after the event.
    pub holes_after: usize,
    /// Area of contact before the event.
    pub area_before: f64,
    /// Area of contact after the event.
    pub area_after: f64,
    /// Contact force before the event, along z.
    pub force_before: f64,
    /// Contact force after the event, along z.
    pub force_after: f64,
    /// Resultant of all loads along z at that time.
    pub load_force: f64,
    /// Energy that a jump of an adhesive contact sets free; told once where one jump is several events.
    pub energy_released: Option<f64>,
}

/// Kinds of events.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EventKind {
    /// A zone of contact appears.
    Nucleation,
    /// A zone of contact vanishes.
    Release,
    /// Two zones become one.
    Merge,
    /// A zone becomes two.
    Split,
    /// A hole appears in a zone.
    HoleOpened,
    /// A hole in a zone vanishes.
    HoleClosed,
    /// Adhesion draws the membrane into contact at once; `energy_released` is what is lost in the jump.
    SnapIn,
    /// The contact jumps open; `energy_released` is what is lost in the jump.
    PullOff,
}

impl EventKind {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Nucleation => "nucleation",
            Self::Release => "release",
            Self::Merge => "merge",
            Self::Split => "split",
            Self::HoleOpened => "hole opened",
            Self::HoleClosed => "hole closed",
            Self::SnapIn => "snap in",
            Self::PullOff => "pull off",
        }
    }

    /// Whether it is one of holes.
    pub fn is_of_hole(self) -> bool {
        matches!(self, Self::HoleOpened | Self::HoleClosed)
    }
}

/// Ways to locate an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LocatedBy {
    /// Way in which an event was located: the increment was halved.
    Bisection,
    /// Way in which a merger was located: from how the distance before it and the neck after it vanish.
    Extrapolation,
}

/// All that may differ between two runs of one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Environment {
    /// Version of the program.
    pub version: String,
    /// Time that the run took.
    pub wall_seconds: f64,
    /// Processor time that the run took, over all threads.
    pub cpu_seconds: Option<f64>,
    /// Most memory in use, in bytes.
    pub peak_memory: Option<u64>,
    /// Part of the wall time that the independent checks took.
    #[serde(default)]
    pub audit_seconds: f64,
    /// Number of threads; results do not depend on it.
    pub threads: usize,
    /// Fingerprint of the text of the case.
    pub input_hash: String,
}

impl Summary {
    /// As JSON, the keys in the order of the types.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

impl StepReport {
    /// All that was solved for a state, also on larger cells before.
    pub fn solves(&self) -> usize {
        self.iterations_before + self.iterations
    }
}

/// A place or a vector of the plane or of a line, with zeros for what it does not have.
pub fn vector<const D: usize>(x: &signorini_geometry::Point<D>) -> [f64; 3] {
    std::array::from_fn(|k| if k < D { x[k] } else { 0.0 })
}

/// The size of a force, with the sign of its largest component.
pub fn signed_size(force: &[f64; 3]) -> f64 {
    let largest = force.iter().copied().fold(0.0, |m: f64, v| if v.abs() > m.abs() { v } else { m });
    let size = force.iter().map(|v| v * v).sum::<f64>().sqrt();
    // One component alone keeps its digits.
    if size == largest.abs() { largest } else { size.copysign(largest) }
}
