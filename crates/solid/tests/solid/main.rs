//! The tests of this crate as one program: each more would link all crates again.

mod elasticity;
mod friction;
mod hertz;
mod methods;
mod patch;
mod pressure;
mod punch;
mod routes;
mod system;
mod unit;
mod zone;
