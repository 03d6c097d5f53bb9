//! Parts by themselves.

mod stiffness;
