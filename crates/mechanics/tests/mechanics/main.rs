//! The tests of this crate as one program: each more would link all crates again.

mod common;
mod free;
mod patch;
mod tangents;
mod unit;
