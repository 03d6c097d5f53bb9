//! Parts by themselves.

mod assembly;
mod friction_solve;
mod hyperelastic;
mod model;
