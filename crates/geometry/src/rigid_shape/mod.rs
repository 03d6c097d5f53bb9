//! Rigid shapes: the gap of a point to them with its gradient and Hessian, and the height in which a membrane sees them,
//! one file a shape.
//!
//! With `g` the gap, `n = ∇g` the outward normal and `H = ∇∇g`:
//!
//! | shape | `g` | `H` |
//! |---|---|---|
//! | [`Plane`] | `n·(x - p)` | `0` |
//! | [`Sphere`] | `\|x - c\| - R` | `(I - nn) / \|x - c\|` |
//! | [`Cylinder`] about `k` | `ρ - R` | `tt / ρ`, `t = k × n` |
//! | [`Cone`] of half angle `γ` about `k` | `ρ cos γ - z sin γ` | `tt cos γ / ρ`, `t = k × e_ρ` |
//! | [`Torus`] about `k` | `d - r`, `d = \|x - R e_ρ\|` | `mm / d + tt (n·e_ρ) / ρ`, `m = t × n` |
//! | [`Revolution`] of a profile about `k` | closest point of the profile | `mm S/(1 + g S) + tt (n·e_ρ) / ρ` |
//! | [`Ellipsoid`], [`Paraboloid`], [`Polyhedron`], [`ClosestPoints`] | certified closest point | of the surface at that point |
//! | [`TrimmedSolid`](crate::trimmed::TrimmedSolid) | closest point of its faces, edges and vertices | of the surface, the edge or the vertex |
//! | [`ImplicitSurface`](crate::implicit_surface::ImplicitSurface) | Newton on the foot | `S (I + g S)⁻¹` |
//!
//! Where a shape has no tangent plane (on an axis, at an apex) the normal is one of those that it has beside that place,
//! and infinite curvatures are left out.

mod block;
mod closest_points;
mod cone;
mod cylinder;
mod ellipsoid;
mod gap;
mod height;
mod implicit;
mod paraboloid;
mod plane;
mod polyhedron;
mod revolution;
mod sphere;
#[cfg(test)]
mod testing;
mod torus;

pub use block::Block;
pub use closest_points::{ClosestPoints, Normals};
pub use cone::Cone;
pub use cylinder::Cylinder;
pub use ellipsoid::Ellipsoid;
pub use gap::GapJet;
pub use height::NoHeight;
pub use paraboloid::Paraboloid;
pub use plane::Plane;
pub use polyhedron::Polyhedron;
pub use revolution::{Profile, ProfileJet, Revolution};
pub use sphere::Sphere;
pub use torus::Torus;

use crate::height_field::{HeightField, View};
use crate::mass_properties::MassProperties;
use crate::mesh::TriangleMesh;
use crate::polyhedra::Features;
use crate::{Aabb, Jet, Looking, Point, Vector};
use std::sync::Arc;

/// A body that does not deform.
pub trait RigidShape: Send + Sync {
    /// The gap of a point, negative inside, with its derivatives.
    fn gap(&self, x: &Point<3>) -> GapJet<3>;

    /// A function that vanishes on the surface and is negative inside, with gradient and Hessian: the gap itself, or what
    /// costs less. Near the surface `f / |∇f|` is the gap to second order.
    fn level(&self, x: &Point<3>) -> Jet<3> {
        let GapJet { gap, normal, hessian } = self.gap(x);
        Jet { value: gap, gradient: normal, hessian }
    }

    /// Gaps to other parts of the surface that a ball about `x` might touch at once: of a surface of revolution its meridians
    /// in other half-planes through the axis, as many as hold a ball in any direction across it. Each is a bound for
    /// itself: no ball that is in nothing is nearer to any of them than its radius.
    fn around(&self, _x: &Point<3>) -> Vec<GapJet<3>> {
        Vec::new()
    }

    /// The gap to the nearest face that a point inside looks at, of a body with edges: beside an edge the nearest face may be another.
    fn facing(&self, _x: &Point<3>, _looking: &Looking) -> Option<GapJet<3>> {
        None
    }

    /// The point about which the body turns.
    fn centre(&self) -> Point<3>;

    /// The box of the shape, where it has an end everywhere and a closed form tells it.
    fn bounds(&self) -> Option<Aabb<3>> {
        None
    }

    /// Volume, centre of mass and moments of inertia of the body in space; none of one without an end, or that has no closed form.
    fn mass_properties(&self) -> Option<MassProperties> {
        None
    }

    /// Its facets, edges and corners, if these are all that bounds it.
    fn features(&self) -> Option<&Features> {
        None
    }

    /// Triangles whose corners lie on the surface, for pictures.
    fn mesh(&self) -> Option<&TriangleMesh> {
        self.features().filter(|features| !features.is_flat()).map(Features::mesh)
    }

    /// The height over (x, y) of the surface that is seen from above or below, by a closed form. A point on the axis where
    /// the surface has no tangent plane is rounded off by the length `rounding`.
    ///
    /// # Errors
    /// Why there is no such height.
    fn height(&self, view: View, rounding: f64) -> Result<Arc<dyn HeightField>, NoHeight> {
        let _ = (view, rounding);
        Err(NoHeight::NoFormula)
    }
}

/// The inverse of a radius of curvature; zero where the curvature is infinite.
fn curvature(radius: f64) -> f64 {
    if radius > 0.0 { 1.0 / radius } else { 0.0 }
}

/// The unit vector along another one, or `otherwise` where that has no length.
fn unit(v: Vector<3>, otherwise: Vector<3>) -> Vector<3> {
    v.try_normalize(0.0).unwrap_or(otherwise)
}

/// Unit vectors across an axis that, with the one along `across`, part a turn into equal parts: a ball that is held by a ring is
/// held by so many of its points.
fn directions_around(axis: &Vector<3>, across: &Vector<3>) -> impl Iterator<Item = Vector<3>> {
    const PARTS: usize = 6;
    let e = unit(*across, any_normal(axis));
    let f = axis.cross(&e);
    (1..PARTS).map(move |k| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / PARTS as f64).sin_cos();
        e * cos + f * sin
    })
}

/// The gap of a point to a line along a unit vector through another point.
fn gap_to_line(x: &Point<3>, through: &Point<3>, along: &Vector<3>) -> GapJet<3> {
    let d = x - through;
    let across = d - along * along.dot(&d);
    let (gap, normal) = (across.norm(), unit(across, any_normal(along)));
    let tangent = along.cross(&normal);
    GapJet { gap, normal, hessian: tangent * tangent.transpose() * curvature(gap) }
}

/// Some unit vector across a unit vector.
fn any_normal(axis: &Vector<3>) -> Vector<3> {
    let mut across = Vector::<3>::zeros();
    across[axis.iamin()] = 1.0;
    (across - axis * axis.dot(&across)).normalize()
}
