//! Parts of the boundary: sides of the box of the cells, and parts of the recovered boundary.
//!
//! Their points are those of the rule of each cell, or of the rules of the boxes into which a cell is divided: where what
//! touches them varies over less than the cell.

use crate::body::CellBody;
use crate::cell::Site;
use crate::error::CellsError;
use crate::region::{BoundaryPoint, Filling};
use signorini_fem::QuadraturePoint;
use signorini_fem::cut::End;
use signorini_geometry::{Aabb, Point, Vector};
use signorini_material::Space;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Where something is held or loaded.
#[derive(Clone)]
pub enum Place<const D: usize> {
    /// The material on a side of the box of the cells.
    Side { axis: usize, end: End },
    /// The points of the recovered boundary for which this holds.
    Boundary(Arc<Holds<D>>),
    /// The points for which this holds of the whole surface: the recovered boundary, and the material on sides of the box.
    Surface(Arc<Holds<D>>),
    /// The whole surface but these sides of the box, on which the body is cut off.
    Whole { without: Vec<(usize, End)> },
}

/// Whether a point belongs to a place.
pub type Holds<const D: usize> = dyn Fn(&BoundaryPoint<D>) -> bool + Send + Sync;

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
        let (mut sites, what) = match place {
            Place::Boundary(holds) => (self.sites(&|p| holds(p)), "a place on the recovered boundary"),
            Place::Side { axis, end } => {
                if *axis >= D {
                    return Err(CellsError::Axis { axis: *axis, dimension: D });
                }
                (self.side_sites(*axis, *end), "a side of the box")
            }
            Place::Surface(holds) => (self.surface_sites(&**holds, &[]), "a place on the surface"),
            Place::Whole { without } => (self.surface_sites(&|_| true, without), "the surface"),
        };
        if sites.is_empty() {
            return Err(self.empty_place(what));
        }
        self.leave_axis(place, &mut sites);
        Ok(sites)
    }

    /// Sides are held by their functions; elsewhere strains at the axis would divide by the radius.
    fn leave_axis(&self, place: &Place<D>, sites: &mut Vec<Site<D>>) {
        if !matches!(place, Place::Side { .. }) {
            sites.retain(|s| !self.is_on_axis(&s.x));
        }
    }

    /// Whether a point lies on the axis around which the body turns, where a boundary has no area.
    fn is_on_axis(&self, x: &Point<D>) -> bool {
        self.material.space == Space::Axisymmetric && x[0] <= 1e-12 * self.tree.bounds().max[0]
    }

    /// That nothing lies in a place, with the box of the cells with material.
    pub(crate) fn empty_place(&self, place: &str) -> CellsError {
        let all = (0..self.cells().len()).map(|c| self.bounds_of(c));
        let whole = all.copied().reduce(|a, b| a.joined(&b));
        let corner = |x: &Point<D>| x.iter().copied().collect();
        let whole = whole.unwrap_or(*self.tree.bounds());
        CellsError::EmptyPlace { place: place.to_string(), low: corner(&whole.min), high: corner(&whole.max) }
    }

    /// The points of a place anew, of which `points` are those by the rules of whole cells, with cells divided into as many
    /// boxes along each direction as told.
    pub(crate) fn points_in_parts(
        &self,
        place: &Place<D>,
        points: &[Site<D>],
        parts: &BTreeMap<usize, usize>,
    ) -> Vec<Site<D>> {
        let mut out: Vec<Site<D>> = points.iter().filter(|p| !parts.contains_key(&p.cell)).copied().collect();
        for (&cell, &count) in parts {
            let b = self.bounds_of(cell);
            for number in 0..count.pow(D as u32) {
                let part = part_of(b, number, count);
                match place {
                    Place::Side { axis, end } => {
                        if end.of(&part, *axis) == end.of(self.tree.bounds(), *axis) {
                            out.extend(self.on_side(cell, &part, *axis, *end));
                        }
                    }
                    Place::Boundary(holds) => {
                        out.extend(self.on_boundary(cell, &part).into_iter().filter(|s| holds(&point_of(s))));
                    }
                    Place::Surface(holds) => out.extend(self.on_surface(cell, &part, &**holds, &[])),
                    Place::Whole { without } => out.extend(self.on_surface(cell, &part, &|_| true, without)),
                }
            }
        }
        self.leave_axis(place, &mut out);
        out
    }

    /// The sides of the box of the cells in which a box has a side.
    fn sides_of(&self, part: &Aabb<D>) -> Vec<(usize, End)> {
        let all = (0..D).flat_map(|axis| End::BOTH.map(|end| (axis, end)));
        all.filter(|(axis, end)| end.of(part, *axis) == end.of(self.tree.bounds(), *axis)).collect()
    }

    /// The points of the recovered boundary of a cell in a part of its box.
    fn on_boundary(&self, cell: usize, part: &Aabb<D>) -> Vec<Site<D>> {
        let rule = self.region.rule(part, &self.discretisation.integration, self.degree());
        let own = rule.boundary.into_iter().filter(|p| self.cell_at(&p.x) == Some(cell));
        own.map(|p| Site { cell, x: p.x, weight: p.weight * self.turn(&p.x), normal: p.normal }).collect()
    }

    /// The points of the material of a cell on a side of a part of its box.
    fn on_side(&self, cell: usize, part: &Aabb<D>, axis: usize, end: End) -> Vec<Site<D>> {
        let points = self.degree() + 4;
        let normal = Vector::<D>::from_fn(|k, _| if k == axis { end.sign() } else { 0.0 });
        let found: Vec<QuadraturePoint<D>> = if self.cells()[cell].rule.filling == Filling::Full {
            side_gauss(part, axis, end, points)
        } else {
            self.region.side_rule(part, axis, end, points)
        };
        // Of several pieces in a leaf the nearest.
        let own = found.into_iter().filter(|p| self.cell_at(&p.x) == Some(cell));
        own.map(|p| Site { cell, x: p.x, weight: p.weight * self.turn(&p.x), normal }).collect()
    }

    /// The points on a side of a part of its box that are none of the boundary: where that lies in a side of the box both are
    /// the same.
    fn beside(
        &self,
        cell: usize,
        part: &Aabb<D>,
        (axis, end): (usize, End),
        boundary: &[Site<D>],
        holds: &Holds<D>,
    ) -> Vec<Site<D>> {
        let at = end.of(self.tree.bounds(), axis);
        let slack = 1e-9 * part.size()[axis];
        let is_new = |site: &Site<D>| {
            let is_same = |p: &Site<D>| (p.x[axis] - at).abs() < slack && p.normal.dot(&site.normal) > 0.9;
            !boundary.iter().any(is_same) && holds(&point_of(site))
        };
        self.on_side(cell, part, axis, end).into_iter().filter(is_new).collect()
    }

    /// The points of boundary and sides of the box, without some of these, in a part of the box of a cell.
    fn on_surface(&self, cell: usize, part: &Aabb<D>, holds: &Holds<D>, without: &[(usize, End)]) -> Vec<Site<D>> {
        let own = self.on_boundary(cell, part);
        let sides = self.sides_of(part).into_iter().filter(|side| !without.contains(side));
        let mut out: Vec<Site<D>> = sides.flat_map(|side| self.beside(cell, part, side, &own, holds)).collect();
        out.extend(own.into_iter().filter(|s| holds(&point_of(s))));
        out
    }

    /// The points of boundary and sides of the box, without some of these.
    fn surface_sites(&self, holds: &Holds<D>, without: &[(usize, End)]) -> Vec<Site<D>> {
        let all = self.sites(&|_| true);
        let mut out: Vec<Site<D>> = self.sites(&|p| holds(p));
        for axis in 0..D {
            for end in End::BOTH.into_iter().filter(|end| !without.contains(&(axis, *end))) {
                for cell in self.cells_on(axis, end) {
                    let first = all.partition_point(|s| s.cell < cell);
                    let own = &all[first..all.partition_point(|s| s.cell <= cell)];
                    out.extend(self.beside(cell, self.bounds_of(cell), (axis, end), own, holds));
                }
            }
        }
        out
    }

    fn side_sites(&self, axis: usize, end: End) -> Vec<Site<D>> {
        let cells = self.cells_on(axis, end).into_iter();
        cells.flat_map(|cell| self.on_side(cell, self.bounds_of(cell), axis, end)).collect()
    }

    /// The cells on a side of the box.
    pub(crate) fn cells_on(&self, axis: usize, end: End) -> Vec<usize> {
        let outer = self.tree.bounds();
        let on = |c: &usize| end.of(self.bounds_of(*c), axis) == end.of(outer, axis);
        (0..self.cells().len()).filter(on).collect()
    }
}

/// The Gauss rule of a whole side of a box.
pub(crate) fn side_gauss<const D: usize>(b: &Aabb<D>, axis: usize, end: End, points: usize) -> Vec<QuadraturePoint<D>> {
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

fn point_of<const D: usize>(site: &Site<D>) -> BoundaryPoint<D> {
    BoundaryPoint { x: site.x, weight: site.weight, normal: site.normal }
}

/// One of the boxes, `count` along each direction, into which a box is divided.
fn part_of<const D: usize>(b: &Aabb<D>, mut number: usize, count: usize) -> Aabb<D> {
    let place: [usize; D] = std::array::from_fn(|_| {
        let k = number % count;
        number /= count;
        k
    });
    // The ends of the box are met exactly.
    let at = |k: usize, i: usize| match i {
        0 => b.min[k],
        i if i == count => b.max[k],
        i => b.min[k] + (b.max[k] - b.min[k]) * (i as f64 / count as f64),
    };
    Aabb::new(Point::from_fn(|k, _| at(k, place[k])), Point::from_fn(|k, _| at(k, place[k] + 1)))
}
