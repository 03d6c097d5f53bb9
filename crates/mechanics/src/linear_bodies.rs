//! What a system keeps of bodies whose stiffness does not change.

use signorini_geometry::Point;
use signorini_solve::{Condensation, SymmetricMatrix};
use std::sync::{Mutex, OnceLock};

/// What a system keeps of its linear bodies.
#[derive(Default)]
pub struct LinearBodies {
    pub is_condensed: OnceLock<Vec<bool>>,
    pub reduced: Mutex<Option<Reduced>>,
}

/// The linear bodies of a system.
pub struct Reduced {
    /// The number of each unknown of the system among those of linear bodies, and back.
    pub place: Vec<u32>,
    pub unknowns: Vec<u32>,
    /// Without supports that prescribe unknowns.
    pub stiffness: SymmetricMatrix,
    pub row_sizes: Vec<f64>,
    pub positions: Vec<[f64; 3]>,
    /// What may touch: where, and the unknowns that move it.
    pub sites: Vec<(Point<3>, Vec<u32>)>,
    pub is_held: Vec<bool>,
    pub condensation: Option<Condensation>,
}
