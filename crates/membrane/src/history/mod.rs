//! The history of a membrane: its increments by time, along a path of equilibria or to a given area, each from the one before,
//! with the changes of topology between.

mod between;
pub(crate) mod bridge;
mod differences;
mod engine;
mod event;
mod events;
mod increment;
mod known;
mod level_set;
pub(crate) mod mergers;
mod nodal;
mod parts;
mod path;
mod remark;
pub(crate) mod seek;
pub(crate) mod statement;
mod told;
mod trail;
mod with_zones;

pub use event::{Event, EventKind, LocatedBy};
pub use increment::{Increment, Sample, Sampler, Stability};
pub use level_set::LINEAR;
pub use remark::{Remark, RemarkKind};
pub use statement::{Control, MethodChoice, PlannedIncrement, Statement};
pub use told::{Advanced, Found, History, Told};
pub(crate) use with_zones::WithZones;
