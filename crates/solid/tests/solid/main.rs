//! The tests of this crate as one program: each more would link all crates again.

mod elasticity;
mod pressed;
mod pressure;
mod punch;
mod system;
mod unit;
mod zone;
