//! Geometry for contact: curves, implicit shapes and closest points.
//!
//! Nothing here knows about contact, materials or files. The layer answers where things are: the value and the
//! derivatives of a field, the closest point of a curve, the side on which a point lies, the outline of a level set.
//!
//! - [`jet`]: scalars that carry exact first and second derivatives.
//! - [`implicit`]: shapes given by a function that is negative inside, and bodies made of them.
//! - [`spline`]: periodic splines of any degree, the representation of a contact front.
//! - [`closed_curve`]: closed oriented curves with closest point, winding number and arc length.
//! - [`shape`]: points, curves and surfaces of space with exact derivatives.
//! - [`closest`]: closest points of any two of them, certified.
//! - [`frame`]: metric, curvature and frames of curves and surfaces.
//! - [`measures`]: gap and coordinates of a contact pair with their first and second variations.
//! - [`mass_properties`]: volume, centre of mass and moments of inertia.
//! - [`body`]: bodies of many shapes, and the closest pair between two.
//! - [`existence`]: where projections exist and are unique.
//! - [`mesh`]: triangle meshes; [`bvh`]: the search tree under them.
//! - [`implicit_surface`]: bodies given by functions, with the exact closest point of their boundary.
//! - [`rigid`]: rigid motion of shapes.
//! - [`rigid_shape`]: gap, normal and curvature of rigid bodies, one file a shape.
//! - [`height_field`]: heights over a plane, as bodies are seen from above or below.
//! - [`grid_spline`]: functions given by values on a grid.
//! - [`outline`]: closed outlines of a function sampled on a grid.
//! - [`polyhedra`]: facets, edges and corners of closed triangle meshes, and where two of them meet.
//! - [`trimmed`]: solids of CAD programs, within faces that are parts of surfaces.
//! - [`polygon`]: winding numbers, areas and crossings of polygons.

pub mod aabb;
pub mod body;
pub mod bvh;
pub mod closed_curve;
pub mod closest;
pub mod existence;
mod feature;
pub mod frame;
pub mod grid_spline;
pub mod height_field;
pub mod implicit;
pub mod implicit_surface;
pub mod jet;
mod looking;
pub mod mass_properties;
pub mod measures;
pub mod mesh;
pub mod outline;
pub(crate) mod patch;
pub mod polygon;
pub mod polyhedra;
pub mod rigid;
pub mod rigid_shape;
pub mod rule;
mod scale;
pub mod sets;
pub mod shape;
pub mod similarity;
pub mod spline;
mod straight;
pub mod trimmed;

pub use aabb::Aabb;
pub use closed_curve::{ClosedCurve, CurvePoint};
pub use implicit::{Ellipsoid, HalfSpace, ImplicitShape};
pub use jet::{Jet, Real};
pub use looking::Looking;
pub use spline::PeriodicBasis;

/// A vector of the plane or of space.
pub type Vector<const D: usize> = nalgebra::SVector<f64, D>;
/// A position; the same numbers as a [`Vector`], named for what it means.
pub type Point<const D: usize> = nalgebra::SVector<f64, D>;
/// A square matrix, such as a Hessian.
pub type Matrix<const D: usize> = nalgebra::SMatrix<f64, D, D>;
