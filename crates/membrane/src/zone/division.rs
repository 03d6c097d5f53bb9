//! What divides a membrane into contact and free regions.

use super::region::free;
use signorini_fem::cut::RegionId;
use signorini_geometry::{Aabb, ImplicitShape, Point};

/// The fronts that may cross a box.
pub struct FrontsInCell<'a, const D: usize> {
    pub sheets: Vec<Box<dyn ImplicitShape<D> + 'a>>,
    /// Front of each sheet.
    pub fronts: Vec<usize>,
    pub features: Vec<Point<D>>,
    /// The region of a point inside the membrane, given the values of the sheets.
    pub region: Box<dyn Fn(&[f64]) -> RegionId + 'a>,
}

/// What divides a membrane into contact and free regions.
pub trait Division<const D: usize>: Sync {
    /// The fronts that may cross a box.
    fn fronts_in(&self, bounds: &Aabb<D>) -> FrontsInCell<'_, D>;
}

/// A membrane without contact.
pub struct NoZone;

impl<const D: usize> Division<D> for NoZone {
    fn fronts_in(&self, _: &Aabb<D>) -> FrontsInCell<'_, D> {
        FrontsInCell { sheets: vec![], fronts: vec![], features: vec![], region: Box::new(|_| free(0)) }
    }
}
