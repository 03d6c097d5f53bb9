//! What every rigid shape must fulfil.

use super::RigidShape;
use crate::height_field::View;
use crate::rigid::RigidMotion;
use crate::{Matrix, Point, Vector};

/// Places inside and outside of shapes of size one about the origin, away from where normals jump.
pub const PLACES: [[f64; 3]; 5] =
    [[0.5, 0.4, 0.6], [0.45, -0.3, 0.2], [-0.3, 0.2, 0.05], [0.0, -0.4, 0.3], [0.2, 0.4, -0.1]];

/// The gap vanishes at points of the surface and has the derivatives that it says, there and anywhere.
pub fn check(shape: &dyn RigidShape, surface: &[Point<3>]) {
    for x in surface {
        let found = shape.gap(x);
        assert!(found.gap.abs() < 1e-12 && (found.normal.norm() - 1.0).abs() < 1e-9, "at {x:?}: {found:?}");
    }
    for x in PLACES {
        check_derivatives(shape, &x.into());
    }
}

/// The level function vanishes on the surface; there its direction and its curvature are those of the gap.
pub fn check_level(shape: &dyn RigidShape, surface: &[Point<3>]) {
    for x in surface {
        let (level, gap) = (shape.level(x), shape.gap(x));
        let length = level.gradient.norm();
        assert!(level.value.abs() < 1e-12 * length && (level.gradient / length - gap.normal).norm() < 1e-9, "at {x:?}");
        let flat = Matrix::<3>::identity() - gap.normal * gap.normal.transpose();
        let error = (flat * level.hessian * flat / length - gap.hessian).norm();
        assert!(error < 1e-8 * (1.0 + gap.hessian.norm()), "at {x:?}: {level:?} and {gap:?}");
    }
}

/// Normal and Hessian against central differences of gap and normal.
pub fn check_derivatives(shape: &dyn RigidShape, x: &Point<3>) {
    let found = shape.gap(x);
    assert!((found.normal.norm() - 1.0).abs() < 1e-9, "at {x:?}: {found:?}");
    for i in 0..3 {
        let h = 1e-6;
        let mut step = Vector::<3>::zeros();
        step[i] = h;
        let [after, before] = [shape.gap(&(x + step)), shape.gap(&(x - step))];
        let slope = (after.gap - before.gap) / (2.0 * h);
        assert!((slope - found.normal[i]).abs() < 1e-7, "at {x:?}: {slope} and {}", found.normal[i]);
        let turn = (after.normal - before.normal) / (2.0 * h);
        let error = (turn - found.hessian.column(i)).norm();
        assert!(error < 1e-6 * (1.0 + found.hessian.norm()), "at {x:?}: {turn:?} and {:?}", found.hessian);
    }
}

/// A body and a point that move together keep their gap; normal and Hessian turn with them.
pub fn check_moved<S: RigidShape>(shape: &dyn RigidShape, moved: impl Fn(&RigidMotion) -> S) {
    let turn = Vector::<3>::new(0.3, -0.8, 0.5);
    let motion = RigidMotion::new(turn, Point::<3>::new(0.2, 0.1, 0.0), Vector::<3>::new(1.0, 2.0, -0.5));
    let moved = moved(&motion);
    for x in PLACES.map(Point::<3>::from) {
        let (before, after) = (shape.gap(&x), moved.gap(&motion.point(&x)));
        let hessian = motion.rotation * before.hessian * motion.rotation.transpose();
        assert!((before.gap - after.gap).abs() < 1e-12, "{} {}", before.gap, after.gap);
        assert!((motion.vector(&before.normal) - after.normal).norm() < 1e-10, "at {x:?}");
        assert!((hessian - after.hessian).norm() < 1e-8 * (1.0 + hessian.norm()), "at {x:?}");
    }
    assert!((motion.point(&shape.centre()) - moved.centre()).norm() < 1e-12 || shape.centre() == Point::<3>::zeros());
}

/// What is seen lies on the surface, turned to the viewer, and the height has the derivatives that it says; for shapes that
/// are seen at (0.1, 0.15) and thereabout.
pub fn check_height(shape: &dyn RigidShape, view: View) {
    let height = shape.height(view, 0.0).unwrap();
    for x in [[0.1, 0.15], [0.15, 0.13], [0.08, 0.1]].map(Vector::<2>::from) {
        let jet = height.jet(&x);
        let found = shape.gap(&Point::<3>::new(x[0], x[1], jet.value));
        assert!(found.gap.abs() < 1e-13 && found.normal[2] * view.sign() > 0.0, "at {x:?}: {jet:?}, {found:?}");
        // The normal is along (-∇h, 1).
        let slope = -found.normal.fixed_rows::<2>(0) / found.normal[2];
        assert!((slope - jet.gradient).norm() < 1e-9, "at {x:?}: {slope:?} and {jet:?}");
        for k in 0..2 {
            let mut step = Vector::<2>::zeros();
            step[k] = 1e-6;
            let [after, before] = [x + step, x - step].map(|x| height.jet(&x).gradient);
            let bend = (after - before) / 2e-6;
            assert!((bend - jet.hessian.column(k)).norm() < 1e-6 * (1.0 + jet.hessian.norm()), "at {x:?}: {bend:?}");
        }
    }
}
