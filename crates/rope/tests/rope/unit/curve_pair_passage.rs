//! Of `curve_pair::passage`.

use signorini_geometry::Vector;
use signorini_rope::testing::{Moved, crossing, distance, roots, touching};

fn moved(from: [f64; 3], to: [f64; 3]) -> Moved {
    Moved { x: from.into(), way: Vector::<3>::from(to) - Vector::<3>::from(from) }
}

#[test]
fn chords_cross_where_they_do() {
    let still = [moved([-1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]), moved([1.0, 0.0, 0.0], [1.0, 0.0, 0.0])];
    // It falls by 4 from a height of 1, turning.
    let falling =
        |y: f64| [moved([0.2, y - 1.0, 1.0], [0.2, y - 1.0, -3.0]), moved([0.2, y + 1.0, 1.0], [0.5, y + 1.0, -3.0])];
    let pair = [still, falling(0.0)];
    let crossed = crossing(&pair).unwrap();
    assert!((crossed - 0.25).abs() < 1e-12);
    assert!((distance(&pair, 0.1) - 0.6).abs() < 1e-3);
    let touch = touching(&pair, 0.4, crossed);
    assert!((distance(&pair, touch) - 0.4).abs() < 1e-12 && touch < crossed);
    assert!(crossing(&[still, falling(1.5)]).is_none());
    // Ends that meet in the middle leave no way between.
    let halves =
        [[still[0], moved([0.2, 0.0, 0.0], [0.2, 0.0, 0.0])], [moved([0.2, 0.0, 0.0], [0.2, 0.0, 0.0]), still[1]]];
    let straight = [moved([0.2, -1.0, 1.0], [0.2, -1.0, -3.0]), moved([0.2, 1.0, 1.0], [0.2, 1.0, -3.0])];
    assert!(halves.iter().any(|half| crossing(&[*half, straight]).is_some()));
    assert_eq!(roots([-1.0, 4.0, 0.0, 0.0]).len(), 1);
    let three = roots([-0.048, 0.68, -1.5, 1.0].map(|c: f64| c));
    assert!(three.iter().all(|t| (-0.048 + t * (0.68 + t * (-1.5 + t))).abs() < 1e-12), "{three:?}");
}
