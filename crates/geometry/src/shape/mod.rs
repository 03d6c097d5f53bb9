//! Points, curves and surfaces.

pub(crate) mod curve;
pub(crate) mod error;
mod moved;
pub(crate) mod surface;

pub(crate) use curve::CurveKind;
pub use curve::{Curve, CurveJet};
pub use error::{Axes, LARGEST_COORDINATE, ShapeError};
pub(crate) use surface::SurfaceKind;
pub use surface::{Surface, SurfaceJet};

use crate::implicit_surface::ImplicitSurface;
use crate::mesh::TriangleMesh;
use crate::trimmed::TrimmedSolid;
use crate::{Aabb, Point};
use std::sync::Arc;

/// A partner of a contact pair.
#[derive(Clone, Debug)]
pub enum Shape {
    Point(Point<3>),
    Curve(Box<Curve>),
    Surface(Box<Surface>),
    Mesh(Box<TriangleMesh>),
    Implicit(Arc<ImplicitSurface>),
    Solid(Arc<TrimmedSolid>),
}

impl Shape {
    /// 0, 1 or 2: a point, a curve or a surface.
    pub fn dimension(&self) -> usize {
        match self {
            Shape::Point(_) => 0,
            Shape::Curve(_) => 1,
            Shape::Surface(_) | Shape::Mesh(_) | Shape::Implicit(_) | Shape::Solid(_) => 2,
        }
    }

    /// Position at given parameters; those a shape does not have are ignored. `element` is the triangle of a mesh. Implicit
    /// surfaces and solids have no parameters: `None`.
    ///
    /// # Panics
    /// If a mesh has no such element.
    pub fn position(&self, element: usize, parameters: [f64; 2]) -> Option<Point<3>> {
        Some(match self {
            Shape::Point(p) => *p,
            Shape::Curve(c) => c.position(parameters[0]),
            Shape::Surface(s) => s.position(parameters[0], parameters[1]),
            Shape::Mesh(m) => m.position(element, parameters),
            Shape::Implicit(_) | Shape::Solid(_) => return None,
        })
    }

    /// A box that holds the shape; tight for points and meshes, a few percent wide for others.
    pub fn bounds(&self) -> Aabb<3> {
        let hull = |hull: &[Point<3>; 2]| Aabb::new(hull[0], hull[1]);
        match self {
            Shape::Point(p) => Aabb::new(*p, *p),
            Shape::Curve(c) => hull(c.atlas.hull()),
            Shape::Surface(s) => hull(s.atlas.hull()),
            Shape::Mesh(m) => *m.bounds(),
            Shape::Implicit(s) => *s.mesh().bounds(),
            Shape::Solid(s) => *s.hull(),
        }
    }

    /// Diagonal of the bounding box; zero for a point.
    pub fn size(&self) -> f64 {
        match self {
            Shape::Point(_) => 0.0,
            Shape::Curve(c) => c.size(),
            Shape::Surface(s) => s.size(),
            Shape::Mesh(m) => m.size(),
            Shape::Implicit(s) => s.mesh().size(),
            Shape::Solid(s) => s.size(),
        }
    }
}

impl From<Curve> for Shape {
    fn from(curve: Curve) -> Self {
        Shape::Curve(Box::new(curve))
    }
}

impl From<Surface> for Shape {
    fn from(surface: Surface) -> Self {
        Shape::Surface(Box::new(surface))
    }
}

impl From<TriangleMesh> for Shape {
    fn from(mesh: TriangleMesh) -> Self {
        Shape::Mesh(Box::new(mesh))
    }
}

impl From<ImplicitSurface> for Shape {
    fn from(surface: ImplicitSurface) -> Self {
        Shape::Implicit(Arc::new(surface))
    }
}

impl From<TrimmedSolid> for Shape {
    fn from(solid: TrimmedSolid) -> Self {
        Shape::Solid(Arc::new(solid))
    }
}
