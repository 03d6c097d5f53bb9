//! The half space below a plane.

use super::height::formula;
use super::{GapJet, NoHeight, RigidShape};
use crate::height_field::{HeightField, View};
use crate::{Jet, Point, Real, Vector};
use std::sync::Arc;

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

    fn height(&self, view: View, _: f64) -> Result<Arc<dyn HeightField>, NoHeight> {
        let (p, n) = (self.point, self.normal);
        if view.sign() * n[2] <= 0.0 {
            return Err(NoHeight::LooksAway);
        }
        let slopes = [n[0] / n[2], n[1] / n[2]];
        let c = Jet::<2>::constant;
        Ok(formula(move |[x, y]| c(p[2]) - c(slopes[0]) * (x - c(p[0])) - c(slopes[1]) * (y - c(p[1]))))
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
        testing::check_height(&plane, View::FromAbove);
        assert_eq!(plane.height(View::FromBelow, 0.0).unwrap_err(), NoHeight::LooksAway);
        testing::check_moved(&plane, |m| Plane { point: m.point(&plane.point), normal: m.vector(&normal) });
    }
}
