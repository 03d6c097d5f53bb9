//! What divides a cell into regions, and the quadrature of these.

use signorini_geometry::{Aabb, ImplicitShape, Point, Vector};

/// Names a region: what lies between the surfaces.
pub type RegionId = u32;

/// What divides one cell.
pub struct CellPartition<'a, const D: usize> {
    /// The surfaces that may cross the cell.
    pub sheets: Vec<Box<dyn ImplicitShape<D> + 'a>>,
    /// What each surface is called in [`SurfacePoint::tag`].
    pub tags: Vec<u32>,
    /// Points at which the cell is split before anything else: corners of surfaces, and one point of any closed
    /// surface that lies within the cell.
    pub features: Vec<Point<D>>,
    /// The region of a point, given the values of the sheets there.
    pub region: Box<dyn Fn(&Point<D>, &[f64]) -> RegionId + 'a>,
}

/// A division of space into regions by implicit surfaces.
pub trait Partition<const D: usize>: Sync {
    /// What divides the cell with the given box.
    fn in_cell(&self, cell: usize, bounds: &Aabb<D>) -> CellPartition<'_, D>;
}

/// A quadrature point of a volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadraturePoint<const D: usize> {
    pub x: Point<D>,
    pub weight: f64,
}

/// A quadrature point of a surface between two regions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint<const D: usize> {
    pub x: Point<D>,
    pub weight: f64,
    /// Unit normal, from the negative to the positive side of the sheet.
    pub normal: Vector<D>,
    pub tag: u32,
    /// The regions on the negative and on the positive side.
    pub minus: RegionId,
    pub plus: RegionId,
}

/// The quadrature of one cell.
#[derive(Clone, Debug, Default)]
pub struct CellRule<const D: usize> {
    /// Volume rules of the regions present, sorted by region.
    pub volumes: Vec<(RegionId, Vec<QuadraturePoint<D>>)>,
    pub surfaces: Vec<SurfacePoint<D>>,
    /// Whether any surface crosses the cell.
    pub cut: bool,
}

impl<const D: usize> CellRule<D> {
    /// The volume rule of one region; empty where the region is absent.
    pub fn volume(&self, region: RegionId) -> &[QuadraturePoint<D>] {
        self.volumes.iter().find(|(r, _)| *r == region).map_or(&[], |(_, points)| points)
    }

    pub(super) fn points_of(&mut self, region: RegionId) -> &mut Vec<QuadraturePoint<D>> {
        let at = self.volumes.binary_search_by_key(&region, |(r, _)| *r).unwrap_or_else(|at| {
            self.volumes.insert(at, (region, Vec::new()));
            at
        });
        &mut self.volumes[at].1
    }
}
