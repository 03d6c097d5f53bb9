//! A ring.

use super::height::{circle, is_upright, rising, sqrt, squared_distance};
use super::{GapJet, NoHeight, RigidShape, any_normal, curvature, directions_around, unit};
use crate::height_field::{HeightField, View};
use crate::mass_properties::MassProperties;
use crate::{Aabb, Jet, Matrix, Point, Real, Vector};
use std::sync::Arc;

/// A ring: everything closer than `minor` to a circle of radius `major`.
#[derive(Clone, Copy, Debug)]
pub struct Torus {
    pub center: Point<3>,
    /// Unit vector along the axis.
    pub axis: Vector<3>,
    /// Radius of the circle in the middle of the tube.
    pub major: f64,
    /// Radius of the tube, less than `major`.
    pub minor: f64,
}

/// Squared distance to the ring, in radii of the tube, and distance to the axis, in radii of the ring, that are near: far from
/// the surface and from any step of a search on it.
const NEAR: f64 = 1.0 / 16.0;

impl RigidShape for Torus {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        let axis = &self.axis;
        let d = x - self.center;
        let across = d - axis * axis.dot(&d);
        let e = unit(across, any_normal(axis));
        let from_ring = d - e * self.major;
        let normal = unit(from_ring, *axis);
        let around = axis.cross(&e);
        let tube = around.cross(&normal);
        let hessian = tube * tube.transpose() * curvature(from_ring.norm())
            + around * around.transpose() * (normal.dot(&e) * curvature(across.norm()));
        GapJet { gap: from_ring.norm() - self.minor, normal, hessian }
    }

    /// `((ρ - R)² + z² - r²)/(2 r)` with the distance `ρ` from the axis and `z` along it: one root. It has no gradient on the
    /// ring, and none that is known on the axis; near both it is the gap.
    fn level(&self, x: &Point<3>) -> Jet<3> {
        let d = x - self.center;
        let z = self.axis.dot(&d);
        let across = d - self.axis * z;
        let rho = across.norm();
        let beyond = rho - self.major;
        let square = beyond * beyond + z * z;
        if square < NEAR * self.minor * self.minor || rho < NEAR * self.major {
            let GapJet { gap, normal, hessian } = self.gap(x);
            return Jet { value: gap, gradient: normal, hessian };
        }
        let (inverse, ratio) = (1.0 / self.minor, self.major / rho);
        let e = across * (1.0 / rho);
        let in_plane = e * e.transpose() + self.axis * self.axis.transpose();
        Jet {
            value: 0.5 * (square - self.minor * self.minor) * inverse,
            gradient: (e * beyond + self.axis * z) * inverse,
            hessian: (in_plane * ratio + Matrix::<3>::identity() * (1.0 - ratio)) * inverse,
        }
    }

    fn around(&self, x: &Point<3>) -> Vec<GapJet<3>> {
        // From within the tube the other meridians are no bounds.
        if self.gap(x).gap < 0.0 {
            return Vec::new();
        }
        let d = x - self.center;
        let across = d - self.axis * self.axis.dot(&d);
        let meridian = |e: Vector<3>| GapJet::ball(x, &(self.center + e * self.major), self.minor);
        directions_around(&self.axis, &across).map(meridian).collect()
    }

    fn centre(&self) -> Point<3> {
        self.center
    }

    fn bounds(&self) -> Option<Aabb<3>> {
        let half = Vector::<3>::repeat(self.major + self.minor);
        Some(Aabb::new(self.center - half, self.center + half))
    }

    fn mass_properties(&self) -> Option<MassProperties> {
        Some(MassProperties::ring(self.center, &self.axis, [self.major, self.minor]))
    }

    fn height(&self, view: View, rounding: f64) -> Result<Arc<dyn HeightField>, NoHeight> {
        let Torus { center, axis, major, minor } = *self;
        if !is_upright(&axis) {
            return Err(NoHeight::AxisNotUpright);
        }
        let c = Jet::<2>::constant;
        Ok(rising(view, center[2], move |x| {
            let across = sqrt(squared_distance(x, &center, [1.0; 2]) + c(rounding * rounding)) - c(major);
            circle(across * across, minor)
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing;
    use super::*;

    #[test]
    fn the_gap_of_a_torus() {
        let axis = Vector::<3>::new(0.0, 0.2, 1.0).normalize();
        let torus = Torus { center: Point::<3>::new(0.0, 0.1, 0.0), axis, major: 0.8, minor: 0.2 };
        let ring = torus.center + Vector::<3>::x() * 0.8;
        let on = |tube: Vector<3>, round: Vector<3>| {
            torus.center + (round - axis * axis.dot(&round)).normalize() * 0.8 + tube
        };
        let out = (Vector::<3>::y() - axis * axis[1]).normalize();
        testing::check_level(
            &torus,
            &[ring + axis * 0.2, on(out * 0.2, Vector::<3>::y()), on(out * -0.2, Vector::<3>::y())],
        );
        testing::check(&torus, &[ring + axis * 0.2, ring + Vector::<3>::x() * 0.2, ring - Vector::<3>::x() * 0.2]);
        assert_eq!(torus.height(View::FromAbove, 0.0).unwrap_err(), NoHeight::AxisNotUpright);
        let upright = Torus { axis: Vector::<3>::z(), major: 0.2, minor: 0.19, ..torus };
        testing::check_height(&upright, View::FromAbove);
        testing::check_height(&upright, View::FromBelow);
        testing::check_moved(&torus, |m| Torus { center: m.point(&torus.center), axis: m.vector(&axis), ..torus });
    }
}
