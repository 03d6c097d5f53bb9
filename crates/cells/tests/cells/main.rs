//! The tests of this crate as one program: each more would link all crates again.

mod system;
mod unit;
mod validation;
