//! The half space below a plane.

use super::{GapJet, RigidShape};
use crate::{Point, Vector};

/// The half space below a plane.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    pub point: Point<3>,
    /// Unit normal out of the body.
    pub normal: Vector<3>,
}

impl RigidShape for Plane {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        GapJet::flat(self.normal.dot(&(x - self.point)), self.normal)
    }

    fn centre(&self) -> Point<3> {
        self.point
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing;
    use super::*;

    #[test]
    fn the_gap_of_a_plane() {
        let normal = Vector::<3>::new(0.1, 0.2, 1.0).normalize();
        let plane = Plane { point: Point::<3>::new(0.0, 0.0, 0.1), normal };
        let along = normal.cross(&Vector::<3>::x());
        testing::check(&plane, &[plane.point, plane.point + along * 3.0]);
        testing::check_moved(&plane, |m| Plane { point: m.point(&plane.point), normal: m.vector(&normal) });
    }
}
