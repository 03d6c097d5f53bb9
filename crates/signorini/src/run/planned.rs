//! A plan as the runner sees it.

use super::driver::Model;
use super::outcome::RunError;
use crate::problem::CaseError;
use serde_json::Value;

/// A problem that was read, whatever solves it.
pub trait Planned {
    /// What a run would have to do: size, time, for a membrane the gap before any load, and warnings; after all that a run
    /// checks at the times that are known before it.
    ///
    /// # Errors
    /// Fields that cannot be used, at their place.
    fn sizes(&self) -> Result<Value, CaseError>;

    /// A picture of the case before anything happens in it, as SVG; none where there is nothing to draw.
    ///
    /// # Errors
    /// Fields that cannot be used, at their place, and a picture that cannot be drawn.
    fn preview(&self) -> Result<Option<String>, RunError>;

    /// The model at its beginning.
    ///
    /// # Errors
    /// Fields that cannot be used, at their place.
    fn model(self: Box<Self>) -> Result<Box<dyn Model>, CaseError>;
}
