//! The history of a membrane: its increments by time, along a path of equilibria or to a given area, each from the one before,
//! with the changes of topology between.

mod between;
pub(crate) mod bridge;
mod differences;
mod engine;
mod event;
mod events;
mod increment;
mod level_set;
pub(crate) mod mergers;
mod messages;
mod nodal;
mod parts;
mod path;
mod path_point;
mod remark;
pub(crate) mod seek;
pub(crate) mod statement;
mod trail;
mod with_zones;

pub use event::{Event, EventKind, LocatedBy};
pub use increment::{Increment, Sample, Sampler, Stability};
pub use level_set::LINEAR;
pub use messages::{Advanced, Found, History, Messages};
pub use remark::{Remark, RemarkKind};
pub use statement::{Control, MethodChoice, PlannedIncrement, Statement};
pub(crate) use with_zones::WithZones;
