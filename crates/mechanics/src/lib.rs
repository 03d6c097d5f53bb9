//! Bodies of any kind in one system.
//!
//! - [`body`]: what a body is to the system.

pub mod body;
pub mod pair;

pub use body::{
    Anchor, Bend, Body, BodyError, BodyFields, BodyState, Constraint, Contribution, Foot, Function, Hold, Load, Master,
    MaterialPoint, Met, Order, PlaceError, Placed, RigidFoot, Sampling, Site,
};
