//! Zones as numbers in files.

use serde_json::Value;
use signorini_fem::Grid;

/// A zone that can be written and read again.
pub trait Stored<const D: usize>: Sized {
    /// The zone as numbers, from which [`Stored::from_json`] makes the same one again.
    fn to_json(&self) -> Value;
    /// The zone of such numbers, on a grid or one as much finer as it was; none where they make no zone.
    fn from_json(grid: &Grid<D>, value: &Value) -> Option<Self>;
}
