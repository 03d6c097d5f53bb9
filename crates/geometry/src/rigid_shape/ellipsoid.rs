//! An ellipsoid along the axes.

use super::height::{circle, rising, squared_distance};
use super::{ClosestPoints, GapJet, NoHeight, Normals, RigidShape, curvature};
use crate::height_field::{HeightField, View};
use crate::mass_properties::MassProperties;
use crate::shape::{Axes, ShapeError, Surface};
use crate::{Aabb, Jet, Matrix, Point, Real, Vector};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

/// An ellipsoid along the axes.
#[derive(Clone, Debug)]
pub struct Ellipsoid {
    center: Point<3>,
    semi_axes: [f64; 3],
    surface: ClosestPoints,
}

impl Ellipsoid {
    /// # Errors
    /// A semi-axis that is not positive.
    pub fn new(center: Point<3>, semi_axes: [f64; 3]) -> Result<Self, ShapeError> {
        let whole = [[0.0, TAU], [-FRAC_PI_2, FRAC_PI_2]];
        let surface = Surface::ellipsoid(Axes::standard(center), semi_axes, whole, true)?;
        Ok(Ellipsoid { center, semi_axes, surface: ClosestPoints { shape: surface.into(), normals: Normals::Outward } })
    }
}

impl RigidShape for Ellipsoid {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        self.surface.gap(x)
    }

    /// `|x / a| - 1`, of degree one in the distance from the centre.
    fn level(&self, x: &Point<3>) -> Jet<3> {
        let inverse = Vector::<3>::from(self.semi_axes.map(f64::recip));
        let scaled = (x - self.center).component_mul(&inverse);
        let norm = scaled.norm();
        let way = scaled.try_normalize(0.0).unwrap_or_else(Vector::<3>::z).component_mul(&inverse);
        let squares = Matrix::<3>::from_diagonal(&inverse.component_mul(&inverse));
        Jet { value: norm - 1.0, gradient: way, hessian: (squares - way * way.transpose()) * curvature(norm) }
    }

    fn centre(&self) -> Point<3> {
        self.center
    }

    fn bounds(&self) -> Option<Aabb<3>> {
        let half = Vector::<3>::from(self.semi_axes);
        Some(Aabb::new(self.center - half, self.center + half))
    }

    fn mass_properties(&self) -> Option<MassProperties> {
        Some(MassProperties::ellipsoid(self.center, self.semi_axes))
    }

    fn height(&self, view: View, _: f64) -> Result<Arc<dyn HeightField>, NoHeight> {
        let (center, [a, b, stretch]) = (self.center, self.semi_axes);
        let c = Jet::<2>::constant;
        Ok(rising(view, center[2], move |x| c(stretch) * circle(squared_distance(x, &center, [a, b]), 1.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing;
    use super::*;

    #[test]
    fn the_gap_of_an_ellipsoid() {
        let center = Point::<3>::new(0.1, 0.2, -0.1);
        let ellipsoid = Ellipsoid::new(center, [0.6, 0.4, 0.3]).unwrap();
        let ways = [[1.0, 0.0, 0.0], [0.48, -0.6, 0.64], [0.0, 0.0, -1.0]].map(Vector::<3>::from);
        let on_it = ways.map(|w| center + w.component_mul(&Vector::<3>::new(0.6, 0.4, 0.3)));
        testing::check(&ellipsoid, &on_it);
        // The pole of the coordinates of the surface has no Hessian.
        testing::check_level(&ellipsoid, &on_it[..2]);
        testing::check_height(&ellipsoid, View::FromAbove);
        testing::check_height(&ellipsoid, View::FromBelow);
        // Along its axes it may only be shifted, not turned.
        let shift = Vector::<3>::new(1.0, -2.0, 0.5);
        let moved = Ellipsoid::new(center + shift, [0.6, 0.4, 0.3]).unwrap();
        for x in testing::PLACES.map(Point::<3>::from) {
            assert!((moved.gap(&(x + shift)).gap - ellipsoid.gap(&x).gap).abs() < 1e-14);
        }
        assert!(Ellipsoid::new(center, [0.6, 0.0, 0.3]).is_err());
    }
}
