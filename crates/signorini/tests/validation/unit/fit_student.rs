//! Of `fit::student`.

use signorini::testing::bound;

/// Of three digits, as printed in tables.
#[test]
fn bounds_are_those_of_tables() {
    for (confidence, freedom, tabulated) in [
        (0.90, 1, 6.314),
        (0.90, 4, 2.132),
        (0.90, 120, 1.658),
        (0.95, 1, 12.706),
        (0.95, 2, 4.303),
        (0.95, 3, 3.182),
        (0.95, 4, 2.776),
        (0.95, 5, 2.571),
        (0.95, 10, 2.228),
        (0.95, 30, 2.042),
        (0.95, 100, 1.984),
        (0.99, 1, 63.657),
        (0.99, 2, 9.925),
        (0.99, 5, 4.032),
        (0.99, 10, 3.169),
        (0.99, 30, 2.750),
    ] {
        let bound = bound(confidence, freedom);
        assert!((bound - tabulated).abs() <= 5.1e-4, "{confidence}, {freedom}: {bound}, not {tabulated}");
    }
    assert!(bound(0.95, 0).is_nan());
    // Of one degree it is Cauchy's, of two it has a closed form.
    assert!((bound(0.7, 1) - (0.35 * std::f64::consts::PI).tan()).abs() < 1e-14);
    assert!((bound(0.7, 2) - 0.7 * (2.0 / (1.0 - 0.49f64)).sqrt()).abs() < 1e-14);
}
