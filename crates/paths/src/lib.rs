//! Paths of ropes, tendons and yarns on surfaces.
//!
//! Every rigid shape of the geometry is a surface here: its level function gives the normal and all curvatures. The frame
//! of a curve on it is that of Darboux: `τ` along the curve, `n` outward, `g = τ × n`, `τ' = k_g g + k_n n`; `k_n < 0` where
//! a rope presses on a convex body.
//!
//! - [`darboux`]: frames and curvatures of a given curve.
//! - [`smooth_mesh`]: triangle meshes as smooth surfaces.
//! - [`theorem`]: whether a rope holds on a given curve with orthotropic friction, and between which tensions.
//! - [`friction`]: orthotropic friction of a rope, its axes carried along or those of the surface.
//! - [`partial_slip`]: how far a rope slips when its end is loaded and unloaded.
//! - [`geodesic`]: straightest curves with their natural variations.
//! - [`wrapping`]: shortest paths over bodies, with exact derivatives.
//! - [`winding`]: paths of yarns on mandrels, polar openings, patterns.

mod banded;
pub mod curve;
pub mod darboux;
mod error;
pub mod friction;
pub mod geodesic;
mod ode;
pub mod partial_slip;
mod quadrature;
mod root;
pub mod smooth_mesh;
pub mod surface;
pub mod theorem;
pub mod winding;
pub mod wrapping;

pub use error::{PathError, Place};
