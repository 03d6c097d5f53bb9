//! Contact with friction, small sliding: the equations of the tractions, and their solution.
//!
//! The bodies are linear, so everything happens on the tractions `z` of the rows, those of a node one after the other:
//! pressure, then friction. With the compliance `W = B K⁻¹ Bᵀ` the weighted gaps and slips are `y = q + W z`, and
//!
//! ```text
//! z = Π(z - c y)        node by node, Π the law, c > 0
//! ```
//!
//! - [`problem`]: nodes, and what is known of the compliance; the natural residual.
//! - [`newton`]: the semismooth Newton method (Alart & Curnier 1991; Hüeber, Stadler & Wohlmuth 2008).
//! - [`ladder`]: what is tried where it cycles.
//! - [`slip`]: weighted slips of two surfaces, beside their weighted gaps.
//! - [`contact`]: the rows of bodies, and their state at one time.

pub mod contact;
pub mod ladder;
pub mod newton;
pub mod problem;
pub mod slip;

pub use contact::{Bodies, FrictionState, FrictionalContact};
pub use ladder::{FrictionError, Solution, solve};
pub use problem::{Node, Problem, RowCompliance};
pub use slip::{NoAxis, WeightedSlip, slips_of_points, weighted_slips};

#[cfg(test)]
mod tests;
