//! Blocks: boxes with any orientation, in the plane rectangles.

use super::{GapJet, Polyhedron, RigidShape};
use crate::mass_properties::MassProperties;
use crate::mesh::TriangleMesh;
use crate::polyhedra::Features;
use crate::shape::ShapeError;
use crate::{Aabb, Looking, Matrix, Point, Vector};

/// The faces of a block, by the numbers of its corners: bit `i` of a number tells on which side the corner is along axis `i`.
const FACES: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
/// How far a rectangle reaches across the plane, in its longest sides: what lies in the plane is nearest to its sides.
const ACROSS: f64 = 10.0;

/// A block: a polyhedron that knows its middle.
#[derive(Clone, Debug)]
pub struct Block {
    body: Polyhedron,
    centre: Point<3>,
    /// Zero across the plane for a rectangle.
    edges: Vector<3>,
    rotation: Matrix<3>,
}

impl Block {
    /// A block with these edges, rotated about its centre.
    ///
    /// # Errors
    /// Edges that span no volume.
    pub fn new(centre: Point<3>, edges: Vector<3>, rotation: Matrix<3>) -> Result<Self, ShapeError> {
        let body = Polyhedron::new(mesh(&centre, &edges, &rotation)?).ok_or_else(no_volume)?;
        Ok(Block { body, centre, edges, rotation })
    }

    /// A rectangle in the plane, by its sides and the angle of rotation about its centre.
    ///
    /// # Errors
    /// Sides that span no area.
    pub fn rectangle(centre: Point<3>, [a, b]: [f64; 2], angle: f64) -> Result<Self, ShapeError> {
        let rotation = nalgebra::Rotation3::new(Vector::<3>::z() * angle).into_inner();
        let deep = mesh(&centre, &Vector::<3>::new(a, b, 2.0 * ACROSS * a.max(b)), &rotation)?;
        let body = Polyhedron::prism(deep).ok_or_else(no_volume)?;
        Ok(Block { body, centre, edges: Vector::<3>::new(a, b, 0.0), rotation })
    }

    /// The corners.
    pub fn corners(&self) -> Vec<Point<3>> {
        let count = if self.edges[2] > 0.0 { 8 } else { 4 };
        (0..count).map(|k| corner(k, &self.centre, &self.edges, &self.rotation)).collect()
    }

    /// The area of the surface; the circumference of a rectangle.
    pub fn surface(&self) -> f64 {
        let [a, b, c] = [0, 1, 2].map(|i| self.edges[i]);
        2.0 * if c > 0.0 { a * b + b * c + c * a } else { a + b }
    }
}

fn no_volume() -> ShapeError {
    ShapeError::new("box", "its edges span no volume".to_string())
}

fn corner(number: usize, centre: &Point<3>, edges: &Vector<3>, rotation: &Matrix<3>) -> Point<3> {
    let half = Vector::<3>::from_fn(|i, _| if number >> i & 1 == 1 { 0.5 * edges[i] } else { -0.5 * edges[i] });
    centre + rotation * half
}

fn mesh(centre: &Point<3>, edges: &Vector<3>, rotation: &Matrix<3>) -> Result<TriangleMesh, ShapeError> {
    let triangles: Vec<[u32; 3]> = FACES.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect();
    TriangleMesh::new((0..8).map(|k| corner(k, centre, edges, rotation)).collect(), &triangles)
}

impl RigidShape for Block {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        self.body.gap(x)
    }

    fn facing(&self, x: &Point<3>, looking: &Looking) -> Option<GapJet<3>> {
        self.body.facing(x, looking)
    }

    fn centre(&self) -> Point<3> {
        self.centre
    }

    fn bounds(&self) -> Option<Aabb<3>> {
        Aabb::around(self.corners())
    }

    /// Of a rectangle those of a plate of thickness one.
    fn mass_properties(&self) -> Option<MassProperties> {
        let own = MassProperties::block(self.centre, self.edges);
        Some(MassProperties { inertia: self.rotation * own.inertia * self.rotation.transpose(), ..own })
    }

    fn features(&self) -> Option<&Features> {
        self.body.features()
    }
}
