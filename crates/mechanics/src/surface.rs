//! What a surface of faces is to contact by mortar: faces with functions, where they are in a state.

use crate::points::{Direction, SlavePoint};
use signorini_contact::{ContactSurface, ShapeFunction};
use signorini_geometry::{Point, Vector};

/// Coordinates on a face.
pub type Local = [f64; 3];

/// Faces at rest, of a plane or axisymmetric body or of one in space.
#[derive(Clone, Copy)]
pub enum Faces<'a> {
    Plane(&'a dyn ContactSurface<2>),
    Space(&'a dyn ContactSurface<3>),
}

/// A point of a face where it is now.
pub(crate) struct SurfacePoint {
    pub x: Point<3>,
    /// Derivatives of `x` along the coordinates; in the plane the second points across it.
    pub tangents: [Vector<3>; 2],
    /// What moves it: each function along as many axes as the body has.
    pub functions: Vec<ShapeFunction>,
}

/// A surface of faces in a state. Faces have the numbers of [`Faces`].
pub trait Surface: Sync {
    /// The faces at rest, and the displacements of their unknowns.
    fn faces(&self) -> (Faces<'_>, &[f64]);

    /// The averaged outward normal at each vertex of a face, of any length. Between them it changes like the functions of the
    /// vertices: without jumps from face to face.
    fn corners(&self, face: usize) -> &[Direction];

    /// A point as one that is tested.
    fn placed(&self, face: usize, s: &Local) -> SlavePoint;

    /// The depth of the cell behind a face.
    fn depth(&self, face: usize) -> f64;

    /// The force per area that moves a face by a unit of length, about: the scale of penalties.
    fn stiffness(&self, face: usize) -> f64;
}

impl dyn Surface + '_ {
    pub fn face_count(&self) -> usize {
        match self.faces().0 {
            Faces::Plane(faces) => faces.face_count(),
            Faces::Space(faces) => faces.face_count(),
        }
    }

    /// The vertices of a face at rest.
    pub fn vertices_at_rest(&self, face: usize) -> Vec<Point<3>> {
        match self.faces().0 {
            Faces::Plane(faces) => vertices(faces, face),
            Faces::Space(faces) => vertices(faces, face),
        }
    }

    /// The mean length of the sides of a face at rest.
    pub fn size(&self, face: usize) -> f64 {
        let at = self.vertices_at_rest(face);
        let sides = match self.faces().0 {
            Faces::Plane(faces) => faces.shape(face),
            Faces::Space(faces) => faces.shape(face),
        }
        .edges();
        sides.iter().map(|&[a, b]| (at[b] - at[a]).norm()).sum::<f64>() / sides.len() as f64
    }

    /// Axes along which unknowns move a point.
    pub(crate) fn dimension(&self) -> usize {
        match self.faces().0 {
            Faces::Plane(_) => 2,
            Faces::Space(_) => 3,
        }
    }

    /// The share of each vertex in the averaged normal at a point.
    pub(crate) fn vertex_functions(&self, face: usize, s: &Local) -> Vec<f64> {
        let shape = match self.faces().0 {
            Faces::Plane(faces) => faces.shape(face),
            Faces::Space(faces) => faces.shape(face),
        };
        (0..shape.vertices().len()).map(|k| shape.vertex_function(k, s)).collect()
    }

    /// The averaged normal at a point, of any length.
    pub(crate) fn normal(&self, face: usize, s: &Local) -> Vector<3> {
        self.corners(face).iter().zip(self.vertex_functions(face, s)).map(|(corner, share)| corner.vector * share).sum()
    }

    pub(crate) fn point(&self, face: usize, s: &Local) -> SurfacePoint {
        match self.faces() {
            (Faces::Plane(faces), u) => point(faces, u, face, s),
            (Faces::Space(faces), u) => point(faces, u, face, s),
        }
    }
}

fn vertices<const D: usize>(faces: &dyn ContactSurface<D>, face: usize) -> Vec<Point<3>> {
    let spatial = |x: Point<D>| Point::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 });
    faces.shape(face).vertices().iter().map(|s| spatial(faces.at(face, s).x)).collect()
}

fn point<const D: usize>(faces: &dyn ContactSurface<D>, u: &[f64], face: usize, s: &Local) -> SurfacePoint {
    let spatial = |x: &Point<D>| Point::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 });
    let functions = faces.functions(face, s);
    let mut at = faces.at(face, s);
    for f in &functions {
        let u = Point::<D>::from_fn(|i, _| u[f.unknown as usize + i]);
        at.x += u * f.value;
        (0..D - 1).for_each(|a| at.tangents[a] += u * f.slopes[a]);
    }
    let mut tangents = at.tangents.each_ref().map(spatial);
    if D == 2 {
        tangents[1] = Vector::<3>::z();
    }
    SurfacePoint { x: spatial(&at.x), tangents, functions }
}
