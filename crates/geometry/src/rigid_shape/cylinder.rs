//! A round cylinder without ends.

use super::height::{circle, is_flat, rising};
use super::{GapJet, NoHeight, RigidShape, any_normal, curvature, directions_around, gap_to_line, unit};
use crate::height_field::{HeightField, View};
use crate::{Jet, Point, Real, Vector};
use std::sync::Arc;

/// A round cylinder without ends.
#[derive(Clone, Copy, Debug)]
pub struct Cylinder {
    /// A point of the axis.
    pub point: Point<3>,
    /// Unit vector along the axis.
    pub axis: Vector<3>,
    pub radius: f64,
}

impl RigidShape for Cylinder {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        let axis = &self.axis;
        let d = x - self.point;
        let across = d - axis * axis.dot(&d);
        let normal = unit(across, any_normal(axis));
        let around = axis.cross(&normal);
        let hessian = around * around.transpose() * curvature(across.norm());
        GapJet { gap: across.norm() - self.radius, normal, hessian }
    }

    fn around(&self, x: &Point<3>) -> Vec<GapJet<3>> {
        let d = x - self.point;
        let across = d - self.axis * self.axis.dot(&d);
        let meridian = |e: Vector<3>| gap_to_line(x, &(self.point + e * self.radius), &self.axis);
        directions_around(&self.axis, &across).map(meridian).collect()
    }

    fn centre(&self) -> Point<3> {
        self.point
    }

    fn height(&self, view: View, _: f64) -> Result<Arc<dyn HeightField>, NoHeight> {
        let Cylinder { point, axis, radius } = *self;
        if !is_flat(&axis) {
            return Err(NoHeight::AxisNotFlat);
        }
        let length = axis[0].hypot(axis[1]);
        let across = [-axis[1] / length, axis[0] / length];
        let c = Jet::<2>::constant;
        Ok(rising(view, point[2], move |[x, y]| {
            let distance = c(across[0]) * (x - c(point[0])) + c(across[1]) * (y - c(point[1]));
            circle(distance * distance, radius)
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing;
    use super::*;

    #[test]
    fn the_gap_of_a_cylinder() {
        let axis = Vector::<3>::new(0.0, 1.0, 0.3).normalize();
        let cylinder = Cylinder { point: Point::<3>::new(0.1, 0.0, -0.1), axis, radius: 0.3 };
        let on_it = cylinder.point + Vector::<3>::x() * 0.3;
        testing::check(&cylinder, &[on_it, on_it + axis * 7.0]);
        assert_eq!(cylinder.height(View::FromAbove, 0.0).unwrap_err(), NoHeight::AxisNotFlat);
        let flat = Cylinder { axis: Vector::<3>::new(0.6, 0.8, 0.0), ..cylinder };
        testing::check_height(&flat, View::FromAbove);
        testing::check_height(&flat, View::FromBelow);
        testing::check_moved(&cylinder, |m| Cylinder {
            point: m.point(&cylinder.point),
            axis: m.vector(&axis),
            ..cylinder
        });
    }
}
