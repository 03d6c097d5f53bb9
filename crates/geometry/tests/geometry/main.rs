//! The tests of this crate as one program: each more would link all crates again.

mod brute_force;
mod continua;
mod derivatives;
mod implicit_surface;
mod mesh;
mod scale;
