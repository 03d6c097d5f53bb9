//! Parts by themselves.

mod hyperelastic;
mod stiffness;
