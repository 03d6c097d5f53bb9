//! Events of a run: changes of topology of membranes, and of what contacts do.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A change of topology of the contact zones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Event {
    /// Name of the contact.
    pub contact: String,
    /// Kind of the event.
    pub kind: EventKind,
    /// Time of the event: the middle of the interval that contains it.
    pub time: f64,
    /// Length of the time interval that contains the event.
    pub within: f64,
    /// How the event was located.
    pub by: LocatedBy,
    /// Position.
    pub at: [f64; 3],
    /// Whether the rigid body of the zone is above the membrane.
    pub above: bool,
    /// Number of zones before the event.
    pub zones_before: usize,
    /// Number of zones after the event.
    pub zones_after: usize,
    /// Number of holes before the event.
    pub holes_before: usize,
    /// Number of holes after the event.
    pub holes_after: usize,
    /// Contact area before the event.
    pub area_before: f64,
    /// Contact area after the event.
    pub area_after: f64,
    /// Contact force before the event, along z.
    pub force_before: f64,
    /// Contact force after the event, along z.
    pub force_after: f64,
    /// Resultant of all loads along z at the time of the event.
    pub load_force: f64,
    /// Energy released in a jump of an adhesive contact. Reported once if one jump consists of several events.
    pub energy_released: Option<f64>,
}

/// A change of what a contact does as a whole.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ContactEvent {
    /// Name of the contact.
    pub contact: String,
    /// What it does from then on.
    pub kind: ContactEventKind,
    /// Time of the event: the middle of the interval that contains it.
    pub time: f64,
    /// Length of the time interval that contains the event.
    pub within: f64,
}

/// What a contact does from an event on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ContactEventKind {
    /// It is closed at a point at least; before it was open everywhere.
    Touch,
    /// It is open everywhere.
    LiftOff,
    /// All of it sticks.
    Stick,
    /// Part of it slips, part of it sticks.
    PartialSlip,
    /// All of it slips.
    Slip,
}

impl ContactEventKind {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Touch => "touches",
            Self::LiftOff => "lifts off",
            Self::Stick => "sticks",
            Self::PartialSlip => "slips in part",
            Self::Slip => "slips",
        }
    }
}

/// Kinds of events.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EventKind {
    /// A contact zone appears.
    Nucleation,
    /// A contact zone vanishes.
    Release,
    /// Two contact zones merge.
    Merge,
    /// A contact zone splits in two.
    Split,
    /// A hole in a contact zone appears.
    HoleOpened,
    /// A hole in a contact zone vanishes.
    HoleClosed,
    /// An adhesive contact jumps to the closed state. `energy_released` is the energy lost in the jump.
    SnapIn,
    /// An adhesive contact jumps to the open state. `energy_released` is the energy lost in the jump.
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
    /// The event was located by bisection of the increment.
    Bisection,
    /// The time of a merger was extrapolated: from the distance of the zones before it and the width of the neck after
    /// it.
    Extrapolation,
}
