//! Parts by themselves.

mod elastic_plastic;
mod hyperelastic;
mod orthotropic;
mod rubber;
mod stiffness;
