//! Why a run or an increment ended, and what looked wrong: words for programs, with sentences for people.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Why a run or an increment ended as it did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// All conditions hold within the tolerances that the problem's own scales give.
    #[default]
    Converged,
    /// In equilibrium, and nothing touches.
    NoContact,
    /// The fronts did not come to rest. Try more cells, or refine = { fronts = 2 } in the mesh, where zones are small or close to each other; smaller increments; a lower degree. method.active_set = {} shows a coarse picture of the zones.
    IterationLimit,
    /// No equilibrium with contact near `initial_zone`: at this load adhesion may hold none. Try another zone, or a load at which the contact exists.
    NoSuchState,
    /// A path by arc length or area could not be followed further; the last warning says where. Try smaller increments, or more cells.
    PathLost,
    /// The equations could not be solved: is the body held, and are its data of one scale? The warning tells which unknown.
    LinearSolver,
    /// Stopped by Ctrl-C; the increments done are on disk. Go on with signorini run CASE --resume.
    Interrupted,
    /// Stopped at `limits`, or at --max-time or --max-iterations of the command; the increments done are on disk. Go on with signorini run CASE --resume.
    LimitReached,
    /// A value became invalid along the way, for example a tension that is not positive at some time.
    Input,
    /// A body can move without resistance in the way that is named, or its load pulls it away: hold it, or press it into contact.
    FreeBody,
    /// An equilibrium is unstable, and once disturbed nothing comes to rest near it: what is to hold the body that is named? `stability = "tell"` keeps such states.
    UnstableState,
    /// The iteration on large sliding did not end. Try smaller increments.
    Newton,
    /// The state of contact alternates at the places that are named. Try smaller increments or finer cells there.
    Contact,
    /// The equations were solved, and the state is no answer: an independent check found that bodies lie in each other, that forces do not balance or break a law, or that the theory does not hold. `answer` and `audit` say what, where, and what to do; the results are on disk.
    Refused,
    /// The increment brings bodies far too deep into each other. Try more increments, or a smaller motion.
    Increment,
}

impl Reason {
    /// Whether there is a state.
    pub fn is_converged(self) -> bool {
        matches!(self, Self::Converged | Self::NoContact)
    }
}

/// What looked wrong, of which kind, and where.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Warning {
    /// Which warning it is: one of each kind is told, of the first increment that has it.
    pub kind: WarningKind,
    /// What looked wrong, and what to try.
    pub message: String,
    /// The end of the increment, in the time of the case; null for what concerns all of it.
    pub time: Option<f64>,
    /// Where: coordinates of the place; null where it has none.
    pub at: Option<[f64; 3]>,
}

/// Kinds of warnings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WarningKind {
    /// A value of the case, or what it amounts to, is odd.
    Case,
    /// A body that the load does not bring to what it may touch.
    Apart,
    /// What a membrane touches has a kink within the contact: along it the pressure is a line force, which is left out.
    Kink,
    /// Slopes at which the theory of the membrane is not linear any more.
    SteepSlopes,
    /// A front that bends within two cells.
    SharpFront,
    /// No state on smaller cells: the one on larger cells stands.
    NotRefined,
    /// A front with fewer modes than `mode_count`.
    FewerModes,
    /// Fronts that came to rest to a part of a cell only.
    FrontsAtRest,
    /// Zones that the grid cannot tell apart.
    NotResolved,
    /// The equations could not be solved.
    LinearSolver,
    /// Where a path of equilibria ended, or why it could not be followed.
    Path,
    /// The contact jumped to another state.
    Jump,
    /// Unstable states among the results, where they were asked for.
    Unstable,
    /// An event that could not be located as closely as asked.
    EventInterval,
    /// Strain at which the theory of small strains errs.
    LargeStrain,
    /// Sides of a contact that do not face each other.
    NotFacing,
    /// With friction more than one equilibrium may exist.
    NotUnique,
    /// Most of a contact with friction closes in one increment: its stick zones depend on the increments.
    ClosesAtOnce,
    /// How far the vertices of a mesh lie off the smooth surface through them.
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
