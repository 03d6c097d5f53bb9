//! The tests of this crate as one program: each more would link all crates again.

mod common;
mod cycles;
mod derivatives;
mod mesh_multigrid;
mod mesh_slivers;
mod multigrid;
mod published;
mod slivers;
mod unit;
