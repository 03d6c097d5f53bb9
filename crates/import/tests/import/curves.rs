use signorini_import::curve::Curve;

#[test]
fn curves_are_linear_between_points_and_constant_beyond() {
    let curve = Curve::through([[0.0, 1.0], [2.0, 5.0], [3.0, 5.0]]);
    for (t, v) in [(-1.0, 1.0), (0.0, 1.0), (0.5, 2.0), (2.0, 5.0), (9.0, 5.0)] {
        assert_eq!(curve.at(t), v, "at {t}");
    }
    assert_eq!(curve.as_constant(), None);
    assert_eq!(curve.as_ramp(2.0), None);
    assert_eq!(Curve::through([[0.0, 0.0], [1.0, 3.0], [2.0, 6.0]]).as_ramp(2.0), Some(3.0));
    // A ramp that ends before the last step does not go on.
    assert_eq!(Curve::through([[0.0, 0.0], [1.0, 3.0]]).as_ramp(2.0), None);
}
