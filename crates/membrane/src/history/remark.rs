//! What looks wrong in a history.

/// A remark on a state, or on the way to it.
#[derive(Clone, Debug)]
pub struct Remark {
    pub kind: RemarkKind,
    /// What looks wrong, and what to try.
    pub message: String,
    /// The end of the increment.
    pub time: Option<f64>,
    /// Coordinates of the place.
    pub at: Option<Vec<f64>>,
}

/// Kinds of remarks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RemarkKind {
    /// What the membrane touches has a kink within the contact.
    Kink,
    /// Slopes at which the theory of the membrane is not linear any more.
    SteepSlopes,
    /// A front that bends within two cells.
    SharpFront,
    /// No state on smaller cells: the one on larger cells stands.
    NotRefined,
    /// A front with fewer modes than were asked for.
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
}

impl Remark {
    pub fn new(kind: RemarkKind, message: impl Into<String>) -> Self {
        Self { kind, message: message.into(), time: None, at: None }
    }

    /// The same, of the increment that ends at a time.
    pub fn at_time(self, time: f64) -> Self {
        Self { time: Some(time), ..self }
    }

    /// The same, at a place.
    pub fn at(self, at: &[f64]) -> Self {
        Self { at: Some(at.to_vec()), ..self }
    }
}
