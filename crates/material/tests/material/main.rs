//! The tests of this crate as one program: each more would link all crates again.

mod elastic;
mod elastic_plastic;
mod hyperelastic;
mod orthotropic;
mod rubber;
