//! Parts by themselves.

mod hyperelastic;
mod rubber;
mod stiffness;
