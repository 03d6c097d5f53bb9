//! Quadrature of the material in a box, from whatever describes the body.

use crate::Domain;
use crate::moments::fitted;
use signorini_fem::QuadraturePoint;
use signorini_fem::cut::{End, height::side_points, height_functions, material, space_tree, sub_cells};
use signorini_geometry::implicit::Restricted;
use signorini_geometry::{Aabb, ImplicitShape, Point, Vector};
use std::collections::BTreeMap;
use std::sync::Arc;

/// How cut cells are integrated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integration {
    /// By height functions: with as many Gauss points in each direction and smooth piece as given, or four more than the
    /// degree, which the curved pieces of a cut cell need (with fewer, under-integrated slivers get motions that cost no
    /// energy).
    Exact { points: Option<usize> },
    /// By as many sub-cells in each direction, cut along chords.
    SubCells { subdivision: usize },
    /// By bisection, and counting of Gauss points; without a boundary.
    SpaceTree { depth: usize },
}

impl Integration {
    /// Gauss points in each direction of a smooth piece.
    pub fn points(&self, degree: usize) -> usize {
        match self {
            Integration::Exact { points } => points.unwrap_or(degree + 4),
            Integration::SubCells { .. } | Integration::SpaceTree { .. } => degree + 1,
        }
    }
}

/// How much of a cell is material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filling {
    Full,
    Cut,
    Void,
}

/// A point of the boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryPoint<const D: usize> {
    pub x: Point<D>,
    /// Length or area of the boundary before it deforms.
    pub weight: f64,
    /// Unit normal, out of the material.
    pub normal: Vector<D>,
}

/// The quadrature of the material in a cell.
#[derive(Clone, Debug)]
pub struct MaterialRule<const D: usize> {
    pub filling: Filling,
    /// Empty where the cell is full.
    pub volume: Vec<QuadraturePoint<D>>,
    /// Whether those points may lie outside of the material.
    pub is_fitted: bool,
    pub boundary: Vec<BoundaryPoint<D>>,
}

impl<const D: usize> MaterialRule<D> {
    pub fn empty(filling: Filling) -> Self {
        MaterialRule { filling, volume: Vec::new(), is_fitted: false, boundary: Vec::new() }
    }

    /// Replaces the points in the volume by those of one rule of the box, and those on the boundary by few of them, where
    /// that is less.
    pub(crate) fn fit(&mut self, b: &Aabb<D>, order: usize) {
        if self.volume.len() > order.pow(D as u32) {
            self.volume = fitted(b, order, self.volume.iter().map(|p| (p.x, p.weight)));
            self.is_fitted = true;
        }
        if self.boundary.len() > SEVERAL * order.pow(D as u32 - 1) {
            self.boundary = thinned(b, order, &self.boundary);
        }
    }

    /// Volume of the material in a cell of the given volume.
    pub fn measure(&self, whole: f64) -> f64 {
        if self.filling == Filling::Full { whole } else { self.volume.iter().map(|p| p.weight).sum() }
    }
}

/// A point of a boundary of facets.
#[derive(Clone, Debug, PartialEq)]
pub struct FacetFoot<const D: usize> {
    pub x: Point<D>,
    /// Unit normals of planes whose common points are the facet, edge or vertex on which it lies.
    pub planes: Vec<Vector<D>>,
    /// The outward unit normal, a mean one on edges and at vertices.
    pub normal: Vector<D>,
}

/// Sides of a cell of which a boundary in it may be as large as.
const SEVERAL: usize = 4;

/// Of the points of a boundary in a box the middle one of those that lie in one of `order` parts of the box in each
/// direction and look the same way, with the weight of all of them.
fn thinned<const D: usize>(b: &Aabb<D>, order: usize, points: &[BoundaryPoint<D>]) -> Vec<BoundaryPoint<D>> {
    let size = b.size();
    let mut groups: BTreeMap<([usize; D], usize, bool), Vec<&BoundaryPoint<D>>> = BTreeMap::new();
    for p in points {
        let part = |k: usize| ((p.x[k] - b.min[k]) / size[k] * order as f64).clamp(0.0, order as f64 - 0.5) as usize;
        let along = p.normal.iamax();
        groups.entry((std::array::from_fn(part), along, p.normal[along] > 0.0)).or_default().push(p);
    }
    let one = |group: &Vec<&BoundaryPoint<D>>| {
        let weight: f64 = group.iter().map(|p| p.weight).sum();
        let middle = group.iter().map(|p| p.x * p.weight).sum::<Point<D>>() / weight;
        let distance = |p: &BoundaryPoint<D>| (p.x - middle).norm_squared();
        let chosen = group.iter().min_by(|p, q| distance(p).total_cmp(&distance(q)));
        chosen.map(|p| BoundaryPoint { weight, ..**p })
    };
    groups.values().filter_map(one).collect()
}

/// What describes where material is.
pub trait Region<const D: usize>: Send + Sync {
    /// The quadrature of the material in a box, for functions of a degree.
    fn rule(&self, b: &Aabb<D>, integration: &Integration, degree: usize) -> MaterialRule<D>;

    /// Quadrature of the material on a side of a box.
    fn side_rule(&self, b: &Aabb<D>, axis: usize, end: End, points: usize) -> Vec<QuadraturePoint<D>>;

    /// Places on a side of a box at which material lies on both sides of it, one at least where there is any.
    fn places_on_side(&self, b: &Aabb<D>, axis: usize, end: End) -> Vec<Point<D>> {
        self.side_rule(b, axis, end, 3).iter().map(|p| p.x).collect()
    }

    fn contains(&self, x: &Point<D>) -> bool;

    /// Whether the points of its rules lie in the material and can be counted to one piece of it or another.
    fn has_points_in_material(&self) -> bool {
        true
    }

    /// The smooth surfaces of which the boundary is made, negative on one side; none where it is made of facets.
    fn sheets(&self) -> Vec<Arc<dyn ImplicitShape<D>>> {
        Vec::new()
    }

    /// The point of a boundary of facets that is closest to a point; none where it is not made of facets.
    fn facet_at(&self, _: &Point<D>) -> Option<FacetFoot<D>> {
        None
    }

    /// A value that is not finite at a point, where the description has one.
    fn defect(&self, _: &Point<D>) -> Option<f64> {
        None
    }
}

/// A share of a cell below which it holds no material: what rounding leaves of sums of its points.
const NOTHING: f64 = 1e-14;

impl<const D: usize> Region<D> for Domain<D> {
    fn rule(&self, b: &Aabb<D>, integration: &Integration, degree: usize) -> MaterialRule<D> {
        let domain = match self.restricted(b) {
            Restricted::Full => return MaterialRule::empty(Filling::Full),
            Restricted::Void => return MaterialRule::empty(Filling::Void),
            Restricted::Open(domain) => domain,
        };
        let partition = material(&domain);
        let points = integration.points(degree);
        let mut rule = match *integration {
            Integration::Exact { .. } => height_functions(&partition, b, points),
            Integration::SubCells { subdivision } => in_sub_cells(&partition, b, subdivision, points),
            Integration::SpaceTree { depth } => space_tree(&partition, b, depth, points),
        };
        let boundary: Vec<BoundaryPoint<D>> = (rule.surfaces.iter())
            .map(|p| BoundaryPoint {
                x: p.x,
                weight: p.weight,
                normal: if p.minus == 1 { p.normal } else { -p.normal },
            })
            .collect();
        let at = rule.volumes.iter().position(|v| v.0 == 1);
        let volume = at.map_or(Vec::new(), |at| rule.volumes.swap_remove(at).1);
        let measure: f64 = volume.iter().map(|p| p.weight).sum();
        if measure <= NOTHING * b.volume() {
            MaterialRule::empty(Filling::Void)
        } else if boundary.is_empty() && measure >= (1.0 - 1e-12) * b.volume() {
            MaterialRule::empty(Filling::Full)
        } else {
            MaterialRule { volume, boundary, ..MaterialRule::empty(Filling::Cut) }
        }
    }

    fn side_rule(&self, b: &Aabb<D>, axis: usize, end: End, points: usize) -> Vec<QuadraturePoint<D>> {
        match self.restricted(b) {
            Restricted::Full => crate::place::side_gauss(b, axis, end, points),
            Restricted::Void => Vec::new(),
            Restricted::Open(domain) => side_points(&material(&domain), b, axis, end, points, 1),
        }
    }

    fn contains(&self, x: &Point<D>) -> bool {
        Domain::contains(self, x)
    }

    fn sheets(&self) -> Vec<Arc<dyn ImplicitShape<D>>> {
        match self {
            Domain::Shape(shape) => vec![shape.clone()],
            Domain::Complement(part) => part.sheets(),
            Domain::Union(parts) | Domain::Intersection(parts) => parts.iter().flat_map(Region::sheets).collect(),
        }
    }

    fn defect(&self, x: &Point<D>) -> Option<f64> {
        Some(self.value(x)).filter(|v| !v.is_finite())
    }
}

/// Sub-cells are those of the plane and of space.
fn in_sub_cells<const D: usize>(
    partition: &signorini_fem::cut::CellPartition<'_, D>,
    b: &Aabb<D>,
    subdivision: usize,
    points: usize,
) -> signorini_fem::CellRule<D> {
    if D == 1 { height_functions(partition, b, points) } else { sub_cells(partition, b, subdivision, points, 1) }
}
