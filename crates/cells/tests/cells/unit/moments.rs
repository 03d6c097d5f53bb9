//! Of `moments`.

use signorini_cells::moments::fitted;
use signorini_geometry::{Aabb, Point};

#[test]
fn fitted_weights_integrate_polynomials_of_their_degree() {
    let b = Aabb::new(Point::<3>::new(-1.0, 0.5, 2.0), Point::<3>::new(1.5, 1.0, 5.0));
    let points: Vec<(Point<3>, f64)> = (0..40)
        .map(|i| {
            let t = |k: f64| (f64::from(i) * k).sin().abs();
            (b.at(&Point::<3>::new(t(1.3), t(0.7), t(2.9))), 0.1 + t(0.3))
        })
        .collect();
    let fit = fitted(&b, 5, points.iter().copied());
    assert_eq!(fit.len(), 125);
    for powers in [[0, 0, 0], [4, 4, 4], [1, 3, 2], [0, 4, 1]] {
        let f = |x: &Point<3>| (0..3).map(|k| x[k].powi(powers[k])).product::<f64>();
        let expected: f64 = points.iter().map(|(x, w)| w * f(x)).sum();
        let found: f64 = fit.iter().map(|p| p.weight * f(&p.x)).sum();
        assert!((found - expected).abs() < 1e-11 * expected.abs().max(1.0), "{powers:?}: {found} {expected}");
    }
}
