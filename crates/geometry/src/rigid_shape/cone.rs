//! A round cone without end.

use super::height::{points_away, rising, sqrt, squared_distance};
use super::{GapJet, NoHeight, RigidShape, any_normal, curvature, directions_around, gap_to_line, unit};
use crate::height_field::{HeightField, View};
use crate::{Jet, Point, Real, Vector};
use std::sync::Arc;

/// A round cone without end.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    pub apex: Point<3>,
    /// Unit vector along the axis, from the apex into the body.
    pub axis: Vector<3>,
    /// Angle between the axis and the surface, between 0 and π/2.
    pub half_angle: f64,
}

impl RigidShape for Cone {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        let (sin, cos) = self.half_angle.sin_cos();
        let axis = &self.axis;
        let d = x - self.apex;
        let along = axis.dot(&d);
        let across = d - axis * along;
        let e = unit(across, any_normal(axis));
        let r = across.norm();
        // Beyond the apex the apex itself is closest.
        if along * cos + r * sin < 0.0 {
            return GapJet::ball(x, &self.apex, 0.0);
        }
        let around = axis.cross(&e);
        let hessian = around * around.transpose() * (cos * curvature(r));
        GapJet { gap: r * cos - along * sin, normal: e * cos - axis * sin, hessian }
    }

    fn around(&self, x: &Point<3>) -> Vec<GapJet<3>> {
        let (sin, cos) = self.half_angle.sin_cos();
        let d = x - self.apex;
        let across = d - self.axis * self.axis.dot(&d);
        let meridians = directions_around(&self.axis, &across).map(|e| self.axis * cos + e * sin);
        meridians
            .map(|along| match along.dot(&d) > 0.0 {
                true => gap_to_line(x, &self.apex, &along),
                false => GapJet::ball(x, &self.apex, 0.0),
            })
            .collect()
    }

    fn centre(&self) -> Point<3> {
        self.apex
    }

    fn height(&self, view: View, rounding: f64) -> Result<Arc<dyn HeightField>, NoHeight> {
        if !points_away(&self.axis, view) {
            return Err(NoHeight::AxisNotAway);
        }
        let (apex, slope) = (self.apex, 1.0 / self.half_angle.tan());
        let c = Jet::<2>::constant;
        Ok(rising(view, apex[2], move |x| {
            -c(slope) * sqrt(squared_distance(x, &apex, [1.0; 2]) + c(rounding * rounding))
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing;
    use super::*;

    #[test]
    fn the_gap_of_a_cone() {
        let axis = Vector::<3>::new(0.1, 0.0, 1.0).normalize();
        let cone = Cone { apex: Point::<3>::new(0.0, 0.0, -1.0), axis, half_angle: 0.5 };
        let on_it = cone.apex + axis * 0.5f64.cos() + Vector::<3>::y() * 0.5f64.sin();
        testing::check(&cone, &[cone.apex, on_it]);
        assert_eq!(cone.height(View::FromBelow, 0.0).unwrap_err(), NoHeight::AxisNotAway);
        let upright = Cone { axis: Vector::<3>::z(), ..cone };
        testing::check_height(&upright, View::FromBelow);
        assert_eq!(upright.height(View::FromAbove, 0.0).unwrap_err(), NoHeight::AxisNotAway);
        // The apex is rounded off in proportion to its slope.
        let apex = upright.height(View::FromBelow, 1e-3).unwrap().jet(&Vector::<2>::zeros());
        assert!(apex.is_finite() && (apex.value - (-1.0 + 1e-3 / 0.5f64.tan())).abs() < 1e-15, "{apex:?}");
        testing::check_moved(&cone, |m| Cone { apex: m.point(&cone.apex), axis: m.vector(&axis), ..cone });
        // Beyond the apex the distance is that of the apex.
        let beyond = cone.apex - axis * 0.3 + Vector::<3>::y() * 0.1;
        assert!((cone.gap(&beyond).gap - 0.1f64.sqrt()).abs() < 1e-15);
        testing::check_derivatives(&cone, &beyond);
    }
}
