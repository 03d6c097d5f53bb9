//! Why a run or an increment ended, and what looked wrong: words for programs, with sentences for people.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Why a run or an increment ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// All equations and contact conditions hold within their tolerances.
    #[default]
    Converged,
    /// Equilibrium without contact.
    NoContact,
    /// The fronts did not converge. If zones are small or close to each other, use more cells, or refine = { fronts = 2 } in the mesh. Otherwise use smaller increments or a lower degree. method.active_set = {} gives a coarse picture of the zones.
    IterationLimit,
    /// There is no equilibrium with contact near `initial_zone`. At this load an adhesive contact may not exist. Use
    /// another zone, or a load at which the contact exists.
    NoSuchState,
    /// Arc-length or area control could not follow the path further; the last warning states where. Use smaller
    /// increments or more cells.
    PathLost,
    /// The linear system could not be solved. Check the supports, and whether the data differ by many orders of
    /// magnitude. The warning names the unknown.
    LinearSolver,
    /// Stopped by Ctrl-C. The increments computed so far are on disk. Continue with signorini run CASE --resume.
    Interrupted,
    /// Stopped at `limits`, or at --max-time or --max-iterations of the command. The increments computed so far are on
    /// disk. Continue with signorini run CASE --resume.
    LimitReached,
    /// A value became invalid during the run, for example a tension that is not positive at some time.
    Input,
    /// A body has a rigid motion without resistance, or its load pulls it away. The message names the body and the
    /// motion. Add a support, or press the body into contact.
    FreeBody,
    /// The equilibrium is unstable, and no state at rest was found after a disturbance. Add a support to the body named
    /// in the message. `stability = "tell"` retains unstable states.
    UnstableState,
    /// Newton's method did not converge. Use smaller increments.
    Newton,
    /// Temperatures and deformations do not agree, or nothing tells a temperature. The message names the body or the changes
    /// of the temperature. Use smaller increments, or a support with a temperature.
    Heat,
    /// The contact status alternates at the points named in the message. Use smaller increments, or finer cells at
    /// these points.
    Contact,
    /// The equations were solved, but the state is refused by the audit: bodies penetrate, forces are not in balance or violate a contact law, or the theory does not apply. `answer` and `audit` state what, where, and what to do. The results are on disk.
    Refused,
    /// In one increment the bodies penetrate each other far too deeply. Use more increments or a smaller prescribed
    /// motion.
    Increment,
}

impl Reason {
    /// Whether there is a state.
    pub fn is_converged(self) -> bool {
        matches!(self, Self::Converged | Self::NoContact)
    }
}

/// A warning: kind, message, time and position.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Warning {
    /// Kind of the warning. One warning of each kind is reported, from the first increment in which it occurs.
    pub kind: WarningKind,
    /// What is wrong, and what to do.
    pub message: String,
    /// Time at the end of the increment. Null if the warning is about the whole run.
    pub time: Option<f64>,
    /// Position. Null if it has none.
    pub at: Option<[f64; 3]>,
}

/// Kinds of warnings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WarningKind {
    /// A value of the case is unusual.
    Case,
    /// The load does not bring a body into contact.
    Apart,
    /// The error of the motion in an increment is larger than `dynamics.tolerance`.
    ErrorInTime,
    /// The surface has a kink within the contact zone of a membrane. The pressure along it is a line force, which is
    /// not included.
    Kink,
    /// The slopes of the membrane are too large for the linear theory.
    SteepSlopes,
    /// The direction of a front changes strongly within two cells.
    SharpFront,
    /// No state was found on smaller cells. The state on larger cells is reported.
    NotRefined,
    /// A front has fewer modes than `mode_count`.
    FewerModes,
    /// The fronts converged only to a fraction of a cell.
    FrontsAtRest,
    /// Zones that the grid does not resolve.
    NotResolved,
    /// The linear system could not be solved.
    LinearSolver,
    /// The equilibrium path ended or could not be followed.
    Path,
    /// The contact jumped to another state.
    Jump,
    /// The results contain unstable states, as requested.
    Unstable,
    /// An event could not be located to the requested tolerance.
    EventInterval,
    /// The strain is too large for the small-strain theory.
    LargeStrain,
    /// A hyperelastic material softens at its stretches: it is not stable there.
    UnstableMaterial,
    /// A cell is inverted at a point of its boundary: its stress is not defined there.
    InvertedCell,
    /// The sides of a contact do not face each other.
    NotFacing,
    /// The equilibrium or the contact forces may not be unique.
    NotUnique,
    /// Most of a contact with friction closes in one increment. The stick zones depend on the increments.
    ClosesAtOnce,
    /// The contact pressure oscillates from node to node of the slave. Resultants are right, pressures are not.
    PressureOscillates,
    /// Distance of the vertices of a mesh from the smooth surface through them.
    Scatter,
}

impl Warning {
    /// A warning about the whole run.
    pub fn new(kind: WarningKind, message: impl Into<String>) -> Self {
        Self { kind, message: message.into(), time: None, at: None }
    }

    /// The same, of the increment that ends at a time.
    pub fn at_time(self, time: f64) -> Self {
        Self { time: Some(time), ..self }
    }

    /// The same, at a place.
    pub fn at(self, at: [f64; 3]) -> Self {
        Self { at: Some(at), ..self }
    }
}

/// A warning about the case, from before it runs.
impl<T: Into<String>> From<T> for Warning {
    fn from(message: T) -> Self {
        Self::new(WarningKind::Case, message)
    }
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}
