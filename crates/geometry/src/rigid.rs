//! Rigid motion of shapes.

use crate::shape::{Curve, Shape, Surface};
use crate::similarity::Similarity;
use crate::{Matrix, Point, Vector};

/// A rotation followed by a translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMotion {
    pub rotation: Matrix<3>,
    pub translation: Vector<3>,
    /// The rotation vector as stated, whole turns included.
    pub turn: Vector<3>,
}

impl RigidMotion {
    /// The rotation by the length of `rotation` about its direction through `centre`, then a displacement.
    pub fn new(rotation: Vector<3>, centre: Point<3>, displacement: Vector<3>) -> Self {
        let turn = rotation;
        let rotation = nalgebra::Rotation3::new(turn).into_inner();
        RigidMotion { rotation, translation: centre + displacement - rotation * centre, turn }
    }

    /// Where a position goes.
    pub fn point(&self, x: &Point<3>) -> Point<3> {
        self.rotation * x + self.translation
    }

    /// Where a direction goes.
    pub fn vector(&self, v: &Vector<3>) -> Vector<3> {
        self.rotation * v
    }

    fn similarity(&self) -> Similarity {
        Similarity { factor: 1.0, rotation: self.rotation, translation: self.translation }
    }

    /// A moved curve.
    pub fn curve(&self, c: &Curve) -> Curve {
        self.similarity().curve(c)
    }

    /// A moved surface.
    pub fn surface(&self, s: &Surface) -> Surface {
        self.similarity().surface(s)
    }

    /// A moved shape. Implicit surfaces and solids keep their functions and faces and cannot be moved: `None`.
    pub fn shape(&self, shape: &Shape) -> Option<Shape> {
        Some(match shape {
            Shape::Mesh(m) => {
                let mut mesh = m.as_ref().clone();
                mesh.move_vertices(m.vertices().iter().map(|v| self.point(v)).collect()).ok()?;
                mesh.into()
            }
            Shape::Implicit(_) | Shape::Solid(_)
                if *self == Self::new(Vector::<3>::zeros(), Point::<3>::zeros(), Vector::<3>::zeros()) =>
            {
                shape.clone()
            }
            _ => return self.similarity().shape(shape),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closest::{Query, closest};
    use crate::shape::Axes;

    #[test]
    fn moving_both_partners_changes_no_distance() {
        let motion = RigidMotion::new(
            Vector::<3>::new(0.3, -0.8, 0.5),
            Point::<3>::new(0.2, 0.1, 0.0),
            Vector::<3>::new(1.0, 2.0, -0.5),
        );
        let axes = Axes::standard(Point::<3>::new(0.1, 0.2, 0.3));
        let points = [[0.0, 0.0, 0.0], [1.0, 0.3, 0.2], [0.4, 1.2, -0.3], [1.1, 1.0, 0.5]].map(Point::<3>::from);
        let weights = [1.0, 0.5, 2.0, 1.5];
        let curve = Curve::bezier(&points, Some(&weights)).unwrap();
        let shapes: Vec<Shape> = vec![
            Shape::Point(Point::<3>::new(2.0, -1.0, 1.0)),
            Curve::helix(axes, 0.5, 0.2, [0.0, 6.0]).unwrap().into(),
            Surface::revolution(&curve, Point::<3>::new(3.0, 0.0, 0.0), Vector::<3>::z(), [0.0, 2.0], false)
                .unwrap()
                .into(),
            curve.into(),
            Surface::quad4(&points).unwrap().into(),
            Surface::tri3(&[points[0], points[1], points[2]]).unwrap().into(),
            Surface::torus(axes, 1.0, 0.3, [[0.0, 3.0], [0.0, 3.0]], [false; 2]).unwrap().into(),
        ];
        for (k, a) in shapes.iter().enumerate() {
            for b in &shapes[k + 1..] {
                let before = closest(a, b, &Query::default()).distance();
                let after = closest(&motion.shape(a).unwrap(), &motion.shape(b).unwrap(), &Query::default()).distance();
                assert!((before - after).abs() < 1e-12, "{before} {after}");
            }
            let z = [0.4, 0.3];
            if let (Shape::Surface(s), Shape::Surface(t)) = (a, motion.shape(a).unwrap()) {
                assert!((motion.point(&s.position(z[0], z[1])) - t.position(z[0], z[1])).norm() < 1e-14);
            }
        }
    }
}
