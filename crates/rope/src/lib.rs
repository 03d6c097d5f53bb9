//! Bodies that are curves: ropes, cables and geometrically exact beams, and contact between curves.
//!
//! - [`path`]: the curve along which a body lies at the start; [`centreline`]: the curve that its numbers make.
//! - [`section`]: shapes and stiffness of cross-sections; [`quaternion`]: how they turn; [`mass`]: what they weigh.
//! - [`beam`]: geometrically exact beams with shear and torsion.
//! - [`cable`]: smooth cables, and beams free of torsion.
//! - [`chain`]: ropes and nets of straight elements; the search of their form.
//! - [`curve_body`]: what all of them have in common where they touch; [`place`]: how they are held and loaded.
//! - [`curve_pair`]: contact between curves.
//! - [`fields`]: how they are shown.

pub mod beam;
pub mod cable;
pub mod centreline;
pub mod chain;
pub mod curve_body;
pub mod curve_pair;
pub mod fields;
pub mod hermite;
pub mod mass;
pub mod path;
pub mod place;
pub mod quaternion;
pub mod section;

/// Inner parts for the tests in `tests`; no part of the interface.
#[doc(hidden)]
pub mod testing {
    pub use crate::curve_pair::passage::{Moved, crossing, distance, roots, touching};
    pub use crate::curve_pair::side::in_cone;
    pub use crate::path::read::points;
}
