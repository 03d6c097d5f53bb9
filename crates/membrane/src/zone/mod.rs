//! What the method needs to know of a contact zone, in one dimension or two.

mod division;
mod fronts;
mod motion;
mod region;
mod sizes;
mod stored;
mod topology;

pub use division::{Division, FrontsInCell, NoZone};
pub use fronts::{FrontFoot, FrontFrame, ZoneFronts};
pub use motion::{Advance, ZoneMotion};
pub use region::{OUTSIDE, contact, contact_index, contact_of, free, is_free};
pub use sizes::ZoneSizes;
pub use stored::Stored;
pub use topology::ZoneTopology;

use crate::obstacle::Side;
use signorini_fem::Grid;
use signorini_fem::cut::RegionId;
use signorini_geometry::Point;

/// A contact zone: its connected parts, bounded by fronts.
pub trait Zone<const D: usize>:
    Division<D> + ZoneFronts<D> + ZoneMotion<D> + ZoneTopology<D> + ZoneSizes<D> + Stored<D> + Clone + Send
{
    /// No contact at all.
    fn empty(grid: &Grid<D>) -> Self;
    fn is_empty(&self) -> bool;
    /// Number of connected zones and of holes in them.
    fn counts(&self) -> (usize, usize);
    /// What a zone touches.
    fn side_of(&self, zone: usize) -> Side;
    /// Holes of one zone.
    fn holes_of(&self, zone: usize) -> usize;
    /// Distance from `x` to the nearest front, if that is near: of fronts beyond `within` none need be known.
    fn distance(&self, x: &Point<D>, within: f64) -> f64;
    /// The region of a point of the membrane.
    fn region_at(&self, x: &Point<D>) -> RegionId;
    /// Points along every front, for pictures and files; one in one dimension.
    fn outlines(&self) -> Vec<Vec<Point<D>>>;
}
