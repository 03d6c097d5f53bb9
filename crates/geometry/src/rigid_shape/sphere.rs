//! A ball.

use super::height::{circle, rising, squared_distance};
use super::{GapJet, NoHeight, RigidShape};
use crate::height_field::{HeightField, View};
use crate::mass_properties::MassProperties;
use crate::{Aabb, Point, Vector};
use std::sync::Arc;

/// A ball.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    pub center: Point<3>,
    pub radius: f64,
}

impl RigidShape for Sphere {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        GapJet::ball(x, &self.center, self.radius)
    }

    fn centre(&self) -> Point<3> {
        self.center
    }

    fn bounds(&self) -> Option<Aabb<3>> {
        let half = Vector::<3>::repeat(self.radius);
        Some(Aabb::new(self.center - half, self.center + half))
    }

    fn mass_properties(&self) -> Option<MassProperties> {
        Some(MassProperties::ball(self.center, self.radius))
    }

    fn height(&self, view: View, _: f64) -> Result<Arc<dyn HeightField>, NoHeight> {
        let Sphere { center, radius } = *self;
        Ok(rising(view, center[2], move |x| circle(squared_distance(x, &center, [1.0; 2]), radius)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing;
    use super::*;
    use crate::Vector;

    #[test]
    fn the_gap_of_a_sphere() {
        let sphere = Sphere { center: Point::<3>::new(0.1, 0.0, 0.3), radius: 0.4 };
        let way = Vector::<3>::new(0.48, -0.6, 0.64);
        testing::check(&sphere, &[sphere.center + Vector::<3>::y() * 0.4, sphere.center + way * 0.4]);
        testing::check_height(&sphere, View::FromAbove);
        testing::check_height(&sphere, View::FromBelow);
        testing::check_moved(&sphere, |m| Sphere { center: m.point(&sphere.center), ..sphere });
        let inside = sphere.gap(&sphere.center);
        assert_eq!((inside.gap, inside.normal.norm()), (-0.4, 1.0));
    }
}
