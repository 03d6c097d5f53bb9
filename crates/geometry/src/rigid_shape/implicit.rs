//! Bodies given by functions, through the exact closest point of their boundary.

use super::{GapJet, RigidShape};
use crate::implicit::ImplicitBody;
use crate::implicit_surface::ImplicitSurface;
use crate::{Jet, Point};

impl RigidShape for ImplicitSurface {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        let foot = self.closest(x);
        GapJet { gap: foot.gap, normal: foot.normal, hessian: foot.hessian }
    }

    /// The function itself where the body is one shape.
    fn level(&self, x: &Point<3>) -> Jet<3> {
        if let ImplicitBody::Shape(shape) = self.body() {
            return shape.jet(x);
        }
        let GapJet { gap, normal, hessian } = self.gap(x);
        Jet { value: gap, gradient: normal, hessian }
    }

    /// The origin: a function says no other.
    fn centre(&self) -> Point<3> {
        Point::<3>::zeros()
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing;
    use super::*;
    use crate::implicit::Function;
    use crate::jet::Real;
    use crate::{Aabb, Vector};

    #[test]
    fn the_gap_of_a_body_given_by_a_function() {
        let field = |x: &Point<3>| {
            let [x, y, z] = [0, 1, 2].map(|k| Jet::<3>::variable(x[k], k));
            let c = Jet::<3>::constant;
            x * x + c(2.0) * y * y + c(3.0) * z * z - c(0.2)
        };
        let bounds = Aabb::new(Point::<3>::repeat(-1.0), Point::<3>::repeat(1.0));
        let surface = ImplicitSurface::new(ImplicitBody::shape(Function(field)), bounds, 40).unwrap();
        let on_it = [Vector::<3>::x() * 0.2f64.sqrt(), Vector::<3>::y() * 0.1f64.sqrt()];
        testing::check(&surface, &on_it);
        testing::check_level(&surface, &on_it);
    }
}
