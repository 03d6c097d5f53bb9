//! Shapes as trees of plain data, and the domains and exact offsets that they make.

use crate::Domain;
use crate::error::CellsError;
use crate::image::ImageData;
use crate::shapes::{Cylinder, Ellipsoid, Function, Level, Offset, RoundedBox, Section, cuboid};
use signorini_geometry::implicit_surface::ImplicitSurface;
use signorini_geometry::rigid_shape::RigidShape;
use signorini_geometry::{Aabb, ImplicitShape, Jet, Point, Vector};
use std::sync::Arc;

/// A function of position with gradient and Hessian.
pub type JetFunction = Arc<dyn Fn(&Point<3>) -> Jet<3> + Send + Sync>;

/// A shape that is negative inside.
#[derive(Clone)]
pub enum Shape {
    /// A rigid shape.
    Rigid(Arc<dyn RigidShape>),
    /// A function that is negative inside: an expression.
    Function(JetFunction),
    Ellipsoid {
        center: [f64; 3],
        semi_axes: [f64; 3],
    },
    /// A box along the axes.
    Cuboid {
        min: [f64; 3],
        max: [f64; 3],
    },
    /// What lies above a threshold of an image, after smoothing by a Gaussian of so many voxels.
    Image {
        image: ImageData,
        threshold: f64,
        smoothing: f64,
    },
    Union(Vec<Shape>),
    Intersection(Vec<Shape>),
    /// The first without all others.
    Difference(Vec<Shape>),
    /// All that is nearer than a distance to a shape, or deeper than it inside where it is negative.
    Offset {
        of: Box<Shape>,
        distance: f64,
    },
}

/// Cells of the grid on which the boundary of an offset shape is looked for, per cell of the body, and their least and
/// largest number along the longest side: the foot of a point is then found by Newton's method from the nearest one.
const PER_CELL: usize = 2;
const LEAST_CELLS: usize = 16;
const MOST_CELLS: usize = 128;

/// The function that stands for a rigid shape.
#[derive(Clone, Copy)]
enum RigidBy {
    /// Its gap, of which bounds are known: for quadrature.
    Distance,
    /// The function whose zero it is: for feet of points.
    Level,
}

impl Shape {
    /// The box of the shape, where it has one.
    pub fn bounds(&self) -> Option<Aabb<3>> {
        match self {
            Shape::Rigid(_) | Shape::Function(_) => None,
            Shape::Ellipsoid { center, semi_axes } => {
                let (c, a) = (Point::<3>::from(*center), Vector::<3>::from(*semi_axes));
                Some(Aabb::new(c - a, c + a))
            }
            Shape::Cuboid { min, max } => Some(Aabb::new(Point::<3>::from(*min), Point::<3>::from(*max))),
            Shape::Image { image, .. } => image_bounds(image),
            Shape::Union(parts) => {
                let all: Option<Vec<Aabb<3>>> = parts.iter().map(Shape::bounds).collect();
                all?.into_iter().reduce(|a, b| a.joined(&b))
            }
            Shape::Intersection(parts) => {
                (parts.iter().filter_map(Shape::bounds)).reduce(|a, b| Aabb::new(a.min.sup(&b.min), a.max.inf(&b.max)))
            }
            Shape::Difference(parts) => parts.first().and_then(Shape::bounds),
            Shape::Offset { of, distance } => of.bounds().map(|b| {
                let d = Vector::<3>::repeat(*distance);
                Aabb::new(b.min - d, b.max + d)
            }),
        }
    }

    /// The domain of the dimension of the body. `bounds` is the box of the cells, `cells` their number along its longest
    /// side.
    pub(super) fn domain<const D: usize>(&self, bounds: &Aabb<3>, cells: usize) -> Result<Domain<D>, CellsError> {
        self.with_rigid(bounds, cells, RigidBy::Distance)
    }

    fn with_rigid<const D: usize>(
        &self,
        bounds: &Aabb<3>,
        cells: usize,
        rigid: RigidBy,
    ) -> Result<Domain<D>, CellsError> {
        let list = |parts: &[Shape]| {
            parts.iter().map(|p| p.with_rigid::<D>(bounds, cells, rigid)).collect::<Result<Vec<_>, _>>()
        };
        self.check()?;
        Ok(match self {
            Shape::Rigid(shape) => match rigid {
                RigidBy::Distance => section(Offset { shape: shape.clone(), distance: 0.0 }),
                RigidBy::Level => section(Level(shape.clone())),
            },
            Shape::Function(f) => {
                let f = f.clone();
                section(Function(move |x: &Point<3>| f(x)))
            }
            Shape::Ellipsoid { center, semi_axes } => Domain::shape(Ellipsoid::<D> {
                center: Point::<D>::from_fn(|k, _| center[k]),
                semi_axes: std::array::from_fn(|k| semi_axes[k]),
            }),
            Shape::Cuboid { min, max } => {
                let corner = |c: &[f64; 3]| Point::<D>::from_fn(|k, _| c[k]);
                cuboid(&Aabb::new(corner(min), corner(max)))
            }
            Shape::Image { image, threshold, smoothing } => {
                Domain::shape(image.clone().voxels::<D>()?.above(*threshold, *smoothing)?)
            }
            Shape::Union(parts) => Domain::union(list(parts)?),
            Shape::Intersection(parts) => Domain::intersection(list(parts)?),
            Shape::Difference(parts) => {
                let mut parts = list(parts)?.into_iter();
                let first = parts.next().unwrap_or(Domain::Union(Vec::new()));
                first.without(Domain::union(parts.collect()))
            }
            Shape::Offset { of, distance } => match (&**of, of.shifted::<D>(*distance)) {
                (_, Some(shape)) => shape.with_rigid::<D>(bounds, cells, rigid)?,
                (Shape::Cuboid { min, max }, _) if *distance > 0.0 => {
                    let corner = |c: &[f64; 3]| Point::<D>::from_fn(|k, _| c[k]);
                    Domain::shape(RoundedBox { bounds: Aabb::new(corner(min), corner(max)), radius: *distance })
                }
                (Shape::Rigid(shape), _) => section(Offset { shape: shape.clone(), distance: *distance }),
                _ => {
                    let shape = Arc::new(of.surface::<D>(bounds, cells, *distance)?);
                    section(Offset { shape, distance: *distance })
                }
            },
        })
    }

    /// The offset of a shape where no distances are needed: of balls; outwards of unions and inwards of intersections by
    /// that of each part, so that edges stay edges.
    fn shifted<const D: usize>(&self, distance: f64) -> Option<Shape> {
        let of_each = |parts: &[Shape], distance: f64| -> Vec<Shape> {
            parts.iter().map(|p| Shape::Offset { of: Box::new(p.clone()), distance }).collect()
        };
        match self {
            Shape::Ellipsoid { center, semi_axes: a } if a[..D].iter().all(|r| *r == a[0]) && a[0] + distance > 0.0 => {
                Some(Shape::Ellipsoid { center: *center, semi_axes: [a[0] + distance; 3] })
            }
            Shape::Cuboid { min, max } if distance < 0.0 && (0..D).all(|k| min[k] - distance < max[k] + distance) => {
                let moved =
                    |corner: &[f64; 3], by: f64| std::array::from_fn(|k| corner[k] + if k < D { by } else { 0.0 });
                Some(Shape::Cuboid { min: moved(min, -distance), max: moved(max, distance) })
            }
            Shape::Union(parts) if distance > 0.0 => Some(Shape::Union(of_each(parts, distance))),
            Shape::Intersection(parts) if distance < 0.0 => Some(Shape::Intersection(of_each(parts, distance))),
            Shape::Difference(parts) if distance < 0.0 => {
                let (first, others) = parts.split_first()?;
                let mut parts = of_each(std::slice::from_ref(first), distance);
                parts.extend(of_each(others, -distance));
                Some(Shape::Difference(parts))
            }
            Shape::Offset { of, distance: inner } if inner * distance > 0.0 => {
                Some(Shape::Offset { of: of.clone(), distance: inner + distance })
            }
            _ => None,
        }
    }

    fn check(&self) -> Result<(), CellsError> {
        let parts = |what: &'static str, parts: &[Shape], least: usize| {
            let count = parts.len();
            if count < least { Err(CellsError::NoParts { what, count, least }) } else { Ok(()) }
        };
        match self {
            Shape::Union(list) => parts("union", list, 1),
            Shape::Intersection(list) => parts("intersection", list, 1),
            Shape::Difference(list) => parts("difference", list, 2),
            Shape::Ellipsoid { semi_axes, .. } => match semi_axes.iter().find(|a| a.is_nan() || **a <= 0.0) {
                Some(value) => Err(CellsError::Value { name: "semi_axes", value: *value, must: "must be positive" }),
                None => Ok(()),
            },
            Shape::Cuboid { min, max } if !(0..3).all(|k| min[k] < max[k]) => {
                Err(CellsError::Box { corners: [*min, *max].concat() })
            }
            Shape::Offset { distance, .. } if !distance.is_finite() => {
                Err(CellsError::Value { name: "distance", value: *distance, must: "must be finite" })
            }
            _ => Ok(()),
        }
    }

    /// The boundary of the shape in the box of the cells and a distance around it, with exact distances. In the plane it is
    /// that of a cylinder along z.
    fn surface<const D: usize>(
        &self,
        bounds: &Aabb<3>,
        cells: usize,
        distance: f64,
    ) -> Result<ImplicitSurface, CellsError> {
        let size = bounds.size().iter().take(D).copied().fold(0.0, f64::max);
        let around = distance.abs() + size / cells as f64;
        let (mut min, mut max) = (bounds.min - Vector::<3>::repeat(around), bounds.max + Vector::<3>::repeat(around));
        if D < 3 {
            (min[2], max[2]) = (-around, around);
        }
        let body = self.with_rigid::<D>(bounds, cells, RigidBy::Level)?;
        let body = body.map(&|shape| Arc::new(Cylinder(shape.clone())));
        let count = (PER_CELL * cells).clamp(LEAST_CELLS, MOST_CELLS);
        Ok(ImplicitSurface::new(body, Aabb::new(min, max), count)?)
    }
}

/// A shape of space in the dimension of the body: itself, or its section.
fn section<const D: usize>(shape: impl ImplicitShape<3> + 'static) -> Domain<D> {
    Domain::shape(Section(Arc::new(shape)))
}

/// The box of all voxels.
pub(super) fn image_bounds(image: &ImageData) -> Option<Aabb<3>> {
    let n = image.count.len();
    let part = |list: &[f64], k: usize| list.get(k).copied();
    let side = |k: usize| Some((part(&image.origin, k)?, part(&image.spacing, k)? * *image.count.get(k)? as f64));
    let mut out = Aabb::new(Point::<3>::zeros(), Point::<3>::zeros());
    for k in 0..n.min(3) {
        let (low, length) = side(k)?;
        (out.min[k], out.max[k]) = (low, low + length);
    }
    Some(out)
}
