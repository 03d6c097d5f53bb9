//! Bodies that are curves: ropes, cables and geometrically exact beams, and contact between curves.

pub mod beam;
pub mod hermite;
pub mod quaternion;
pub mod section;
