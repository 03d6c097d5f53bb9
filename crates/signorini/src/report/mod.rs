//! What a run tells: one summary for all models, with the same keys and the same types.
//!
//! Numbers stand in the base units of the case. Vectors have three entries in every space: on a line and for membranes seen
//! from above `[x, y, z]` with z upward, in the plane and around an axis `[x, y, 0]`, x the radius around an axis. A figure
//! that a model does not have is null. The comments on the fields are what `signorini explain` and the reference tell.

mod contact;
mod events;
mod heat;
mod paths;
mod reason;
mod table;
pub mod words;

use crate::plan::reader::Interpreted;
use crate::problem::Space;
use crate::problem::units::{self, Units};
pub use contact::{Component, ContactReport, ErrorEstimate, ForceBounds, OtherState, RopeLimits, TractionKind};
pub use events::{ContactEvent, ContactEventKind, Event, EventKind, LocatedBy};
pub use heat::{BodyHeat, ContactHeatReport, HeatReport};
pub use paths::*;
pub use reason::{Reason, Warning, WarningKind};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use signorini_audit::{Answer, Finding};
use std::collections::BTreeMap;
pub use table::{Column, columns, headed, history, resultants, resultants_of, table};

/// Version of the keys of the summary.
pub const SCHEMA: u32 = 2;

/// Results of a run: the content of summary.json.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Summary {
    /// Version of the keys of the summary.
    pub schema: u32,
    /// Title of the case, or the name of its file.
    pub case: String,
    /// Whether all increments converged.
    pub converged: bool,
    /// Why the run or the increment ended. `signorini explain WORD` explains the reasons.
    pub reason: Reason,
    /// Result of the audit over all increments. Null if the run did not finish.
    #[serde(default)]
    pub answer: Option<Answer>,
    /// The result in a sentence.
    pub verdict: String,
    /// Contact discretisation, as in `contacts.NAME.method`.
    pub method: String,
    /// Largest number of unknowns that were solved for.
    pub unknowns: usize,
    /// Names of the base units of the case. Null if the case has none.
    pub units: Option<UnitNames>,
    /// The main picture, relative to the folder. Null without pictures.
    pub first_picture: Option<String>,
    /// Warnings from before or during the run.
    pub warnings: Vec<Warning>,
    /// Stress law of each solid, by the name of the body.
    #[serde(default)]
    pub materials: BTreeMap<String, String>,
    /// How values with units were converted: line, text, value, unit and factor.
    pub interpreted: Vec<Interpreted>,
    /// One entry per increment.
    pub steps: Vec<StepReport>,
    /// Changes of topology, in steps with `events`.
    pub events: Vec<Event>,
    /// When contacts of solids, ropes and beams touched, parted, stuck and slipped, in steps with `events`.
    #[serde(default)]
    pub contact_events: Vec<ContactEvent>,
    /// Results of paths on rigid bodies.
    #[serde(flatten)]
    pub of_paths: PathReports,
    /// Data of the computer and the run. Only these differ between two runs of one case.
    pub environment: Environment,
}

/// Names of the base units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct UnitNames {
    /// Unit of positions, displacements and gaps.
    pub length: String,
    /// Unit of contact areas; of length for a string and in the plane.
    pub area: String,
    /// Unit of forces; in the plane for a body of thickness one.
    pub force: String,
    /// Unit of pressures and stresses.
    pub pressure: String,
    /// Unit of line loads, for ropes, beams and edges.
    #[serde(default)]
    pub line_load: String,
    /// Unit of moments.
    #[serde(default)]
    pub moment: String,
    /// Unit of energies.
    pub energy: String,
    /// Unit of physical times.
    pub time: String,
    /// Unit of velocities.
    #[serde(default)]
    pub velocity: String,
    /// Scale of temperatures.
    #[serde(default)]
    pub temperature: String,
    /// Unit of flows of heat.
    #[serde(default)]
    pub heat_flow: String,
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
            velocity: units.written(units::VELOCITY),
            temperature: units.names[3].replace("deg", "°"),
            heat_flow: units.written(units::POWER),
        }
    }
}

/// The state at the end of an increment.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StepReport {
    /// Number of the increment, from 0.
    pub index: usize,
    /// Time at the end of the increment.
    pub time: f64,
    /// Whether the increment converged.
    pub converged: bool,
    /// Why the run or the increment ended. `signorini explain WORD` explains the reasons.
    pub reason: Reason,
    /// Findings of the audit: all that are reported or refused. For each other check, the finding closest to its limit.
    #[serde(default)]
    pub audit: Vec<Finding>,
    /// Number of equilibrium solves on the final cells. For solids, number of iterations of Newton's method.
    pub iterations: usize,
    /// Number of equilibrium solves on larger cells and in cut-backs before this state.
    pub iterations_before: usize,
    /// Linear solver. `direct`: factorisation. `condensed`: linear bodies are factorised once, and a dense system
    /// contains what contact changes. `direct with krylov`: the multipliers of large contact zones are eliminated
    /// before a Cholesky factorisation, which preconditions a Krylov method. `multigrid`: multigrid. `schwarz`:
    /// iterative with a Schwarz preconditioner. `petsc`: PETSc, by one or several processes.
    pub solver: String,
    /// Largest number of iterations of an iterative solver for one linear system.
    pub linear_iterations: Option<usize>,
    /// Residual of each iteration, relative to its tolerance.
    pub residual_history: Vec<f64>,
    /// Elastic energy of the bodies, with that of kinematic hardening. For a membrane its potential energy, which is the elastic energy minus the work of
    /// the load.
    pub energy: Option<f64>,
    /// Energy dissipated by plastic strain in the increment. Null without elastic-plastic bodies.
    #[serde(default)]
    pub plastic_dissipation: Option<f64>,
    /// `energy` minus the adhesion energy of the contact zones.
    pub energy_total: Option<f64>,
    /// Kinetic energy of all bodies. Null in equilibrium.
    #[serde(default)]
    pub kinetic_energy: Option<f64>,
    /// Energy that damping took in the increment, that of the method in time included. Null in equilibrium.
    #[serde(default)]
    pub damping_dissipation: Option<f64>,
    /// Integral of the deflection of a membrane.
    pub volume: Option<f64>,
    /// Largest slope of the membrane. The theory is linear and valid for slopes much smaller than 1.
    pub max_slope: Option<f64>,
    /// Largest principal strain of solids. Small strains are assumed.
    pub max_strain: Option<f64>,
    /// Stability of the state, for systems beyond small strains and systems of rigid bodies; null for others.
    #[serde(default)]
    pub stability: Option<StabilityReport>,
    /// Sum of all forces, relative to the largest one. Round-off in equilibrium.
    pub equilibrium_residual: Option<f64>,
    /// Force of each support on the body, by the name of the support.
    pub support_forces: BTreeMap<String, [f64; 3]>,
    /// Force of each constraint on its nodes per unit of their factors, by the name of the constraint.
    #[serde(default)]
    pub constraint_forces: BTreeMap<String, f64>,
    /// Resultant of each load, by the name of the load.
    pub load_forces: BTreeMap<String, [f64; 3]>,
    /// Point about which moments are reported: the origin, or `output.moments_about`. Null if no moments are reported.
    #[serde(default)]
    pub moments_about: Option<[f64; 3]>,
    /// Moment of each support on the body in the current configuration, by the name of the support.
    #[serde(default)]
    pub support_moments: BTreeMap<String, [f64; 3]>,
    /// Resultant moment of each load, by the name of the load.
    #[serde(default)]
    pub load_moments: BTreeMap<String, [f64; 3]>,
    /// Results of each contact, by its name.
    pub contacts: BTreeMap<String, ContactReport>,
    /// Values at the points of `output.probes`, by their names. Null outside the body.
    pub probes: BTreeMap<String, Option<Probe>>,
    /// Ropes and beams, by their names.
    #[serde(default)]
    pub curves: BTreeMap<String, CurveReport>,
    /// Bodies of finite cells by their names, as samples of a material that fills their box.
    #[serde(default)]
    pub cells: BTreeMap<String, CellsReport>,
    /// Free rigid bodies, by their names.
    #[serde(default)]
    pub free_bodies: BTreeMap<String, Pose>,
    /// How bodies with a mass move, by their names. Empty in equilibrium.
    #[serde(default)]
    pub motion: BTreeMap<String, MotionReport>,
    /// Temperatures and flows of heat. Null without bodies that have a temperature.
    #[serde(default)]
    pub heat: Option<HeatReport>,
}

/// Stability of an equilibrium: the second variation of the energy on the admissible motions.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StabilityReport {
    /// Whether no small disturbance lowers the energy.
    pub stable: bool,
    /// Number of negative eigenvalues of the tangent on the admissible motions; 0 for a stable state.
    pub negative_eigenvalues: usize,
    /// Number of unstable states that were left before this state.
    pub followed: usize,
    /// Body with the largest motion when the first unstable state is left. Null if all states were stable.
    pub body: Option<String>,
    /// Time at which stability was lost, if it was in this increment.
    pub critical_time: Option<f64>,
}

/// A rope or beam at the end of an increment. The axial force of a rope is not negative.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CurveReport {
    /// Tension at the start: of a rope without what acts along half a cell; of a beam the axial force in the first cell.
    pub start_tension: f64,
    /// Tension at the end: of a rope without what acts along half a cell; of a beam the axial force in the last cell.
    pub end_tension: f64,
    /// Largest axial force.
    pub max_tension: f64,
    /// Smallest axial force.
    pub min_tension: f64,
    /// Number of cells without tension.
    pub slack_cells: usize,
    /// Bending moments, shear forces and torque. Null without bending stiffness.
    #[serde(default)]
    pub section: Option<SectionReport>,
    /// Unstrained length of the rope that is paid out, for straight elements. A winch changes it.
    pub unstrained_length: Option<f64>,
}

/// Stress resultants of the sections of a beam: magnitudes of vectors in the section.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SectionReport {
    /// Bending moment at the start.
    pub start_bending_moment: f64,
    /// Bending moment at the end.
    pub end_bending_moment: f64,
    /// Largest bending moment.
    pub max_bending_moment: f64,
    /// Arc length at which it occurs.
    pub max_bending_moment_at: f64,
    /// Largest shear force. Null if the model has no shear.
    pub max_shear_force: Option<f64>,
    /// Largest torque, with its sign. Null if the model has no torsion.
    pub max_torque: Option<f64>,
}

/// A body of finite cells as a sample of a material that fills its box, for the stress-strain curve.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CellsReport {
    /// Mean normal stresses along the axes: integral over the material, divided by the volume of the box.
    pub mean_stress: [f64; 3],
    /// Mean strains along the axes: relative displacement of opposite sides of the box, divided by their distance. Null
    /// if there is no material on one side.
    pub mean_strain: [Option<f64>; 3],
}

/// How a body moves with inertia.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MotionReport {
    /// Mass of the body.
    pub mass: f64,
    /// Kinetic energy of the body.
    pub kinetic_energy: f64,
    /// Velocity of the centre of mass: the momentum over the mass.
    pub velocity: [f64; 3],
    /// Angular momentum about the origin.
    pub angular_momentum: [f64; 3],
}

/// Displacement and rotation of a free rigid body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Pose {
    /// Displacement of the centre since the start.
    pub displacement: [f64; 3],
    /// Rotation vector in radians since the start, which tells how the body lies; full turns included while it turns about one axis.
    pub rotation: [f64; 3],
    /// How far it has turned about the axes of space, in radians: the rotation vectors of all increments, summed; full turns
    /// included, about whatever axes.
    #[serde(default)]
    pub turned: [f64; 3],
}

/// Values at a point of `output.probes`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Probe {
    /// Position of the point in the undeformed body. Outside of solids and finite cells the nearest point that is shown.
    pub at: [f64; 3],
    /// Displacement of the point.
    pub displacement: [f64; 3],
    /// Whether the point is in a contact zone. Null for solids.
    pub in_contact: Option<bool>,
    /// Contact pressure at the point; null for solids.
    pub pressure: Option<f64>,
    /// Equivalent stress (von Mises). Null for membranes.
    pub von_mises: Option<f64>,
    /// Temperature; null for bodies without one.
    #[serde(default)]
    pub temperature: Option<f64>,
}

/// Data that may differ between two runs of one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Environment {
    /// Version of the program.
    pub version: String,
    /// Wall time of the run in seconds.
    pub wall_seconds: f64,
    /// Processor time of the run in seconds, summed over all threads.
    pub cpu_seconds: Option<f64>,
    /// Peak memory in bytes.
    pub peak_memory: Option<u64>,
    /// Memory in bytes that the bodies and the equations were estimated to need before the run: on a machine, of all processes there.
    /// Null of membranes, ropes and beams.
    #[serde(default)]
    pub estimated_memory: Option<u64>,
    /// Wall time of the audit in seconds.
    #[serde(default)]
    pub audit_seconds: f64,
    /// Number of threads. Results do not depend on it.
    pub threads: usize,
    /// Hash of the text of the case.
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
