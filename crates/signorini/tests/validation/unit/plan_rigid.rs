//! Of `plan::rigid`.

use signorini::expression::Expression;
use signorini::problem::KeyPath;
use signorini::testing::{LocatedExpression, RigidBody};
use signorini_geometry::rigid_shape::{GapJet, Plane};
use signorini_geometry::{Point, Vector};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

#[test]
fn a_turned_body_turns_its_gap_and_normal() {
    let number = |v: f64| LocatedExpression { expression: Expression::number(v), key: KeyPath::default() };
    let plane = Plane { point: Point::<3>::new(1.0, 0.0, 0.0), normal: Vector::<3>::y() };
    let displacement = vec![number(0.0), number(0.5)];
    let body = RigidBody::new("plane", Arc::new(plane), displacement, vec![number(FRAC_PI_2)]);
    // A quarter turn lets the plane look along -x, through (1, 0.5, 0).
    let problem = signorini::case::read("case", "space = \"3d\"\n[bodies]\n", &[]).unwrap();
    let GapJet { gap, normal, .. } = body.gap_at(&problem, 0.0).unwrap()(&Point::<3>::new(0.25, 7.0, 0.0));
    assert!((gap - 0.75).abs() < 1e-14 && (normal + Vector::<3>::x()).norm() < 1e-14, "{gap} {normal:?}");
}
