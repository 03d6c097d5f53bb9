//! Of `sizing`.

use signorini_geometry::Point;
use signorini_membrane::sizing::Sizing;

#[test]
fn a_straight_front_has_the_size_that_it_wants_and_cells_grow_from_there() {
    let places = |size: f64| (-4000..4000).map(move |k| (Point::<2>::new(1e-3 * f64::from(k), 0.0), 1e-3, size));
    let sizing = Sizing::new(places(0.02));
    assert!((sizing.at(&Point::<2>::zeros()) / 0.02 - 1.0).abs() < 1e-3);
    assert_eq!(sizing.divisions(&Point::<2>::zeros(), 0.08), 2);
    // A short part that wants less.
    let sharp = (-40..40).map(|k| (Point::<2>::new(1e-3 * f64::from(k), 0.0), 1e-3, 0.005));
    let sizing = Sizing::new(places(0.1).chain(sharp));
    let at = |x: f64| sizing.at(&Point::<2>::new(x, 0.0));
    assert!(at(0.0) < 0.0065 && at(0.2) > 0.03 && at(2.0) > 0.09, "{} {} {}", at(0.0), at(0.2), at(2.0));
}
