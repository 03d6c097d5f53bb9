//! The tests of this crate as one program: each more would link all crates again.

mod meshes;
mod ropes;
mod winding;
mod wrapping;
