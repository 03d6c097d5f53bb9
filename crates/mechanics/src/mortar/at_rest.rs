//! What small sliding keeps: measures with the bodies at rest.

use super::face_terms::FaceTerms;
use super::measured::{Measured, NodeMeasure};
use std::sync::{Arc, OnceLock};

/// The measures with the bodies at rest, and the displacements from which slips count.
#[derive(Default)]
pub struct SmallSliding {
    /// Found when it is first asked for in an increment.
    pub at_rest: OnceLock<Arc<AtRest>>,
    /// Displacements of slave and master at the last state.
    pub since: [Vec<f64>; 2],
}

/// Both sides with deformable bodies at rest.
pub struct AtRest {
    pub measured: Arc<Measured>,
    pub measures: Vec<NodeMeasure>,
    /// Rows and columns of all nodes.
    pub terms: FaceTerms,
}

impl SmallSliding {
    /// Forgets what was found for another time, or before what follows from the last state changed.
    pub fn forget(&mut self) {
        self.at_rest = OnceLock::new();
    }
}
