//! Events: changes of the topology of the contact along a history.

use crate::obstacle::Side;
use signorini_geometry::Point;

/// A change of the contact between two times.
#[derive(Clone, Debug)]
pub struct Event<const D: usize> {
    pub kind: EventKind,
    /// The middle of the interval of time that holds the event, and the length of that.
    pub time: f64,
    pub within: f64,
    pub by: LocatedBy,
    pub at: Point<D>,
    /// What the zone touches, and which of the obstacles there.
    pub side: Side,
    pub obstacle: Option<usize>,
    /// Number of zones and of holes, before and after.
    pub zones: [usize; 2],
    pub holes: [usize; 2],
    /// Area of contact and force of the bodies on the membrane, before and after.
    pub area: [f64; 2],
    pub force: [f64; 2],
    /// Energy that a jump of an adhesive contact sets free; told once where one jump is several events.
    pub energy_released: Option<f64>,
}

/// Kinds of events.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// A zone of contact appears, or vanishes.
    Nucleation,
    Release,
    /// Two zones become one, or one becomes two.
    Merge,
    Split,
    /// A hole appears in a zone, or vanishes.
    HoleOpened,
    HoleClosed,
    /// Adhesion draws the membrane into contact at once, or lets go at once.
    SnapIn,
    PullOff,
}

impl EventKind {
    /// Whether it happens to a hole.
    pub fn is_of_hole(self) -> bool {
        matches!(self, Self::HoleOpened | Self::HoleClosed)
    }
}

/// How an event was located.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LocatedBy {
    /// By halving the interval.
    Bisection,
    /// By what vanishes as it draws near.
    Extrapolation,
}
