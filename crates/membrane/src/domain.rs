//! Where a membrane is: domains whose boundary either fits the background grid or cuts it.

use signorini_fem::{Cells, MeshCells};
use signorini_geometry::{Aabb, HalfSpace, ImplicitShape, Point, polygon};
use std::sync::Arc;

/// What of a domain's boundary may cross a cell.
pub struct BoundaryInCell<'a, const D: usize> {
    pub sheets: Vec<Box<dyn ImplicitShape<D> + 'a>>,
    /// Boundary piece of each sheet.
    pub pieces: Vec<u32>,
    pub features: Vec<Point<D>>,
}

/// The domain of a membrane.
pub trait Domain<const D: usize>: Send + Sync {
    /// Boundary that may cross the box.
    fn boundary_in(&self, cell: &Aabb<D>) -> BoundaryInCell<'_, D>;
    /// Whether a point is inside, given the values of the sheets of its cell.
    fn contains(&self, x: &Point<D>, sheet_values: &[f64]) -> bool;
    /// A function that is negative inside and continuous everywhere.
    fn level(&self, x: &Point<D>) -> f64;
    /// Number of pieces of the boundary.
    fn pieces(&self) -> usize;
    /// A point of the domain near a point outside it, within `reach`.
    fn pulled_inside(&self, x: &Point<D>, reach: f64) -> Option<Point<D>>;
    /// Whether the domain is its bounding box. Pieces are then the sides: lower and upper in each direction.
    fn is_box(&self) -> bool {
        false
    }
    /// Whether cells fit the domain, so that its boundary consists of their sides.
    fn is_fitted(&self) -> bool {
        self.is_box()
    }
}

/// An interval or a rectangle that the grid fits.
pub struct BoxDomain<const D: usize>(pub Aabb<D>);

impl<const D: usize> Domain<D> for BoxDomain<D> {
    fn boundary_in(&self, _: &Aabb<D>) -> BoundaryInCell<'_, D> {
        BoundaryInCell { sheets: Vec::new(), pieces: Vec::new(), features: Vec::new() }
    }
    fn contains(&self, _: &Point<D>, _: &[f64]) -> bool {
        true
    }
    fn level(&self, x: &Point<D>) -> f64 {
        (0..D).map(|k| (self.0.min[k] - x[k]).max(x[k] - self.0.max[k])).fold(f64::NEG_INFINITY, f64::max)
    }
    fn pieces(&self) -> usize {
        2 * D
    }
    fn pulled_inside(&self, x: &Point<D>, reach: f64) -> Option<Point<D>> {
        let inside = self.0.clamp(x);
        ((x - inside).amax() <= reach).then_some(inside)
    }
    fn is_box(&self) -> bool {
        true
    }
}

/// The inside of an implicit shape: a disc, an ellipse, or where an expression is negative.
pub struct ImplicitDomain<S>(pub S);

impl<const D: usize, S: ImplicitShape<D>> Domain<D> for ImplicitDomain<S> {
    fn boundary_in(&self, b: &Aabb<D>) -> BoundaryInCell<'_, D> {
        if self.0.range(b).is_some_and(|[low, high]| low > 0.0 || high < 0.0) {
            return BoundaryInCell { sheets: Vec::new(), pieces: Vec::new(), features: Vec::new() };
        }
        BoundaryInCell { sheets: vec![Box::new(&self.0)], pieces: vec![0], features: Vec::new() }
    }
    fn contains(&self, x: &Point<D>, sheet_values: &[f64]) -> bool {
        sheet_values.first().copied().unwrap_or_else(|| self.0.value(x)) < 0.0
    }
    fn level(&self, x: &Point<D>) -> f64 {
        self.0.value(x)
    }
    fn pieces(&self) -> usize {
        1
    }
    fn pulled_inside(&self, x: &Point<D>, reach: f64) -> Option<Point<D>> {
        let mut y = *x;
        for _ in 0..5 {
            let value = self.0.value(&y);
            if value < 0.0 {
                return ((x - y).norm() <= reach).then_some(y);
            }
            let g = self.0.gradient(&y);
            // A little further than the boundary, so that the next look finds the inside.
            y -= g * ((value + 1e-3 * reach * g.norm()) / g.norm_squared().max(f64::MIN_POSITIVE));
        }
        None
    }
}

/// A simple polygon, its corners counter-clockwise; each edge is a piece of the boundary.
pub struct PolygonDomain(Vec<Point<2>>);

impl PolygonDomain {
    /// Orders the corners counter-clockwise.
    pub fn new(mut corners: Vec<Point<2>>) -> Self {
        if polygon::signed_area(&corners) < 0.0 {
            corners.reverse();
        }
        Self(corners)
    }
}

impl Domain<2> for PolygonDomain {
    fn boundary_in(&self, cell: &Aabb<2>) -> BoundaryInCell<'_, 2> {
        let reach = cell.radius() * (1.0 + 1e-9);
        let mut here = BoundaryInCell { sheets: Vec::new(), pieces: Vec::new(), features: Vec::new() };
        for (i, (a, b)) in polygon::edges(&self.0).enumerate() {
            if polygon::segment_distance(a, b, &cell.center()) <= reach {
                here.sheets.push(Box::new(HalfSpace::left_of(a, b)));
                here.pieces.push(i as u32);
                here.features.push(*a);
                here.features.push(*b);
            }
        }
        here
    }
    fn contains(&self, x: &Point<2>, _: &[f64]) -> bool {
        polygon::winding_number(&self.0, x) != 0
    }
    fn level(&self, x: &Point<2>) -> f64 {
        let distance =
            polygon::edges(&self.0).map(|(a, b)| polygon::segment_distance(a, b, x)).fold(f64::INFINITY, f64::min);
        if self.contains(x, &[]) { -distance } else { distance }
    }
    fn pieces(&self) -> usize {
        self.0.len()
    }
    fn pulled_inside(&self, x: &Point<2>, reach: f64) -> Option<Point<2>> {
        if self.contains(x, &[]) {
            return Some(*x);
        }
        let nearest = polygon::edges(&self.0).map(|(a, b)| {
            let d = b - a;
            let t = ((x - a).dot(&d) / d.norm_squared()).clamp(1e-3, 1.0 - 1e-3);
            a + t * d - 1e-3 * reach * HalfSpace::left_of(a, b).normal
        });
        nearest
            .filter(|y| (x - y).norm() <= reach && self.contains(y, &[]))
            .min_by(|a, b| (x - a).norm().total_cmp(&(x - b).norm()))
    }
}

/// The cells of a mesh: each side on the boundary belongs to one of its pieces.
pub struct MeshDomain(pub Arc<MeshCells>);

impl Domain<2> for MeshDomain {
    fn boundary_in(&self, _: &Aabb<2>) -> BoundaryInCell<'_, 2> {
        BoundaryInCell { sheets: Vec::new(), pieces: Vec::new(), features: Vec::new() }
    }
    fn contains(&self, x: &Point<2>, _: &[f64]) -> bool {
        self.0.containing(x).is_some()
    }
    fn level(&self, x: &Point<2>) -> f64 {
        let reach = 2.0 * self.0.bounds().radius();
        let distance = self.0.closest_on_boundary(x, reach).map_or(reach, |y| (x - y).norm());
        if self.contains(x, &[]) { -distance } else { distance }
    }
    fn pieces(&self) -> usize {
        self.0.pieces()
    }
    fn pulled_inside(&self, x: &Point<2>, reach: f64) -> Option<Point<2>> {
        if self.contains(x, &[]) { Some(*x) } else { self.0.closest_on_boundary(x, reach) }
    }
    fn is_fitted(&self) -> bool {
        true
    }
}

/// A domain on its cells: which of them its boundary can cross.
#[derive(Clone)]
pub struct DomainOnCells<const D: usize> {
    pub domain: Arc<dyn Domain<D>>,
    /// For each cell, whether it lies inside, outside, or may be crossed.
    pub status: Arc<Vec<CellStatus>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellStatus {
    Inside,
    Outside,
    Crossed,
}

impl<const D: usize> DomainOnCells<D> {
    pub fn new(domain: Arc<dyn Domain<D>>, cells: &dyn Cells<D>) -> Self {
        if domain.is_fitted() {
            return Self { domain, status: Arc::new(vec![CellStatus::Inside; cells.count()]) };
        }
        let status_of = |cell: usize| {
            let b = cells.bounds_of(cell);
            let boundary = domain.boundary_in(&b);
            if boundary.sheets.is_empty() {
                return if domain.contains(&b.center(), &[]) { CellStatus::Inside } else { CellStatus::Outside };
            }
            let partition = signorini_fem::cut::CellPartition {
                tags: boundary.pieces,
                sheets: boundary.sheets,
                features: boundary.features,
                region: Box::new(|x, values| u32::from(domain.contains(x, values))),
            };
            let rule = cells.cut(cell, &partition, 1);
            match (rule.cut, rule.volumes.first()) {
                (true, _) => CellStatus::Crossed,
                (false, Some((1, _))) => CellStatus::Inside,
                _ => CellStatus::Outside,
            }
        };
        let mut status = vec![CellStatus::Outside; cells.count()];
        match cells.as_grid().filter(|grid| grid.cell_count() == cells.count()) {
            // Blocks that the boundary does not cross are settled at once.
            Some(grid) => {
                let mut open = vec![([0; D], grid.cells())];
                while let Some((low, high)) = open.pop() {
                    let size: [usize; D] = std::array::from_fn(|k| high[k] - low[k]);
                    if size.iter().all(|n| *n == 1) {
                        let cell = grid.cell_at(low);
                        status[cell] = status_of(cell);
                        continue;
                    }
                    let last = std::array::from_fn(|k| high[k] - 1);
                    let b = Aabb::new(grid.cell_box(grid.cell_at(low)).min, grid.cell_box(grid.cell_at(last)).max);
                    if domain.boundary_in(&b).sheets.is_empty() {
                        if domain.contains(&b.center(), &[]) {
                            for k in 0..size.iter().product() {
                                let mut rest = k;
                                let at = std::array::from_fn(|axis| {
                                    let i = low[axis] + rest % size[axis];
                                    rest /= size[axis];
                                    i
                                });
                                status[grid.cell_at(at)] = CellStatus::Inside;
                            }
                        }
                        continue;
                    }
                    let axis = (0..D).max_by_key(|&k| size[k]).unwrap_or(0);
                    let middle = low[axis] + size[axis] / 2;
                    let (mut first, mut second) = (high, low);
                    (first[axis], second[axis]) = (middle, middle);
                    open.push((low, first));
                    open.push((second, high));
                }
            }
            None => status.iter_mut().enumerate().for_each(|(cell, s)| *s = status_of(cell)),
        }
        Self { domain, status: Arc::new(status) }
    }
}
