//! What a surface of faces is to contact by mortar: faces with functions, where they are in a state.

use crate::points::{Foot, Placed};
use signorini_contact::ContactSurface;
use signorini_geometry::Vector;

/// Coordinates on a face.
pub type Local = [f64; 3];

/// Faces at rest, of a plane or axisymmetric body or of one in space.
#[derive(Clone, Copy)]
pub enum Faces<'a> {
    Plane(&'a dyn ContactSurface<2>),
    Space(&'a dyn ContactSurface<3>),
}

/// A surface of faces in a state. Faces have the numbers of [`Faces`].
pub trait Surface: Sync {
    /// The faces at rest, and the displacements of their unknowns.
    fn faces(&self) -> (Faces<'_>, &[f64]);

    /// Outward normal averaged over the faces that meet, of any length: a direction that changes without jumps from face to
    /// face.
    fn normal(&self, face: usize, s: &Local) -> Vector<3>;

    /// A point as one that is tested, with the averaged normal and what moves both; second derivatives of the normal only where
    /// they are asked for.
    fn placed(&self, face: usize, s: &Local, bends: bool) -> Placed;

    /// A point as one that is met: position and tangents, with what moves them.
    fn met(&self, face: usize, s: &Local) -> Foot;

    /// The force per area that moves a face by a unit of length, about: the scale of penalties.
    fn stiffness(&self, face: usize) -> f64;
}
