//! Parts by themselves.

mod admissible;
mod rigid_system;
mod rotation;
mod stability;
