//! Parts by themselves.

mod admissible;
mod contact_law;
mod polyhedra;
mod rigid_dynamics;
mod rigid_system;
mod rotation;
mod stability;
mod time_step;
