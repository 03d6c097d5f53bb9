//! A paraboloid of revolution.

use super::height::{points_away, rising, squared_distance};
use super::{ClosestPoints, GapJet, NoHeight, Normals, RigidShape, any_normal};
use crate::height_field::{HeightField, View};
use crate::shape::{Axes, ShapeError, Surface};
use crate::{Jet, Matrix, Point, Real, Vector};
use std::sync::Arc;

/// A paraboloid of revolution, as far as four radii from its axis.
#[derive(Clone, Debug)]
pub struct Paraboloid {
    apex: Point<3>,
    axis: Vector<3>,
    radius: f64,
    surface: ClosestPoints,
}

impl Paraboloid {
    /// From its apex, the unit vector along its axis, into the body, and its radius of curvature at the apex.
    ///
    /// # Errors
    /// Numbers that are not finite, or a radius of zero.
    pub fn new(apex: Point<3>, axis: Vector<3>, radius: f64) -> Result<Self, ShapeError> {
        let ex = any_normal(&axis);
        let axes = Axes { origin: apex, ex, ey: axis.cross(&ex), ez: axis };
        let range = [[-4.0 * radius, 4.0 * radius]; 2];
        let surface = Surface::graph(axes, [0.5 / radius, 0.5 / radius, 0.0], range)?;
        // The axis points into the body, so does the normal of the graph.
        Ok(Paraboloid {
            apex,
            axis,
            radius,
            surface: ClosestPoints { shape: surface.into(), normals: Normals::Inward },
        })
    }
}

impl RigidShape for Paraboloid {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        self.surface.gap(x)
    }

    /// `ρ²/(2 R) - z`.
    fn level(&self, x: &Point<3>) -> Jet<3> {
        let d = x - self.apex;
        let along = self.axis.dot(&d);
        let across = d - self.axis * along;
        let flat = Matrix::<3>::identity() - self.axis * self.axis.transpose();
        Jet {
            value: 0.5 * across.norm_squared() / self.radius - along,
            gradient: across / self.radius - self.axis,
            hessian: flat / self.radius,
        }
    }

    fn centre(&self) -> Point<3> {
        self.apex
    }

    fn height(&self, view: View, _: f64) -> Result<Arc<dyn HeightField>, NoHeight> {
        if !points_away(&self.axis, view) {
            return Err(NoHeight::AxisNotAway);
        }
        let (apex, diameter) = (self.apex, 2.0 * self.radius);
        let c = Jet::<2>::constant;
        Ok(rising(view, apex[2], move |x| -squared_distance(x, &apex, [1.0; 2]) / c(diameter)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing;
    use super::*;

    #[test]
    fn the_gap_of_a_paraboloid() {
        let (apex, axis) = (Point::<3>::new(0.1, 0.2, -0.1), Vector::<3>::z());
        let paraboloid = Paraboloid::new(apex, axis, 1.0).unwrap();
        let on_it = [apex, apex + Vector::<3>::new(0.6, 0.8, 0.5)];
        testing::check(&paraboloid, &on_it);
        testing::check_level(&paraboloid, &on_it);
        testing::check_height(&paraboloid, View::FromBelow);
        assert_eq!(paraboloid.height(View::FromAbove, 0.0).unwrap_err(), NoHeight::AxisNotAway);
        testing::check_moved(&paraboloid, |m| Paraboloid::new(m.point(&apex), m.vector(&axis), 1.0).unwrap());
        // The axis points into the body.
        assert!(paraboloid.gap(&(apex + axis * 0.2)).gap < 0.0);
        assert!(Paraboloid::new(apex, axis, f64::NAN).is_err());
    }
}
