//! The tests of this crate as one program: each more would link all crates again.

mod key_path;
mod unit;
