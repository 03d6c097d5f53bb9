//! Parts of the boundary: sides of the box of the cells, and parts of the recovered boundary.

use crate::body::{CellBody, Site};
use crate::error::CellsError;
use crate::region::{BoundaryPoint, Filling};
use signorini_fem::QuadraturePoint;
use signorini_fem::cut::End;
use signorini_geometry::{Point, Vector};
use std::sync::Arc;

/// Where something is held or loaded.
#[derive(Clone)]
pub enum Place<const D: usize> {
    /// The material on a side of the box of the cells.
    Side { axis: usize, end: End },
    /// The points of the recovered boundary for which this holds.
    Boundary(Arc<dyn Fn(&BoundaryPoint<D>) -> bool + Send + Sync>),
    /// The points for which this holds of the whole surface: the recovered boundary, and the material on sides of the box.
    Surface(Arc<dyn Fn(&BoundaryPoint<D>) -> bool + Send + Sync>),
}

impl<const D: usize> Place<D> {
    /// The side where a coordinate is least.
    pub fn low(axis: usize) -> Self {
        Place::Side { axis, end: End::Low }
    }

    /// The side where a coordinate is greatest.
    pub fn high(axis: usize) -> Self {
        Place::Side { axis, end: End::High }
    }

    pub fn boundary(holds: impl Fn(&BoundaryPoint<D>) -> bool + Send + Sync + 'static) -> Self {
        Place::Boundary(Arc::new(holds))
    }
}

impl<const D: usize> CellBody<D> {
    /// The quadrature points of a place.
    ///
    /// # Errors
    /// A side along an axis that the body does not have; a place without any material.
    pub fn points_on(&self, place: &Place<D>) -> Result<Vec<Site<D>>, CellsError> {
        let (sites, what) = match place {
            Place::Boundary(holds) => (self.sites(&|p| holds(p)), "named on the recovered boundary"),
            Place::Side { axis, end } => {
                if *axis >= D {
                    return Err(CellsError::Axis { axis: *axis, dimension: D });
                }
                (self.side_sites(*axis, *end), "named on a side of the box")
            }
            Place::Surface(holds) => (self.surface_sites(&|p| holds(p)), "named on the surface"),
        };
        if sites.is_empty() { Err(CellsError::EmptyPlace { what }) } else { Ok(sites) }
    }

    /// The points of boundary and sides of the box. Where the boundary lies in a side of the box both are the same.
    fn surface_sites(&self, holds: &dyn Fn(&BoundaryPoint<D>) -> bool) -> Vec<Site<D>> {
        let mut out = self.sites(holds);
        for axis in 0..D {
            for end in End::BOTH {
                let at = end.of(self.tree.bounds(), axis);
                for site in self.side_sites(axis, end) {
                    let slack = 1e-9 * self.bounds_of(site.cell).size()[axis];
                    let own = &self.cells()[site.cell].rule.boundary;
                    let is_known =
                        own.iter().any(|p| (p.x[axis] - at).abs() < slack && p.normal.dot(&site.normal) > 0.9);
                    if !is_known && holds(&BoundaryPoint { x: site.x, weight: site.weight, normal: site.normal }) {
                        out.push(site);
                    }
                }
            }
        }
        out
    }

    fn side_sites(&self, axis: usize, end: End) -> Vec<Site<D>> {
        let mut out = Vec::new();
        let points = self.degree() + 4;
        let normal = Vector::<D>::from_fn(|k, _| if k == axis { end.sign() } else { 0.0 });
        for number in self.cells_on(axis, end) {
            let cell = &self.cells()[number];
            let b = self.bounds_of(number);
            let found: Vec<QuadraturePoint<D>> = if cell.rule.filling == Filling::Full {
                side_gauss(b, axis, end, points)
            } else {
                self.region.side_rule(b, axis, end, points)
            };
            for p in found {
                // Of several pieces in a leaf the nearest.
                if self.cell_at(&p.x) == Some(number) {
                    out.push(Site { cell: number, x: p.x, weight: p.weight * self.turn(&p.x), normal });
                }
            }
        }
        out
    }

    /// The cells on a side of the box.
    pub(crate) fn cells_on(&self, axis: usize, end: End) -> Vec<usize> {
        let outer = self.tree.bounds();
        let on = |c: &usize| end.of(self.bounds_of(*c), axis) == end.of(outer, axis);
        (0..self.cells().len()).filter(on).collect()
    }
}

/// The Gauss rule of a whole side of a box.
pub(crate) fn side_gauss<const D: usize>(
    b: &signorini_geometry::Aabb<D>,
    axis: usize,
    end: End,
    points: usize,
) -> Vec<QuadraturePoint<D>> {
    let gauss = signorini_geometry::rule::gauss_legendre(points);
    (0..points.pow(D as u32 - 1))
        .map(|mut i| {
            let mut weight = 1.0;
            let x = Point::from_fn(|k, _| {
                if k == axis {
                    return end.of(b, k);
                }
                let (t, w) = gauss[i % points];
                i /= points;
                weight *= w * (b.max[k] - b.min[k]);
                b.min[k] + t * (b.max[k] - b.min[k])
            });
            QuadraturePoint { x, weight }
        })
        .collect()
}
