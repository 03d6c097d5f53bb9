//! Of `path::sample`.

use signorini_geometry::Point;
use signorini_geometry::shape::Axes;
use signorini_rope::centreline::{Closure, Continuity};
use signorini_rope::path::{Path, PathError};

fn p(x: f64, y: f64, z: f64) -> Point<3> {
    Point::<3>::new(x, y, z)
}

#[test]
fn elements_of_a_smooth_path_have_equal_lengths() {
    let helix = Path::helix(Axes::new(p(1.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0)).unwrap(), 2.0, 3.0, 1.7);
    let helix = helix.unwrap();
    let exact = 1.7 * (std::f64::consts::TAU.powi(2) * 4.0 + 9.0).sqrt();
    assert!((helix.length() - exact).abs() < 1e-12 * exact);
    let sampled = helix.sample(13, Continuity::C1).unwrap();
    assert!(sampled.lengths.iter().all(|h| (h - exact / 13.0).abs() < 1e-11));
    let chords: Vec<f64> = sampled.positions.windows(2).map(|x| (x[1] - x[0]).norm()).collect();
    assert!(chords.iter().all(|c| (c - chords[0]).abs() < 1e-11));
    let arc = Path::arc([p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0), p(0.0, -1.0, 0.0)]).unwrap();
    assert!((arc.length() - 1.5 * std::f64::consts::PI).abs() < 1e-12);
    let arc = Path::arc([p(1.0, 0.0, 0.0), p(0.0, -1.0, 0.0), p(0.0, 1.0, 0.0)]).unwrap();
    assert!((arc.length() - 1.5 * std::f64::consts::PI).abs() < 1e-12);
    assert!((arc.sample(3, Continuity::C1).unwrap().tangents[0] - p(0.0, -1.0, 0.0)).norm() < 1e-12);
}

#[test]
fn splines_converge_to_what_they_interpolate() {
    for closure in [Closure::Open, Closure::Closed] {
        let error = |n: usize| {
            let point = |k: usize| {
                let t = std::f64::consts::TAU * k as f64 / n as f64;
                p(t.cos(), t.sin(), 0.0)
            };
            let points: Vec<_> = (0..n).map(point).collect();
            let spline = Path::spline(&points, closure).unwrap();
            let exact = std::f64::consts::TAU * if closure == Closure::Open { (n - 1) as f64 / n as f64 } else { 1.0 };
            (spline.length() / exact - 1.0).abs()
        };
        // A natural end is of second order only in the curvature.
        let order = (error(20) / error(40)).log2();
        assert!(order > if closure == Closure::Closed { 3.8 } else { 2.8 }, "{closure:?} {order}");
    }
}

#[test]
fn kinks_take_nodes_or_are_refused() {
    let path = Path::points(&[p(0.0, 0.0, 0.0), p(3.0, 0.0, 0.0), p(3.0, 1.0, 0.0)], Closure::Open).unwrap();
    assert!(
        matches!(path.sample(8, Continuity::C1), Err(PathError::Kink { degrees, .. }) if (degrees - 90.0).abs() < 1e-9)
    );
    let sampled = path.sample(8, Continuity::C0).unwrap();
    assert_eq!(sampled.positions[6], p(3.0, 0.0, 0.0));
    assert!(sampled.lengths.iter().all(|h| (h - 0.5).abs() < 1e-14));
    assert!(matches!(path.sample(1, Continuity::C0), Err(PathError::TooFewCells { needed: 2, .. })));
    let straight = Path::points(&[p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(5.0, 0.0, 0.0)], Closure::Open).unwrap();
    assert_eq!(straight.sample(4, Continuity::C1).unwrap().positions.len(), 5);
    let square = [p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(1.0, 1.0, 0.0), p(0.0, 1.0, 0.0)];
    let ring = Path::points(&square, Closure::Closed).unwrap().sample(8, Continuity::C0).unwrap();
    assert_eq!((ring.positions.len(), ring.lengths.len()), (8, 8));
    assert!(ring.positions.iter().step_by(2).zip(square).all(|(a, b)| (a - b).norm() < 1e-12));
}

#[test]
fn paths_that_are_none_are_refused() {
    let twice = Path::points(&[p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(1.0, 0.0, 0.0)], Closure::Open);
    assert!(matches!(twice, Err(PathError::Repeated { first: 1, second: 2, .. })));
    let eight = [p(0.0, 0.0, 0.0), p(2.0, 2.0, 0.0), p(2.0, 0.0, 0.0), p(0.0, 2.0, 0.0)];
    let eight = Path::points(&eight, Closure::Open).unwrap();
    match eight.sample(9, Continuity::C0) {
        Err(PathError::CrossesItself { at, .. }) => {
            assert!((at[0] - 1.0).abs() < 1e-12 && (at[1] - 1.0).abs() < 1e-12)
        }
        other => panic!("{other:?}"),
    }
    assert!(matches!(Path::points(&[p(0.0, 0.0, 0.0)], Closure::Open), Err(PathError::TooFewPoints { .. })));
    assert!(Path::spline(&[p(0.0, f64::NAN, 0.0), p(1.0, 0.0, 0.0)], Closure::Open).is_err());
    assert!(Path::arc([p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(2.0, 0.0, 0.0)]).is_err());
    // A loop that ends where it starts is none.
    let ring = [p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(1.0, 1.0, 0.0), p(0.0, 0.0, 0.0)];
    assert!(Path::points(&ring, Closure::Open).unwrap().sample(6, Continuity::C0).is_ok());
}
